#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>

namespace adamas {

/// Which of the diamonds that a surface crosses are split, in an order in which parents come before their
/// children: those of greater rank; of the same rank those of earlier generations; of the same generation
/// those that come before a place of a page.
struct SurfaceCut {
  static constexpr int kAll = std::numeric_limits<int>::max();

  int rank = 0;
  int generation = kAll;   ///< 3 for each LOD that a diamond is finer than the root's, and its phase
  std::uint64_t page = 0;  ///< z-order of its cube among those of the LOD
  std::size_t place = 0;

  /// The least rank of diamonds of a generation that are split; in the cut's own generation but for places.
  [[nodiscard]] int least_rank(int of_generation) const {
    return of_generation < generation ? rank : rank + 1;
  }
};

}  // namespace adamas
