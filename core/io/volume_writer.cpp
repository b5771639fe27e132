#include "core/io/volume_writer.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <string_view>

#include "core/base/assert.h"
#include "core/base/error.h"
#include "core/io/input_file.h"
#include "core/io/stored_type.h"
#include "core/io/xml_text.h"

namespace adamas {

namespace {

static_assert(std::endian::native == std::endian::little, "planes are written as they are");

std::string numbers(const Vec3& v, std::string_view separator = " ") {
  return fmt::format("{}{}{}{}{}", v.x, separator, v.y, separator, v.z);
}

std::string sizes(const VolumeGrid& grid) { return fmt::format("{}", fmt::join(grid.dimensions, " ")); }

std::string nrrd_header(const VolumeGrid& grid, const std::string& data_name) {
  return fmt::format(
      "NRRD0004\ntype: {}\ndimension: 3\nspace dimension: 3\nsizes: {}\n"
      "space directions: ({},0,0) (0,{},0) (0,0,{})\nkinds: domain domain domain\nendian: little\n"
      "encoding: raw\nspace origin: ({})\n{}\n",
      grid.type == SampleType::kFloat32 ? "float" : sample_name(grid.type), sizes(grid), grid.spacing.x,
      grid.spacing.y, grid.spacing.z, numbers(grid.origin, ","),
      data_name.empty() ? "" : "data file: " + data_name + "\n");
}

std::string meta_image_header(const VolumeGrid& grid, const std::string& data_name) {
  return fmt::format(
      "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\n"
      "CompressedData = False\nTransformMatrix = 1 0 0 0 1 0 0 0 1\nOffset = {}\nElementSpacing = {}\n"
      "DimSize = {}\nElementType = {}\nElementDataFile = {}\n",
      numbers(grid.origin), numbers(grid.spacing), sizes(grid),
      stored_name(stored_type(grid.type), TypeNames::kMetaImage), data_name.empty() ? "LOCAL" : data_name);
}

std::string vti_header(const std::string& name, const VolumeGrid& grid, const std::string& array) {
  const auto& n = grid.dimensions;
  // VTK counts points along an axis in 32 bits.
  constexpr std::uint64_t kMost = std::numeric_limits<std::int32_t>::max();
  if (std::any_of(n.begin(), n.end(), [](std::uint64_t size) { return size > kMost; })) {
    fail("{}: expected at most {} samples along each axis of a .vti, found {} x {} x {}", name, kMost, n[0],
         n[1], n[2]);
  }
  const std::string extent = fmt::format("0 {} 0 {} 0 {}", n[0] - 1, n[1] - 1, n[2] - 1);
  const std::string quoted = xml_attribute(array);
  std::string text = fmt::format(
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"ImageData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n"
      "  <ImageData WholeExtent=\"{0}\" Origin=\"{1}\" Spacing=\"{2}\">\n"
      "    <Piece Extent=\"{0}\">\n"
      "      <PointData Scalars=\"{3}\">\n"
      "        <DataArray type=\"{4}\" Name=\"{3}\" format=\"appended\" offset=\"0\"/>\n"
      "      </PointData>\n      <CellData/>\n    </Piece>\n  </ImageData>\n"
      "  <AppendedData encoding=\"raw\">\n   _",
      extent, numbers(grid.origin), numbers(grid.spacing), quoted,
      stored_name(stored_type(grid.type), TypeNames::kVtk));
  const std::uint64_t bytes = grid.bytes();
  text.append(reinterpret_cast<const char*>(&bytes), sizeof(bytes));
  return text;
}

/// A pattern, a list, the header's own file, or nothing at all would be read from other names.
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

VolumeWriter::VolumeWriter(const std::filesystem::path& path, const VolumeGrid& grid,
                           const VolumeWriterOptions& options)
    : grid_(grid) {
  const std::string name = path.string(), extension = file_extension(path);
  grid.check(name);
  const bool apart = !volume_data_file(path).empty();
  const auto data_file = options.data_file.empty() ? volume_data_file(path) : options.data_file;
  const auto data_name = options.data_name.empty() ? data_file.filename().string() : options.data_name;
  if (apart) check_data_name(name, data_name);
  std::string text;
  if (extension == ".vti") {
    text = vti_header(name, grid, options.array);
    end_ = "\n  </AppendedData>\n</VTKFile>\n";
  } else if (extension == ".nrrd" || extension == ".nhdr") {
    text = nrrd_header(grid, apart ? data_name : "");
  } else if (extension == ".mha" || extension == ".mhd") {
    text = meta_image_header(grid, apart ? data_name : "");
  } else if (extension != ".raw") {
    fail("{}: expected .vti, .nrrd, .nhdr, .mha, .mhd or .raw for a volume, found '{}'", name, extension);
  }
  header_ = std::make_unique<OutputStream>(path);
  if (apart) data_ = std::make_unique<OutputStream>(data_file);
  check_room(apart ? data_file : path, grid.bytes());
  header_->write(text);
}

void VolumeWriter::write_plane(std::span<const std::byte> samples) {
  ADAMAS_ASSERT(samples.size() == grid_.plane_bytes() && planes_ < grid_.dimensions[2]);
  (data_ ? data_ : header_)->write(samples.data(), samples.size());
  ++planes_;
}

void VolumeWriter::finish() {
  ADAMAS_ASSERT(planes_ == grid_.dimensions[2]);
  header_->write(end_);
  if (data_) data_->close();
  header_->close();
  if (data_) data_->commit();
  header_->commit();
}

}  // namespace adamas
