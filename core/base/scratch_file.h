#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>

namespace adamas::inline core {

/// Bytes for a while in a file without a name, which is gone with its last user, however that ends.
class ScratchFile {
 public:
  /// An empty folder is that of the system. Throws Error where it cannot hold files.
  explicit ScratchFile(std::filesystem::path folder);
  ~ScratchFile();
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;

  /// Throws Error where there is no room.
  void write(std::uint64_t at, std::span<const std::byte> bytes);
  /// Reads what was written there; throws Error where that fails.
  void read(std::uint64_t at, std::span<std::byte> bytes) const;

 private:
  std::filesystem::path folder_;
  int descriptor_;
};

}  // namespace adamas::inline core
