#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string_view>

#include "adamas/progress.h"
#include "core/base/error.h"
#include "core/io/volume_source.h"

namespace adamas::io {

/// Takes the unpacked samples of a volume, and puts them into a scratch file or gives them on.
class SampleSink {
 public:
  using Put = std::function<void(std::span<const std::byte>)>;

  /// `source` must outlive this object.
  SampleSink(const VolumeSource& source, Put put, Progress& progress);
  /// `scratch` is empty.
  SampleSink(const VolumeSource& source, std::shared_ptr<FileHandle> scratch, Progress& progress);

  /// Takes bytes, up to expected() in all. Returns false if there were more, so that no further ones are
  /// needed. Throws Cancelled, and Error if the disk is full or the source refuses further bytes.
  bool take(std::span<const std::byte> bytes);
  bool take(std::string_view text) { return take(std::as_bytes(std::span(text.data(), text.size()))); }

  [[nodiscard]] std::uint64_t expected() const { return expected_; }
  [[nodiscard]] std::uint64_t found() const { return found_; }
  /// The source with its samples in the scratch file, if there is one, as they are stored. Throws Error if
  /// there are fewer than expected.
  [[nodiscard]] VolumeSource finish() const;

 private:
  void note_others(std::uint64_t bytes);

  const VolumeSource& source_;
  Progress& progress_;
  Put put_;
  std::shared_ptr<FileHandle> file_;
  std::uint64_t expected_ = 0, found_ = 0, reported_ = 0;
  std::string remark_;  ///< a remark on bytes that are not taken
};

/// Unpacks the samples of a packed source into a scratch file in `folder` and returns the source that reads
/// them there. Throws Error if they are corrupt, if their number is not the one in the header, or if the disk
/// is full; and Cancelled.
VolumeSource unpack_volume(VolumeSource source, const std::filesystem::path& folder, Progress& progress);
/// Unpacks the samples of a packed source into an empty scratch file, and returns the source that reads them
/// there.
VolumeSource unpack_into(std::shared_ptr<FileHandle> scratch, const VolumeSource& source, Progress& progress);
/// Unpacks the samples of a packed source and puts them piece by piece, as they are stored. Returns the
/// source as it would be with the samples in a scratch file.
VolumeSource unpack_pieces(const VolumeSource& source, SampleSink::Put put, Progress& progress);

/// The number of bytes of an array of a VTK file, by the count that precedes it or, for text, by counting.
/// The source's grid is not used.
std::uint64_t measure_vtk_array(const VolumeSource& source);

}  // namespace adamas::io
