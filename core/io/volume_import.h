#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "core/base/progress.h"
#include "core/io/child_process.h"
#include "core/io/volume_reader.h"

namespace adamas {

/// A volume that a library reads, its samples apart.
struct ImportedVolume {
  std::array<std::uint64_t, 3> dimensions{};
  StoredType stored = StoredType::kUint8;
  Vec3 spacing{1, 1, 1};
  Vec3 origin;
  std::array<Vec3, 3> directions = VolumeGrid::kStraight;
};

/// The end of an import in the child: the volume first, then its samples in order.
class ImportSink {
 public:
  /// `name` and `input_bytes` as of import_volume.
  ImportSink(ByteSink& bytes, const std::string& name, std::uint64_t input_bytes)
      : bytes_(bytes), name_(name), input_bytes_(input_bytes) {}

  /// Throws Error where files of that size cannot hold such a volume.
  void begin(const ImportedVolume& volume, const std::string& remark = {});
  void samples(std::span<const std::byte> bytes) { bytes_.write(bytes.data(), bytes.size()); }

 private:
  ByteSink& bytes_;
  const std::string& name_;
  std::uint64_t input_bytes_;
};

/// Runs `produce`, which calls a library, in a child process (read_in_child) and returns a source of what it
/// hands over, in a scratch file in `options`' folder. `name` begins messages, `input_bytes` is the size of
/// all files. Throws Error where the child did, where it crashed, where there are too few samples, or more
/// than a file of that size may hold.
VolumeSource import_volume(const std::string& name, std::uint64_t input_bytes, const VolumeOptions& options,
                           Progress& progress, const std::function<void(ImportSink&)>& produce);

/// Of HDF5: the data set that `options.array` names, or the only one with numbers along three axes, the
/// slowest being z. Its attribute "element_size_um" gives the spacing (z, y, x), as ilastik and Fiji write
/// it.
VolumeSource import_hdf5(const std::filesystem::path& path, const VolumeOptions& options, Progress& progress);
/// Of what VTK reads on an image grid: the point array that `options.array` names, or the only one with one
/// value per sample.
VolumeSource import_grid(const std::filesystem::path& path, const VolumeOptions& options, Progress& progress);
/// Of pictures, TIFF or PNG, one plane each, or the pages of one TIFF; rows as stored, the first at y = 0.
VolumeSource import_stack(const std::vector<std::filesystem::path>& paths, const Vec3& spacing,
                          const Vec3& origin, const VolumeOptions& options, Progress& progress);

}  // namespace adamas
