#pragma once

#include <cstddef>
#include <cstdint>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace adamas {

inline constexpr std::size_t kLargePage = std::size_t{2} << 20;

/// Asks the system to give memory in large pages, as far as it has whole ones: thousands of small ones, each
/// fetched by a fault of its own, take longer to get than to fill. Only a wish.
inline void wish_for_large_pages([[maybe_unused]] void* memory, [[maybe_unused]] std::size_t bytes) {
#ifdef __linux__
  const auto begin = reinterpret_cast<std::uintptr_t>(memory);
  const std::uintptr_t first = (begin + kLargePage - 1) / kLargePage * kLargePage;
  const std::uintptr_t end = (begin + bytes) / kLargePage * kLargePage;
  if (first < end) madvise(reinterpret_cast<void*>(first), end - first, MADV_HUGEPAGE);
#endif
}

/// Makes room in a vector for so many, which will come.
template <class Vector>
void reserve_in_large_pages(Vector& vector, std::size_t size) {
  vector.reserve(size);
  wish_for_large_pages(vector.data(), vector.capacity() * sizeof(*vector.data()));
}

}  // namespace adamas
