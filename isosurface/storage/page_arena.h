#pragma once

#include <cstddef>
#include <cstdlib>
#include <memory>
#include <new>
#include <type_traits>
#include <vector>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace adamas {

/// Many objects of one type that stay until the end, not initialised, in blocks of memory that the system is
/// asked to give in large pages: thousands of small ones, each fetched by a fault of its own, take longer to
/// get than to fill.
template <class T>
class PageArena {
 public:
  static_assert(std::is_trivially_destructible_v<T>);

  /// Valid for as long as the arena is.
  T* add() {
    if (used_ == kPerBlock) {
      void* memory = std::aligned_alloc(kLargePage, kBlockBytes);
      if (memory == nullptr) throw std::bad_alloc();
#ifdef __linux__
      // Only a wish.
      madvise(memory, kBlockBytes, MADV_HUGEPAGE);
#endif
      blocks_.emplace_back(static_cast<std::byte*>(memory));
      used_ = 0;
    }
    return new (blocks_.back().get() + sizeof(T) * used_++) T;
  }

 private:
  static constexpr std::size_t kLargePage = std::size_t{2} << 20;
  static constexpr std::size_t kBlockBytes = (sizeof(T) + kLargePage - 1) / kLargePage * kLargePage;
  static constexpr std::size_t kPerBlock = kBlockBytes / sizeof(T);
  struct Free {
    void operator()(std::byte* memory) const { std::free(memory); }
  };

  std::vector<std::unique_ptr<std::byte, Free>> blocks_;
  std::size_t used_ = kPerBlock;  ///< of the last block
};

}  // namespace adamas
