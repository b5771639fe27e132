#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <type_traits>
#include <vector>

#include "core/base/error.h"

namespace adamas::interfaces {

/// An array that grows in chunks: elements are constructed in place and never move, so references stay valid.
/// An empty type takes no memory.
template <class T>
class ChunkedArray {
 public:
  T& operator[](std::size_t i) {
    if constexpr (kIsEmpty)
      return nothing_;
    else
      return (*chunks_[i / kChunk])[i % kChunk];
  }
  const T& operator[](std::size_t i) const {
    if constexpr (kIsEmpty)
      return nothing_;
    else
      return (*chunks_[i / kChunk])[i % kChunk];
  }

  /// Allocates the elements with indices below `count`; new elements are value-initialised.
  void grow(std::size_t count) {
    if constexpr (!kIsEmpty) {
      while (chunks_.size() * kChunk < count) chunks_.push_back(std::make_unique<Chunk>());
    }
  }
  [[nodiscard]] std::size_t bytes() const {
    return chunks_.size() * sizeof(Chunk) + chunks_.capacity() * sizeof(chunks_[0]);
  }

 private:
  static constexpr bool kIsEmpty = std::is_empty_v<T>;
  static constexpr std::size_t kChunk = 1024;
  using Chunk = std::array<T, kChunk>;

  std::vector<std::unique_ptr<Chunk>> chunks_;
  [[no_unique_address]] std::conditional_t<kIsEmpty, T, std::array<T, 0>> nothing_{};
};

/// Elements with 32-bit indices and stable addresses; slots of released elements are reused, the last
/// released first. A default Element is a free slot; its is_free() returns true.
template <class Element>
class ElementPool {
 public:
  /// Throws Error unless `count` more elements can have indices below `limit`.
  void require_room(std::uint32_t count, std::uint32_t limit) const {
    if (slots_ > limit - count) fail("hierarchy: expected at most {} elements of a kind, found more", limit);
  }
  /// Returns the index of a free slot, which the caller must fill at once.
  std::uint32_t allocate() {
    if (!free_.empty()) {
      const std::uint32_t index = free_.back();
      free_.pop_back();
      return index;
    }
    elements_.grow(slots_ + std::size_t{1});
    return slots_++;
  }
  void release(std::uint32_t index) {
    elements_[index] = Element{};
    free_.push_back(index);
  }

  Element& operator[](std::uint32_t index) { return elements_[index]; }
  const Element& operator[](std::uint32_t index) const { return elements_[index]; }

  /// Returns the number of elements in use.
  [[nodiscard]] std::size_t size() const { return slots_ - free_.size(); }
  /// Returns a number above the indices of all elements.
  [[nodiscard]] std::uint32_t slots() const { return slots_; }
  [[nodiscard]] std::size_t bytes() const {
    return elements_.bytes() + free_.capacity() * sizeof(std::uint32_t);
  }

  /// Calls fn(index) for all elements, by index.
  template <class Fn>
  void for_each(Fn&& fn) const {
    for (std::uint32_t index = 0; index < slots_; ++index) {
      if (!elements_[index].is_free()) fn(index);
    }
  }

 private:
  ChunkedArray<Element> elements_;
  std::vector<std::uint32_t> free_;
  std::uint32_t slots_ = 0;
};

}  // namespace adamas::interfaces
