#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

#include "core/base/hash.h"

namespace adamas::isosurface {

/// Finds the patches of joined points that have to be separated again: the two patches that are joined by two
/// edges at the same time; the three patches of two coinciding triangles; and a patch with fewer than three
/// triangles, since a whole body may be reduced to two patches. The object keeps its memory for the next
/// call.
class CoincidingPatches {
 public:
  /// A patch that may coincide with others.
  struct Suspect {
    std::uint32_t patch;
    bool is_joined;  ///< whether the patch has several points
  };

  /// Checks the suspects, which are in order of their numbers, among `patches` patches.
  /// `for_each_triangle(visit)` calls visit(triangle), the same each time, for triangles of three different
  /// patches, among them all that have a suspect. Returns the patches found, some of them several times.
  template <class ForEachTriangle>
  std::vector<std::uint32_t> find(std::size_t patches, std::span<const Suspect> suspects,
                                  const ForEachTriangle& for_each_triangle) {
    if (places_.size() < patches) places_.resize(patches, kNone);
    for (std::size_t s = 0; s < suspects.size(); ++s)
      places_[suspects[s].patch] = static_cast<std::uint32_t>(s);
    find_around(suspects.size(), for_each_triangle);
    std::vector<std::uint32_t> found;
    for (std::size_t s = 0; s < suspects.size(); ++s) {
      places_[suspects[s].patch] = kNone;
      const std::uint32_t first = s == 0 ? 0 : begin_[s - 1];
      check(suspects[s], {around_.data() + first, begin_[s] - first}, found);
    }
    return found;
  }

 private:
  using Pair = std::array<std::uint32_t, 2>;
  using Triangle = std::array<std::uint32_t, 3>;
  static constexpr std::uint32_t kNone = 0xffffffffu;

  /// Collects the other two corners of each triangle of each suspect.
  template <class ForEachTriangle>
  void find_around(std::size_t suspects, const ForEachTriangle& for_each_triangle) {
    const auto for_each_corner = [&](const auto& visit) {
      for_each_triangle([&](const Triangle& t) {
        for (std::size_t c = 0; c < 3; ++c) {
          const std::uint32_t place = places_[t[c]];
          if (place != kNone) visit(place, Pair{t[(c + 1) % 3], t[(c + 2) % 3]});
        }
      });
    };
    begin_.assign(suspects + 1, 0);
    for_each_corner([&](std::uint32_t s, const Pair&) { ++begin_[s + 1]; });
    std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
    around_.resize(begin_.back());
    for_each_corner([&](std::uint32_t s, const Pair& others) { around_[begin_[s]++] = others; });
  }

  static void check(Suspect suspect, std::span<const Pair> around, std::vector<std::uint32_t>& found) {
    const std::uint32_t patch = suspect.patch;
    if (around.size() < 3 && suspect.is_joined) found.push_back(patch);
    if (!may_coincide(around)) return;
    for (std::size_t n = 0; n < around.size(); ++n) {
      for (std::size_t m = 0; m < n; ++m) {
        if (around[m][0] == around[n][0]) found.insert(found.end(), {patch, around[n][0]});
        if (around[m][0] == around[n][1] && around[m][1] == around[n][0])
          found.insert(found.end(), {patch, around[n][0], around[n][1]});
      }
    }
  }

  /// Returns whether two pairs may have the same first number, or be each other's reverse. It is never false
  /// where two are.
  static bool may_coincide(std::span<const Pair> around) {
    // Bits of a small table are indexed by a hash, which is different for most pairs.
    std::array<std::uint64_t, 4> firsts{}, pairs{};
    std::uint64_t twice = 0;
    const auto set = [&twice](std::array<std::uint64_t, 4>& bits, std::uint64_t key) {
      const std::uint64_t hash = fibonacci_hash(key), bit = std::uint64_t{1} << (hash >> 56 & 63);
      std::uint64_t& word = bits[hash >> 62];
      twice |= word & bit;
      word |= bit;
    };
    for (const Pair& others : around) {
      set(firsts, others[0]);
      set(pairs, std::uint64_t{others[0]} + others[1]);
    }
    return twice != 0;
  }

  std::vector<std::uint32_t> places_;  ///< the suspect of each patch, or kNone
  /// The begin of the pairs of each suspect in around_, and, once they are collected, their end.
  std::vector<std::uint32_t> begin_;
  std::vector<Pair> around_;
};

}  // namespace adamas::isosurface
