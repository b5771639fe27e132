#pragma once

#include <cstddef>
#include <cstdlib>
#include <memory>
#include <new>
#include <type_traits>
#include <vector>

#include "core/base/large_pages.h"

namespace adamas::inline core {

/// A vector whose elements stay where they are as it grows. They are not initialised, and lie in a small
/// block of memory and, where that does not suffice, in large blocks that go from one user to the next.
template <class T>
class StableVector {
 public:
  static_assert(std::is_trivially_destructible_v<T>);

  [[nodiscard]] std::size_t size() const { return size_; }

  /// Appends an element, and returns where it is for as long as the vector lives.
  T* add() {
    if (size_ == capacity_) grow();
    return new (place(size_++)) T;
  }
  [[nodiscard]] T& operator[](std::size_t n) { return *std::launder(reinterpret_cast<T*>(place(n))); }

 private:
  static constexpr std::size_t kFirstBytes = std::size_t{1} << 16;
  static constexpr std::size_t kInFirst = kFirstBytes < sizeof(T) ? 1 : kFirstBytes / sizeof(T);
  static constexpr std::size_t kInBlock = kLargePage / sizeof(T);
  static_assert(kInBlock > 0 && alignof(T) <= alignof(std::max_align_t));
  struct Free {
    void operator()(std::byte* memory) const { std::free(memory); }
  };
  struct GiveBack {
    void operator()(std::byte* memory) const { give_large_block(memory); }
  };

  void grow() {
    if (first_ == nullptr) {
      first_.reset(static_cast<std::byte*>(std::malloc(kInFirst * sizeof(T))));
      if (first_ == nullptr) throw std::bad_alloc();
      capacity_ = kInFirst;
    } else {
      blocks_.emplace_back(take_large_block());
      capacity_ += kInBlock;
    }
  }

  [[nodiscard]] std::byte* place(std::size_t n) {
    if (n < kInFirst) return first_.get() + sizeof(T) * n;
    n -= kInFirst;
    return blocks_[n / kInBlock].get() + sizeof(T) * (n % kInBlock);
  }

  std::unique_ptr<std::byte, Free> first_;
  std::vector<std::unique_ptr<std::byte, GiveBack>> blocks_;
  std::size_t size_ = 0, capacity_ = 0;
};

}  // namespace adamas::inline core
