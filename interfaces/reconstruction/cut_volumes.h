#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/geometry/divider.h"
#include "core/geometry/ownership_problem.h"

namespace adamas::interfaces {

/// Returns the part of a box round the origin that lies below the plane x + y + z = s. `m`: the lengths of
/// the box's sides, ascending (Scardovelli and Zaleski, Analytical relations connecting linear interfaces and
/// volume fractions in rectangular grids, 2000).
inline double box_volume_below(const std::array<double, 3>& m, double s) {
  const double total = m[0] + m[1] + m[2], alpha = s + 0.5 * total;
  if (alpha <= 0) return 0;
  if (alpha >= total) return 1;
  // The volume is measured from the nearer corner, where nothing cancels.
  if (alpha > 0.5 * total) return 1 - box_volume_below(m, -s);
  if (m[1] <= 1e-9 * m[2]) return alpha / m[2];
  if (m[0] <= 1e-6 * m[2]) {
    const double a = alpha;
    const double area = a < m[1] ? a * a / 2 : m[1] * (a - m[1] / 2);
    return area / (m[1] * m[2]);
  }
  const auto cube = [](double x) { return x > 0 ? x * x * x : 0; };
  return (cube(alpha) - cube(alpha - m[0]) - cube(alpha - m[1]) - cube(alpha - m[2]) +
          cube(alpha - m[0] - m[1])) /
         (6 * m[0] * m[1] * m[2]);
}

/// The part of a tetrahedron where a linear function with these values at its corners is positive.
struct PositivePart {
  double volume;                 ///< relative to the tetrahedron's volume
  std::array<double, 4> growth;  ///< its derivatives with respect to the values
};

/// The order of a tetrahedron's corners with the positive ones first, indexed by the bits of the positive
/// corners.
inline constexpr std::array<std::array<std::uint8_t, 4>, 16> kPositiveFirst{{{0, 1, 2, 3},
                                                                             {0, 1, 2, 3},
                                                                             {1, 0, 2, 3},
                                                                             {0, 1, 2, 3},
                                                                             {2, 0, 1, 3},
                                                                             {0, 2, 1, 3},
                                                                             {1, 2, 0, 3},
                                                                             {0, 1, 2, 3},
                                                                             {3, 0, 1, 2},
                                                                             {0, 3, 1, 2},
                                                                             {1, 3, 0, 2},
                                                                             {0, 1, 3, 2},
                                                                             {2, 3, 0, 1},
                                                                             {0, 2, 3, 1},
                                                                             {1, 2, 3, 0},
                                                                             {0, 1, 2, 3}}};

/// Returns the volume where the function is positive, and its derivatives. This is inline, so that callers
/// that need the volume alone do not pay for the derivatives.
inline PositivePart positive_part(const std::array<double, 4>& v) {
  const unsigned positive =
      (v[0] > 0 ? 1u : 0u) | (v[1] > 0 ? 2u : 0u) | (v[2] > 0 ? 4u : 0u) | (v[3] > 0 ? 8u : 0u);
  if (positive == 0) return {0, {}};
  if (positive == 15) return {1, {}};
  const auto& o = kPositiveFirst[positive];
  const double a = v[o[0]], b = v[o[1]], c = v[o[2]], d = v[o[3]];
  PositivePart result{0, {}};
  auto& g = result.growth;
  // A single positive corner keeps a / (a - b), a / (a - c) and a / (a - d) of its edges.
  if (b <= 0) {
    const double ab = 1 / (a - b), ac = 1 / (a - c), ad = 1 / (a - d), product = a * a * ab * ac * ad,
                 part = a * product;
    result.volume = part;
    g[o[0]] = 3 * product - part * (ab + ac + ad);
    g[o[1]] = part * ab, g[o[2]] = part * ac, g[o[3]] = part * ad;
    return result;
  }
  if (c > 0) {
    const double ad = 1 / (a - d), bd = 1 / (b - d), cd = 1 / (c - d), product = d * d * ad * bd * cd,
                 part = -d * product;
    result.volume = 1 - part;
    g[o[0]] = part * ad, g[o[1]] = part * bd, g[o[2]] = part * cd;
    g[o[3]] = 3 * product - part * (ad + bd + cd);
    return result;
  }
  // The positive part lies between the edge of the two positive corners and the four points on the cut edges.
  const double ac = 1 / (a - c), ad = 1 / (a - d), bc = 1 / (b - c), bd = 1 / (b - d);
  const double p = a * ac, q = a * ad, r = b * bc, t = b * bd;
  result.volume = r * t + p * q * (1 - t) + p * t * (1 - r);
  const double by_p = q * (1 - t) + t * (1 - r), by_q = p * (1 - t), by_r = t - p * t,
               by_t = r - p * q + p * (1 - r);
  // a / (a - c) grows by -c / (a - c)^2 with a and by a / (a - c)^2 with c.
  g[o[0]] = -by_p * c * ac * ac - by_q * d * ad * ad;
  g[o[1]] = -by_r * c * bc * bc - by_t * d * bd * bd;
  g[o[2]] = by_p * a * ac * ac + by_r * b * bc * bc;
  g[o[3]] = by_q * a * ad * ad + by_t * b * bd * bd;
  return result;
}

/// A tetrahedron inside another one: the barycentric coordinates of its corners, and its volume relative to
/// the outer one.
struct TetrahedronPiece {
  std::array<Weights, 4> corners;
  double volume;
};

/// The tetrahedron that pieces lie in, as a piece of itself.
inline constexpr TetrahedronPiece kWholeTetrahedron{
    {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}}, 1};

/// Keeps the parts of the pieces where the linear function with these values at the corners is positive.
/// `scratch` is working memory.
void keep_positive(const std::array<double, 4>& values, std::vector<TetrahedronPiece>& pieces,
                   std::vector<TetrahedronPiece>& scratch);

/// Returns the part of the outer tetrahedron that lies in the pieces where the linear function with these
/// values at its corners is positive, and its derivatives if they are asked for (else zero).
template <bool kGrowth>
PositivePart positive_part_of(const std::vector<TetrahedronPiece>& pieces,
                              const std::array<double, 4>& values) {
  PositivePart result{0, {}};
  for (const TetrahedronPiece& piece : pieces) {
    std::array<double, 4> at{};
    for (std::size_t c = 0; c < 4; ++c) at[c] = evaluate(values, piece.corners[c]);
    const PositivePart found = positive_part(at);
    result.volume += piece.volume * found.volume;
    for (std::size_t c = 0; kGrowth && c < 4; ++c) {
      for (std::size_t i = 0; i < 4; ++i)
        result.growth[i] += piece.volume * found.growth[c] * piece.corners[c][i];
    }
  }
  return result;
}

}  // namespace adamas::interfaces
