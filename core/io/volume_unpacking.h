#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string_view>

#include "adamas/progress.h"
#include "core/base/error.h"
#include "core/io/volume_source.h"

namespace adamas::io {

/// Takes the unpacked samples of a volume into a scratch file.
class SampleSink {
 public:
  /// `source` stays with the caller; `scratch` is empty.
  SampleSink(const VolumeSource& source, std::shared_ptr<FileHandle> scratch, Progress& progress);

  /// Takes the first `expected` bytes in all and leaves the others alone. False where there were others: no
  /// more is wanted. Throws Cancelled, and Error where the disk is full or the source refuses others.
  bool take(std::span<const std::byte> bytes);
  bool take(std::string_view text) { return take(std::as_bytes(std::span(text.data(), text.size()))); }

  [[nodiscard]] std::uint64_t expected() const { return expected_; }
  [[nodiscard]] std::uint64_t found() const { return file_->size(); }
  /// The source, with its samples in the scratch file as they are stored. Throws Error where there are fewer
  /// than expected.
  [[nodiscard]] VolumeSource finish() const;

 private:
  void note_others(std::uint64_t bytes);

  const VolumeSource& source_;
  Progress& progress_;
  std::shared_ptr<FileHandle> file_;
  std::uint64_t expected_ = 0, reported_ = 0;
  std::string remark_;  ///< on bytes that are not taken
};

/// Unpacks the samples of a packed source into a scratch file in `folder` and returns the source that reads
/// them there. Throws Error where they are corrupt or not as many as the header says, or the disk is full;
/// Cancelled.
VolumeSource unpack_volume(VolumeSource source, const std::filesystem::path& folder, Progress& progress);
/// The same into an empty scratch file.
VolumeSource unpack_into(std::shared_ptr<FileHandle> scratch, const VolumeSource& source, Progress& progress);

/// How many bytes an array of a VTK file has by what stands before it or, where it is text, by counting; of
/// the source's grid nothing is looked at.
std::uint64_t measure_vtk_array(const VolumeSource& source);

}  // namespace adamas::io
