#pragma once

#include <algorithm>
#include <vector>

namespace adamas::inline core {

/// Sorts a list and leaves each value in it once.
template <class T>
void sort_unique(std::vector<T>& list) {
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end()), list.end());
}

}  // namespace adamas::inline core
