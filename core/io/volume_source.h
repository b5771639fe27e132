#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "core/data/volume.h"
#include "core/io/file_handle.h"
#include "core/io/grid_axes.h"
#include "core/io/stored_type.h"
#include "core/io/xml_skeleton.h"

namespace adamas {

/// How the bytes of a file stand for samples.
enum class SamplePacking : std::uint8_t {
  kRaw,
  kDeflate,    ///< one zlib or gzip stream, up to the file's end
  kBzip2,      ///< bzip2 streams, up to the file's end
  kText,       ///< decimal numbers with blanks or commas between them
  kVtkBlocks,  ///< numbers and sizes of blocks, then a zlib stream for each
};

/// What the header of a volume comes to: where its samples lie, and how.
struct VolumeSource {
  std::string name;  ///< for messages
  std::filesystem::path file;
  std::uint64_t header_bytes = 0;  ///< at the file's beginning
  std::uint64_t skip_lines = 0;    ///< behind them, and
  std::uint64_t skip_bytes = 0;    ///< behind those, of the decompressed bytes where they are compressed
  bool at_end = false;             ///< instead: the samples are the file's last bytes
  bool exact = false;              ///< nothing may follow the samples
  std::size_t count_bytes = 0;     ///< of an unsigned number before them, how many bytes they take
  StoredType stored = StoredType::kUint8;
  bool big_endian = false;
  SamplePacking coding = SamplePacking::kRaw;
  bool base64 = false;      ///< the coded bytes are written as base64
  bool before_tag = false;  ///< they end where the next XML tag begins
  /// Where the samples are the bytes of this file instead, unpacked.
  std::shared_ptr<const FileHandle> scratch;
  double slope = 1, intercept = 0;  ///< a sample is slope * number + intercept
  std::string remark;               ///< what the header says and nobody follows; mostly empty
  VolumeGrid grid;                  ///< with the type that the samples become

  [[nodiscard]] std::uint64_t sample_file_bytes() const { return grid.samples() * stored_bytes(stored); }
  [[nodiscard]] bool packed() const { return coding != SamplePacking::kRaw || base64; }
  [[nodiscard]] bool scaled() const { return slope != 1 || intercept != 0; }
  void set_stored(StoredType type);
  /// Sets spacing, directions and origin; the samples stay in the file's order. Throws Error where a step has
  /// no length or the axes lie in one plane.
  void set_axes(const GridAxes& axes);
};

/// The text of a header, which begins the file `path`, as a source; sizes of files are not looked at. Throws
/// Error, with the path, at anything but one value per sample.
VolumeSource nrrd_source(std::string_view text, const std::filesystem::path& path);
VolumeSource meta_image_source(std::string_view text, const std::filesystem::path& path);
/// Of the point array of that name or, where it is empty, the active scalars or the only array.
VolumeSource vti_source(const XmlSkeleton& skeleton, const std::filesystem::path& path,
                        const std::string& array);
/// NIfTI-1 and NIfTI-2. The samples of a pair lie in the .img beside. Of several times, `time` is the number
/// of the one to read, from 0 on.
VolumeSource nifti_source(std::string_view text, const std::filesystem::path& path,
                          std::optional<std::uint64_t> time = {});

}  // namespace adamas
