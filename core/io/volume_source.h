#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "core/data/volume.h"
#include "core/io/grid_axes.h"

namespace adamas {

/// The type of samples in a file.
enum class StoredType : std::uint8_t {
  kInt8,
  kUint8,
  kInt16,
  kUint16,
  kInt32,
  kUint32,
  kInt64,
  kUint64,
  kFloat32,
  kFloat64
};

/// Size of one sample in a file.
std::size_t stored_bytes(StoredType type);
/// "int8", "float64".
const char* stored_name(StoredType type);
std::optional<StoredType> find_stored_type(std::string_view name);
/// What such samples become: themselves, int16 for int8, else float32.
SampleType sample_type_for(StoredType type);

/// What the header of a volume comes to: where its samples lie, and how.
struct VolumeSource {
  std::string name;    ///< for messages
  std::string format;  ///< "NRRD"
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
