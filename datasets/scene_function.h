#pragma once

#include <cmath>

#include "adamas/geometry.h"

namespace adamas::datasets {

/// The least and the greatest value of a function over a box.
struct FunctionRange {
  double low = 0, high = 0;
};

/// A scalar function that scenes are made of: linear, or a multiple of the signed distance to a sphere.
struct SceneFunction {
  /// Linear: dot(gradient, p - center) + constant. Sphere: slope * (radius - |p - center|).
  enum class Kind { kLinear, kSphere };
  Kind kind = Kind::kLinear;
  Vec3 center;
  Vec3 gradient;
  double constant = 0;
  double radius = 0;
  double slope = 1;

  static SceneFunction linear(const Vec3& gradient, const Vec3& center, double constant = 0) {
    SceneFunction f;
    f.gradient = gradient;
    f.center = center;
    f.constant = constant;
    return f;
  }
  /// The signed distance to a sphere, positive inside.
  static SceneFunction sphere(const Vec3& center, double radius) {
    SceneFunction f;
    f.kind = Kind::kSphere;
    f.center = center;
    f.radius = radius;
    return f;
  }
  /// The function times a factor.
  [[nodiscard]] SceneFunction scaled(double factor) const {
    SceneFunction f = *this;
    f.gradient = factor * gradient;
    f.constant = factor * constant;
    f.slope = factor * slope;
    return f;
  }
  /// The negated function, with exactly opposite values in floating point.
  [[nodiscard]] SceneFunction negated() const { return scaled(-1); }

  [[nodiscard]] bool is_linear() const { return kind == Kind::kLinear; }
  [[nodiscard]] double value(const Vec3& p) const {
    return is_linear() ? dot(gradient, p - center) + constant : slope * (radius - distance(p, center));
  }
  /// The range over a box, exact to round-off.
  [[nodiscard]] FunctionRange range(const Box3& box) const;

  bool operator==(const SceneFunction&) const = default;
};

}  // namespace adamas::datasets
