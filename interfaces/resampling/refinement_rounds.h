#pragma once

#include <utility>
#include <vector>

#include "interfaces/hierarchy/hierarchy.h"

namespace adamas::interfaces {

/// The tetrahedra that refinement looks at, round by round. Deferred ones wait until no other has to be
/// split.
class RefinementRounds {
 public:
  void add(TetrahedronId t, bool deferred) { (deferred ? deferred_ : cells_).push_back(t); }

  /// Returns the number of deferred ones.
  [[nodiscard]] std::size_t deferred_count() const { return deferred_.size(); }
  /// Returns the tetrahedra that are to be split in the next round, where wants_split(t) holds; none after
  /// the last round. evaluate(leaves) estimates the errors of deferred ones before.
  template <class WantsSplit, class IsLeaf, class Evaluate>
  std::vector<TetrahedronId> next(const WantsSplit& wants_split, const IsLeaf& is_leaf,
                                  const Evaluate& evaluate) {
    const auto drop_others = [&] { std::erase_if(cells_, [&](TetrahedronId t) { return !wants_split(t); }); };
    drop_others();
    if (cells_.empty()) {
      cells_.swap(deferred_);
      std::erase_if(cells_, [&](TetrahedronId t) { return !is_leaf(t); });
      evaluate(cells_);
      drop_others();
    }
    return std::exchange(cells_, {});
  }

 private:
  std::vector<TetrahedronId> cells_, deferred_;
};

}  // namespace adamas::interfaces
