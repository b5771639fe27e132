#include "interfaces/reconstruction/cut_volumes.h"

#include <cmath>

#include "core/geometry/divider.h"

namespace adamas::interfaces {

void keep_positive(const std::array<double, 4>& values, std::vector<TetrahedronPiece>& pieces,
                   std::vector<TetrahedronPiece>& scratch) {
  scratch.clear();
  for (const TetrahedronPiece& piece : pieces) {
    std::array<double, 4> d{};
    for (std::size_t c = 0; c < 4; ++c) d[c] = evaluate(values, piece.corners[c]);
    std::array<std::size_t, 4> o{0, 1, 2, 3};  // corners by descending value
    const auto order = [&](std::size_t i, std::size_t j) {
      if (d[o[i]] < d[o[j]]) std::swap(o[i], o[j]);
    };
    order(0, 1), order(2, 3), order(0, 2), order(1, 3), order(1, 2);
    if (d[o[0]] <= 0) continue;
    if (d[o[3]] >= 0) {
      scratch.push_back(piece);
      continue;
    }
    const auto corner = [&](std::size_t i) { return piece.corners[o[i]]; };
    const auto cut = [&](std::size_t i, std::size_t j) {
      const double t = d[o[i]] / (d[o[i]] - d[o[j]]);
      Weights w{};
      for (std::size_t c = 0; c < 4; ++c) w[c] = (1 - t) * corner(i)[c] + t * corner(j)[c];
      return w;
    };
    const auto keep = [&](const std::array<Weights, 4>& corners) {
      const double volume = std::abs(volume_fraction(corners));
      if (volume > 0) scratch.push_back({corners, volume});
    };
    if (d[o[1]] <= 0) {
      keep({corner(0), cut(0, 1), cut(0, 2), cut(0, 3)});
    } else if (d[o[2]] <= 0) {
      keep({corner(0), corner(1), cut(1, 2), cut(1, 3)});
      keep({corner(0), cut(0, 2), cut(0, 3), cut(1, 3)});
      keep({corner(0), cut(0, 2), cut(1, 2), cut(1, 3)});
    } else {
      keep({corner(0), corner(1), corner(2), cut(2, 3)});
      keep({corner(0), corner(1), cut(1, 3), cut(2, 3)});
      keep({corner(0), cut(0, 3), cut(1, 3), cut(2, 3)});
    }
  }
  pieces.swap(scratch);
}

}  // namespace adamas::interfaces
