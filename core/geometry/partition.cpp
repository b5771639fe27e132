#include "core/geometry/partition.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/geometry/convex_polyhedron.h"
#include "core/geometry/divider.h"

namespace adamas::inline core {

namespace {

/// On a convex polygon a linear function changes sign twice at most. Where it is round-off it may seem to do
/// so more often: the weakest runs of corners on one side then count as zeros of the other side.
void drop_weak_runs(std::vector<double>& d, std::vector<char>& positive) {
  const std::size_t n = d.size();
  while (true) {
    std::size_t changes = 0, weakest = n, weakest_size = 0;
    double weakest_value = std::numeric_limits<double>::infinity();
    for (std::size_t c = 0; c < n; ++c) {
      if (positive[c] == positive[(c + n - 1) % n]) continue;
      ++changes;
      double greatest = 0;
      std::size_t size = 0;
      for (; size < n && positive[(c + size) % n] == positive[c]; ++size)
        greatest = std::max(greatest, std::abs(d[(c + size) % n]));
      if (greatest < weakest_value) weakest_value = greatest, weakest = c, weakest_size = size;
    }
    if (changes <= 2) return;
    const bool side = positive[weakest] == 0;
    for (std::size_t i = 0; i < weakest_size; ++i) {
      d[(weakest + i) % n] = 0;
      positive[(weakest + i) % n] = side ? 1 : 0;
    }
  }
}

class ConvexPolygon {
 public:
  ConvexPolygon() = default;
  explicit ConvexPolygon(std::vector<Weights> corners) : corners_(std::move(corners)) {}
  [[nodiscard]] const std::vector<Weights>& corners() const { return corners_; }

  /// Cuts where `d`, given at the corners, changes sign.
  void cut(std::vector<double>& d, std::vector<char>& positive, ConvexPolygon& above,
           ConvexPolygon& below) const {
    above.corners_.clear();
    below.corners_.clear();
    drop_weak_runs(d, positive);
    for (std::size_t c = 0; c < corners_.size(); ++c) {
      const std::size_t next = (c + 1) % corners_.size();
      (positive[c] != 0 ? above : below).corners_.push_back(corners_[c]);
      if (positive[c] == positive[next]) continue;
      const Weights w = between(corners_[c], corners_[next], d[c] == 0 ? 0 : d[c] / (d[c] - d[next]));
      above.corners_.push_back(w);
      below.corners_.push_back(w);
    }
  }

 private:
  std::vector<Weights> corners_;
};

}  // namespace

void partition_tetrahedron(const OwnershipProblem& problem, std::vector<OwnedTetrahedron>& parts) {
  thread_local Divider<ConvexPolyhedron> divider;
  divider.divide(problem, ConvexPolyhedron::unit(),
                 [&](std::uint32_t owner, const ConvexPolyhedron& part, const auto&) {
                   part.for_each_tetrahedron([&](const std::array<Weights, 4>& corners) {
                     parts.push_back({owner, corners});
                   });
                 });
}

void partition_polygon(const OwnershipProblem& problem, const std::vector<Weights>& polygon,
                       std::vector<OwnedPolygon>& parts) {
  thread_local Divider<ConvexPolygon> divider;
  divider.divide(problem, ConvexPolygon(polygon),
                 [&](std::uint32_t owner, const ConvexPolygon& part, const auto&) {
                   parts.push_back({owner, part.corners()});
                 });
}

double volume_fraction(const std::array<Weights, 4>& c) {
  // Edge vectors in the coordinates (w1, w2, w3); the unit tetrahedron has determinant 1.
  std::array<std::array<double, 3>, 3> m{};
  for (std::size_t r = 0; r < 3; ++r) {
    for (std::size_t i = 0; i < 3; ++i) m[r][i] = c[r + 1][i + 1] - c[0][i + 1];
  }
  return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
         m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
         m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
}

}  // namespace adamas::inline core
