#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

namespace adamas::inline core {

/// Opens an empty file without a name in a folder, for reading and writing. It disappears with its last user,
/// however that ends. Returns its descriptor. Throws Error where the folder cannot hold one.
int open_unnamed_file(const std::filesystem::path& folder);

/// The system's folder for temporary files: that of the variable TMPDIR, or /tmp. Throws Error, which names
/// the variable, where it is no folder.
std::filesystem::path temporary_folder();

/// A temporary file without a name, which disappears with its last user, however that ends.
class ScratchFile {
 public:
  /// Makes an empty file in a folder; an empty path stands for the system's folder for temporary files.
  /// Throws Error where no file can be made.
  explicit ScratchFile(std::filesystem::path folder);
  ~ScratchFile();
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;

  /// Writes bytes at offset `at`. Throws Error where there is no room.
  void write(std::uint64_t at, std::span<const std::byte> bytes);
  /// Reads bytes that were written, at offset `at`. Throws Error where that fails.
  void read(std::uint64_t at, std::span<std::byte> bytes) const;

 private:
  std::filesystem::path folder_;
  int descriptor_;
};

/// A file in memory for a separate program to read or write. It disappears with its last user. Throws Error
/// where there is no memory for it.
class MemoryFile {
 public:
  /// `name` is shown by tools that list the files of a process.
  explicit MemoryFile(const char* name);
  ~MemoryFile();
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  [[nodiscard]] int descriptor() const { return descriptor_; }
  /// Writes `bytes` at the beginning of the file.
  void fill(const std::vector<char>& bytes) const;
  [[nodiscard]] std::vector<char> content() const;

 private:
  int descriptor_;
};

}  // namespace adamas::inline core
