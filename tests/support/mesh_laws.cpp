#include "tests/support/mesh_laws.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "core/base/hash.h"

namespace adamas::test {

namespace {

/// Returns six times the volume of a tetrahedron, in units of its diamond's scale cubed.
std::int64_t scaled_volume(const MeshLaws::Corners& points, int bits) {
  const auto edge = [&](std::size_t v, int axis) {
    return std::int64_t{(points[v][axis] - points[0][axis]) >> bits};
  };
  const auto minor = [&](int x, int y) { return edge(2, x) * edge(3, y) - edge(2, y) * edge(3, x); };
  return edge(1, 0) * minor(1, 2) + edge(1, 1) * minor(2, 0) + edge(1, 2) * minor(0, 1);
}

}  // namespace

void MeshLaws::add(const Diamond& diamond, const Corners& corners) {
  const std::int64_t volume = scaled_volume(corners, diamond.scale_bits());
  if (volume <= 0) throw std::logic_error("mesh: a tetrahedron is not positively oriented");
  for (std::size_t a = 0; a < 4; ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      const LatticePoint way = corners[b] - corners[a];
      if (trailing_zeros(way) == 0) continue;
      const LatticePoint middle = corners[a] + LatticePoint{way.i / 2, way.j / 2, way.k / 2};
      if (is_split_(middle))
        throw std::logic_error(fmt::format("mesh: vertex ({}, {}, {}) hangs", middle.i, middle.j, middle.k));
    }
  }
  volumes_[static_cast<std::size_t>(diamond.level())] += volume;
}

void MeshLaws::check_volume() const {
  auto volumes = volumes_;
  for (std::size_t finer = volumes.size() - 1; finer > 0; --finer) {
    if (volumes[finer] % 8 != 0) throw std::logic_error("mesh: volumes do not add up");
    volumes[finer - 1] += volumes[finer] / 8;
  }
  // A root cube's side is twice the scale of level 0.
  const auto [a, b, c] = domain_.roots();
  if (volumes[0] != std::int64_t{6 * 8} * a * b * c)
    throw std::logic_error("mesh: volumes do not add up to the domain's");
}

std::uint64_t tetrahedron_checksum(std::array<LatticePoint, 4> corners) {
  std::sort(corners.begin(), corners.end());
  std::uint64_t h = 0;
  for (const LatticePoint p : corners) h = mix64_variant1(h + hash_value(p));
  return h;
}

}  // namespace adamas::test
