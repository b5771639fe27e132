#include "core/base/large_pages.h"

#include <cstdlib>
#include <mutex>
#include <new>
#include <vector>

namespace adamas::inline core {

namespace {

/// The number of free blocks that are kept; further ones go back to the system. With a sanitizer none is
/// kept, since it could not tell who uses one.
#ifdef __SANITIZE_ADDRESS__
constexpr std::size_t kMost = 0;
#else
constexpr std::size_t kMost = 32;
#endif

struct Blocks {
  std::mutex mutex;
  std::vector<std::byte*> free;

  ~Blocks() {
    for (std::byte* const block : free) std::free(block);
  }
};

Blocks& blocks() {
  static Blocks all;
  return all;
}

}  // namespace

std::byte* take_large_block() {
  {
    Blocks& all = blocks();
    const std::lock_guard lock(all.mutex);
    if (!all.free.empty()) {
      std::byte* const block = all.free.back();
      all.free.pop_back();
      return block;
    }
  }
  void* const memory = std::aligned_alloc(kLargePage, kLargePage);
  if (memory == nullptr) throw std::bad_alloc();
  request_large_pages(memory, kLargePage);
  return static_cast<std::byte*>(memory);
}

void give_large_block(std::byte* block) {
  Blocks& all = blocks();
  {
    const std::lock_guard lock(all.mutex);
    if (all.free.size() < kMost) {
      all.free.push_back(block);
      return;
    }
  }
  std::free(block);
}

}  // namespace adamas::inline core
