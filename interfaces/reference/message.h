#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

namespace adamas {

/// Collects plain values, texts and lists of plain values as bytes, for a process on the same machine.
class MessageWriter {
 public:
  template <class T>
  requires std::is_trivially_copyable_v<T>
  void put(const T& value) { append(&value, sizeof(T)); }
  template <class T>
  requires std::is_trivially_copyable_v<T>
  void put(const std::vector<T>& values) {
    put(static_cast<std::uint64_t>(values.size()));
    append(values.data(), values.size() * sizeof(T));
  }
  void put(const std::string& text) { put(std::vector<char>(text.begin(), text.end())); }

  [[nodiscard]] const std::vector<char>& bytes() const { return bytes_; }

 private:
  void append(const void* data, std::size_t size) {
    const auto* begin = static_cast<const char*>(data);
    bytes_.insert(bytes_.end(), begin, begin + size);
  }

  std::vector<char> bytes_;
};

/// Takes them apart again. What is read is not trusted: after the first value that is not there all are
/// empty, and `good` is false.
class MessageReader {
 public:
  explicit MessageReader(std::vector<char> bytes) : bytes_(std::move(bytes)) {}

  template <class T>
  requires std::is_trivially_copyable_v<T>
  [[nodiscard]] T get() {
    T value{};
    take(&value, sizeof(T));
    return value;
  }
  template <class T>
  requires std::is_trivially_copyable_v<T>
  [[nodiscard]] std::vector<T> get_list() {
    const auto count = get<std::uint64_t>();
    if (!good_ || count > (bytes_.size() - position_) / sizeof(T)) {
      good_ = false;
      return {};
    }
    std::vector<T> values(static_cast<std::size_t>(count));
    take(values.data(), values.size() * sizeof(T));
    return values;
  }
  [[nodiscard]] std::string get_text() {
    const std::vector<char> text = get_list<char>();
    return {text.begin(), text.end()};
  }

  [[nodiscard]] bool good() const { return good_; }
  /// Everything was there, and nothing is left.
  [[nodiscard]] bool complete() const { return good_ && position_ == bytes_.size(); }

 private:
  void take(void* data, std::size_t size) {
    if (!good_ || size > bytes_.size() - position_) {
      good_ = false;
      return;
    }
    if (size > 0) std::memcpy(data, bytes_.data() + position_, size);
    position_ += size;
  }

  std::vector<char> bytes_;
  std::size_t position_ = 0;
  bool good_ = true;
};

}  // namespace adamas
