#pragma once

#include <cstddef>
#include <cstdint>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace adamas::inline core {

inline constexpr std::size_t kLargePage = std::size_t{2} << 20;

/// Asks the system to give memory in large pages, as far as it has whole ones: thousands of small ones, each
/// fetched by a fault of its own, take longer to get than to fill. The system may refuse.
inline void request_large_pages([[maybe_unused]] void* memory, [[maybe_unused]] std::size_t bytes) {
#ifdef __linux__
  const auto begin = reinterpret_cast<std::uintptr_t>(memory);
  const std::uintptr_t first = (begin + kLargePage - 1) / kLargePage * kLargePage;
  const std::uintptr_t end = (begin + bytes) / kLargePage * kLargePage;
  if (first < end) madvise(reinterpret_cast<void*>(first), end - first, MADV_HUGEPAGE);
#endif
}

/// Makes room for `size` elements in a vector, in large pages.
template <class Vector>
void reserve_in_large_pages(Vector& vector, std::size_t size) {
  vector.reserve(size);
  request_large_pages(vector.data(), vector.capacity() * sizeof(*vector.data()));
}

/// A block of kLargePage bytes, aligned to as many, with anything in it: one that was given back where there
/// is one, since memory that the system has to provide takes longer to get than to fill. May be called by
/// several threads at once.
std::byte* take_large_block();
void give_large_block(std::byte* block);

}  // namespace adamas::inline core
