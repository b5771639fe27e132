#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>

namespace adamas::io {

/// An open file, read from any place. Errors are thrown with the name that it was opened under.
class FileHandle {
 public:
  /// A checked input file (check_input_file).
  static std::shared_ptr<FileHandle> open(const std::filesystem::path& path);
  /// An empty file in `folder` that has no name, so that it is gone with its last user, however that ends. An
  /// empty `folder` stands for that of the system.
  static std::shared_ptr<FileHandle> scratch(std::filesystem::path folder);
  /// An empty scratch file in memory, for what is going to be read into memory anyway.
  static std::shared_ptr<FileHandle> in_memory();

  ~FileHandle();
  FileHandle(const FileHandle&) = delete;
  FileHandle& operator=(const FileHandle&) = delete;

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] std::uint64_t size() const { return size_; }

  /// Reads as many bytes as there are from `at` on, at most `bytes.size()`; returns how many.
  std::size_t read_some(std::uint64_t at, std::span<std::byte> bytes) const;
  /// Puts bytes at the end of a scratch file. Throws Error that names the folder where the disk is full.
  void append(std::span<const std::byte> bytes);

  /// The place behind the next `lines` line ends from `at` on. Throws Error with `name` where there are
  /// fewer.
  [[nodiscard]] std::uint64_t behind_lines(std::uint64_t at, std::uint64_t lines,
                                           const std::string& name) const;

 private:
  FileHandle(int descriptor, std::string name, std::uint64_t size);

  int descriptor_;
  std::string name_;
  std::uint64_t size_;
};

}  // namespace adamas::io
