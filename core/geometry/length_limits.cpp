#include "core/geometry/length_limits.h"

#include "core/base/error.h"

namespace adamas {

void check_lengths(const std::string& name, const Box3& box) {
  for (int axis = 0; axis < 3; ++axis) {
    const double low = box.min[axis], high = box.max[axis];
    if (within_length_limits(low, high)) continue;
    fail("{}: expected coordinates below {} that are more than {} apart, found {} and {} along {}", name,
         kGreatestCoordinate, kLeastLength, low, high, "xyz"[axis]);
  }
}

}  // namespace adamas
