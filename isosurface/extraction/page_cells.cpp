#include "isosurface/extraction/page_cells.h"

#include <algorithm>
#include <bit>
#include <limits>

#include "core/base/error.h"

namespace adamas::isosurface {

namespace {

using Set = VertexLink::Set;

/// Returns the neighbours whose steps fulfil a condition.
template <class Condition>
constexpr Set neighbours_where(Condition holds) {
  Set found = 0;
  for (int n = 0; n < VertexLink::kCount; ++n) {
    if (n != 13 && holds(VertexLink::step(n))) found |= 1u << n;
  }
  return found;
}

/// The neighbours that come before a vertex in the order of lattice points.
constexpr Set kBefore = neighbours_where([](LatticePoint d) { return d < LatticePoint{0, 0, 0}; });

/// The neighbours whose coordinate is less, equal, or greater, for each axis.
using ByAxis = std::array<Set, 3>;
constexpr ByAxis by_axis(std::int32_t way) {
  ByAxis found{};
  for (int axis = 0; axis < 3; ++axis)
    found[static_cast<std::size_t>(axis)] = neighbours_where([=](LatticePoint d) { return d[axis] == way; });
  return found;
}
constexpr ByAxis kLess = by_axis(-1), kSame = by_axis(0), kGreater = by_axis(1);

/// The greatest parameter of a point that is nearer to the first end of its edge.
constexpr double kBelowHalf = 0.5 - std::numeric_limits<double>::epsilon() / 4;

/// Returns whether the contour's point on an edge is nearer to an end than to the other end, given the
/// distances of their values from the isovalue. A point in the middle counts as nearer to the second end.
bool is_nearer(double height, double other_height, bool is_first) {
  return is_first ? height < other_height : height <= other_height;
}

unsigned parity(LatticePoint p) { return static_cast<unsigned>((p.i & 1) | (p.j & 1) << 1 | (p.k & 1) << 2); }

}  // namespace

template <class Sample>
PageCells<Sample>::PageCells(StoredDiamonds<Sample>& diamonds, double isovalue, double least_parameter)
    : diamonds_(diamonds),
      isovalue_(isovalue),
      least_parameter_(least_parameter),
      lattice_step_(diamonds.lattice_step(0)),
      box_(diamonds),
      places_(static_cast<std::size_t>(kEdgeSide) * kEdgeSide * kEdgeSide, kNone) {}

template <class Sample>
bool PageCells<Sample>::load(LatticePoint block) {
  first_ = PageGrid::kSide * block;
  for (const std::int32_t place : used_) places_[static_cast<std::size_t>(place)] = kNone;
  used_.clear();
  crossed_.clear();
  box_.load(block);
  return box_.is_finite();
}

template <class Sample>
bool PageCells<Sample>::add(LatticePoint block, SurfaceSlab& slab) {
  apart_ = nullptr;
  if (!load(block)) return false;
  const LatticePoint end = box_.cells();
  for (LatticePoint cell{0, 0, 0}; cell.k < end.k; ++cell.k) {
    for (cell.j = 0; cell.j < end.j; ++cell.j) {
      std::uint32_t crossed = box_.crossed_cells(cell.j, cell.k);
      slab.crossed_cells += static_cast<std::uint64_t>(std::popcount(crossed));
      for (; crossed != 0; crossed &= crossed - 1) {
        cell.i = std::countr_zero(crossed);
        add_cell(cell, slab);
      }
    }
  }
  return true;
}

template <class Sample>
void PageCells<Sample>::add_again(LatticePoint block, std::span<const LatticePoint> cells, const Apart& apart,
                                  std::uint32_t first_new, SurfaceSlab& slab) {
  apart_ = &apart;
  load(block);
  for (const LatticePoint cell : cells) {
    if ((box_.crossed_cells(cell.j, cell.k) >> cell.i & 1) == 0) continue;
    std::array<std::uint16_t, 19> edges;
    const CellContour& contour = contour_of(cell, slab, edges);
    for (std::size_t n = 0; n < contour.triangle_count; ++n) {
      std::array<std::uint32_t, 3> t;
      for (std::size_t c = 0; c < 3; ++c) t[c] = crossed_[edges[contour.triangles[n][c]]].number;
      const bool is_new =
          std::ranges::any_of(t, [&](std::uint32_t p) { return p >= first_new && p < kFirstPatch; });
      if (is_new && t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) slab.triangles.push_back(t);
    }
  }
}

template <class Sample>
const CellContour& PageCells<Sample>::contour_of(LatticePoint cell, SurfaceSlab& slab,
                                                 std::array<std::uint16_t, 19>& edges) {
  const auto pair = [&](std::int32_t j, std::int32_t k) {
    return box_.above(cell.j + j, cell.k + k) >> (cell.i + 1) & 3u;
  };
  const unsigned above = pair(0, 0) | pair(1, 0) << 2 | pair(0, 1) << 4 | pair(1, 1) << 6;
  const CellContour& contour = CellContour::of(parity(cell), above);
  const std::uint16_t* const places = places_.data() + edge_place(2 * cell);
  for (std::size_t e = 0; e < contour.edge_count; ++e) {
    const CellContour::Edge& edge = contour.edges[e];
    const std::uint16_t& place = places[kPlacesOfSums[edge.sum]];
    if (place == kNone) {
      const LatticePoint a = cell + corner_offset(edge.a), b = cell + corner_offset(edge.b);
      add_vertex(is_nearer(height(a), height(b), a < b) ? a : b, slab);
    }
    edges[e] = place;
  }
  return contour;
}

template <class Sample>
void PageCells<Sample>::add_cell(LatticePoint cell, SurfaceSlab& slab) {
  std::array<std::uint16_t, 19> edges;
  const CellContour& contour = contour_of(cell, slab, edges);
  for (std::size_t n = 0; n < contour.triangle_count; ++n) {
    const auto& triangle = contour.triangles[n];
    const std::array<std::uint16_t, 3> corners{edges[triangle[0]], edges[triangle[1]], edges[triangle[2]]};
    const std::array<std::uint32_t, 3> t{crossed_[corners[0]].number, crossed_[corners[1]].number,
                                         crossed_[corners[2]].number};
    if (((t[0] | t[1] | t[2]) & kFirstPatch) != 0) add_geometry(corners, slab);
    if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) slab.triangles.push_back(t);
  }
}

