#include <cmath>
#include <utility>

#include "core/base/error.h"
#include "core/io/input_file.h"
#include "core/io/input_formats.h"
#include "core/io/nifti_header.h"

namespace adamas::io {

namespace {

class Parser {
 public:
  Parser(std::string_view text, const std::filesystem::path& path)
      : header_(NiftiHeader::parse(text, path.string())), path_(path) {
    image_.kind = "NIfTI";
    image_.name = source_.name = path.string();
    image_.centers.emplace();
    source_.big_endian = header_.big_endian;
    // Other programs pass over what follows the samples.
    source_.rest = SampleRest::kTold;
  }

  ImageHeader run() {
    set_dimensions();
    set_type();
    find_samples();
    set_places();
    const bool planar = header_.components() == 1;
    image_.arrays.push_back(
        {.name = {}, .centering = Centering::kPoints, .source = std::move(source_), .planar = planar});
    return std::move(image_);
  }

 private:
  void set_dimensions() {
    const std::int64_t axes = header_.dim[0];
    if (axes < 1 || axes > 7) fail("{}: expected one to seven dimensions, found {}", image_.name, axes);
    for (std::size_t axis = 0; axis < static_cast<std::size_t>(axes); ++axis) {
      const std::int64_t size = header_.dim[axis + 1];
      if (size < 1) fail("{}: expected positive sizes, found {}", image_.name, size);
      if (axis < 3) {
        image_.dimensions[axis] = static_cast<std::uint64_t>(size);
      } else if (axis == 3) {
        image_.times = static_cast<std::uint64_t>(size);
      } else if (axis == 4) {
        source_.components = static_cast<std::size_t>(size);
      } else if (size != 1) {
        fail("{}: expected one to five dimensions, found {} values along dimension {}", image_.name, size,
             axis + 1);
      }
    }
    source_.grid.dimensions = image_.dimensions;
    source_.grid.check(image_.name);
  }

  void set_type() {
    const auto type = header_.type();
    if (!type) fail("{}: expected a type of numbers, found the datatype {}", image_.name, header_.datatype);
    source_.set_stored(*type);
    const std::size_t of_type = header_.components();
    const int expected = 8 * static_cast<int>(stored_bytes(*type) * of_type);
    // Some writers leave it empty.
    if (header_.bits != 0 && header_.bits != expected) {
      fail("{}: expected {} bits for samples of {}, found {}", image_.name, expected, stored_name(*type),
           header_.bits);
    }
    if (source_.components > 1 && image_.times > 1)
      fail("{}: expected vectors of one time, found {} times", image_.name, image_.times);
    if (of_type > 1 && source_.components > 1)
      fail("{}: expected vectors of numbers, found some of {} numbers each", image_.name, of_type);
    source_.components *= of_type;
    source_.check_size();
    const double slope = header_.slope, intercept = header_.intercept;
    if (slope == 0 || !std::isfinite(slope) || !std::isfinite(intercept)) return;
    source_.slope = slope;
    source_.intercept = intercept;
    if (source_.scaled()) source_.grid.type = SampleType::kFloat32;
  }

  void find_samples() {
    constexpr double kFarthest = 1 << 30;
    double offset = header_.offset;
    const auto behind = static_cast<double>(header_.bytes);
    if (header_.single && offset == 0) offset = behind + 4;
    const double least = header_.single ? behind : 0;
    if (!(offset >= least && offset <= kFarthest) || offset != std::floor(offset)) {
      fail("{}: expected samples from byte {} on or later, found a vox_offset of {}", image_.name, least,
           offset);
    }
    source_.file = path_;
    if (!header_.single) set_image_file();
    image_.time_spacing = header_.time_spacing();
    image_.time_step = source_.grid.samples() * stored_bytes(source_.stored) * header_.components();
    const bool packed = file_extension(source_.file).ends_with(".gz");
    (packed ? source_.skip_bytes : source_.header_bytes) = static_cast<std::uint64_t>(offset);
    if (packed) source_.coding = SamplePacking::kDeflate;
  }

