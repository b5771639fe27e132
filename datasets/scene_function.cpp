#include "datasets/scene_function.h"

#include <algorithm>

namespace adamas::datasets {

namespace {

FunctionRange linear_range(const SceneFunction& f, const Box3& box) {
  const Vec3 half = 0.5 * box.size();
  const double middle = f.value(box.center());
  double reach = 0;
  for (int axis = 0; axis < 3; ++axis) reach += std::abs(f.gradient[axis]) * half[axis];
  return {middle - reach, middle + reach};
}

FunctionRange sphere_range(const SceneFunction& f, const Box3& box) {
  double nearest = 0, farthest = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double below = box.min[axis] - f.center[axis], above = f.center[axis] - box.max[axis];
    const double out = std::max({below, above, 0.0}), across = std::max(-below, -above);
    nearest += out * out;
    farthest += across * across;
  }
  const double a = f.slope * (f.radius - std::sqrt(nearest)), b = f.slope * (f.radius - std::sqrt(farthest));
  return {std::min(a, b), std::max(a, b)};
}

}  // namespace

FunctionRange SceneFunction::range(const Box3& box) const {
  return is_linear() ? linear_range(*this, box) : sphere_range(*this, box);
}

}  // namespace adamas::datasets
