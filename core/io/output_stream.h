#pragma once

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string_view>
#include <vector>

#include "core/base/output_file.h"

namespace adamas::io {

/// A file written in one go: every byte is accounted for, and it gets its name at `finish()` alone.
class OutputStream {
 public:
  /// Throws Error when the file cannot be made.
  explicit OutputStream(const std::filesystem::path& path);

  /// These throw Error when the bytes cannot be written (a full disk).
  void write(const void* data, std::size_t size);
  void write(std::string_view text) { write(text.data(), text.size()); }
  template <class T>
  void put(const T& value) {
    write(&value, sizeof(T));
  }
  /// Writes what is buffered and checks the size, without the name yet: for files that get theirs together.
  void close();
  /// After close().
  void commit() { file_.commit(); }
  void finish() {
    close();
    commit();
  }

 private:
  void check();

  OutputFile file_;
  std::vector<char> buffer_;
  std::ofstream stream_;
  std::size_t written_ = 0;
};

/// Compresses bytes into a file as one gzip stream without a name or a time, so that equal bytes give equal
/// files.
class GzipStream {
 public:
  /// The stream must outlive this.
  explicit GzipStream(OutputStream& out);
  ~GzipStream();
  GzipStream(const GzipStream&) = delete;
  GzipStream& operator=(const GzipStream&) = delete;

  /// These throw Error where the bytes cannot be written.
  void write(const void* data, std::size_t size);
  void write(std::string_view text) { write(text.data(), text.size()); }
  /// After the last byte.
  void finish();

 private:
  class State;
  std::unique_ptr<State> state_;
};

}  // namespace adamas::io
