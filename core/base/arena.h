#pragma once

#include <cstddef>
#include <cstdlib>
#include <memory>
#include <new>
#include <type_traits>
#include <vector>

#include "core/base/large_pages.h"

namespace adamas {

/// Many objects of one type that stay where they are until the end, not initialised: in a small block of
/// memory and, where that does not suffice, in blocks that come in large pages.
template <class T>
class Arena {
 public:
  static_assert(std::is_trivially_destructible_v<T>);

  [[nodiscard]] std::size_t size() const { return size_; }

  /// Valid for as long as the arena is.
  T* add() {
    if (size_ == capacity_) grow();
    return new (place(size_++)) T;
  }
  /// The one that was added as the nth, from 0.
  [[nodiscard]] T& operator[](std::size_t n) { return *std::launder(reinterpret_cast<T*>(place(n))); }

 private:
  static constexpr std::size_t kFirstBytes = std::size_t{1} << 16;
  static constexpr std::size_t kInFirst = kFirstBytes < sizeof(T) ? 1 : kFirstBytes / sizeof(T);
  static constexpr std::size_t kBlockBytes = (sizeof(T) + kLargePage - 1) / kLargePage * kLargePage;
  static constexpr std::size_t kInBlock = kBlockBytes / sizeof(T);
  struct Free {
    void operator()(std::byte* memory) const { std::free(memory); }
  };

  void grow() {
    const bool is_first = blocks_.empty();
    void* memory = is_first ? std::malloc(kInFirst * sizeof(T)) : std::aligned_alloc(kLargePage, kBlockBytes);
    if (memory == nullptr) throw std::bad_alloc();
    blocks_.emplace_back(static_cast<std::byte*>(memory));
    if (!is_first) wish_for_large_pages(memory, kBlockBytes);
    capacity_ += is_first ? kInFirst : kInBlock;
  }

  [[nodiscard]] std::byte* place(std::size_t n) {
    if (n < kInFirst) return blocks_.front().get() + sizeof(T) * n;
    n -= kInFirst;
    return blocks_[1 + n / kInBlock].get() + sizeof(T) * (n % kInBlock);
  }

  static_assert(alignof(T) <= alignof(std::max_align_t));

  std::vector<std::unique_ptr<std::byte, Free>> blocks_;
  std::size_t size_ = 0, capacity_ = 0;
};

}  // namespace adamas
