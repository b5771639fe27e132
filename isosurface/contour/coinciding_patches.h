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
/// Suspects are the patches that may have to do with others.
class CoincidingPatches {
 public:
  struct Suspect {
    std::uint32_t patch;
    bool is_joined;  ///< of several points
  };

  /// `for_each_corner(visit)` calls visit(suspect, after, before), the same each time, with the other two
  /// patches of each triangle that has a suspect and two others, which all differ. A suspect is given by its
  /// place in `suspects`. Returns patches, some of them several times.
  template <class ForEachCorner>
  static std::vector<std::uint32_t> find(std::span<const Suspect> suspects,
                                         const ForEachCorner& for_each_corner) {
    std::vector<std::uint32_t> begin;
    reserve_in_large_pages(begin, suspects.size() + 1);
    begin.resize(suspects.size() + 1);
    for_each_corner([&](std::uint32_t s, std::uint32_t, std::uint32_t) { ++begin[s + 1]; });
    std::partial_sum(begin.begin(), begin.end(), begin.begin());
    // What follows each suspect in its triangles, and what comes before.
    std::vector<Pair> around;
    reserve_in_large_pages(around, begin.back());
    around.resize(begin.back());
    for_each_corner([&](std::uint32_t s, std::uint32_t after, std::uint32_t before) {
      around[begin[s]++] = {after, before};
    });
    std::vector<std::uint32_t> found;
    for (std::size_t s = 0; s < suspects.size(); ++s) {
      const std::uint32_t first = s == 0 ? 0 : begin[s - 1];
      check(suspects[s], {around.data() + first, begin[s] - first}, found);
    }
    return found;
  }

 private:
  using Pair = std::array<std::uint32_t, 2>;

  static void check(Suspect suspect, std::span<const Pair> around, std::vector<std::uint32_t>& found) {
    const std::uint32_t patch = suspect.patch;
    if (around.size() < 3 && suspect.is_joined) found.push_back(patch);
    for (std::size_t n = 0; n < around.size(); ++n) {
      for (std::size_t m = 0; m < n; ++m) {
        if (around[m][0] == around[n][0]) found.insert(found.end(), {patch, around[n][0]});
        if (around[m][0] == around[n][1] && around[m][1] == around[n][0])
          found.insert(found.end(), {patch, around[n][0], around[n][1]});
      }
    }
  }
};

/// The places of suspects by their patches, for those who give CoincidingPatches its corners.
class SuspectPlaces {
 public:
  static constexpr std::uint32_t kNone = 0xffffffffu;

  /// `patches`: numbers of patches are below this.
  SuspectPlaces(std::span<const CoincidingPatches::Suspect> suspects, std::size_t patches) {
    reserve_in_large_pages(places_, patches);
    places_.resize(patches, kNone);
    for (std::size_t s = 0; s < suspects.size(); ++s)
      places_[suspects[s].patch] = static_cast<std::uint32_t>(s);
  }

  [[nodiscard]] bool has_any(const std::array<std::uint32_t, 3>& t) const {
    return (places_[t[0]] & places_[t[1]] & places_[t[2]]) != kNone;
  }
  /// Calls visit(suspect, after, before) for the corners of a triangle that are suspects.
  template <class Visit>
  void visit_corners(const std::array<std::uint32_t, 3>& t, const Visit& visit) const {
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint32_t place = places_[t[c]];
      if (place != kNone) visit(place, t[(c + 1) % 3], t[(c + 2) % 3]);
    }
  }

 private:
  std::vector<std::uint32_t> places_;
};

}  // namespace adamas
