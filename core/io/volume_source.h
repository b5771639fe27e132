#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "core/data/volume.h"
#include "core/io/grid_axes.h"
#include "core/io/stored_type.h"

namespace adamas {

/// What the header of a volume comes to: where its samples lie, and how.
struct VolumeSource {
  std::string name;  ///< for messages
  std::filesystem::path file;
  std::uint64_t header_bytes = 0;  ///< at the file's beginning
  std::uint64_t skip_lines = 0;    ///< behind them, and
  std::uint64_t skip_bytes = 0;    ///< behind those
  bool at_end = false;             ///< instead: the samples are the file's last bytes
  bool exact = false;              ///< nothing may follow the samples
  std::size_t count_bytes = 0;     ///< of an unsigned number before them, how many bytes they take
  StoredType stored = StoredType::kUint8;
  bool big_endian = false;
  std::array<bool, 3> reversed{};  ///< axes along which the file counts down
  VolumeGrid grid;                 ///< with the type that the samples become

  [[nodiscard]] std::uint64_t sample_file_bytes() const { return grid.samples() * stored_bytes(stored); }
  void set_stored(StoredType type);
  /// Sets spacing, origin and `reversed` for grid.dimensions. Throws Error where an axis is not parallel to
  /// that of its place in x, y, z: others cannot be read plane by plane.
  void set_axes(const GridAxes& axes);
};

/// The text of a header, which begins the file `path`, as a source; sizes of files are not looked at. Throws
/// Error, with the path, at anything but one uncompressed binary value per sample.
VolumeSource nrrd_source(std::string_view text, const std::filesystem::path& path);
VolumeSource meta_image_source(std::string_view text, const std::filesystem::path& path);
/// Of the point array of that name or, where it is empty, the active scalars or the only array.
VolumeSource vti_source(std::string_view text, const std::filesystem::path& path, const std::string& array);

}  // namespace adamas
