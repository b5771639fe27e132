#include "interfaces/resampling/adaptation.h"

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/base/parallel.h"
#include "core/lattice/forced_split.h"
#include "interfaces/resampling/cell_evaluation.h"
#include "interfaces/resampling/refinement_rounds.h"

namespace adamas::interfaces {

namespace {

/// The diamonds that are demanded so far, as forced_split() needs them.
struct Demand {
  const Domain& tree_domain;
  LatticeMap<char>& points;

  [[nodiscard]] const Domain& domain() const { return tree_domain; }
  [[nodiscard]] bool is_split(LatticePoint p) const { return points.find(p) != nullptr; }
};

/// Returns the points of all diamonds that are split.
LatticeMap<char> split_diamonds(const HierarchyTopology& hierarchy) {
  LatticeMap<char> points;
  hierarchy.for_each_diamond([&](DiamondId d) {
    if (hierarchy.is_split(d)) points.insert(hierarchy.lattice(d));
  });
  return points;
}

/// Estimates the errors of all tetrahedra of the tree, level by level; all keep their triangles.
void evaluate_tree(ResamplingState& state) {
  std::vector<TetrahedronId> parents = state.hierarchy.roots(), children;
  while (!parents.empty()) {
    state.progress.check();
    std::erase_if(parents, [&](TetrahedronId t) { return state.hierarchy.is_leaf(t); });
    parallel_for(parents.size(), 16, [&](std::size_t i) {
      distribute_to_children(state, parents[i]);
      for (const TetrahedronId child : state.hierarchy.children(parents[i])) evaluate_interface(state, child);
    });
    children.clear();
    for (const TetrahedronId t : parents) {
      for (const TetrahedronId child : state.hierarchy.children(t)) children.push_back(child);
    }
    parents.swap(children);
  }
}

/// Returns the diamonds of the tree that refinement from the roots would split: those of tetrahedra whose
/// errors are too great, with all their ancestors. A tetrahedron counts only if these splits create it:
/// errors may grow on the way down, so refinement would never have reached some of those below.
LatticeMap<char> demanded_diamonds(const ResamplingState& state, const Refinement& refinement) {
  LatticeMap<char> demanded;
  std::vector<TetrahedronId> open = state.hierarchy.roots();
  while (!open.empty()) {
    const TetrahedronId t = open.back();
    open.pop_back();
    if (!refinement.demands_split(t)) continue;
    forced_split(Demand{state.hierarchy.domain(), demanded},
                 state.hierarchy.lattice(state.hierarchy.diamond(t)), [&](LatticePoint p) {
                   demanded.insert(p);
                   if (!state.hierarchy.is_split(p)) return;
                   for (const TetrahedronId parent : state.hierarchy.tetrahedra(state.hierarchy.find(p))) {
                     for (const TetrahedronId child : state.hierarchy.children(parent)) open.push_back(child);
                   }
                 });
  }
  return demanded;
}

/// Merges all other diamonds, children first, and drops the leaf data of tetrahedra that stay split.
void merge_others(ResamplingState& state, const LatticeMap<char>& demanded) {
  std::vector<DiamondId> order = diamonds_in_order(state.hierarchy);
  std::vector<TetrahedronId> restored;
  for (auto d = order.rbegin(); d != order.rend(); ++d) {
    if (!state.hierarchy.is_split(*d) || demanded.find(state.hierarchy.lattice(*d)) != nullptr) continue;
    ADAMAS_ASSERT(state.hierarchy.can_merge(*d));
    // The children have changed the order of the elements.
    for (const TetrahedronId t : state.hierarchy.tetrahedra(*d)) {
      const CellRecord& cell = state.hierarchy.payload(t);
      std::sort(state.element_order.begin() + cell.first_element,
                state.element_order.begin() + cell.last_element);
    }
    state.hierarchy.merge(*d, restored);
  }
  state.hierarchy.for_each_diamond([&](DiamondId d) {
    if (!state.hierarchy.is_split(d)) return;
    for (const TetrahedronId t : state.hierarchy.tetrahedra(d)) drop_leaf_data(state, t);
  });
}

/// The rounds of refinement from the roots, and what it knows of tetrahedra at the time.
class RoundsFromRoots {
 public:
  explicit RoundsFromRoots(const std::vector<TetrahedronId>& roots) : known_(roots.size(), Known::kError) {
    for (const TetrahedronId root : roots) rounds_.add(root, false);
  }

