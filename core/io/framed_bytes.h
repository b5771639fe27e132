#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <tuple>
#include <type_traits>
#include <variant>
#include <vector>

namespace adamas::io {

/// The longest frame, in bytes.
inline constexpr std::size_t kFrameBytes = std::size_t{1} << 20;

/// Thrown if a stream of bytes ends before its data are complete.
struct TruncatedStream {};

/// The members of a struct that are sent, as a tuple of pointers to members; empty for other types.
template <class T>
inline constexpr auto kSentMembers = std::tuple<>();
template <class T>
inline constexpr bool kHasSentMembers = std::tuple_size_v<std::remove_const_t<decltype(kSentMembers<T>)>> > 0;
/// Whether the number of elements of a container varies, so that it is sent too.
template <class T>
inline constexpr bool kHasLength = requires(T value) {
  value.resize(0);
};

/// Writes values to a pipe or file in frames, so that its reader sees whether all of them arrived. Throws
/// Error if they cannot be written.
class ByteSink {
 public:
  explicit ByteSink(int descriptor) : descriptor_(descriptor) {}
  ByteSink(const ByteSink&) = delete;
  ByteSink& operator=(const ByteSink&) = delete;

  void write(const void* data, std::size_t size);
  /// Writes a value: the bytes of one that is trivially copyable, else its parts (kSentMembers, the number
  /// and the elements of a string or vector, the elements of an array, the index and the content of a
  /// variant).
  template <class T>
  void put(const T& value) {
    if constexpr (kHasSentMembers<T>) {
      std::apply([&](const auto... member) { (put(value.*member), ...); }, kSentMembers<T>);
    } else if constexpr (std::is_trivially_copyable_v<T>) {
      write(&value, sizeof(T));
    } else if constexpr (requires { value.index(); }) {
      put(static_cast<std::uint64_t>(value.index()));
      std::visit([this](const auto& content) { this->put(content); }, value);
    } else {
      if constexpr (kHasLength<T>) put(static_cast<std::uint64_t>(value.size()));
      using Element = typename T::value_type;
      if constexpr (std::is_trivially_copyable_v<Element>) {
        write(value.data(), value.size() * sizeof(Element));
      } else {
        for (const Element& element : value) put(element);
      }
    }
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
  [[nodiscard]] T get() {
    T value{};
    get(value);
    return value;
  }
  template <class T>
  void get(T& value) {
    if constexpr (kHasSentMembers<T>) {
      std::apply([&](const auto... member) { (get(value.*member), ...); }, kSentMembers<T>);
    } else if constexpr (std::is_trivially_copyable_v<T>) {
      read(&value, sizeof(T));
    } else if constexpr (kHasLength<T>) {
      get_elements(value, static_cast<std::size_t>(get<std::uint64_t>()));
    } else {
      for (auto& element : value) get(element);
    }
  }
  template <class... Ts>
  void get(std::variant<Ts...>& value) {
    const auto index = get<std::uint64_t>();
    std::uint64_t at = 0;
    const bool is_known = ((index == at++ && (value = get<Ts>(), true)) || ...);
    if (!is_known) throw TruncatedStream();
  }
  /// Throws unless the stream ends here.
  void expect_end();

 private:
  template <class T>
  void get_elements(T& values, std::size_t count) {
    using Element = typename T::value_type;
    constexpr std::size_t kStep = std::size_t{1} << 22;
    values.clear();
    if constexpr (std::is_trivially_copyable_v<Element>) {
      if (count <= kStep * 64) values.reserve(count);
      while (values.size() < count) {
        const std::size_t old = values.size();
        values.resize(count - old < kStep ? count : old + kStep);
        read(values.data() + old, (values.size() - old) * sizeof(Element));
      }
    } else {
      while (values.size() < count) values.push_back(get<Element>());
    }
  }
  /// Reads the next frame; returns false at the proper end of the stream.
  bool next_frame();

  int descriptor_;
  std::vector<char> frame_;
  std::size_t position_ = 0;
};

}  // namespace adamas::io
