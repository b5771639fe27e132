#include "isosurface/contour/cell_contour.h"

#include <bit>

#include "core/geometry/tetrahedron_contour.h"
#include "core/lattice/diamond_type.h"

namespace adamas::isosurface {

namespace {

constexpr unsigned kParities = 8, kCorners = 8;

using CellTetrahedra = std::array<std::array<std::uint8_t, 4>, 6>;

std::uint8_t corner_at(LatticePoint from_centre) {
  return static_cast<std::uint8_t>((from_centre.i > 0 ? 1 : 0) | (from_centre.j > 0 ? 2 : 0) |
                                   (from_centre.k > 0 ? 4 : 0));
}

/// Returns the corners of the cell's tetrahedra, positively oriented: those of the diamond whose split vertex
/// would be the cell's centre.
CellTetrahedra tetrahedra_of(unsigned parity) {
  const LatticePoint first = corner_offset(parity);
  const LatticePoint centre = 2 * first + LatticePoint{1, 1, 1};
  const DiamondType& type = kDiamondTypes[static_cast<std::size_t>(diamond_type(centre, 0))];
  CellTetrahedra result{};
  for (std::size_t slot = 0; slot < result.size(); ++slot)
    result[slot] = {corner_at(-type.direction), corner_at(type.direction), corner_at(type.ring[slot]),
                    corner_at(type.ring[(slot + 1) % result.size()])};
  return result;
}

/// Returns the index of an edge among a contour's edges, to which it is added if need be.
std::uint8_t place_of(CellContour& contour, std::uint8_t a, std::uint8_t b) {
  for (std::uint8_t n = 0; n < contour.edge_count; ++n) {
    const auto& edge = contour.edges[n];
    if ((edge.a == a && edge.b == b) || (edge.a == b && edge.b == a)) return n;
  }
  const LatticePoint sum = corner_offset(a) + corner_offset(b);
  contour.edges[contour.edge_count] = {a, b, static_cast<std::uint8_t>(sum.i + 3 * sum.j + 9 * sum.k)};
  return contour.edge_count++;
}

CellContour contour_of(const CellTetrahedra& tetrahedra, unsigned above) {
  CellContour result;
  for (const auto& corners : tetrahedra) {
    unsigned bits = 0;
    for (unsigned v = 0; v < 4; ++v) bits |= (above >> corners[v] & 1) << v;
    const TetrahedronContour& part = kTetrahedronContours[bits];
    for (std::size_t n = 0; n < part.triangle_count; ++n) {
      auto& triangle = result.triangles[result.triangle_count++];
      for (std::size_t c = 0; c < 3; ++c) {
        const auto [v, w] = kTetrahedronEdges[part.triangles[n][c]];
        triangle[c] = place_of(result, corners[v], corners[w]);
      }
    }
  }
  return result;
}

int neighbour_at(LatticePoint step) { return 13 + step.i + 3 * step.j + 9 * step.k; }

VertexLink link_of(unsigned parity) {
  VertexLink result{};
  // The vertex is each corner of one of the cells round it.
  for (unsigned corner = 0; corner < kCorners; ++corner) {
    for (const auto& tetrahedron : tetrahedra_of(parity ^ corner)) {
      VertexLink::Set others = 0;
      bool has_vertex = false;
      for (const std::uint8_t other : tetrahedron) {
        has_vertex = has_vertex || other == corner;
        if (other != corner) others |= 1u << neighbour_at(corner_offset(other) - corner_offset(corner));
      }
      if (!has_vertex) continue;
      result.neighbours |= others;
      for (VertexLink::Set left = others; left != 0; left &= left - 1) {
        const int n = std::countr_zero(left);
        result.adjacent[static_cast<std::size_t>(n)] |= others & ~(1u << n);
      }
    }
  }
  return result;
}

}  // namespace

const CellContour& CellContour::find(unsigned parity, unsigned above) {
  static const auto kAll = [] {
    std::array<std::array<CellContour, 256>, kParities> all;
    for (unsigned p = 0; p < kParities; ++p) {
      for (unsigned a = 0; a < 256; ++a) all[p][a] = contour_of(tetrahedra_of(p), a);
    }
    return all;
  }();
  return kAll[parity][above];
}

const VertexLink& VertexLink::find(unsigned parity) {
  static const auto kAll = [] {
    std::array<VertexLink, kParities> all;
    for (unsigned p = 0; p < kParities; ++p) all[p] = link_of(p);
    return all;
  }();
  return kAll[parity];
}

VertexLink::Set VertexLink::component(Set among) const {
  Set found = among & (0 - among);
  for (Set left = found; left != 0;) {
    const int n = std::countr_zero(left);
    const Set fresh = adjacent[static_cast<std::size_t>(n)] & among & ~found;
    found |= fresh;
    left = (left & (left - 1)) | fresh;
  }
  return found;
}

bool VertexLink::is_disc(Set component) const {
  // The patch's triangles and edges are those of the link, a sphere, between the neighbours: three neighbours
  // that share edges form a triangle of the link.
  int euler = 0;
  for (Set left = component; left != 0; left &= left - 1) {
    const int n = std::countr_zero(left);
    ++euler;
    const Set later = left & (left - 1) & adjacent[static_cast<std::size_t>(n)];
    for (Set others = later; others != 0; others &= others - 1) {
      const int m = std::countr_zero(others);
      --euler;
      for (Set thirds = others & (others - 1) & adjacent[static_cast<std::size_t>(m)]; thirds != 0;
           thirds &= thirds - 1)
        ++euler;
    }
  }
  return euler == 1;
}

}  // namespace adamas::isosurface
