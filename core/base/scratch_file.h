#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>

namespace adamas::inline core {

/// A temporary file without a name, which disappears with its last user, however that ends.
class ScratchFile {
 public:
  /// Makes an empty file in a folder; an empty path stands for the system's folder for temporary files.
  /// Throws Error where no file can be made.
  explicit ScratchFile(std::filesystem::path folder);
  ~ScratchFile();
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;

  /// Writes bytes from `at` on. Throws Error where there is no room.
  void write(std::uint64_t at, std::span<const std::byte> bytes);
  /// Reads bytes that were written, from `at` on. Throws Error where that fails.
  void read(std::uint64_t at, std::span<std::byte> bytes) const;

 private:
  std::filesystem::path folder_;
  int descriptor_;
};

}  // namespace adamas::inline core
