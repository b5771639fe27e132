#include "core/lattice/domain.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/error.h"
#include "core/geometry/length_limits.h"
#include "core/lattice/diamond.h"

namespace adamas::inline core {
namespace {

void check_box(const Box3& box) {
  for (int axis = 0; axis < 3; ++axis) {
    const double low = box.min[axis], high = box.max[axis];
    const char name = "xyz"[axis];
    if (!std::isfinite(low) || !std::isfinite(high)) {
      fail("domain: expected a finite box, found {} from {} to {}", name, low, high);
    }
    if (!(low < high)) fail("domain: expected a box with min < max, found {} from {} to {}", name, low, high);
    if (!within_length_limits(low, high)) {
      fail("domain: expected sides above {} and coordinates below {}, found {} from {} to {}", kLeastLength,
           kGreatestCoordinate, name, low, high);
    }
  }
  const Vec3 size = box.size();
  const auto [shortest, longest] = std::minmax({size.x, size.y, size.z});
  if (longest > kGreatestAspect * shortest) {
    fail(
        "domain: expected sides of which none is more than {:g} times as long as another, found {} x {} x {}",
        kGreatestAspect, size.x, size.y, size.z);
  }
}

/// The number of levels until cells get so small that rounded positions could invert a tetrahedron.
int levels(double low, double high, int roots) {
  constexpr double kUlpsPerCell = 1024;
  const double ulp = std::numeric_limits<double>::epsilon() * std::max(std::abs(low), std::abs(high));
  const double cells = (high - low) / (roots * kUlpsPerCell * ulp);
  return cells < 1 ? 0 : std::min(kRootBits - 1, std::ilogb(cells));
}

double cell_ratio(const Vec3& size, const std::array<int, 3>& roots) {
  const auto [low, high] = std::minmax({size.x / roots[0], size.y / roots[1], size.z / roots[2]});
  return high / low;
}

}  // namespace

Domain::Domain(const Box3& box, std::array<int, 3> roots) : box_(box), roots_(roots) {
  check_box(box);
  for (int axis = 0; axis < 3; ++axis) {
    const int n = roots[static_cast<std::size_t>(axis)];
    const char name = "xyz"[axis];
    if (n < 1 || n > kMaxRoots) {
      fail("domain: expected 1 to {} root cubes per axis, found {} along {}", kMaxRoots, n, name);
    }
    extent_[axis] = n << kRootBits;
    spacing_[axis] = (box.max[axis] - box.min[axis]) / extent_[axis];
    depth_ = std::min(depth_, levels(box.min[axis], box.max[axis], n));
    if (depth_ < 1) {
      fail("domain: expected a box that is not too thin for its coordinates, found {} from {} to {}", name,
           box.min[axis], box.max[axis]);
    }
  }
}

Domain Domain::fit(const Box3& box, int max_roots) {
  check_box(box);
  max_roots = std::clamp(max_roots, 1, kMaxRoots);
  const Vec3 size = box.size();
  const int shortest = size.x <= size.y && size.x <= size.z ? 0 : size.y <= size.z ? 1 : 2;
  const auto u = static_cast<std::size_t>((shortest + 1) % 3),
             v = static_cast<std::size_t>((shortest + 2) % 3);
  std::array<int, 3> roots{1, 1, 1}, best = roots;
  for (roots[u] = 1; roots[u] <= max_roots; ++roots[u]) {
    for (roots[v] = 1; roots[v] <= max_roots; ++roots[v]) {
      // A difference that may be rounding is no gain.
      if (cell_ratio(size, roots) < cell_ratio(size, best) * (1 - 1e-12)) best = roots;
    }
  }
  return {box, best};
}

double Domain::diameter(LatticePoint p) const {
  if (trailing_zeros(p) >= kRootBits) return std::ldexp(norm(spacing_), kRootBits);
  const Diamond diamond(p);
  const LatticePoint d = diamond.type().direction;
  // The diamond is symmetric about p: its diameter is twice the distance of its farthest vertex.
  Vec3 along, across;
  for (int axis = 0; axis < 3; ++axis) (d[axis] != 0 ? along : across)[axis] = spacing_[axis];
  return std::ldexp(std::max(norm(along), norm(across)), diamond.scale_bits() + 1);
}

}  // namespace adamas::inline core
