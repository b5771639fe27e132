#include "interfaces/hierarchy/hierarchy.h"

#include <algorithm>

#include "core/lattice/forced_split.h"

namespace adamas::interfaces {
namespace {
// The greatest number of pairs. Tetrahedra have two ids per pair, and the last id is the invalid one.
constexpr std::uint32_t kMaxPairs = 0x7ffffff0u;
}  // namespace

HierarchyTopology::HierarchyTopology(const Domain& domain) : domain_(domain) {
  const auto [a, b, c] = domain.roots();
  for (int k = 0; k <= c; ++k) {
    for (int j = 0; j <= b; ++j) {
      for (int i = 0; i <= a; ++i) make_vertex({i << kRootBits, j << kRootBits, k << kRootBits});
    }
  }
  for (int k = 0; k < c; ++k) {
    for (int j = 0; j < b; ++j) {
      for (int i = 0; i < a; ++i) make_root_cube({i, j, k});
    }
  }
}

VertexId HierarchyTopology::make_vertex(LatticePoint p) {
  const std::uint32_t v = vertices_.allocate();
  vertices_[v].point = p;
  return VertexId(v);
}

void HierarchyTopology::make_root_cube(LatticePoint cube) {
  const std::int32_t half = std::int32_t{1} << (kRootBits - 1);
  const Diamond diamond(2 * half * cube + LatticePoint{half, half, half});
  const DiamondId id = find_or_make_diamond(diamond.point(), static_cast<std::size_t>(diamond.type_index()),
                                            diamond.scale_bits());
  const auto roots = domain_.roots();
  for (int slot = 0; slot < diamond.tetrahedron_count(); ++slot) {
    if (slot % 2 == 0) pairs_.allocate();
    const TetrahedronId t(std::size_t{2} * (pairs_.slots() - 1) + static_cast<std::size_t>(slot % 2));
    for (std::size_t v = 0; v < 4; ++v) {
      const LatticePoint p = diamond.tetrahedron(slot)[v];
      const int x = p.i >> kRootBits, y = p.j >> kRootBits, z = p.k >> kRootBits;
      node(t).vertices[v] = VertexId(static_cast<std::size_t>(x + (roots[0] + 1) * (y + (roots[1] + 1) * z)));
    }
    attach(t, id, static_cast<std::uint8_t>(slot));
    roots_.push_back(t);
    ++leaf_count_;
  }
}

DiamondId HierarchyTopology::find_or_make_diamond(LatticePoint p, std::size_t type_index, int bits) {
  const auto [place, is_new] = diamond_at_.insert(p);
  if (!is_new) return *place;
  const DiamondId id(diamonds_.allocate());
  *place = id;
  Record& diamond = record(id);
  diamond.point = p;
  diamond.type_index = static_cast<std::uint8_t>(type_index);
  diamond.bits = static_cast<std::uint8_t>(bits);
  diamond.full_count =
      static_cast<std::uint8_t>(diamond.type().tetrahedron_count >> domain_.boundary_count(p));
  return id;
}

void HierarchyTopology::attach(TetrahedronId t, DiamondId d, std::uint8_t slot) {
  Record& diamond = record(d);
  ADAMAS_ASSERT(!diamond.tetrahedra[slot].valid());
  diamond.tetrahedra[slot] = t;
  ++diamond.count;
  node(t).diamond = d;
  pairs_[t.value / 2].slots[t.value % 2] = slot;
}

void HierarchyTopology::detach(TetrahedronId t) {
  const DiamondId d = diamond(t);
  Record& old = record(d);
  old.tetrahedra[pairs_[t.value / 2].slots[t.value % 2]] = TetrahedronId();
  if (--old.count > 0) return;
  diamond_at_.erase(old.point);
  diamonds_.release(d.value);
}

void HierarchyTopology::split_leaf(TetrahedronId leaf, std::vector<Split>& done) {
  if (!is_leaf(leaf) || !can_split(leaf)) return;
  const DiamondId d = diamond(leaf);
  if (is_complete(d)) {
    split_complete(d, done);
  } else {
    forced_split(*this, record(d).point, [&](LatticePoint p) { split_complete(find(p), done); });
  }
}

std::array<LatticePoint, 8> HierarchyTopology::prefetch_children(const Record& diamond) const {
  const DiamondType& type = diamond.type();
  const std::int32_t half_scale = (std::int32_t{1} << diamond.bits) / 2;
  std::array<LatticePoint, 8> children;
  for (std::size_t c = 0; c < static_cast<std::size_t>(type.child_count); ++c) {
    children[c] = diamond.point + half_scale * type.child_offsets[c];
    diamond_at_.prefetch(children[c]);
  }
  return children;
}

void HierarchyTopology::split_complete(DiamondId d, std::vector<Split>& done) {
  ADAMAS_ASSERT(d.valid() && is_complete(d) && !is_split(d));
  pairs_.require_room(8, kMaxPairs);  // there are more pairs than vertices or diamonds
  Record& diamond = record(d);
  for (const TetrahedronId t : diamond.tetrahedra) {
    if (t.valid()) __builtin_prefetch(&node(t));
  }
  diamond.vertex = make_vertex(diamond.point);
  const std::array<LatticePoint, 8> children = prefetch_children(diamond);
  std::array<std::uint32_t, 8> pairs;
  for (std::size_t slot = 0; slot < 8; ++slot) {
    const TetrahedronId t = diamond.tetrahedra[slot];
    if (!t.valid()) continue;
    pairs[slot] = pairs_.allocate();
    pairs_[pairs[slot]].parent = t;
    node(t).children = pairs[slot];
    done.push_back({t, tetrahedra_of(pairs[slot]), diamond.vertex});
  }
  leaf_count_ += diamond.count;
  link_children(diamond, children, pairs);
}

void HierarchyTopology::link_children(const Record& diamond, const std::array<LatticePoint, 8>& points,
                                      const std::array<std::uint32_t, 8>& pairs) {
  const DiamondType& type = diamond.type();
  const int child_bits = type.phase == 2 ? diamond.bits - 1 : diamond.bits;
  const auto count = static_cast<std::size_t>(type.child_count);
  std::array<DiamondId, 8> children;
  for (std::size_t c = 0; c < count; ++c) {
    const auto& halves = type.child_tetrahedra[c];
    if (!diamond.tetrahedra[halves[0].slot].valid() && !diamond.tetrahedra[halves[1].slot].valid()) continue;
    children[c] = find_or_make_diamond(points[c], type.child_types[c], child_bits);
    __builtin_prefetch(&record(children[c]));
  }
  for (std::size_t c = 0; c < count; ++c) {
    for (const DiamondType::ChildTetrahedron& half : type.child_tetrahedra[c]) {
      const TetrahedronId t = diamond.tetrahedra[half.slot];
      if (!t.valid()) continue;
      const auto& v = node(t).vertices;
      const std::array<VertexId, 5> corners{v[0], v[1], v[2], v[3], diamond.vertex};
      const TetrahedronId half_id = tetrahedra_of(pairs[half.slot])[half.end];
      for (std::size_t w = 0; w < 4; ++w) node(half_id).vertices[w] = corners[half.vertices[w]];
      attach(half_id, children[c], half.child_slot);
    }
  }
}

bool HierarchyTopology::can_merge(DiamondId d) const {
  if (!is_split(d)) return false;
  for (const TetrahedronId t : record(d).tetrahedra) {
    if (t.valid()) __builtin_prefetch(&node(t));
  }
  for (const TetrahedronId t : record(d).tetrahedra) {
    if (!t.valid()) continue;
    for (const TetrahedronId child : children(t)) {
      if (!is_leaf(child)) return false;
    }
  }
  return true;
}

void HierarchyTopology::merge_diamond(DiamondId d) {
  ADAMAS_ASSERT(can_merge(d));
  Record& diamond = record(d);
  prefetch_children(diamond);
  for (const TetrahedronId t : diamond.tetrahedra) {
    if (!t.valid()) continue;
    for (const TetrahedronId child : children(t)) __builtin_prefetch(&record(node(child).diamond));
  }
  for (const TetrahedronId t : diamond.tetrahedra) {
    if (!t.valid()) continue;
    for (const TetrahedronId child : children(t)) detach(child);
    pairs_.release(node(t).children);
    node(t).children = kNoPair;
  }
  leaf_count_ -= diamond.count;
  vertices_.release(diamond.vertex.value);
  diamond.vertex = VertexId();
}

SmallList<TetrahedronId, 8> HierarchyTopology::tetrahedra(DiamondId d) const {
  SmallList<TetrahedronId, 8> result;
  for (const TetrahedronId t : record(d).tetrahedra) {
    if (t.valid()) result.push_back(t);
  }
  return result;
}

std::size_t HierarchyTopology::bytes() const {
  return vertices_.bytes() + pairs_.bytes() + diamonds_.bytes() + diamond_at_.bytes() +
         roots_.capacity() * sizeof(roots_[0]);
}

std::vector<DiamondId> diamonds_in_order(const HierarchyTopology& hierarchy) {
  struct Ranked {
    int rank;
    LatticePoint point;
    DiamondId diamond;
  };
  std::vector<Ranked> ranked;
  hierarchy.for_each_diamond([&](DiamondId d) {
    const TetrahedronId t = *hierarchy.tetrahedra(d).begin();
    ranked.push_back({3 * hierarchy.level(t) + hierarchy.phase(t), hierarchy.lattice(d), d});
  });
  std::sort(ranked.begin(), ranked.end(), [](const Ranked& a, const Ranked& b) {
    return a.rank != b.rank ? a.rank < b.rank : a.point < b.point;
  });
  std::vector<DiamondId> order;
  for (const Ranked& r : ranked) order.push_back(r.diamond);
  return order;
}

}  // namespace adamas::interfaces
