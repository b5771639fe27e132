// A hierarchy of other data is adapted: cells are merged and split until it is the one that refinement from
// the roots gives.

#include <algorithm>
#include <vector>

#include "core/base/parallel.h"
#include "core/refinement/forced_refinement.h"
#include "interfaces/resampling/nested_errors.h"
#include "interfaces/resampling/resampler.h"

namespace adamas::interfaces {

namespace {

/// The diamonds that are demanded so far, for forced_split.
struct Demand {
  const Domain& of;
  LatticeMap<char>& points;

  [[nodiscard]] const Domain& domain() const { return of; }
  [[nodiscard]] bool is_split(LatticePoint p) const { return points.find(p) != nullptr; }
};

/// The points of all diamonds that are split.
LatticeMap<char> split_diamonds(const HierarchyTopology& hierarchy) {
  LatticeMap<char> points;
  hierarchy.for_each_diamond([&](DiamondId d) {
    if (hierarchy.is_split(d)) points.insert(hierarchy.lattice(d));
  });
  return points;
}

}  // namespace

/// Works out the errors of all tetrahedra of the tree, level by level; all keep their triangles.
void Resampler::evaluate_tree() {
  std::vector<TetrahedronId> parents = hierarchy_.roots(), children;
  while (!parents.empty()) {
    progress_.check();
    std::erase_if(parents, [&](TetrahedronId t) { return hierarchy_.is_leaf(t); });
    parallel_for(parents.size(), 16, [&](std::size_t i) {
      hand_down(parents[i]);
      for (const TetrahedronId child : hierarchy_.children(parents[i])) evaluate_interface(child);
    });
    children.clear();
    for (const TetrahedronId t : parents) {
      for (const TetrahedronId child : hierarchy_.children(t)) children.push_back(child);
    }
    parents.swap(children);
  }
}

/// The diamonds that refinement from the roots would split, as far as the tree reaches: those of tetrahedra
/// whose errors are too great, with all their ancestors. A tetrahedron counts only where these make it:
/// errors may grow on the way down, so that below there may be some that nobody would have looked at.
LatticeMap<char> Resampler::demanded_diamonds() const {
  LatticeMap<char> demanded;
  std::vector<TetrahedronId> open = hierarchy_.roots();
  while (!open.empty()) {
    const TetrahedronId t = open.back();
    open.pop_back();
    if (!demands_split(t)) continue;
    forced_split(Demand{hierarchy_.domain(), demanded}, hierarchy_.lattice(hierarchy_.diamond(t)),
                 [&](LatticePoint p) {
                   demanded.insert(p);
                   if (!hierarchy_.is_split(p)) return;
                   for (const TetrahedronId parent : hierarchy_.tetrahedra(hierarchy_.find(p))) {
                     for (const TetrahedronId child : hierarchy_.children(parent)) open.push_back(child);
                   }
                 });
  }
  return demanded;
}

/// Merges all diamonds but these, children first. What is split afterwards has nothing that only leaves have.
void Resampler::merge_others(const LatticeMap<char>& demanded) {
  std::vector<DiamondId> order = diamonds_in_order(hierarchy_);
  std::vector<TetrahedronId> restored;
  for (auto d = order.rbegin(); d != order.rend(); ++d) {
    if (!hierarchy_.is_split(*d) || demanded.find(hierarchy_.lattice(*d)) != nullptr) continue;
    ADAMAS_ASSERT(hierarchy_.can_merge(*d));
    // The children have put the elements into an order of their own.
    for (const TetrahedronId t : hierarchy_.tetrahedra(*d)) {
      const CellRecord& cell = hierarchy_.payload(t);
      std::sort(element_order_.begin() + cell.first_element, element_order_.begin() + cell.last_element);
    }
    hierarchy_.merge(*d, restored);
  }
  hierarchy_.for_each_diamond([&](DiamondId d) {
    if (!hierarchy_.is_split(d)) return;
    for (const TetrahedronId t : hierarchy_.tetrahedra(d)) close_cell(t);
  });
}

/// Gives the vertices and tetrahedra the numbers that refinement from the roots gives them, by splitting
/// another hierarchy in its order. What comes after depends on these numbers: sums are taken in their order.
void Resampler::number_as_from_roots() {
  MeshHierarchy numbered(hierarchy_.domain());
  std::vector<TetrahedronId> adapted =
      numbered.roots();  // by number: the same tetrahedron of the adapted one
  for (const VertexId v : corners_of(numbered.roots()))
    numbered.payload(v) = std::move(hierarchy_.payload(v));
  std::vector<TetrahedronId> cells = numbered.roots();
  while (!cells.empty()) {
    std::vector<Split> splits;
    for (const TetrahedronId t : cells) {
      if (demands_split(adapted[t.value])) numbered.split(t, splits);
    }
    cells.clear();
    adapted.resize(numbered.tetrahedron_slots());
    for (const Split& split : splits) {
      const TetrahedronId parent = adapted[split.parent.value];
      const auto children = hierarchy_.children(parent);
      for (std::size_t side = 0; side < 2; ++side) {
        adapted[split.children[side].value] = children[side];
        if (numbered.is_leaf(split.children[side])) cells.push_back(split.children[side]);
      }
      VertexRecord& vertex = hierarchy_.payload(hierarchy_.split_vertex(hierarchy_.diamond(parent)));
      if (!numbered.payload(split.vertex).distances.body.valid())
        numbered.payload(split.vertex) = std::move(vertex);
    }
  }
  ADAMAS_ASSERT(numbered.leaf_count() == hierarchy_.leaf_count());
  for (std::uint32_t t = 0; t < adapted.size(); ++t)
    numbered.payload(TetrahedronId(t)) = std::move(hierarchy_.payload(adapted[t]));
  hierarchy_ = std::move(numbered);
}

void Resampler::adapt() {
  report("adapting");
  const LatticeMap<char> before = split_diamonds(hierarchy_);
  evaluate_tree();
  merge_others(demanded_diamonds());
  adapting_ = true;
  refine_to_targets(leaves());
  adapting_ = false;
  adaptation_ = Adaptation{};
  hierarchy_.for_each_diamond([&](DiamondId d) {
    if (!hierarchy_.is_split(d)) return;
    ++(before.find(hierarchy_.lattice(d)) != nullptr ? adaptation_->kept : adaptation_->split);
  });
  adaptation_->merged = before.size() - adaptation_->kept;
  number_as_from_roots();
}

}  // namespace adamas::interfaces
