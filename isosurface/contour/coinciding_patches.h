#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

#include "core/base/large_pages.h"

namespace adamas {

/// Finds, of the patches that points of a surface are joined to, those that have to be taken apart again: both
/// of two edges that begin at one patch and end at one; three where two triangles lie on each other; and a
/// patch that has fewer than three triangles, since all that is left of a body may lie in two patches.
class CoincidingPatches {
 public:
  /// Looks at `count` patches, of which those of `is_suspect` may have to do with others.
  /// `for_each_corner(visit)` calls visit(triangle, corner) for the corners, at suspects, of triangles whose
  /// three patches differ, the same each time. Returns numbers of patches, some of them several times.
  template <class ForEachCorner>
  static std::vector<std::uint32_t> find(std::uint32_t count, const std::vector<bool>& is_suspect,
                                         const std::vector<bool>& is_joined,
                                         const ForEachCorner& for_each_corner) {
    using Triangle = std::array<std::uint32_t, 3>;
    std::vector<std::uint32_t> begin;
    reserve_in_large_pages(begin, count + std::size_t{1});
    begin.resize(count + std::size_t{1});
    for_each_corner([&](const Triangle& t, std::size_t c) { ++begin[t[c] + 1]; });
    std::partial_sum(begin.begin(), begin.end(), begin.begin());
    // What follows each patch in its triangles, and what comes before.
    std::vector<Pair> around;
    reserve_in_large_pages(around, begin.back());
    around.resize(begin.back());
    for_each_corner([&](const Triangle& t, std::size_t c) {
      around[begin[t[c]]++] = {t[(c + 1) % 3], t[(c + 2) % 3]};
    });
    std::vector<std::uint32_t> found;
    for (std::uint32_t p = 0; p < count; ++p) {
      if (!is_suspect[p]) continue;
      const std::uint32_t first = p == 0 ? 0 : begin[p - 1];
      check(p, is_joined[p], {around.data() + first, begin[p] - first}, found);
    }
    return found;
  }

 private:
  using Pair = std::array<std::uint32_t, 2>;

  static void check(std::uint32_t patch, bool is_joined, std::span<const Pair> around,
                    std::vector<std::uint32_t>& found) {
    if (around.size() < 3 && is_joined) found.push_back(patch);
    for (std::size_t n = 0; n < around.size(); ++n) {
      for (std::size_t m = 0; m < n; ++m) {
        if (around[m][0] == around[n][0]) found.insert(found.end(), {patch, around[n][0]});
        if (around[m][0] == around[n][1] && around[m][1] == around[n][0])
          found.insert(found.end(), {patch, around[n][0], around[n][1]});
      }
    }
  }
};

}  // namespace adamas
