#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "core/base/stable_vector.h"
#include "core/lattice/lattice_map.h"

namespace adamas {

/// Numbers of lattice points that lie near each other, as those of a surface do: a table of blocks of 4^3
/// points of a level, so that what is asked for together lies together in memory. For scattered points a
/// LatticeMap takes less memory.
class PointNumbers {
 public:
  static constexpr std::uint32_t kNone = 0xffffffffu;

  /// Makes room for about so many points.
  void expect(std::size_t points) {
    constexpr std::size_t kInBlock = 6;
    blocks_.reserve(points / kInBlock);
  }

  /// Where the number of p is, for the caller to change, and whether p has none yet; it is kNone then. The
  /// pointer is valid until the next call.
  std::pair<std::uint32_t*, bool> insert(LatticePoint p) {
    // In units of its level a point has at least one odd coordinate. The key of a block is its centre, from
    // which its level follows.
    const int level = std::min(trailing_zeros(p), kRootBits);
    const LatticePoint q{p.i >> level, p.j >> level, p.k >> level};
    const auto centre = [level](std::int32_t x) { return ((x & ~3) + 2) << level; };
    const LatticePoint key{centre(q.i), centre(q.j), centre(q.k)};
    Recent& recent =
        recent_[static_cast<std::size_t>((q.i >> 2 & 7) + 8 * (q.j >> 2 & 7) + 64 * (q.k >> 2 & 7))];
    if (key != recent.key) recent = {key, block(key)};
    std::uint32_t& number =
        (*recent.block)[static_cast<std::size_t>((q.i & 3) + 4 * (q.j & 3) + 16 * (q.k & 3))];
    return {&number, number == kNone};
  }

  /// Calls visit(number here, number there) for each point that has a number in both tables.
  template <class Visit>
  void for_each_common(PointNumbers& other, Visit&& visit) {
    blocks_.for_each([&](LatticePoint key, std::uint32_t n) {
      const std::uint32_t* const found = other.blocks_.find(key);
      if (found == nullptr) return;
      const Block &here = numbers_[n], &there = other.numbers_[*found];
      for (std::size_t p = 0; p < here.size(); ++p) {
        if (here[p] != kNone && there[p] != kNone) visit(here[p], there[p]);
      }
    });
  }

 private:
  using Block = std::array<std::uint32_t, 64>;
  /// A block that was asked for lately. A search in the table would mostly miss the caches.
  struct Recent {
    LatticePoint key = kNoKey<LatticePoint>;
    Block* block = nullptr;
  };

  Block* block(LatticePoint key) {
    const auto [block, is_new] = blocks_.insert(key);
    if (is_new) {
      *block = static_cast<std::uint32_t>(numbers_.size());
      numbers_.add()->fill(kNone);
    }
    return &numbers_[*block];
  }

  LatticeMap<std::uint32_t> blocks_;
  StableVector<Block> numbers_;
  std::array<Recent, 512> recent_;  ///< by where the block lies among 8^3 of its level
};

}  // namespace adamas
