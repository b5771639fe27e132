#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>

namespace adamas::io {

/// An open file that is read at any offset. Errors are thrown with the name that it was opened under.
class FileHandle {
 public:
  /// Opens a checked input file (check_input_file).
  static std::shared_ptr<FileHandle> open(const std::filesystem::path& path);
  /// Makes an empty file without a name in `folder`, which disappears with its last user, however that ends.
  /// An empty `folder` stands for the system's folder for temporary files.
  static std::shared_ptr<FileHandle> scratch(std::filesystem::path folder);
  /// Makes an empty scratch file in memory, for data that are going to be read into memory anyway.
  static std::shared_ptr<FileHandle> in_memory();

  ~FileHandle();
  FileHandle(const FileHandle&) = delete;
  FileHandle& operator=(const FileHandle&) = delete;

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] std::uint64_t size() const { return size_; }

  /// Reads as many bytes as there are at offset `at`, at most `bytes.size()`; returns how many.
  std::size_t read_some(std::uint64_t at, std::span<std::byte> bytes) const;
  /// Appends bytes to a scratch file. Throws Error that names the folder if the disk is full.
  void append(std::span<const std::byte> bytes);

  /// The position behind the next `lines` line ends from offset `at` on. Throws Error with `name` if there
  /// are fewer.
  [[nodiscard]] std::uint64_t behind_lines(std::uint64_t at, std::uint64_t lines,
                                           const std::string& name) const;

 private:
  FileHandle(int descriptor, std::string name, std::uint64_t size);

  int descriptor_;
  std::string name_;
  std::uint64_t size_;
};

}  // namespace adamas::io
