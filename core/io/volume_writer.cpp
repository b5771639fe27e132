#include "core/io/volume_writer.h"

#include <algorithm>
#include <bit>
#include <string_view>

#include "core/base/assert.h"
#include "core/base/error.h"
#include "core/io/input_file.h"
#include "core/io/sample_values.h"
#include "core/io/volume_headers.h"

namespace adamas::io {

namespace {

static_assert(std::endian::native == std::endian::little, "planes are written as they are");

bool is_nifti(std::string_view extension) { return extension == ".nii" || extension == ".nii.gz"; }

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

std::string lost_places(const std::filesystem::path& path, const VolumeGrid& grid) {
  const std::string extension = file_extension(path);
  const bool anatomical = grid.space == "RAS" || grid.space == "LAS" || grid.space == "LPS";
  if (extension == ".raw") {
    if (grid.is_straight() && grid.space.empty()) return {};
    return path.string() + ": axes, origin and space of the volume are not kept";
  }
  if (is_nifti(extension)) {
    if (anatomical || (grid.is_straight() && grid.space.empty())) return {};
    return fmt::format("{}: the space of coordinates is {}: NIfTI takes them for RAS", path.string(),
                       grid.space.empty() ? "not known" : grid.space);
  }
  if (grid.space.empty() || extension == ".nrrd" || extension == ".nhdr") return {};
  if (anatomical && extension != ".vti" && extension != ".pvd") return {};
  return fmt::format("{}: coordinates are {}, which the file does not say", path.string(), grid.space);
}

bool keeps_scale(const std::filesystem::path& path) { return is_nifti(file_extension(path)); }

bool writes_values(const std::filesystem::path& path, const VolumeGrid& grid) {
  return grid.is_scaled() && !keeps_scale(path);
}

VolumeWriter::VolumeWriter(const std::filesystem::path& path, const VolumeGrid& of_planes,
                           const VolumeWriterOptions& options)
    : grid_(of_planes), writes_values_(writes_values(path, of_planes)) {
  const std::string name = path.string(), extension = file_extension(path);
  grid_.check(name);
  VolumeGrid grid = grid_;
  if (writes_values_) grid.type = SampleType::kFloat32, grid.slope = 1, grid.intercept = 0;
  const bool apart = !volume_data_file(path).empty();
  const auto data_file = options.data_file.empty() ? volume_data_file(path) : options.data_file;
  const auto data_name = options.data_name.empty() ? data_file.filename().string() : options.data_name;
  if (apart) check_data_name(name, data_name);
  std::string text;
  if (extension == ".vti") {
    text = vti_header_text(name, grid, {{options.array}}) + vti_count(grid);
    end_ = kVtiEnd;
  } else if (extension == ".nrrd" || extension == ".nhdr") {
    text = nrrd_header_text(grid, apart ? data_name : "");
  } else if (extension == ".mha" || extension == ".mhd") {
    text = meta_image_header_text(grid, apart ? data_name : "");
  } else if (is_nifti(extension)) {
    text = nifti_header_bytes(grid);
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
  check_room(apart ? data_file : path, grid.bytes());
  header_->write(text);
}

void VolumeWriter::write_plane(std::span<const std::byte> samples) {
  ADAMAS_ASSERT(samples.size() == grid_.plane_bytes() && planes_ < grid_.dimensions[2]);
  if (writes_values_) {
    find_values(grid_, samples, values_);
    samples = std::as_bytes(std::span(values_));
  }
  if (gzip_) {
    gzip_->write(samples.data(), samples.size());
  } else {
    (data_ ? data_ : header_)->write(samples.data(), samples.size());
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
  const std::string text = vti_header_text(path.string(), grid, declared);
  OutputStream stream(path);
  check_room(path, grid.bytes() * arrays.size());
  stream.write(text);
  for (const PointArray& array : arrays) {
    stream.write(vti_count(grid));
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
