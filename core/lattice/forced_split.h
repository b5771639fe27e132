#pragma once

#include <array>
#include <cstddef>

#include "core/base/assert.h"
#include "core/lattice/diamond.h"
#include "core/lattice/domain.h"

namespace adamas::inline core {

/// Calls `split_one(point)` for the diamond at `point` and all its ancestors that are not split yet, parents
/// first, so that each is complete when its turn comes (D 2). A hierarchy offers `domain()` and
/// `is_split(point)`, which must be true once `split_one(point)` has returned.
template <class Hierarchy, class SplitOne>
void forced_split(const Hierarchy& hierarchy, LatticePoint point, SplitOne&& split_one) {
  // A chain of ancestors has three diamonds per level; each leaves at most three other parents behind.
  std::array<LatticePoint, static_cast<std::size_t>(3 * kRootBits * 3 + 2)> pending;
  std::size_t count = 0;
  pending[count++] = point;
  while (count > 0) {
    const LatticePoint p = pending[count - 1];
    if (hierarchy.is_split(p)) {
      --count;
      continue;
    }
    const Diamond diamond(p);
    const std::size_t before = count;
    for (int c = 0; c < diamond.parent_count(); ++c) {
      const LatticePoint parent = diamond.parent(c);
      if (!hierarchy.domain().contains(parent) || hierarchy.is_split(parent)) continue;
      ADAMAS_ASSERT(count < pending.size());
      pending[count++] = parent;
    }
    if (count == before) {
      split_one(p);
      --count;
    }
  }
}

}  // namespace adamas::inline core
