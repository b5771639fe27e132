#include "isosurface/extraction/diamond_stencil.h"

#include <utility>

#include "core/geometry/tetrahedron_contour.h"
#include "core/lattice/diamond.h"
#include "isosurface/volume/page_grid.h"

namespace adamas::isosurface {

namespace {

/// Returns the vertices of a tetrahedron and the split vertex as members, in the order of
/// DiamondType::ChildTetrahedron.
std::array<std::size_t, 5> corners_of(std::size_t slot, std::size_t tetrahedron_count) {
  const std::size_t next = slot + 1 == tetrahedron_count ? 0 : slot + 1;
  return {DiamondStencil::kBegin, DiamondStencil::kEnd, DiamondStencil::kRing + slot,
          DiamondStencil::kRing + next, DiamondStencil::kMiddle};
}

DiamondStencil::Half half_of(const DiamondType::ChildTetrahedron& from, const DiamondStencil& stencil) {
  const auto corners = corners_of(from.slot, stencil.tetrahedron_count);
  DiamondStencil::Half half{};
  half.slot = from.slot;
  for (std::size_t v = 0; v < 4; ++v) {
    half.vertices[v] = static_cast<std::uint8_t>(corners[from.vertices[v]]);
    half.members |= 1u << half.vertices[v];
  }
  for (std::size_t edge = 0; edge < half.edges.size(); ++edge) {
    const auto [a, b] = kTetrahedronEdges[edge];
    half.edges[edge] =
        DiamondStencil::edge_place(stencil.offsets[half.vertices[a]] + stencil.offsets[half.vertices[b]]);
  }
  return half;
}

/// Fills the tables that are indexed by the members above a contour.
void count_triangles(DiamondStencil& stencil) {
  for (DiamondStencil::Members above = 0; above < 1u << stencil.count; ++above) {
    unsigned crossed = 0;
    for (std::size_t n = 0; n < 2 * stencil.child_count; ++n)
      crossed |= (DiamondStencil::triangles(stencil.halves[n].members, above) > 0 ? 1u : 0u) << n;
    stencil.crossed.push_back(static_cast<std::uint16_t>(crossed));
    stencil.added.push_back(static_cast<std::int8_t>(stencil.added_in(0xff, above)));
  }
}

DiamondStencil stencil_of(const DiamondType& type) {
  DiamondStencil stencil{};
  stencil.phase = type.phase;
  stencil.tetrahedron_count = static_cast<std::size_t>(type.tetrahedron_count);
  stencil.count = DiamondStencil::kRing + stencil.tetrahedron_count;
  stencil.offsets[DiamondStencil::kBegin] = -type.direction;
  stencil.offsets[DiamondStencil::kEnd] = type.direction;
  for (std::size_t slot = 0; slot < stencil.tetrahedron_count; ++slot) {
    stencil.offsets[DiamondStencil::kRing + slot] = type.ring[slot];
    const auto corners = corners_of(slot, stencil.tetrahedron_count);
    for (std::size_t v = 0; v < 4; ++v) stencil.tetrahedra[slot] |= 1u << corners[v];
  }
  stencil.child_count = static_cast<std::size_t>(type.child_count);
  for (std::size_t c = 0; c < stencil.child_count; ++c) {
    const LatticePoint offset = type.child_offsets[c];
    stencil.children[c] = type.phase == 2 ? offset : LatticePoint{offset.i / 2, offset.j / 2, offset.k / 2};
    for (std::size_t h = 0; h < 2; ++h)
      stencil.halves[2 * c + h] = half_of(type.child_tetrahedra[c][h], stencil);
  }
  for (std::size_t m = 0; m < stencil.count; ++m)
    stencil.places[m] = static_cast<std::int32_t>(PaddedGrid<int>::offset(stencil.offsets[m]));
  count_triangles(stencil);
  return stencil;
}

/// The ends of all edges between points on a page or one step round it, indexed by
/// DiamondStencil::edge_place.
struct EdgesOfPage {
  struct Edge {
    std::array<std::int8_t, 3> first, second;
  };
  std::vector<Edge> edges{std::size_t{DiamondStencil::kEdgePlaces}};

  EdgesOfPage() {
    constexpr std::int32_t kEdges = DiamondStencil::kEdgeSide, kHalf = 8, kSide = PageGrid::kSide;
    // Diamonds on all pages are like those on this one, if their edges lie within the points round it.
    constexpr LatticePoint kBlock{1, 1, 1};
    for (std::int32_t place = 0; place < DiamondStencil::kEdgePlaces; ++place) {
      // An edge is the split edge of the diamond at its middle, which is half the sum of its ends.
      const LatticePoint sum{place % kEdges - 2, place / kEdges % kEdges - 2, place / (kEdges * kEdges) - 2};
      auto ends = Diamond(kHalf * (2 * kSide * kBlock + sum)).split_edge();
      if (ends[1] < ends[0]) std::swap(ends[0], ends[1]);
      Edge& edge = edges[static_cast<std::size_t>(place)];
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto from_first = [axis](LatticePoint p) {
          return static_cast<std::int8_t>(p[static_cast<int>(axis)] / (2 * kHalf) - kSide);
        };
        edge.first[axis] = from_first(ends[0]);
        edge.second[axis] = from_first(ends[1]);
      }
    }
  }
};

}  // namespace

std::array<LatticePoint, 2> DiamondStencil::ends_of_edge(std::int32_t place) {
  static const EdgesOfPage kAll;
  const EdgesOfPage::Edge& edge = kAll.edges[static_cast<std::size_t>(place)];
  return {LatticePoint{edge.first[0], edge.first[1], edge.first[2]},
          LatticePoint{edge.second[0], edge.second[1], edge.second[2]}};
}

int DiamondStencil::added_in(unsigned slots, Members above) const {
  int more = 0;
  for (std::size_t slot = 0; slot < tetrahedron_count; ++slot) {
    if ((slots >> slot & 1) != 0) more -= triangles(tetrahedra[slot], above);
  }
  for (std::size_t n = 0; n < 2 * child_count; ++n) {
    if ((slots >> halves[n].slot & 1) != 0) more += triangles(halves[n].members, above);
  }
  return more;
}

const DiamondStencil* DiamondStencil::all() {
  static const auto kAll = [] {
    std::array<DiamondStencil, kDiamondTypeCount> all;
    for (std::size_t type = 0; type < all.size(); ++type) all[type] = stencil_of(kDiamondTypes[type]);
    return all;
  }();
  return kAll.data();
}

}  // namespace adamas::isosurface
