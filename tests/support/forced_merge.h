#pragma once

#include <array>
#include <cstddef>

#include "core/base/assert.h"
#include "core/lattice/diamond.h"
#include "core/lattice/domain.h"

namespace adamas::test {

/// Returns whether the diamond at `point` is split and none of its children is.
template <class Hierarchy>
[[nodiscard]] bool is_mergeable(const Hierarchy& hierarchy, LatticePoint point) {
  if (!hierarchy.is_split(point)) return false;
  for (const LatticePoint child : Diamond(point).children(hierarchy.domain())) {
    if (hierarchy.is_split(child)) return false;
  }
  return true;
}

/// Calls `merge_one(point)` for the diamond at `point` and all its descendants that are split, children
/// first. A hierarchy offers `domain()` and `is_split(point)`, which must be false once `merge_one(point)`
/// has returned.
template <class Hierarchy, class MergeOne>
void forced_merge(const Hierarchy& hierarchy, LatticePoint point, MergeOne&& merge_one) {
  // A chain of descendants has three diamonds a level, and each of these leaves at most seven other children
  // behind.
  std::array<LatticePoint, static_cast<std::size_t>(3 * kRootBits * 7 + 2)> pending;
  std::size_t count = 0;
  pending[count++] = point;
  while (count > 0) {
    const LatticePoint p = pending[count - 1];
    if (!hierarchy.is_split(p)) {
      --count;
      continue;
    }
    const std::size_t before = count;
    for (const LatticePoint child : Diamond(p).children(hierarchy.domain())) {
      if (!hierarchy.is_split(child)) continue;
      ADAMAS_ASSERT(count < pending.size());
      pending[count++] = child;
    }
    if (count == before) {
      merge_one(p);
      --count;
    }
  }
}

}  // namespace adamas::test
