#include "core/io/volume_source.h"

#include <cmath>

#include "core/base/error.h"

namespace adamas {

namespace {

struct StoredTypeInfo {
  const char* name;
  std::size_t bytes;
  SampleType becomes;
};

/// By StoredType.
constexpr StoredTypeInfo kTypes[] = {
    {"int8", 1, SampleType::kInt16},      {"uint8", 1, SampleType::kUint8},
    {"int16", 2, SampleType::kInt16},     {"uint16", 2, SampleType::kUint16},
    {"int32", 4, SampleType::kFloat32},   {"uint32", 4, SampleType::kFloat32},
    {"int64", 8, SampleType::kFloat32},   {"uint64", 8, SampleType::kFloat32},
    {"float32", 4, SampleType::kFloat32}, {"float64", 8, SampleType::kFloat32}};

const StoredTypeInfo& info(StoredType type) { return kTypes[static_cast<std::size_t>(type)]; }

}  // namespace

std::size_t stored_bytes(StoredType type) { return info(type).bytes; }

const char* stored_name(StoredType type) { return info(type).name; }

std::optional<StoredType> find_stored_type(std::string_view name) {
  for (std::size_t i = 0; i < std::size(kTypes); ++i) {
    if (kTypes[i].name == name) return static_cast<StoredType>(i);
  }
  return {};
}

SampleType sample_type_for(StoredType type) { return info(type).becomes; }

void VolumeSource::set_stored(StoredType type) {
  stored = type;
  grid.type = sample_type_for(type);
}

void VolumeSource::set_axes(const GridAxes& axes) {
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    const Vec3& d = axes.directions[a];
    const double across = std::abs(d[(axis + 1) % 3]) + std::abs(d[(axis + 2) % 3]);
    if (!(std::abs(d[axis]) > 0) || !(across <= kParallelAxes * std::abs(d[axis]))) {
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
