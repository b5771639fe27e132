#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

namespace adamas::io {

/// The longest frame, in bytes.
inline constexpr std::size_t kFrameBytes = std::size_t{1} << 20;

/// Thrown if a stream of bytes ends before its data are complete.
struct TruncatedStream {};

/// Writes values to a pipe or file in frames, so that its reader sees whether all of them arrived. Throws
/// Error if they cannot be written.
class ByteSink {
 public:
  explicit ByteSink(int descriptor) : descriptor_(descriptor) {}
  ByteSink(const ByteSink&) = delete;
  ByteSink& operator=(const ByteSink&) = delete;

  void write(const void* data, std::size_t size);
  template <class T>
  requires std::is_trivially_copyable_v<T>
  void put(const T& value) { write(&value, sizeof(T)); }
  void put(const std::string& text);
  template <class T>
  requires std::is_trivially_copyable_v<T>
  void put(const std::vector<T>& values) {
    put(static_cast<std::uint64_t>(values.size()));
    write(values.data(), values.size() * sizeof(T));
  }
  /// Ends the stream and marks it as complete.
  void finish();
  /// Ends the stream with an error that its reader will throw.
  void finish_with_error(const std::string& message);

 private:
  void flush();
  void send(char kind, const void* data, std::size_t size);

  int descriptor_;
  std::vector<char> buffer_;
};

/// Reads what a ByteSink has written. Throws Error if the writer reported one, and TruncatedStream if the
/// stream ends before its data are complete. The data are not trusted: no more memory is allocated than the
/// bytes that arrive need.
class ByteSource {
 public:
  explicit ByteSource(int descriptor) : descriptor_(descriptor) {}
  ByteSource(const ByteSource&) = delete;
  ByteSource& operator=(const ByteSource&) = delete;

  void read(void* data, std::size_t size);
  template <class T>
  requires std::is_trivially_copyable_v<T>
  [[nodiscard]] T get() {
    T value;
    read(&value, sizeof(T));
    return value;
  }
  [[nodiscard]] std::string get_string();
  template <class T>
  requires std::is_trivially_copyable_v<T>
  [[nodiscard]] std::vector<T> get_vector() {
    constexpr std::size_t kStep = std::size_t{1} << 22;
    const auto count = static_cast<std::size_t>(get<std::uint64_t>());
    std::vector<T> values;
    if (count <= kStep * 64) values.reserve(count);
    while (values.size() < count) {
      const std::size_t old = values.size();
      values.resize(count - old < kStep ? count : old + kStep);
      read(values.data() + old, (values.size() - old) * sizeof(T));
    }
    return values;
  }
  /// Throws unless the stream ends here.
  void expect_end();

 private:
  /// Reads the next frame; returns false at the proper end of the stream.
  bool next_frame();

  int descriptor_;
  std::vector<char> frame_;
  std::size_t position_ = 0;
};

}  // namespace adamas::io
