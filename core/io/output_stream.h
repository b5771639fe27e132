#pragma once

#include <fmt/format.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/output_file.h"

namespace adamas::io {

/// A file that is written from its beginning to its end. Its size is checked, and it gets its name only at
/// `finish()`.
class OutputStream {
 public:
  /// Throws Error if the file cannot be made.
  explicit OutputStream(const std::filesystem::path& path);

  /// Both functions write bytes, and throw Error if these cannot be written (a full disk).
  void write(const void* data, std::size_t size);
  void write(std::string_view text) { write(text.data(), text.size()); }
  template <class T>
  void put(const T& value) {
    write(&value, sizeof(T));
  }
  /// Writes what is buffered and checks the size, but gives no name yet: for files that get their names
  /// together.
  void close();
  /// Gives the file its name, after close().
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

/// Text that is written to a stream in large blocks; flush() has to be called in the end.
class TextBlock {
 public:
  explicit TextBlock(OutputStream& stream) : stream_(stream) {}
  template <class... Args>
  void add(fmt::format_string<Args...> format, Args&&... args) {
    fmt::format_to(std::back_inserter(text_), format, std::forward<Args>(args)...);
    if (text_.size() > kBlock) flush();
  }
  void flush() {
    stream_.write(text_.data(), text_.size());
    text_.clear();
  }

 private:
  static constexpr std::size_t kBlock = std::size_t{1} << 20;
  OutputStream& stream_;
  fmt::memory_buffer text_;
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

  /// Both functions compress bytes, and throw Error if they cannot be written.
  void write(const void* data, std::size_t size);
  void write(std::string_view text) { write(text.data(), text.size()); }
  /// Ends the stream, after the last byte.
  void finish();

 private:
  class State;
  std::unique_ptr<State> state_;
};

/// Writes bytes as base64 (RFC 4648, section 4), with padding and without line ends.
class Base64Stream {
 public:
  explicit Base64Stream(OutputStream& stream) : stream_(stream) {}

  void write(const void* data, std::size_t size) {
    const auto* bytes = static_cast<const std::uint8_t*>(data);
    text_.clear();
    std::size_t at = 0;
    for (; at < size && waiting_ > 0; ++at) take(bytes[at]);
    for (; at + 3 <= size; at += 3) add_group({bytes[at], bytes[at + 1], bytes[at + 2]}, 4);
    for (; at < size; ++at) take(bytes[at]);
    stream_.write(text_);
  }
  /// Ends the text, after the last byte.
  void finish() {
    text_.clear();
    if (waiting_ > 0) {
      for (std::size_t i = waiting_; i < 3; ++i) group_[i] = 0;
      add_group(group_, waiting_ + 1);
      text_.append(3 - waiting_, '=');
      waiting_ = 0;
    }
    stream_.write(text_);
  }

 private:
  void take(std::uint8_t byte) {
    group_[waiting_++] = byte;
    if (waiting_ < 3) return;
    add_group(group_, 4);
    waiting_ = 0;
  }
  /// Adds the first `digits` of the four characters that stand for three bytes.
  void add_group(const std::array<std::uint8_t, 3>& bytes, std::size_t digits) {
    static constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const unsigned bits = unsigned{bytes[0]} << 16 | unsigned{bytes[1]} << 8 | bytes[2];
    const char four[] = {kDigits[bits >> 18], kDigits[bits >> 12 & 63], kDigits[bits >> 6 & 63],
                         kDigits[bits & 63]};
    text_.append(four, digits);
  }

  OutputStream& stream_;
  std::string text_;
  std::array<std::uint8_t, 3> group_{};  ///< bytes of an incomplete group of three
  std::size_t waiting_ = 0;              ///< their number
};

}  // namespace adamas::io