  /// Returns the tetrahedra that are split in the next round; none after the last one.
  template <class Demands, class IsLeaf>
  std::vector<TetrahedronId> next(const Demands& demands, const IsLeaf& is_leaf) {
    return rounds_.next(demands, is_leaf, [&](const std::vector<TetrahedronId>& leaves) {
      for (const TetrahedronId t : leaves) known_[t.value] = Known::kError;
    });
  }
  /// Adds a child that a split has created. `parts_may_wait`: whether the parent's error says so.
  void add(TetrahedronId parent, TetrahedronId child, bool is_leaf, bool parts_may_wait) {
    const Known of_parent = known_[parent.value];
    const bool waits = of_parent == Known::kDeferred || (of_parent == Known::kError && parts_may_wait);
    if (child.value >= known_.size()) known_.resize(child.value + 1, Known::kNothing);
    known_[child.value] = waits ? Known::kDeferred : is_leaf ? Known::kError : Known::kNothing;
    if (is_leaf) rounds_.add(child, waits);
  }

 private:
  enum class Known : std::uint8_t { kNothing, kError, kDeferred };
  std::vector<Known> known_;  ///< by tetrahedron
  RefinementRounds rounds_;
};

/// Gives the vertices and tetrahedra the numbers that refinement from the roots gives them, by splitting
/// another hierarchy in that order. Later results depend on these numbers, since sums are taken in their
/// order.
void number_as_from_roots(ResamplingState& state, const Refinement& refinement) {
  MeshHierarchy numbered(state.hierarchy.domain());
  // The equal tetrahedron of the adapted hierarchy, by number.
  std::vector<TetrahedronId> adapted = numbered.roots();
  for (const VertexId v : state.corners(numbered.roots()))
    numbered.payload(v) = std::move(state.hierarchy.payload(v));
  RoundsFromRoots rounds(numbered.roots());
  const auto next = [&] {
    return rounds.next([&](TetrahedronId t) { return refinement.demands_split(adapted[t.value]); },
                       [&](TetrahedronId t) { return numbered.is_leaf(t); });
  };
  for (auto cells = next(); !cells.empty(); cells = next()) {
    std::vector<Split> splits;
    for (const TetrahedronId t : cells) numbered.split(t, splits);
    adapted.resize(numbered.tetrahedron_slots());
    for (const Split& split : splits) {
      const TetrahedronId parent = adapted[split.parent.value];
      const bool wait = parts_may_wait(state, state.hierarchy.payload(parent).interface);
      const auto children = state.hierarchy.children(parent);
      for (std::size_t side = 0; side < 2; ++side) {
        const TetrahedronId child = split.children[side];
        adapted[child.value] = children[side];
        rounds.add(split.parent, child, numbered.is_leaf(child), wait);
      }
      VertexRecord& vertex =
          state.hierarchy.payload(state.hierarchy.split_vertex(state.hierarchy.diamond(parent)));
      if (!numbered.payload(split.vertex).distances.body.valid())
        numbered.payload(split.vertex) = std::move(vertex);
    }
  }
  ADAMAS_ASSERT(numbered.leaf_count() == state.hierarchy.leaf_count());
  for (std::uint32_t t = 0; t < adapted.size(); ++t) {
    CellRecord& cell = numbered.payload(TetrahedronId(t));
    cell = std::move(state.hierarchy.payload(adapted[t]));
    cell.forget_contacts();  // they have the numbers of vertices
  }
  state.hierarchy = std::move(numbered);
}

}  // namespace

Adaptation adapt_hierarchy(ResamplingState& state, Refinement& refinement) {
  state.report("adapting");
  const LatticeMap<char> before = split_diamonds(state.hierarchy);
  evaluate_tree(state);
  merge_others(state, demanded_diamonds(state, refinement));
  refinement.evaluate_inner(true);
  refinement.refine_to_targets(state.leaves());
  refinement.evaluate_inner(false);
  Adaptation result;
  state.hierarchy.for_each_diamond([&](DiamondId d) {
    if (!state.hierarchy.is_split(d)) return;
    ++(before.find(state.hierarchy.lattice(d)) != nullptr ? result.kept : result.split);
  });
  result.merged = before.size() - result.kept;
  number_as_from_roots(state, refinement);
  return result;
}

}  // namespace adamas::interfaces
