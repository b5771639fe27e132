#include "core/geometry/convex_polyhedron.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/base/assert.h"

namespace adamas::inline core {

namespace {

/// A corner of the cut on an edge of the polyhedron, and its numbers on the two sides.
struct Crossing {
  std::uint16_t from, to;  ///< the edge's corner above and the one below
  std::uint16_t above, below;
  /// The next corner of the cut's border, seen from outside of either side.
  std::uint16_t next_above, next_below;
};

}  // namespace

ConvexPolyhedron ConvexPolyhedron::unit() {
  ConvexPolyhedron whole;
  for (std::size_t v = 0; v < 4; ++v) {
    Weights corner{};
    corner[v] = 1;
    whole.add(corner);
  }
  whole.loop_ = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
  whole.ends_ = {3, 6, 9, 12};
  return whole;
}

void ConvexPolyhedron::cut(std::vector<double>& d, std::vector<char>& positive, ConvexPolyhedron& above,
                           ConvexPolyhedron& below) const {
  if (try_cut(d, positive, above, below)) return;
  connect(1, d, positive);
  connect(0, d, positive);
  const bool whole = try_cut(d, positive, above, below);
  ADAMAS_ASSERT(whole);
}

/// Both sides of a plane are connected along the edges of a convex polyhedron. If round-off says otherwise,
/// all parts of a side but the one that reaches farthest from the plane count as zeros of the other side.
void ConvexPolyhedron::connect(char side, std::vector<double>& d, std::vector<char>& positive) const {
  std::vector<std::size_t> part(corners_.size());
  std::iota(part.begin(), part.end(), std::size_t{0});
  for (bool changed = true; changed;) {
    changed = false;
    for_each_edge([&](std::size_t a, std::size_t b) {
      if (positive[a] != side || positive[b] != side || part[a] == part[b]) return;
      part[a] = part[b] = std::min(part[a], part[b]);
      changed = true;
    });
  }
  std::size_t farthest = corners_.size();
  for (std::size_t c = 0; c < corners_.size(); ++c) {
    if (positive[c] == side && (farthest == corners_.size() || std::abs(d[c]) > std::abs(d[farthest])))
      farthest = c;
  }
  for (std::size_t c = 0; c < corners_.size(); ++c) {
    if (positive[c] != side || part[c] == part[farthest]) continue;
    positive[c] = side == 0 ? 1 : 0;
    d[c] = 0;
  }
}

bool ConvexPolyhedron::try_cut(const std::vector<double>& d, const std::vector<char>& positive,
                               ConvexPolyhedron& above, ConvexPolyhedron& below) const {
  thread_local std::vector<std::uint16_t> place;
  thread_local std::vector<Crossing> crossings;
  above.clear();
  below.clear();
  crossings.clear();
  place.resize(corners_.size());
  for (std::size_t c = 0; c < corners_.size(); ++c)
    place[c] = (positive[c] != 0 ? above : below).add(corners_[c]);

  const auto crossing = [&](std::uint16_t from, std::uint16_t to) {
    for (std::size_t i = 0; i < crossings.size(); ++i) {
      if (crossings[i].from == from && crossings[i].to == to) return i;
    }
    const bool swapped = corners_[to] > corners_[from];
    const std::uint16_t a = swapped ? to : from, b = swapped ? from : to;
    const Weights w = between(corners_[a], corners_[b], d[a] == 0 ? 0 : d[a] / (d[a] - d[b]));
    crossings.push_back({from, to, above.add(w), below.add(w), 0, 0});
    return crossings.size() - 1;
  };

  for (std::size_t face = 0, begin = 0; face < ends_.size(); begin = ends_[face++]) {
    std::size_t down = 0, up = 0, passages = 0;
    for (std::size_t k = begin; k < ends_[face]; ++k) {
      const std::uint16_t c = loop_[k], next = loop_[k + 1 < ends_[face] ? k + 1 : begin];
      const bool high = positive[c] != 0;
      (high ? above : below).loop_.push_back(place[c]);
      if (high == (positive[next] != 0)) continue;
      const std::size_t x = crossing(high ? c : next, high ? next : c);
      above.loop_.push_back(crossings[x].above);
      below.loop_.push_back(crossings[x].below);
      (high ? down : up) = x;
      ++passages;
    }
    if (passages > 2) return false;
    above.end_face();
    below.end_face();
    if (passages == 0) continue;
    // On the upper side the face's border continues from where it goes down to where it comes up again, and
    // the border of the cut runs the other way; on the lower side it continues from where it comes up to
    // where it goes down.
    crossings[up].next_above = static_cast<std::uint16_t>(down);
    crossings[down].next_below = static_cast<std::uint16_t>(up);
  }
  const auto close = [&](ConvexPolyhedron& side, std::uint16_t Crossing::*number,
                         std::uint16_t Crossing::*next) {
    std::size_t count = 0, x = 0;
    do {
      side.loop_.push_back(crossings[x].*number);
      x = crossings[x].*next;
      ++count;
    } while (x != 0);
    side.end_face();
    return count == crossings.size();
  };
  const bool whole_above = close(above, &Crossing::above, &Crossing::next_above);
  return close(below, &Crossing::below, &Crossing::next_below) && whole_above;
}

}  // namespace adamas::inline core