/// Adds a triangle of the contour, before its points are joined, to the patches at its corners.
template <class Sample>
void PageCells<Sample>::add_geometry(const std::array<std::uint16_t, 3>& corners, SurfaceSlab& slab) const {
  const CrossedEdge &a = crossed_[corners[0]], &b = crossed_[corners[1]], &c = crossed_[corners[2]];
  const Vec3 area_vector = 0.5 * cross(b.position - a.position, c.position - a.position);
  const double area = norm(area_vector), moment = dot(area_vector, a.position);
  const auto add = [&](std::uint32_t number) {
    if (number >= kFirstPatch)
      slab.patches[number - kFirstPatch].joined.add_triangle(area_vector, area, moment);
  };
  add(a.number);
  if (b.number != a.number) add(b.number);
  if (c.number != a.number && c.number != b.number) add(c.number);
}

template <class Sample>
void PageCells<Sample>::add_vertex(LatticePoint v, SurfaceSlab& slab) {
  const VertexLink& link = VertexLink::of(parity(v));
  const Set points = points_near(v, link);
  Set single = points & on_border(v);
  if (apart_ != nullptr) {
    if (const Set* const apart = apart_->find(in_samples(v))) single |= points & *apart;
  }
  const auto number = [&](Set of) {
    const std::uint32_t n = number_of(v, of, slab);
    for (Set left = of; left != 0; left &= left - 1) {
      const int neighbour = std::countr_zero(left);
      const std::int32_t place = edge_place(2 * v + VertexLink::step(neighbour));
      places_[static_cast<std::size_t>(place)] = static_cast<std::uint16_t>(crossed_.size());
      used_.push_back(place);
      crossed_.push_back({positions_[static_cast<std::size_t>(neighbour)], n});
    }
  };
  for (Set left = points & ~single; left != 0;) {
    const Set patch = link.component(left);
    left &= ~patch;
    if ((patch & (patch - 1)) != 0 && link.is_disc(patch)) {
      number(patch);
    } else {
      single |= patch;
    }
  }
  for (; single != 0; single &= single - 1) number(single & (0 - single));
}

