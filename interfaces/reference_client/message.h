#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace adamas::interfaces {

/// Writes plain values, texts and lists of plain values as bytes, for a process on the same machine.
class MessageWriter {
 public:
  template <class T>
  requires std::is_trivially_copyable_v<T>
  void operator()(const T& value) { append(&value, sizeof(T)); }
  template <class T>
  requires std::is_trivially_copyable_v<T>
  void operator()(const std::vector<T>& values) { put_list(values); }
  void operator()(const std::string& text) { put_list(text); }

  [[nodiscard]] const std::vector<char>& bytes() const { return bytes_; }

 private:
  template <class List>
  void put_list(const List& values) {
    (*this)(static_cast<std::uint64_t>(values.size()));
    append(values.data(), values.size() * sizeof(values[0]));
  }
  void append(const void* data, std::size_t size) {
    const auto* begin = static_cast<const char*>(data);
    bytes_.insert(bytes_.end(), begin, begin + size);
  }

  std::vector<char> bytes_;
};

/// Reads the values of a message. The bytes are not trusted: after the first missing value, all values are
/// empty and complete() is false.
class MessageReader {
 public:
  explicit MessageReader(std::vector<char> bytes) : bytes_(std::move(bytes)) {}

  template <class T>
  requires std::is_trivially_copyable_v<T>
  void operator()(T& value) { take(&value, sizeof(T)); }
  template <class T>
  requires std::is_trivially_copyable_v<T>
  void operator()(std::vector<T>& values) { get_list(values); }
  void operator()(std::string& text) { get_list(text); }

  /// Returns whether no value was missing and no bytes are left.
  [[nodiscard]] bool complete() const { return good_ && position_ == bytes_.size(); }

 private:
  template <class List>
  void get_list(List& values) {
    std::uint64_t count = 0;
    (*this)(count);
    if (!good_ || count > (bytes_.size() - position_) / sizeof(values[0])) {
      good_ = false;
      return;
    }
    values.resize(static_cast<std::size_t>(count));
    take(values.data(), values.size() * sizeof(values[0]));
  }
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

/// Encodes a message. It begins with the mark of its kind; `Message::members(message, visit)` passes each
/// member to `visit`.
template <class Message>
std::vector<char> encode(const Message& message) {
  MessageWriter writer;
  writer(Message::kMark);
  Message::members(message, writer);
  return writer.bytes();
}

/// Returns whether the bytes begin like a message of this kind.
template <class Message>
bool is_message(const std::vector<char>& bytes) {
  return bytes.size() >= Message::kMark.size() &&
         std::equal(Message::kMark.begin(), Message::kMark.end(), bytes.begin());
}

/// Decodes a message; returns none if the bytes are not a complete message of this kind.
template <class Message>
std::optional<Message> decode(std::vector<char> bytes) {
  MessageReader reader(std::move(bytes));
  auto mark = Message::kMark;
  mark.fill(0);
  reader(mark);
  if (mark != Message::kMark) return std::nullopt;
  Message message;
  Message::members(message, reader);
  return reader.complete() ? std::optional(std::move(message)) : std::nullopt;
}

}  // namespace adamas::interfaces
