#include "adamas/volume.h"

#include <algorithm>
#include <cmath>

#include "adamas/geometry.h"
#include "adamas/text.h"
#include "core/base/error.h"

namespace adamas {

namespace {

double determinant(const std::array<Vec3, 3>& columns) {
  return dot(cross(columns[0], columns[1]), columns[2]);
}

}  // namespace

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

bool VolumeGrid::is_along_axes() const {
  return std::all_of(directions.begin(), directions.end(), [](const Vec3& d) {
    const int zeros = static_cast<int>(d.x == 0) + static_cast<int>(d.y == 0) + static_cast<int>(d.z == 0);
    return zeros == 2 && std::abs(d.x + d.y + d.z) == 1;
  });
}

bool VolumeGrid::is_left_handed() const { return determinant(directions) < 0; }

Vec3 VolumeGrid::in_space(const Vec3& in_frame) const {
  if (is_straight()) return in_frame;
  const Vec3 way = in_frame - origin;
  return origin + (way.x * directions[0] + way.y * directions[1] + way.z * directions[2]);
}

Vec3 VolumeGrid::in_frame(const Vec3& in_space) const {
  if (is_straight()) return in_space;
  const auto& [a, b, c] = directions;
  const Vec3 way = (1 / determinant(directions)) * (in_space - origin);
  return origin + Vec3{dot(cross(b, c), way), dot(cross(c, a), way), dot(cross(a, b), way)};
}

// The greatest stretch is the root of the greatest eigenvalue of the matrix of the directions' dot products,
// whose diagonal is 1, by the trigonometric formula for symmetric matrices.
double VolumeGrid::greatest_stretch() const {
  const auto& [a, b, c] = directions;
  const double ab = dot(a, b), bc = dot(b, c), ca = dot(c, a);
  const double p = std::sqrt((ab * ab + bc * bc + ca * ca) / 3);
  if (!(p > 1e-30)) return 1;
  const double r = std::clamp(ab * bc * ca / (p * p * p), -1.0, 1.0);
  return std::sqrt(1 + 2 * p * std::cos(std::acos(r) / 3));
}

Box3 VolumeGrid::frame_box() const {
  Box3 box{origin, origin};
  for (int axis = 0; axis < 3; ++axis)
    box.max[axis] += spacing[axis] * (static_cast<double>(dimensions[static_cast<std::size_t>(axis)]) - 1);
  return box;
}

Box3 VolumeGrid::box() const {
  Box3 box;
  for (const Vec3& corner : frame_box().corners()) box.extend(in_space(corner));
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
  if (!(slope > 0) || !std::isfinite(slope) || !std::isfinite(intercept)) {
    fail("{}: expected values of a positive multiple of the samples and a finite number, found {} and {}",
         name, slope, intercept);
  }
  for (const std::string& unit : {length_unit, value_unit}) {
    const bool shown = visible_text(unit) == unit && unit.find('"') == std::string::npos;
    if (unit.size() > kLongestUnit || !shown)
      fail("{}: expected units of up to {} bytes that can be printed, found '{}'", name, kLongestUnit,
           visible_text(unit));
  }
  constexpr double kRoundOff = 1e-6, kFlat = 1e-4;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Vec3& d = directions[axis];
    if (!(std::abs(norm(d) - 1) <= kRoundOff)) {
      fail("{}: expected a direction of length 1 for axis {}, found ({}, {}, {})", name, "ijk"[axis], d.x,
           d.y, d.z);
    }
  }
  if (!(std::abs(determinant(directions)) >= kFlat)) {
    const auto& [a, b, c] = directions;
    fail(
        "{}: expected axes that are not in one plane, found ({:.6g}, {:.6g}, {:.6g}), ({:.6g}, {:.6g}, "
        "{:.6g}) "
        "and ({:.6g}, {:.6g}, {:.6g})",
        name, a.x, a.y, a.z, b.x, b.y, b.z, c.x, c.y, c.z);
  }
}

namespace {

template <class Sample>
constexpr SampleType kTypeOf = SampleType::kFloat32;
template <>
constexpr SampleType kTypeOf<std::uint8_t> = SampleType::kUint8;
template <>
constexpr SampleType kTypeOf<std::uint16_t> = SampleType::kUint16;
template <>
constexpr SampleType kTypeOf<std::int16_t> = SampleType::kInt16;

}  // namespace

template <class Sample>
std::span<const Sample> Volume::as() const {
  if (grid.type != kTypeOf<Sample>)
    fail("expected samples of type {}, found {}", sample_name(kTypeOf<Sample>), sample_name(grid.type));
  // Memory from operator new is aligned for every type of sample.
  return {static_cast<const Sample*>(static_cast<const void*>(samples.data())),
          samples.size() / sizeof(Sample)};
}

template std::span<const std::uint8_t> Volume::as() const;
template std::span<const std::uint16_t> Volume::as() const;
template std::span<const std::int16_t> Volume::as() const;
template std::span<const float> Volume::as() const;

}  // namespace adamas
