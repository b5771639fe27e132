#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "adamas/geometry.h"
#include "adamas/volume.h"
#include "core/data/stored_type.h"
#include "core/io/file_handle.h"
#include "core/io/grid_axes.h"

namespace adamas::io {

/// The form in which a file holds samples.
enum class SamplePacking : std::uint8_t {
  kRaw,
  kDeflate,     ///< one zlib or gzip stream, up to the file's end
  kRawDeflate,  ///< one deflate stream without a header, as in zip archives
  kBzip2,       ///< bzip2 streams, up to the file's end
  kText,        ///< decimal numbers with blanks or commas between them
  kVtkBlocks,   ///< numbers and sizes of blocks, then a zlib stream for each
};

/// How bytes behind the samples are treated: they are other data of the format; unknown bytes, which a remark
/// mentions; or a sign that the header states another size than the data have, which is refused.
enum class TrailingBytes : std::uint8_t { kOtherData, kRemark, kRefused };

/// The place and form of the samples of one array of a file.
struct VolumeSource {
  std::string name;  ///< for messages
  std::filesystem::path file;
  std::vector<std::filesystem::path> more_files;  ///< files whose bytes follow those of `file`; usually none
  std::uint64_t header_bytes = 0;                 ///< bytes before the samples
  std::uint64_t skip_lines = 0;                   ///< lines to skip behind them
  /// Bytes to skip behind those; decompressed bytes if the samples are compressed.
  std::uint64_t skip_bytes = 0;
  bool at_end = false;  ///< whether the samples are the file's last bytes instead
  TrailingBytes trailing = TrailingBytes::kOtherData;
  std::size_t count_bytes = 0;  ///< size of the unsigned number before the samples that counts their bytes
  StoredType stored = StoredType::kUint8;
  std::size_t components = 1;  ///< numbers per sample, which follow each other; a volume has one
  bool big_endian = false;
  SamplePacking coding = SamplePacking::kRaw;
  std::uint32_t checksum = 0;  ///< of kRawDeflate: the CRC-32 of all unpacked bytes, skipped ones included
  bool base64 = false;         ///< the coded bytes are written as base64
  bool before_tag = false;     ///< whether the coded bytes end where the next XML tag begins
  /// A file that holds the unpacked samples instead; null if there is none.
  std::shared_ptr<const FileHandle> scratch;
  double slope = 1, intercept = 0;  ///< a sample is slope * number + intercept (see keep_scale)
  std::string kind;                 ///< what the file is, as ImageHeader::kind; empty if no header tells
  std::string array;                ///< the array's name; empty if the file has none
  /// The other arrays that could be read, if the file itself says which array is shown and none was named.
  std::vector<std::string> other_arrays;
  std::string remark;  ///< what the file holds and is ignored; usually empty
  VolumeGrid grid;     ///< the grid, with the type that the samples are read as

  [[nodiscard]] std::uint64_t values() const { return grid.samples() * components; }
  [[nodiscard]] std::uint64_t sample_file_bytes() const { return values() * stored_bytes(stored); }
  [[nodiscard]] bool packed() const { return coding != SamplePacking::kRaw || base64 || !more_files.empty(); }
  [[nodiscard]] bool scaled() const { return slope != 1 || intercept != 0; }
  void set_stored(StoredType type);
  /// Makes the numbers themselves the samples, or floats of them where there is no such type of samples, and
  /// leaves the scale to the grid, if numbers are whole and the slope is positive.
  void keep_scale();
  /// Sets spacing, directions and origin; the samples stay in the file's order. Throws Error if a step has no
  /// length or the axes lie in one plane.
  void set_axes(const GridAxes& axes);
  /// The size of all samples in messages: "24 bytes for 2 x 3 x 4 samples of uint8".
  [[nodiscard]] std::string size_text() const;
  /// Throws Error if the numbers of all samples take more bytes than can be counted.
  void check_size() const;
};

}  // namespace adamas::io
