#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "adamas/progress.h"
#include "core/base/error.h"
#include "core/io/input_formats.h"
#include "core/io/reader_program.h"
#include "core/io/volume_reader.h"

namespace adamas::io {

/// A volume that a library reads, without its samples.
struct ImportedVolume {
  std::array<std::uint64_t, 3> dimensions{};
  StoredType stored = StoredType::kUint8;
  double slope = 1, intercept = 0;  ///< as in VolumeSource
  Vec3 spacing{1, 1, 1};
  Vec3 origin;
  std::array<Vec3, 3> directions = VolumeGrid::kStraight;
};

/// The greatest ratio of decompressed to compressed bytes in the formats of these libraries.
inline constexpr std::uint64_t kGreatestExpansion = 10'000;

/// Sends an imported volume from the child: the volume first, then its samples in order.
class ImportSink {
 public:
  ImportSink(const ReaderRequest& request, ByteSink& bytes) : request_(request), bytes_(bytes) {}

  /// Sends the volume without its samples. Throws Error if files of that size cannot hold it.
  void begin(const ImportedVolume& volume, const std::string& array = {}, const std::string& remark = {});
  void samples(std::span<const std::byte> bytes) { bytes_.write(bytes.data(), bytes.size()); }

 private:
  const ReaderRequest& request_;
  ByteSink& bytes_;
};

/// Lets a library read a volume in a child process (read_in_child) and returns a source of its samples, which
/// are in a scratch file in `options`' folder. Throws Error if the child did, if it crashed, and if there are
/// too few samples, or more than a file of that size may hold.
VolumeSource import_volume(const ReaderRequest& request, const VolumeOptions& options, Progress& progress);

/// Imports a volume of HDF5: the data set that `options.array` names, or the only numeric one along three
/// axes, the slowest being z, or the time `options.time` of one along four, the slowest being time. Its
/// attribute "element_size_um" gives the spacing (z, y, x), as ilastik and Fiji write it.
VolumeSource import_hdf5(const std::filesystem::path& path, const VolumeOptions& options, Progress& progress);
/// Finds the series in a file of HDF5 (find_volume_series), in a child process.
VolumeSeries find_hdf5_series(const std::filesystem::path& path, const std::string& array);
/// Imports a volume that VTK reads on an image grid: the point array that `options.array` names, or the only
/// one with one value per sample.
VolumeSource import_grid(const std::filesystem::path& path, const VolumeOptions& options, Progress& progress);
/// Imports a volume of pictures, TIFF or PNG, one plane each, or of the pages of one TIFF; rows as stored,
/// the first at y = 0.
VolumeSource import_stack(const std::vector<std::filesystem::path>& paths, const Vec3& spacing,
                          const Vec3& origin, const VolumeOptions& options, Progress& progress);

}  // namespace adamas::io
