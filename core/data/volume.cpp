#include "core/data/volume.h"

#include <cmath>

#include "core/base/error.h"

namespace adamas {

const char* sample_name(SampleType type) {
  switch (type) {
    case SampleType::kUint8:
      return "uint8";
    case SampleType::kUint16:
      return "uint16";
    case SampleType::kInt16:
      return "int16";
    case SampleType::kFloat32:
      return "float32";
  }
  return "";
}

Box3 VolumeGrid::box() const {
  Box3 box{origin, origin};
  for (int axis = 0; axis < 3; ++axis)
    box.max[axis] += spacing[axis] * (static_cast<double>(dimensions[static_cast<std::size_t>(axis)]) - 1);
  return box;
}

void VolumeGrid::check(const std::string& name) const {
  constexpr std::uint64_t kMostSamples = std::uint64_t{1} << 59;
  std::uint64_t product = 1;
  for (const std::uint64_t n : dimensions) {
    if (n == 0 || n > kMostSamples / product) {
      fail("{}: expected at least one sample along each axis and at most 2^59 in all, found {} x {} x {}",
           name, dimensions[0], dimensions[1], dimensions[2]);
    }
    product *= n;
  }
  for (int axis = 0; axis < 3; ++axis) {
    if (!(spacing[axis] > 0) || !std::isfinite(spacing[axis])) {
      fail("{}: expected a positive spacing along {}, found {}", name, "xyz"[axis], spacing[axis]);
    }
    if (!std::isfinite(origin[axis])) {
      fail("{}: expected a finite origin along {}, found {}", name, "xyz"[axis], origin[axis]);
    }
  }
}

}  // namespace adamas
