#include "interfaces/network/body_rays.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/hash.h"

namespace adamas::interfaces {

namespace {

constexpr int kRandomRays = 24;
constexpr double kCleanWeight = 1e-7;  // hits nearer to an edge, or more grazing than this, prove nothing
constexpr double kCleanAngle = 1e-6;

/// A random number in [0, 1).
double next_random(std::uint64_t& state) {
  return static_cast<double>(next_splitmix64(state) >> 11) * 0x1p-53;
}

Vec3 random_direction(std::uint64_t& state) {
  const double z = 2 * next_random(state) - 1;
  const double angle = 2 * M_PI * next_random(state);
  const double r = std::sqrt(std::max(0.0, 1 - z * z));
  return {r * std::cos(angle), r * std::sin(angle), z};
}

/// Parameter at which a ray from inside leaves a box.
double exit_of(const Box3& box, const Vec3& origin, const Vec3& direction) {
  double leave = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    if (direction[axis] == 0) continue;
    const double wall = direction[axis] > 0 ? box.max[axis] : box.min[axis];
    leave = std::min(leave, std::max(0.0, (wall - origin[axis]) / direction[axis]));
  }
  return leave;
}

/// A point moved a little into the box, where rays cannot miss the ends of sheets at its boundary by
/// round-off.
Vec3 pulled_inside(const Box3& box, Vec3 p) {
  for (int axis = 0; axis < 3; ++axis) {
    const double pull = 1e-9 * box.size()[axis];
    p[axis] = std::clamp(p[axis], box.min[axis] + pull, box.max[axis] - pull);
  }
  return p;
}

}  // namespace

Vec3 BodyRays::normal(std::uint32_t side) const {
  const Vec3 n = normalized(cross(corner(side, 1) - corner(side, 0), corner(side, 2) - corner(side, 0)));
  return side % 2 == 0 ? n : -n;
}

BodyRays::Result BodyRays::shoot(const std::vector<std::uint32_t>& part) const {
  Result result;
  shoot_from_extremes(part, result);
  std::uint64_t random = part.front();
  for (int ray = 0; ray < kRandomRays; ++ray) {
    const auto pick = static_cast<std::size_t>(next_random(random) * static_cast<double>(part.size()));
    const std::uint32_t side = part[std::min(pick, part.size() - 1)];
    const double a = 0.05 + 0.9 * next_random(random), b = 0.05 + 0.9 * next_random(random);
    const double u = std::min(a, b), v = std::abs(a - b);
    const Vec3 origin = u * corner(side, 0) + v * corner(side, 1) + (1 - u - v) * corner(side, 2);
    Vec3 direction = random_direction(random);
    if (dot(direction, normal(side)) < 0) direction = -direction;
    follow(side, origin, direction, result);
  }
  std::sort(result.seen.begin(), result.seen.end());
  result.seen.erase(std::unique(result.seen.begin(), result.seen.end()), result.seen.end());
  return result;
}

void BodyRays::shoot_from_extremes(const std::vector<std::uint32_t>& part, Result& result) const {
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sign : {-1.0, 1.0}) {
      Vec3 direction;
      direction[axis] = sign;
      // Of equally far corners, as on a wall, the one that lies farthest on the way on.
      std::array<double, 3> farthest{};
      std::uint32_t best = kInfinity;
      std::size_t best_corner = 0;
      for (const std::uint32_t side : part) {
        if (dot(normal(side), direction) < 1e-3) continue;
        for (std::size_t i = 0; i < 3; ++i) {
          const Vec3 p = corner(side, i);
          const std::array<double, 3> reach{sign * p[axis], p[(axis + 1) % 3], p[(axis + 2) % 3]};
          if (best == kInfinity || reach > farthest) farthest = reach, best = side, best_corner = i;
        }
      }
      if (best == kInfinity) continue;
      const Vec3 middle = (1.0 / 3) * (corner(best, 0) + corner(best, 1) + corner(best, 2));
      follow(best, 0.95 * corner(best, best_corner) + 0.05 * middle, direction, result);
    }
  }
}

void BodyRays::follow(std::uint32_t side, Vec3 origin, Vec3 direction, Result& result) const {
  if (domain_ != nullptr && !domain_->contains(origin)) return;
  if (flat(side) || std::abs(dot(normal(side), direction)) < kCleanAngle) return;
  const double leave =
      domain_ == nullptr ? std::numeric_limits<double>::infinity() : exit_of(*domain_, origin, direction);
  if (const auto hit = tree_.first_hit(origin, direction, leave, side / 2))
    return arrive(side, direction, *hit, result);
  if (domain_ != nullptr) {
    origin = pulled_inside(*domain_, origin + leave * direction);
    const Vec3 last = pulled_inside(*domain_, domain_->max);
    for (int axis = 0; axis < 3; ++axis) {
      direction = {};
      direction[axis] = 1;
      if (!(origin[axis] < last[axis])) continue;
      const auto hit =
          tree_.first_hit(origin, direction, last[axis] - origin[axis], ClosestPointTree::kNoTriangle);
      if (hit) return arrive(side, direction, *hit, result);
      origin[axis] = last[axis];
    }
  }
  result.seen.push_back(kInfinity);
}

void BodyRays::arrive(std::uint32_t side, const Vec3& direction, const RayHit& hit, Result& result) const {
  const auto& w = hit.weights;
  const double facing = dot(normal(2 * hit.triangle), direction);
  const bool clean = std::min({w[0], w[1], w[2]}) >= kCleanWeight && std::abs(facing) >= kCleanAngle;
  if (!clean || flat(2 * hit.triangle)) return;
  const std::uint32_t seen = 2 * hit.triangle + (facing < 0 ? 0 : 1);
  if (material(seen) == material(side)) {
    result.seen.push_back(seen);
  } else {
    ++result.inconsistent;
  }
}

}  // namespace adamas::interfaces
