#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "adamas/progress.h"  // set_thread_limit

namespace adamas::inline core {

/// Runs `body(begin, end)` over disjoint chunks of [0, count) on the threads allowed by set_thread_limit, at
/// most `grain` items a chunk. Chunk borders depend on `count` and `grain` alone, so results that are kept
/// per item or per chunk are the same on any number of threads. An exception of one chunk is rethrown here.
void parallel_chunks(std::size_t count, std::size_t grain,
                     const std::function<void(std::size_t, std::size_t)>& body);

/// Runs `body(i)` for every i in [0, count).
template <class Body>
void parallel_for(std::size_t count, std::size_t grain, Body&& body) {
  parallel_chunks(count, grain, [&body](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) body(i);
  });
}

/// Runs `body(begin, end, list)` over chunks of [0, count) as parallel_chunks() does, with a list for each
/// chunk, and returns the lists joined in the order of chunks.
template <class T, class Body>
std::vector<T> parallel_collect(std::size_t count, std::size_t grain, Body&& body) {
  std::vector<std::vector<T>> lists((count + grain - 1) / grain);
  parallel_chunks(count, grain,
                  [&](std::size_t begin, std::size_t end) { body(begin, end, lists[begin / grain]); });
  std::vector<T> joined;
  for (const std::vector<T>& list : lists) joined.insert(joined.end(), list.begin(), list.end());
  return joined;
}

}  // namespace adamas::inline core
