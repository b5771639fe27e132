#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <new>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace adamas::inline core {

inline constexpr std::size_t kLargePage = std::size_t{2} << 20;

/// Asks the system to give memory in large pages, as far as whole ones fit: thousands of small pages, each
/// fetched by a page fault, take longer to get than to fill. The system may refuse.
inline void request_large_pages([[maybe_unused]] void* memory, [[maybe_unused]] std::size_t bytes) {
#ifdef __linux__
  const auto begin = reinterpret_cast<std::uintptr_t>(memory);
  const std::uintptr_t first = (begin + kLargePage - 1) / kLargePage * kLargePage;
  const std::uintptr_t end = (begin + bytes) / kLargePage * kLargePage;
  if (first < end) madvise(reinterpret_cast<void*>(first), end - first, MADV_HUGEPAGE);
#endif
}

/// Reserves room for `size` elements of a vector, in large pages.
template <class Vector>
void reserve_in_large_pages(Vector& vector, std::size_t size) {
  vector.reserve(size);
  request_large_pages(vector.data(), vector.capacity() * sizeof(*vector.data()));
}

/// An allocator that asks the system for large pages behind large arrays: random access to them costs fewer
/// page-table walks (a tenth of the time of a closest-point query among a million triangles).
template <class T>
struct LargePageAllocator {
  using value_type = T;

  LargePageAllocator() = default;
  template <class U>
  explicit LargePageAllocator(const LargePageAllocator<U>&) {}

  T* allocate(std::size_t count) {
    if (count > (static_cast<std::size_t>(-1) >> 1) / sizeof(T)) throw std::bad_alloc();
    const std::size_t bytes = count * sizeof(T);
    const std::size_t alignment = bytes >= 2 * kLargePage ? kLargePage : (alignof(T) > 64 ? alignof(T) : 64);
    void* memory = std::aligned_alloc(alignment, (bytes + alignment - 1) / alignment * alignment);
    if (memory == nullptr) throw std::bad_alloc();
    if (alignment == kLargePage) request_large_pages(memory, bytes);
    return static_cast<T*>(memory);
  }
  void deallocate(T* memory, std::size_t) { std::free(memory); }
  bool operator==(const LargePageAllocator&) const { return true; }
};

/// Returns a block of kLargePage bytes, aligned to as many and not initialised. Blocks that were given back
/// are used again, since memory from the system takes longer to get than to fill. Several threads may call it
/// at once.
std::byte* take_large_block();
/// Gives a block of take_large_block back.
void give_large_block(std::byte* block);

}  // namespace adamas::inline core
