#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "adamas/geometry.h"
#include "adamas/progress.h"
#include "adamas/raw_volume.h"
#include "adamas/volume.h"
#include "core/base/error.h"
#include "core/io/volume_source.h"

namespace adamas::io {

/// Reads the planes of a volume in any order, one plane at a time, whatever the size of the file. Samples
/// have the machine's byte order and the file's order; int8 becomes int16, and the types that VolumeGrid does
/// not know become float32.
class VolumeReader {
 public:
  /// Throws Error if the file is missing or its size is not the one that the source states. The samples must
  /// not be packed.
  explicit VolumeReader(VolumeSource source);

  [[nodiscard]] const VolumeGrid& grid() const { return source_.grid; }
  [[nodiscard]] const VolumeSource& source() const { return source_; }

  /// Reads the samples of plane k, grid().plane_bytes() bytes. Throws Error if they cannot be read.
  void read_plane(std::uint64_t k, std::span<std::byte> samples);

  /// Reads numbers as they are in the file, in the machine's byte order, starting with number `first`.
  void read_stored(std::uint64_t first, std::span<std::byte> numbers);

  /// The number of samples in the planes read so far that differ from the numbers in the file, and the
  /// greatest difference. Numbers that are clamped to the range of the type do not count for the difference.
  [[nodiscard]] std::uint64_t changed() const { return changed_; }
  [[nodiscard]] double greatest_change() const { return greatest_change_; }
  /// Whether numbers that differ in the file may have become equal; whole numbers of at most two bytes stay
  /// different if they are only scaled.
  [[nodiscard]] bool loses_digits() const;
  /// A line on the conversion of the planes read so far; empty where the samples are as in the file.
  [[nodiscard]] std::string note() const;

 private:
  [[nodiscard]] std::string changes() const;
  void find_samples();
  void read_at(std::uint64_t at, std::byte* bytes, std::size_t size);
  void read_as_stored(std::uint64_t at, std::span<std::byte> samples);
  template <class Stored>
  void read_plane_of(std::uint64_t at, std::span<std::byte> samples);
  template <class Stored, class Sample>
  void read_converted(std::uint64_t at, std::span<std::byte> samples);

  VolumeSource source_;
  std::uint64_t begin_ = 0;  ///< offset of the samples in the file
  std::shared_ptr<const FileHandle> file_;
  std::vector<std::byte> buffer_;
  /// Whether each plane was read; a plane that is read again is not counted again.
  std::vector<bool> was_read_;
  std::uint64_t changed_ = 0, cut_off_ = 0;
  double greatest_change_ = 0;
};

/// Notes the remark of the reader on the conversion of the planes read so far, as a loss if digits were lost.
void note_reading(const VolumeReader& reader, Progress& progress);

/// The unpacked samples of all times of a compressed file.
struct UnpackedTimes {
  std::shared_ptr<const FileHandle> samples;  ///< null before the first volume is opened
};

struct VolumeOptions {
  std::string array;  ///< the name of the array, in a file with several
  /// The folder for unpacked samples; empty: the system's folder for temporary files.
  std::filesystem::path scratch_folder;
  std::optional<std::uint64_t>
      time{};  ///< the number of the time, from 0, in a file with several (NIfTI, HDF5, NumPy)
  /// Whether whole numbers with a scale (NIfTI) stay as they are, with VolumeGrid::slope, instead of becoming
  /// floats.
  bool keep_scale = false;
  /// The unpacked samples, shared by calls that open several times of one file one after another.
  std::shared_ptr<UnpackedTimes> all_times{};
};

/// Opens a volume of one value per sample, whose format follows from the extension or, if that is unknown,
/// from the first bytes (docs/file_formats.md lists them). Samples that cannot be read in place, plane by
/// plane, are first unpacked into a file that disappears with the reader; `progress` is for that. Throws
/// Error, with the file's name, at anything else.
VolumeReader open_volume(const std::filesystem::path& path, const VolumeOptions& options = {},
                         Progress& progress = SilentProgress::instance());

/// Opens a file of bare samples. Throws Error unless its size is exactly that of the volume.
VolumeReader open_raw_volume(const std::filesystem::path& path, const RawVolume& volume);

}  // namespace adamas::io
