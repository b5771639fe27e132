#pragma once

#include <filesystem>
#include <vector>

namespace adamas::inline core {

/// Opens an empty file without a name in a folder, for reading and writing. It disappears with its last user,
/// however that ends. Returns its descriptor, or -1, with the reason in errno.
int open_unnamed_file(const std::filesystem::path& folder);

/// The system's folder for temporary files: that of the variable TMPDIR, or /tmp. Throws Error, which names
/// the variable, where it is no folder.
std::filesystem::path temporary_folder();

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
  /// Writes `bytes` from the beginning on.
  void fill(const std::vector<char>& bytes) const;
  [[nodiscard]] std::vector<char> content() const;

 private:
  int descriptor_;
};

}  // namespace adamas::inline core
