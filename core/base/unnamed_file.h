#pragma once

#include <filesystem>
#include <vector>

namespace adamas::inline core {

/// Opens an empty file in a folder for reading and writing that has no name, so that it is gone with its last
/// user, however that ends. Returns its descriptor, or -1, where errno tells why.
int open_unnamed_file(const std::filesystem::path& folder);

/// The system's folder for temporary files: that of the variable TMPDIR, or /tmp. Throws Error, which names
/// the variable, where it is none.
std::filesystem::path temporary_folder();

/// A file in memory that is gone with its last user too: what a separate program reads or writes. Throws
/// Error where there is no memory for it.
class MemoryFile {
 public:
  /// `name` is for those who look at the process.
  explicit MemoryFile(const char* name);
  ~MemoryFile();
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  [[nodiscard]] int descriptor() const { return descriptor_; }
  /// Writes `bytes`, for a reader from the beginning on.
  void fill(const std::vector<char>& bytes) const;
  [[nodiscard]] std::vector<char> content() const;

 private:
  int descriptor_;
};

}  // namespace adamas::inline core
