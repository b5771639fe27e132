#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "core/base/stable_vector.h"
#include "core/lattice/lattice_map.h"

namespace adamas::inline core {

/// Numbers of lattice points that lie near each other, as those of a surface do. They are kept in blocks of
/// 4^3 points of one scale (Diamond::scale), so that points that are used together lie together in memory;
/// 8^3 blocks form a region, and there are so few regions that the table of them stays in the caches. For
/// scattered points a LatticeMap takes less memory.
class PointNumbers {
 public:
  static constexpr std::uint32_t kNone = 0xffffffffu;

  /// Returns a pointer to the number of p, for the caller to set, and whether p is new; its number is kNone
  /// then. The pointer is valid as long as this object.
  std::pair<std::uint32_t*, bool> insert(LatticePoint p) {
    // In units of its scale a point has at least one odd coordinate. The key of a region is its centre, which
    // determines its scale.
    const int bits = std::min(trailing_zeros(p), kRootBits);
    const LatticePoint q{p.i >> bits, p.j >> bits, p.k >> bits};
    const auto centre = [bits](std::int32_t x) { return ((x & ~31) + 16) << bits; };
    const LatticePoint key{centre(q.i), centre(q.j), centre(q.k)};
    Recent& recent =
        recent_[place<2>({q.i >> 5, q.j >> 5, q.k >> 5}) + 64 * static_cast<std::size_t>(bits & 1)];
    if (key != recent.key) recent = {key, region(key)};
    std::uint32_t& block = (*recent.region)[place<3>({q.i >> 2, q.j >> 2, q.k >> 2})];
    if (block == kNone) {
      block = static_cast<std::uint32_t>(blocks_.size());
      blocks_.add()->fill(kNone);
    }
    std::uint32_t& number = blocks_[block][place<2>(q)];
    return {&number, number == kNone};
  }

  /// Calls visit(number here, number there) for each point that has a number in both tables.
  template <class Visit>
  void for_each_common(PointNumbers& other, Visit&& visit) {
    const auto for_each_of_both = [](const auto& here, const auto& there, const auto& call) {
      for (std::size_t n = 0; n < here.size(); ++n) {
        if (here[n] != kNone && there[n] != kNone) call(here[n], there[n]);
      }
    };
    indices_.for_each([&](LatticePoint key, std::uint32_t region) {
      const std::uint32_t* const found = other.indices_.find(key);
      if (found == nullptr) return;
      for_each_of_both(regions_[region], other.regions_[*found],
                       [&](std::uint32_t here, std::uint32_t there) {
                         for_each_of_both(blocks_[here], other.blocks_[there], visit);
                       });
    });
  }

 private:
  using Block = std::array<std::uint32_t, 64>;    ///< numbers
  using Region = std::array<std::uint32_t, 512>;  ///< places of blocks, or kNone
  /// A region that was used recently.
  struct Recent {
    LatticePoint key = kNoKey<LatticePoint>;
    Region* region = nullptr;
  };

  /// A point's place in a cube of 2^Bits points a side.
  template <int Bits>
  static std::size_t place(LatticePoint q) {
    constexpr std::int32_t kIn = (1 << Bits) - 1;
    return static_cast<std::size_t>((q.i & kIn) | (q.j & kIn) << Bits | (q.k & kIn) << (2 * Bits));
  }

  Region* region(LatticePoint key) {
    const auto [index, is_new] = indices_.insert(key);
    if (is_new) {
      *index = static_cast<std::uint32_t>(regions_.size());
      regions_.add()->fill(kNone);
    }
    return &regions_[*index];
  }

  LatticeMap<std::uint32_t> indices_;  ///< indices of regions, by key
  StableVector<Region> regions_;
  StableVector<Block> blocks_;
  /// The region last used for each place among 4^3 of its scale, for two scales.
  std::array<Recent, 128> recent_;
};

}  // namespace adamas::inline core
