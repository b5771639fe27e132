#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/geometry/ownership_problem.h"

namespace adamas::inline core {

/// The point at fraction `t` of the way from a to b; exactly a and b for 0 and 1.
inline Weights between(const Weights& a, const Weights& b, double t) {
  if (t <= 0) return a;
  if (t >= 1) return b;
  Weights w;
  for (std::size_t i = 0; i < 4; ++i) w[i] = (1 - t) * a[i] + t * b[i];
  return w;
}

/// A convex part of a tetrahedron: corners, by weights, and faces. Corners and edges are kept
/// combinatorially, so that cuts leave closed surfaces however small the parts become.
class ConvexPolyhedron {
 public:
  /// The whole tetrahedron.
  static ConvexPolyhedron unit();

  [[nodiscard]] const std::vector<Weights>& corners() const { return corners_; }

  /// Cuts where `d`, given at the corners, changes sign; `positive` is the side of each corner, and both
  /// sides have some. Signs that a plane cannot have, due to round-off, are first corrected in `d` and
  /// `positive`. Points of the cut do not depend on the order of the corners.
  void cut(std::vector<double>& d, std::vector<char>& positive, ConvexPolyhedron& above,
           ConvexPolyhedron& below) const;

  /// Calls back with tetrahedra that fill the polyhedron. The diagonals of a face depend on the face's
  /// corners only.
  template <class Visit>
  void for_each_tetrahedron(Visit&& visit) const {
    const std::size_t apex = first_of(corners_.size(), [](std::size_t i) { return i; });
    for (std::size_t face = 0, begin = 0; face < ends_.size(); begin = ends_[face++]) {
      const std::size_t size = ends_[face] - begin;
      const auto corner = [&](std::size_t k) -> std::size_t { return loop_[begin + k % size]; };
      bool has_apex = false;
      for (std::size_t k = 0; k < size; ++k) has_apex = has_apex || corner(k) == apex;
      if (has_apex) continue;
      const std::size_t first = first_of(size, corner);
      for (std::size_t k = 1; k + 1 < size; ++k) {
        const std::array<Weights, 4> t{corners_[apex], corners_[corner(first)], corners_[corner(first + k)],
                                       corners_[corner(first + k + 1)]};
        if (distinct(t)) visit(t);
      }
    }
  }

 private:
  /// The k in [0, count) whose corner(k) comes first by its weights.
  template <class Corner>
  [[nodiscard]] std::size_t first_of(std::size_t count, const Corner& corner) const {
    std::size_t best = 0;
    for (std::size_t k = 1; k < count; ++k) {
      if (corners_[corner(k)] > corners_[corner(best)]) best = k;
    }
    return best;
  }
  static bool distinct(const std::array<Weights, 4>& t) {
    return t[0] != t[1] && t[0] != t[2] && t[0] != t[3] && t[1] != t[2] && t[1] != t[3] && t[2] != t[3];
  }
  void clear() {
    corners_.clear();
    loop_.clear();
    ends_.clear();
  }
  std::uint16_t add(const Weights& corner) {
    corners_.push_back(corner);
    return static_cast<std::uint16_t>(corners_.size() - 1);
  }
  /// Ends the current face, if it has any corners.
  void end_face() {
    if (loop_.size() > (ends_.empty() ? 0 : ends_.back()))
      ends_.push_back(static_cast<std::uint32_t>(loop_.size()));
  }
  template <class Visit>
  void for_each_edge(Visit&& visit) const {
    for (std::size_t face = 0, begin = 0; face < ends_.size(); begin = ends_[face++]) {
      for (std::size_t k = begin; k < ends_[face]; ++k)
        visit(loop_[k], loop_[k + 1 < ends_[face] ? k + 1 : begin]);
    }
  }
  /// Cuts, and returns false where the sides are not those of a plane.
  bool try_cut(const std::vector<double>& d, const std::vector<char>& positive, ConvexPolyhedron& above,
               ConvexPolyhedron& below) const;
  void connect(char side, std::vector<double>& d, std::vector<char>& positive) const;

  std::vector<Weights> corners_;
  /// Corners of the faces, face by face, each edge once in either direction.
  std::vector<std::uint16_t> loop_;
  std::vector<std::uint32_t> ends_;  ///< the end of each face in `loop_`
};

}  // namespace adamas::inline core