  /// The samples of x.hdr lie in x.img, or in x.img.gz as well.
  void set_image_file() {
    const std::filesystem::path stem = path_.parent_path() / file_stem(path_);
    const bool upper = path_.extension() == ".HDR";
    source_.file = stem.string() + (upper ? ".IMG" : ".img");
    std::filesystem::path gzip = source_.file;
    gzip += ".gz";
    if (!std::filesystem::exists(source_.file) && std::filesystem::exists(gzip)) source_.file = gzip;
    source_.name += ": " + source_.file.string();
  }

  void set_places() {
    for (int axis = 0; axis < 3; ++axis) image_.spacing[axis] = header_.spacing(axis);
    if (const auto stated = header_.axes()) {
      image_.space = "RAS";
      image_.axes = *stated;
      return;
    }
    for (int axis = 0; axis < 3; ++axis)
      image_.axes.directions[static_cast<std::size_t>(axis)] *= image_.spacing[axis];
  }

  NiftiHeader header_;
  const std::filesystem::path& path_;
  ImageHeader image_;
  VolumeSource source_;
};

/// The header of a pair, of whichever of its files.
std::filesystem::path header_path(const std::filesystem::path& path) {
  if (!file_extension(path).starts_with(".img")) return path;
  const std::filesystem::path header = path.parent_path() / (file_stem(path) + ".hdr");
  std::filesystem::path packed = header;
  packed += ".gz";
  return !std::filesystem::exists(header) && std::filesystem::exists(packed) ? packed : header;
}

ImageHeader read_image(const std::filesystem::path& path) {
  const std::filesystem::path header = header_path(path);
  return nifti_image(read_nifti_header(header), header);
}

VolumeSeries find_series(const std::filesystem::path& path, const std::string& array) {
  // Pictures of high dynamic range end in .hdr too.
  if (read_beginning(path).starts_with("#?")) return {};
  const ImageHeader header = read_image(path);
  if (header.times <= 1) return {};
  if (header.times > kMostVolumeSteps)
    fail("{}: expected at most {} times, found {}", header.name, kMostVolumeSteps, header.times);
  // A file that is cut off is told of before its first times are read.
  const VolumeSource last = volume_of(header, array, header.times - 1);
  if (!last.packed()) static_cast<void>(VolumeReader(last));
  VolumeSeries series{{}, StepTimes::kSpaced};
  for (std::uint64_t n = 0; n < header.times; ++n)
    series.steps.push_back({static_cast<double>(n) * header.time_spacing, {}, n});
  return series;
}

/// Pictures of high dynamic range end in .hdr too.
GridFile read_grid(const std::filesystem::path& path) {
  const bool picture = file_extension(path) == ".hdr" && read_beginning(path).starts_with("#?");
  return picture ? read_grid_by_library(path) : grid_of(read_image(path), path);
}

/// The others that may belong to a pair.
std::vector<std::filesystem::path> others_of_pair(const std::filesystem::path& path) {
  const std::string extension = file_extension(path);
  const bool header = extension.starts_with(".hdr");
  if (!header && !extension.starts_with(".img")) return {};
  std::vector<std::filesystem::path> files;
  for (const char* other :
       {header ? ".img" : ".hdr", header ? ".img.gz" : ".hdr.gz", header ? ".IMG" : ".HDR"})
    files.push_back(path.parent_path() / (file_stem(path) + other));
  return files;
}

bool is_nifti(std::string_view bytes) {
  return (bytes.size() >= 348 && bytes.substr(344, 4) == std::string_view("n+1\0", 4)) ||
         (bytes.size() >= 8 && bytes.substr(4, 4) == std::string_view("n+2\0", 4));
}

}  // namespace

InputFormat nifti_format() {
  return {.name = "NIfTI",
          .endings = ".nii .nii.gz .hdr",
          .more_endings = ".hdr.gz .img .img.gz",
          .shown_by = is_nifti,
          .read_header = read_image,
          .read_grid = read_grid,
          .find_series = find_series,
          .referred_files = others_of_pair,
          .several_times = true};
}

ImageHeader nifti_image(std::string_view text, const std::filesystem::path& path) {
  return Parser(text, path).run();
}

}  // namespace adamas::io
