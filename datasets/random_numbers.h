#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

#include "adamas/geometry.h"
#include "core/base/hash.h"

namespace adamas::datasets {

/// Random numbers that are the same on every platform: a Weyl sequence through a mixing function, like
/// SplitMix64 but with another function (two rounds of `remix`).
class RandomNumbers {
 public:
  explicit RandomNumbers(std::uint64_t seed) : state_(mix(seed + kGoldenRatio64)) {}

  std::uint64_t bits() { return mix(state_ += kGoldenRatio64); }
  /// A number in [0, 1).
  double uniform() { return static_cast<double>(bits() >> 11) * 0x1p-53; }
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  /// A whole number in [0, count).
  std::uint64_t below(std::uint64_t count) { return bits() % count; }
  bool chance(double probability) { return uniform() < probability; }
  /// A normally distributed number, with mean 0 and standard deviation 1 (Box and Muller).
  double normal() {
    const double distance = std::sqrt(-2 * std::log(1 - uniform()));
    return distance * std::cos(uniform(0, 2 * std::numbers::pi));
  }
  /// A point uniformly distributed in a box.
  Vec3 point(const Box3& box) {
    const double x = uniform(box.min.x, box.max.x), y = uniform(box.min.y, box.max.y);
    return {x, y, uniform(box.min.z, box.max.z)};
  }
  /// A direction uniformly distributed on the unit sphere.
  Vec3 direction() {
    const double z = uniform(-1, 1), around = uniform(0, 2 * std::numbers::pi);
    const double r = std::sqrt(1 - z * z);
    return {r * std::cos(around), r * std::sin(around), z};
  }

 private:
  static std::uint64_t mix(std::uint64_t z) {
    z = remix(remix(z));
    return z ^ (z >> 32);
  }
  std::uint64_t state_;
};

}  // namespace adamas::datasets
