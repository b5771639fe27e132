#include "interfaces/resampling/thin_places.h"

#include <algorithm>
#include <cmath>

#include "core/base/parallel.h"

namespace adamas::interfaces {

namespace {

/// Points that are looked at, about, and along a side of a triangle, at most.
constexpr double kMostPoints = 1e6, kMostAlongSide = 64;
/// Of more triangles than this that are no larger than the spacing not all are looked at.
constexpr std::size_t kMostSmall = 500'000;

/// Calls visit(point) at the middles of n^2 equal parts of a triangle.
template <typename Visit>
void for_each_middle(const std::array<Vec3, 3>& corners, int n, Visit visit) {
  const Vec3 u = (1.0 / n) * (corners[1] - corners[0]), v = (1.0 / n) * (corners[2] - corners[0]);
  for (int i = 0; i < n; ++i) {
    for (int j = 0; i + j < n; ++j) {
      visit(corners[0] + (i + 1.0 / 3) * u + (j + 1.0 / 3) * v);
      if (i + j + 1 < n) visit(corners[0] + (i + 2.0 / 3) * u + (j + 2.0 / 3) * v);
    }
  }
}

double longest_side(const std::array<Vec3, 3>& corners) {
  return std::max(
      {distance(corners[0], corners[1]), distance(corners[1], corners[2]), distance(corners[2], corners[0])});
}

}  // namespace

std::vector<ThinPlace> thin_places(const InterfaceNetwork& network, const Box3& box, double thickest,
                                   double spacing) {
  const std::size_t count = network.triangles().size();
  std::vector<double> sides(count);
  double squares = 0;
  for (std::uint32_t t = 0; t < count; ++t) {
    sides[t] = longest_side(network.triangle_corners(t));
    squares += sides[t] * sides[t];
  }
  spacing = std::max(spacing, std::sqrt(squares / kMostPoints));
  const auto small = std::ranges::count_if(sides, [spacing](double side) { return side <= spacing; });
  const std::size_t stride = static_cast<std::size_t>(small) / kMostSmall + 1;
  constexpr std::size_t kChunk = 256;
  std::vector<std::vector<ThinPlace>> parts((count + kChunk - 1) / kChunk);
  const auto look = [&](std::uint32_t t, const Vec3& p, std::vector<ThinPlace>& places) {
    const auto& bodies = network.table().sides(network.interface_of(t));
    for (std::size_t side = 0; side < 2; ++side) {
      const Vec3 inwards = (side == 0 ? 1.0 : -1.0) * network.normal(t);
      const auto hit = network.tree().first_hit(p, inwards, thickest, t);
      if (!hit) continue;
      const auto& opposite = network.table().sides(network.interface_of(hit->triangle));
      if (opposite[0] != bodies[side] && opposite[1] != bodies[side]) continue;
      const Vec3 middle = p + 0.5 * hit->t * inwards;
      if (box.contains(middle)) places.push_back({middle, hit->t, bodies[side]});
    }
  };
  parallel_chunks(count, kChunk, [&](std::size_t first, std::size_t last) {
    for (std::size_t t = first; t < last; ++t) {
      const auto number = static_cast<std::uint32_t>(t);
      const double n = std::clamp(std::ceil(sides[t] / spacing), 1.0, kMostAlongSide);
      if (n == 1 && t % stride != 0) continue;
      for_each_middle(network.triangle_corners(number), static_cast<int>(n),
                      [&](const Vec3& p) { look(number, p, parts[first / kChunk]); });
    }
  });
  std::vector<ThinPlace> result;
  for (const auto& part : parts) result.insert(result.end(), part.begin(), part.end());
  return result;
}

}  // namespace adamas::interfaces