template <class Sample>
Set PageCells<Sample>::points_near(LatticePoint v, const VertexLink& link) {
  const Set above = neighbours_above(v);
  const double height_of_v = height(v);
  Set found = 0;
  for (Set crossed = (is_above(v) ? ~above : above) & link.neighbours & ~outside(v); crossed != 0;
       crossed &= crossed - 1) {
    const int n = std::countr_zero(crossed);
    const LatticePoint w = v + VertexLink::step(n);
    const bool v_is_first = (kBefore >> n & 1) == 0;
    if (!is_nearer(height_of_v, height(w), v_is_first)) continue;
    found |= 1u << n;
    const LatticePoint first = v_is_first ? v : w, second = v_is_first ? w : v;
    const double exact = edge_parameter(box_.value(first), box_.value(second), isovalue_);
    // Rounding leaves the point on its half of the edge.
    const double t = v_is_first ? std::clamp(exact, least_parameter_, kBelowHalf)
                                : std::clamp(exact, 0.5, 1 - least_parameter_);
    const EdgePoint point{in_lattice(first), in_lattice(second), t};
    near_[static_cast<std::size_t>(n)] = point;
    positions_[static_cast<std::size_t>(n)] =
        point_between(diamonds_.domain().position(point.first), diamonds_.domain().position(point.second), t);
  }
  return found;
}

template <class Sample>
std::uint32_t PageCells<Sample>::number_of(LatticePoint v, Set points, SurfaceSlab& slab) {
  const int first = std::countr_zero(points);
  constexpr std::int32_t kEnd = PageGrid::kSide;
  const bool is_shared =
      apart_ != nullptr || std::min({v.i, v.j, v.k}) == 0 || std::max({v.i, v.j, v.k}) == kEnd;
  std::uint32_t* known = nullptr;
  if (is_shared) {
    const auto [number, is_new] = slab.shared.insert(point_key(in_samples(v), first));
    if (!is_new) return *number;
    known = number;
  }
  std::uint32_t number;
  if ((points & (points - 1)) == 0) {
    number = slab.first_edge + static_cast<std::uint32_t>(slab.edge_points.size());
    slab.edge_points.push_back(near_[static_cast<std::size_t>(first)]);
    slab.edge_positions.push_back(positions_[static_cast<std::size_t>(first)]);
  } else {
    number = kFirstPatch + static_cast<std::uint32_t>(slab.patches.size());
    auto& patch = slab.patches.emplace_back(SurfaceSlab::Patch{{in_samples(v), points}, {}});
    for (Set left = points; left != 0; left &= left - 1) {
      const auto n = static_cast<std::size_t>(std::countr_zero(left));
      patch.joined.add(positions_[n], near_[n]);
    }
  }
  if (slab.first_edge + std::max(slab.edge_points.size(), slab.patches.size()) >= kFirstPatch)
    fail("a contour has more than 2^31 points: choose another isovalue or a coarser mesh");
  if (known != nullptr) *known = number;
  return number;
}

template <class Sample>
Set PageCells<Sample>::neighbours_above(LatticePoint v) const {
  Set found = 0;
  for (int k = 0; k < 3; ++k) {
    for (int j = 0; j < 3; ++j)
      found |= (box_.above(v.j + j - 1, v.k + k - 1) >> v.i & 7u) << (3 * j + 9 * k);
  }
  return found;
}

template <class Sample>
Set PageCells<Sample>::outside(LatticePoint v) const {
  const LatticePoint at = in_samples(v), last = diamonds_.grid().last();
  Set found = 0;
  for (int axis = 0; axis < 3; ++axis) {
    if (at[axis] == 0) found |= kLess[static_cast<std::size_t>(axis)];
    if (at[axis] == last[axis]) found |= kGreater[static_cast<std::size_t>(axis)];
  }
  return found;
}

template <class Sample>
Set PageCells<Sample>::on_border(LatticePoint v) const {
  const LatticePoint at = in_samples(v), last = diamonds_.grid().last();
  Set found = 0;
  for (int axis = 0; axis < 3; ++axis) {
    if (at[axis] == 0 || at[axis] == last[axis]) found |= kSame[static_cast<std::size_t>(axis)];
  }
  return found;
}

template class PageCells<std::uint8_t>;
template class PageCells<std::uint16_t>;
template class PageCells<std::int16_t>;
template class PageCells<float>;

}  // namespace adamas::isosurface
