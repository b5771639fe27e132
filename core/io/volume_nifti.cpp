#include <cmath>

#include "core/base/error.h"
#include "core/io/input_file.h"
#include "core/io/nifti_header.h"
#include "core/io/volume_source.h"

namespace adamas {

namespace {

class Parser {
 public:
  Parser(std::string_view text, const std::filesystem::path& path, std::optional<std::uint64_t> time)
      : header_(NiftiHeader::parse(text, path.string())), path_(path), time_(time) {
    source_.name = path.string();
    source_.big_endian = header_.big_endian;
  }

  VolumeSource run() {
    set_dimensions();
    set_type();
    find_samples();
    set_places();
    return source_;
  }

 private:
  void set_dimensions() {
    const std::int64_t axes = header_.dim[0];
    if (axes < 1 || axes > 7) fail("{}: expected one to seven dimensions, found {}", source_.name, axes);
    source_.grid.dimensions = {1, 1, 1};
    for (std::size_t axis = 0; axis < static_cast<std::size_t>(axes); ++axis) {
      const std::int64_t size = header_.dim[axis + 1];
      if (size < 1) fail("{}: expected positive sizes, found {}", source_.name, size);
      if (axis < 3) {
        source_.grid.dimensions[axis] = static_cast<std::uint64_t>(size);
      } else if (axis == 3) {
        times_ = static_cast<std::uint64_t>(size);
      } else if (size != 1) {
        fail("{}: expected one value per sample, found {} along dimension {}", source_.name, size, axis + 1);
      }
    }
    source_.grid.check(source_.name);
    if (times_ > 1 && !time_)
      fail("{}: expected one time, or which of them by --time (0 to {}), found {} times", source_.name,
           times_ - 1, times_);
    if (time_.value_or(0) >= times_)
      fail("{}: expected a time from 0 to {}, found {}", source_.name, times_ - 1, *time_);
  }

  void set_type() {
    const auto type = header_.type();
    if (!type) {
      fail("{}: expected a type of one number per sample, found the datatype {}", source_.name,
           header_.datatype);
    }
    source_.set_stored(*type);
    const int expected = 8 * static_cast<int>(stored_bytes(*type));
    // Some writers leave it empty.
    if (header_.bits != 0 && header_.bits != expected) {
      fail("{}: expected {} bits for samples of {}, found {}", source_.name, expected, stored_name(*type),
           header_.bits);
    }
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
      fail("{}: expected samples from byte {} on or later, found a vox_offset of {}", source_.name, least,
           offset);
    }
    source_.file = path_;
    if (!header_.single) set_image_file();
    const std::uint64_t before = time_.value_or(0);
    if (before > 0 && source_.sample_file_bytes() > (std::uint64_t{1} << 62) / before)
      fail("{}: expected times that a file can hold, found {}", source_.name, times_);
    const std::uint64_t begin = static_cast<std::uint64_t>(offset) + before * source_.sample_file_bytes();
    const bool packed = file_extension(source_.file).ends_with(".gz");
    (packed ? source_.skip_bytes : source_.header_bytes) = begin;
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
    GridAxes axes;
    if (const auto stated = header_.axes()) {
      source_.grid.space = "RAS";
      axes = *stated;
    } else {
      for (int axis = 0; axis < 3; ++axis)
        axes.directions[static_cast<std::size_t>(axis)] *= header_.spacing(axis);
    }
    source_.set_axes(axes);
  }

  NiftiHeader header_;
  const std::filesystem::path& path_;
  std::optional<std::uint64_t> time_;
  std::uint64_t times_ = 1;
  VolumeSource source_;
};

}  // namespace

VolumeSource nifti_source(std::string_view text, const std::filesystem::path& path,
                          std::optional<std::uint64_t> time) {
  return Parser(text, path, time).run();
}

}  // namespace adamas
