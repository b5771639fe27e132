#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace adamas {

/// The part of a tetrahedron where a linear function with these values at its corners is positive.
struct PositivePart {
  double volume;                 ///< in relation to the tetrahedron's
  std::array<double, 4> growth;  ///< its derivatives by the values
};

/// A tetrahedron's corners, those with a positive value first, by the bits of these.
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

/// Inline: callers that need the volume alone do not pay for the derivatives.
inline PositivePart positive_part(const std::array<double, 4>& v) {
  const unsigned positive =
      (v[0] > 0 ? 1u : 0u) | (v[1] > 0 ? 2u : 0u) | (v[2] > 0 ? 4u : 0u) | (v[3] > 0 ? 8u : 0u);
  if (positive == 0) return {0, {}};
  if (positive == 15) return {1, {}};
  const auto& o = kPositiveFirst[positive];
  const double a = v[o[0]], b = v[o[1]], c = v[o[2]], d = v[o[3]];
  PositivePart result{0, {}};
  auto& g = result.growth;
  // A corner that is cut off keeps a / (a - b) and so on of its edges.
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
  // What lies between the edge of two positive corners and the four points on the edges that are cut.
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

}  // namespace adamas
