#include "core/io/volume_writer.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <filesystem>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "adamas/geometry.h"
#include "adamas/volume.h"
#include "core/base/assert.h"
#include "core/base/error.h"
#include "core/data/anatomical_space.h"
#include "core/data/stored_type.h"
#include "core/io/input_file.h"
#include "core/io/nifti_header.h"
#include "core/io/vti_header.h"
#include "core/io/xml_file.h"

namespace adamas::io {

namespace {

static_assert(std::endian::native == std::endian::little, "planes are written as they are");

/// An array of a .vti: its values are slope * sample + intercept, which are stated as attributes if they
/// differ from the samples.
struct VtiArray {
  std::string name;
  double slope = 1, intercept = 0;
};
/// The end of a .vti, after the samples.
constexpr const char* kVtiEnd = "\n  </AppendedData>\n</VTKFile>\n";

std::string numbers(const Vec3& v, std::string_view separator = " ") {
  // Adding zero removes the sign of a negative zero.
  return fmt::format("{}{}{}{}{}", v.x + 0.0, separator, v.y + 0.0, separator, v.z + 0.0);
}

std::string sizes(const VolumeGrid& grid) { return fmt::format("{}", fmt::join(grid.dimensions, " ")); }

Vec3 step(const VolumeGrid& grid, int axis) {
  return grid.spacing[axis] * grid.directions[static_cast<std::size_t>(axis)];
}

/// The orientation of axes in the notation of MetaImage: for each axis the side of the body, in LPS, that it
/// leads away from most; each of the three pairs of sides occurs once.
std::string anatomical_orientation(const VolumeGrid& grid) {
  constexpr std::array<std::array<char, 2>, 3> kFrom{{{'R', 'L'}, {'A', 'P'}, {'I', 'S'}}};
  std::array<int, 3> order{0, 1, 2}, best = order;
  double greatest = -1;
  do {
    double product = 1;
    for (std::size_t a = 0; a < 3; ++a) product *= std::abs(grid.directions[a][order[a]]);
    if (product > greatest) best = order;
    greatest = std::max(greatest, product);
  } while (std::next_permutation(order.begin(), order.end()));
  std::string text;
  for (std::size_t a = 0; a < 3; ++a) {
    const auto side = static_cast<std::size_t>(best[a]);
    text += kFrom[side][grid.directions[a][best[a]] < 0 ? 1 : 0];
  }
  return text;
}

/// The lines of a NRRD file that tell units.
std::string nrrd_units(const VolumeGrid& grid) {
  std::string lines;
  if (!grid.length_unit.empty())
    lines += fmt::format("space units: \"{0}\" \"{0}\" \"{0}\"\n", grid.length_unit);
  if (!grid.value_unit.empty()) lines += fmt::format("sample units: {}\n", grid.value_unit);
  return lines;
}

/// The header of a NRRD file. `data_name`: the file of the samples, empty if they follow.
std::string nrrd_header_text(const VolumeGrid& grid, StoredType type, const std::string& data_name) {
  const std::string name = type == StoredType::kFloat32   ? "float"
                           : type == StoredType::kFloat64 ? "double"
                                                          : stored_name(type);
  const std::string space = nrrd_space(grid.space);
  return fmt::format(
      "NRRD0004\ntype: {}\ndimension: 3\n{}sizes: {}\nspace directions: ({}) ({}) ({})\n"
      "kinds: domain domain domain\nendian: little\nencoding: raw\nspace origin: ({})\n{}{}\n",
      name, space.empty() ? "space dimension: 3\n" : "space: " + space + "\n", sizes(grid),
      numbers(step(grid, 0), ","), numbers(step(grid, 1), ","), numbers(step(grid, 2), ","),
      numbers(grid.origin, ","), nrrd_units(grid), data_name.empty() ? "" : "data file: " + data_name + "\n");
}

/// The header of a MetaImage file. `data_name`: the file of the samples, empty if they follow.
std::string meta_image_header_text(VolumeGrid grid, StoredType type, const std::string& data_name) {
  std::string orientation;
  if (to_space("LPS", grid)) orientation = "AnatomicalOrientation = " + anatomical_orientation(grid) + "\n";
  const auto& [i, j, k] = grid.directions;
  return fmt::format(
      "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\n"
      "CompressedData = False\nTransformMatrix = {} {} {}\nOffset = {}\n{}ElementSpacing = {}\n"
      "DimSize = {}\nElementType = {}\nElementDataFile = {}\n",
      numbers(i), numbers(j), numbers(k), numbers(grid.origin), orientation, numbers(grid.spacing),
      sizes(grid), stored_name(type, TypeNames::kMetaImage), data_name.empty() ? "LOCAL" : data_name);
}

/// What a .vti has no words for, as arrays of its field data, which VTK keeps; empty where there is nothing.
std::string vti_field_data(const VolumeGrid& grid) {
  std::string arrays;
  for (const auto& [name, text] :
       {std::pair(kVtiLengthUnit, grid.length_unit), std::pair(kVtiValueUnit, grid.value_unit),
        std::pair(kVtiSpace, grid.space)}) {
    if (text.empty()) continue;
    std::string codes;
    for (const char c : text) codes += fmt::format("{} ", static_cast<unsigned char>(c));
    arrays += fmt::format(
        "      <Array type=\"String\" Name=\"{}\" NumberOfTuples=\"1\" format=\"ascii\">{}0</Array>\n", name,
        codes);
  }
  return arrays.empty() ? "" : "    <FieldData>\n" + arrays + "    </FieldData>\n";
}

/// The text before the samples of a .vti; vti_count() has to precede each array. Throws Error with `name` if
/// there are too many samples along an axis.
std::string vti_header_text(const std::string& name, const VolumeGrid& grid, StoredType type,
                            const std::vector<VtiArray>& arrays) {
  const auto& n = grid.dimensions;
  // VTK counts points along an axis in 32 bits.
  constexpr std::uint64_t kMost = std::numeric_limits<std::int32_t>::max();
  if (std::any_of(n.begin(), n.end(), [](std::uint64_t size) { return size > kMost; })) {
    fail("{}: expected at most {} samples along each axis of a .vti, found {} x {} x {}", name, kMost, n[0],
         n[1], n[2]);
  }
  const std::string extent = fmt::format("0 {} 0 {} 0 {}", n[0] - 1, n[1] - 1, n[2] - 1);
  const auto& [i, j, k] = grid.directions;
  const std::string direction = grid.is_straight()
                                    ? ""
                                    : fmt::format(" Direction=\"{} {} {}\"", numbers({i.x, j.x, k.x}),
                                                  numbers({i.y, j.y, k.y}), numbers({i.z, j.z, k.z}));
  std::string declared;
  std::uint64_t offset = 0;
  for (const VtiArray& array : arrays) {
    const std::string scale =
        array.slope == 1 && array.intercept == 0
            ? ""
            : fmt::format(" slope=\"{}\" intercept=\"{}\"", array.slope, array.intercept);
    declared +=
        fmt::format("        <DataArray type=\"{}\" Name=\"{}\"{} format=\"appended\" offset=\"{}\"/>\n",
                    stored_name(type, TypeNames::kVtk), xml_attribute(array.name), scale, offset);
    offset += sizeof(std::uint64_t) + grid.samples() * stored_bytes(type);
  }
  return fmt::format(
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"ImageData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n"
      "  <ImageData WholeExtent=\"{0}\" Origin=\"{1}\" Spacing=\"{2}\"{5}>\n{6}"
      "    <Piece Extent=\"{0}\">\n"
      "      <PointData Scalars=\"{3}\">\n"
      "{4}      </PointData>\n      <CellData/>\n    </Piece>\n  </ImageData>\n"
      "  <AppendedData encoding=\"raw\">\n   _",
      extent, numbers(grid.origin), numbers(grid.spacing), xml_attribute(arrays.front().name), declared,
      direction, vti_field_data(grid));
}

/// The number that precedes an array of a .vti: the size of the array in bytes.
std::string vti_count(const VolumeGrid& grid, StoredType type) {
  const std::uint64_t bytes = grid.samples() * stored_bytes(type);
  return {reinterpret_cast<const char*>(&bytes), sizeof(bytes)};
}

std::string nifti_header_bytes(VolumeGrid grid, StoredType type) {
  to_space("RAS", grid);
  return nifti_file_header(grid, type);
}

bool is_nifti(std::string_view extension) { return extension == ".nii" || extension == ".nii.gz"; }

/// Refuses names that a reader would take for a pattern, a list, the header's own file or nothing.
void check_data_name(const std::string& path, const std::string& data_name) {
  const bool odd =
      std::any_of(data_name.begin(), data_name.end(), [](char c) { return c == '%' || (c >= 0 && c < ' '); });
  if (odd || data_name.empty() || data_name.front() == ' ' || data_name.back() == ' ' ||
      data_name.starts_with("LIST") || file_stem(data_name).empty()) {
    fail("{}: expected a data file whose name a header can hold, found '{}'", path, data_name);
  }
}

void check_room(const std::filesystem::path& path, std::uint64_t bytes) {
  std::error_code code;
  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
  const auto room = std::filesystem::space(folder, code).available;
  if (!code && room < bytes) {
    fail("{}: expected {} bytes of room on the disk, found {}", path.string(), bytes, room);
  }
}

}  // namespace

std::filesystem::path volume_data_file(const std::filesystem::path& path) {
  const std::string extension = file_extension(path);
  if (extension != ".nhdr" && extension != ".mhd") return {};
  return std::filesystem::path(path).replace_extension(".raw");
}

namespace {

/// Whether a format tells units and spaces of any name.
bool has_words(const std::string& extension) {
  return extension == ".nrrd" || extension == ".nhdr" || extension == ".vti" || extension == ".pvd";
}

/// What a format cannot tell of the units; empty where it tells them. MetaImages are in millimetres, and raw
/// samples have no lengths.
std::string lost_units(const std::string& extension, const VolumeGrid& grid) {
  if (has_words(extension)) return {};
  const std::string& unit = grid.length_unit;
  const bool is_meta_image = extension == ".mha" || extension == ".mhd";
  const bool tells =
      extension == ".raw" || (is_meta_image && unit == "mm") || (is_nifti(extension) && nifti_tells(unit));
  std::vector<std::string> lost;
  if (!unit.empty() && !tells) lost.push_back(fmt::format("of length, {},", unit));
  if (!grid.value_unit.empty()) lost.push_back(fmt::format("of values, {},", grid.value_unit));
  return lost.empty() ? "" : fmt::format("the unit {} is not kept", fmt::join(lost, " and that "));
}

/// What a format cannot tell of the places; empty where it tells them.
std::string lost_axes(const std::string& extension, const VolumeGrid& grid) {
  const bool anatomical = grid.space == "RAS" || grid.space == "LAS" || grid.space == "LPS";
  if (extension == ".raw")
    return grid.is_straight() && grid.space.empty() ? ""
                                                    : "axes, origin and space of the volume are not kept";
  if (is_nifti(extension)) {
    if (anatomical || (grid.is_straight() && grid.space.empty())) return {};
    return fmt::format("the space of coordinates is {}: NIfTI takes them for RAS",
                       grid.space.empty() ? "not known" : grid.space);
  }
  if (grid.space.empty() || anatomical || has_words(extension)) return {};
  return fmt::format("coordinates are {}, which the file does not say", grid.space);
}

}  // namespace

std::string lost_places(const std::filesystem::path& path, const VolumeGrid& grid) {
  const std::string extension = file_extension(path);
  std::string lost = lost_axes(extension, grid);
  if (const std::string units = lost_units(extension, grid); !units.empty())
    lost += (lost.empty() ? "" : "; ") + units;
  return lost.empty() ? "" : path.string() + ": " + lost;
}

bool keeps_scale(const std::filesystem::path& path) { return is_nifti(file_extension(path)); }

bool writes_values(const std::filesystem::path& path, const VolumeGrid& grid) {
  return grid.is_scaled() && !keeps_scale(path);
}

VolumeWriter::VolumeWriter(const std::filesystem::path& path, const VolumeGrid& of_planes,
                           const VolumeWriterOptions& options)
    : grid_(of_planes),
      numbers_(options.numbers.value_or(stored_type(of_planes.type))),
      writes_values_(writes_values(path, of_planes)) {
  const std::string name = path.string(), extension = file_extension(path);
  grid_.check(name);
  VolumeGrid grid = grid_;
  if (writes_values_) grid.slope = 1, grid.intercept = 0;
  const StoredType type = writes_values_ ? StoredType::kFloat32 : numbers_;
  const bool apart = !volume_data_file(path).empty();
  const auto data_file = options.data_file.empty() ? volume_data_file(path) : options.data_file;
  const auto data_name = options.data_name.empty() ? data_file.filename().string() : options.data_name;
  if (apart) check_data_name(name, data_name);
  std::string text;
  if (extension == ".vti") {
    text = vti_header_text(name, grid, type, {{options.array}}) + vti_count(grid, type);
    end_ = kVtiEnd;
  } else if (extension == ".nrrd" || extension == ".nhdr") {
    text = nrrd_header_text(grid, type, apart ? data_name : "");
  } else if (extension == ".mha" || extension == ".mhd") {
    text = meta_image_header_text(grid, type, apart ? data_name : "");
  } else if (is_nifti(extension)) {
    text = nifti_header_bytes(grid, type);
  } else if (extension != ".raw") {
    fail("{}: expected .vti, .nrrd, .nhdr, .mha, .mhd, .nii, .nii.gz or .raw for a volume, found '{}'", name,
         extension);
  }
  header_ = std::make_unique<OutputStream>(path);
  if (apart) data_ = std::make_unique<OutputStream>(data_file);
  if (extension.ends_with(".gz")) {
    gzip_ = std::make_unique<GzipStream>(*header_);
    gzip_->write(text);
    return;
  }
  check_room(apart ? data_file : path, grid.samples() * stored_bytes(type));
  header_->write(text);
}

void VolumeWriter::write_plane(std::span<const std::byte> numbers) {
  ADAMAS_ASSERT(numbers.size() == grid_.plane_samples() * stored_bytes(numbers_) &&
                planes_ < grid_.dimensions[2]);
  if (writes_values_) {
    find_values(grid_, numbers_, numbers, values_);
    numbers = std::as_bytes(std::span(values_));
  }
  if (gzip_) {
    gzip_->write(numbers.data(), numbers.size());
  } else {
    (data_ ? data_ : header_)->write(numbers.data(), numbers.size());
  }
  ++planes_;
}

void VolumeWriter::finish() {
  ADAMAS_ASSERT(planes_ == grid_.dimensions[2]);
  if (gzip_) gzip_->finish();
  header_->write(end_);
  if (data_) data_->close();
  header_->close();
  if (data_) data_->commit();
  header_->commit();
}

void write_point_arrays(const std::filesystem::path& path, const VolumeGrid& grid,
                        const std::vector<PointArray>& arrays) {
  grid.check(path.string());
  std::vector<VtiArray> declared;
  for (const PointArray& array : arrays) declared.push_back({array.name, array.slope, array.intercept});
  const std::string text = vti_header_text(path.string(), grid, stored_type(grid.type), declared);
  OutputStream stream(path);
  check_room(path, grid.bytes() * arrays.size());
  stream.write(text);
  for (const PointArray& array : arrays) {
    stream.write(vti_count(grid, stored_type(grid.type)));
    for (std::uint64_t k = 0; k < grid.dimensions[2]; ++k) {
      const std::span<const std::byte> samples = array.plane(k);
      ADAMAS_ASSERT(samples.size() == grid.plane_bytes());
      stream.write(samples.data(), samples.size());
    }
  }
  stream.write(kVtiEnd);
  stream.finish();
}

}  // namespace adamas::io
