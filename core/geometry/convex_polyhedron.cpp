#include "core/geometry/convex_polyhedron.h"

namespace adamas {

namespace {

/// A corner of the cut, on an edge of the polyhedron, and its numbers on the two sides.
struct Crossing {
  std::uint16_t from, to;  ///< the edge's corner above and the one below
  std::uint16_t above, below;
  std::uint16_t next_above, next_below;  ///< along the cut's border, seen from outside of either side
};

/// Where a face's border passes the cut, in order.
struct Passage {
  std::size_t crossing;
  bool down;
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

void ConvexPolyhedron::cut(const std::vector<double>& d, const std::vector<char>& positive,
                           ConvexPolyhedron& above, ConvexPolyhedron& below) const {
  thread_local std::vector<std::uint16_t> place;
  thread_local std::vector<Crossing> crossings;
  thread_local std::vector<Passage> passages;
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
    passages.clear();
    for (std::size_t k = begin; k < ends_[face]; ++k) {
      const std::uint16_t c = loop_[k], next = loop_[k + 1 < ends_[face] ? k + 1 : begin];
      const bool up = positive[c] != 0;
      (up ? above : below).loop_.push_back(place[c]);
      if (up == (positive[next] != 0)) continue;
      const std::size_t x = crossing(up ? c : next, up ? next : c);
      above.loop_.push_back(crossings[x].above);
      below.loop_.push_back(crossings[x].below);
      passages.push_back({x, up});
    }
    for (ConvexPolyhedron* side : {&above, &below}) {
      const std::size_t end = side->ends_.empty() ? 0 : side->ends_.back();
      if (side->loop_.size() > end) side->end_face();
    }
    // Above, the face's border goes on from where it passes down to where it comes up again, and the border
    // of the cut the other way; below, from where it comes up to where it goes down.
    for (std::size_t i = 0; i < passages.size(); ++i) {
      const std::size_t here = passages[i].crossing, there = passages[(i + 1) % passages.size()].crossing;
      if (passages[i].down) {
        crossings[there].next_above = static_cast<std::uint16_t>(here);
      } else {
        crossings[there].next_below = static_cast<std::uint16_t>(here);
      }
    }
  }
  const auto close = [&](ConvexPolyhedron& side, std::uint16_t Crossing::*number,
                         std::uint16_t Crossing::*next) {
    place.assign(crossings.size(), 0);
    for (std::size_t start = 0; start < crossings.size(); ++start) {
      if (place[start] != 0) continue;
      for (std::size_t x = start; place[x] == 0; x = crossings[x].*next) {
        place[x] = 1;
        side.loop_.push_back(crossings[x].*number);
      }
      side.end_face();
    }
  };
  close(above, &Crossing::above, &Crossing::next_above);
  close(below, &Crossing::below, &Crossing::next_below);
}

}  // namespace adamas
