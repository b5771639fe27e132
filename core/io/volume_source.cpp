#include "core/io/volume_source.h"

#include <cmath>

#include "core/base/error.h"

namespace adamas {

void VolumeSource::set_stored(StoredType type) {
  stored = type;
  grid.type = sample_type_for(type);
}

namespace {

bool is_in_place(const Vec3& d, int axis) {
  const double across = std::abs(d[(axis + 1) % 3]) + std::abs(d[(axis + 2) % 3]);
  return std::abs(d[axis]) > 0 && across <= kParallelAxes * std::abs(d[axis]);
}

}  // namespace

bool are_in_place(const GridAxes& axes) {
  for (int axis = 0; axis < 3; ++axis) {
    if (!is_in_place(axes.directions[static_cast<std::size_t>(axis)], axis)) return false;
  }
  return true;
}

void VolumeSource::set_axes(const GridAxes& axes) {
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    const Vec3& d = axes.directions[a];
    if (!is_in_place(d, axis)) {
      fail(
          "{}: expected axes parallel to x, y and z in this order, found the {} axis along ({:.6g}, {:.6g}, "
          "{:.6g})",
          name, std::array{"first", "second", "third"}[a], d.x, d.y, d.z);
    }
    reversed[a] = d[axis] < 0;
    grid.spacing[axis] = std::abs(d[axis]);
    const double last = static_cast<double>(grid.dimensions[a] - 1);
    grid.origin[axis] = axes.origin[axis] + (reversed[a] ? last * d[axis] : 0);
  }
  grid.check(name);
}

}  // namespace adamas
