#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "adamas/geometry.h"

namespace adamas::inline core {

/// Twice the area, divided by the square of the longest side.
inline double triangle_quality(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 u = b - a, v = c - b, w = a - c;
  const double longest = std::max({squared_norm(u), squared_norm(v), squared_norm(w)});
  return longest > 0 ? norm(cross(u, v)) / longest : 0;
}

/// The triangulation of a loop of points whose worst triangle is best, among all without new points. For
/// weakly convex loops; collinear corners make no triangle without area unless all but a part that turns back
/// on itself are collinear.
class BestTriangulation {
 public:
  BestTriangulation(const std::vector<Vec3>& points, std::span<const std::uint32_t> loop)
      : points_(points), loop_(loop), size_(loop.size()), best_(size_ * size_, {2, 0}) {
    for (std::size_t length = 2; length < size_; ++length) {
      for (std::size_t i = 0; i + length < size_; ++i) choose(i, i + length);
    }
  }

  /// Calls emit(a, b, c) for each triangle, oriented as the loop.
  template <class Emit>
  void for_each(Emit&& emit) const {
    std::vector<std::pair<std::size_t, std::size_t>> spans{{0, size_ - 1}};
    while (!spans.empty()) {
      const auto [i, j] = spans.back();
      spans.pop_back();
      if (j < i + 2) continue;
      const std::size_t k = at(i, j).middle;
      emit(loop_[i], loop_[k], loop_[j]);
      spans.emplace_back(k, j);
      spans.emplace_back(i, k);
    }
  }

 private:
  /// The best triangulation of the part of the loop between two of its corners.
  struct Choice {
    double quality;
    std::size_t middle;
  };
  [[nodiscard]] const Choice& at(std::size_t i, std::size_t j) const { return best_[i * size_ + j]; }

  void choose(std::size_t i, std::size_t j) {
    Choice best{-1, i + 1};
    for (std::size_t k = i + 1; k < j; ++k) {
      const double rest = std::min(at(i, k).quality, at(k, j).quality);
      if (rest <= best.quality) continue;
      const double all = std::min(rest, quality(loop_[i], loop_[k], loop_[j]));
      if (all > best.quality) best = {all, k};
    }
    best_[i * size_ + j] = best;
  }

  [[nodiscard]] double quality(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
    return triangle_quality(points_[a], points_[b], points_[c]);
  }

  const std::vector<Vec3>& points_;
  std::span<const std::uint32_t> loop_;
  std::size_t size_;
  std::vector<Choice> best_;
};

/// Triangulates a (weakly) convex polygon, given by indices into `points`; `emit(a, b, c)` keeps orientation.
template <class Emit>
void triangulate_convex(const std::vector<Vec3>& points, std::span<const std::uint32_t> loop, Emit&& emit) {
  if (loop.size() == 3) {
    emit(loop[0], loop[1], loop[2]);
  } else if (loop.size() == 4) {
    // A polygon of four corners has the same choice, between two diagonals, without tables.
    const auto worst = [&](std::size_t k) {
      const auto corner = [&](std::size_t i) { return points[loop[(k + i) % 4]]; };
      return std::min(triangle_quality(corner(0), corner(1), corner(2)),
                      triangle_quality(corner(0), corner(2), corner(3)));
    };
    const std::size_t k = worst(0) > worst(1) ? 0 : 1;
    emit(loop[k], loop[k + 1], loop[k + 2]);
    emit(loop[k], loop[k + 2], loop[(k + 3) % 4]);
  } else if (loop.size() > 3) {
    BestTriangulation(points, loop).for_each(emit);
  }
}

}  // namespace adamas::inline core
