#include "core/io/volume_source.h"

#include <cmath>
#include <utility>

#include "core/base/error.h"

namespace adamas::io {

void VolumeSource::set_stored(StoredType type) {
  stored = type;
  grid.type = sample_type_for(type);
}

void VolumeSource::keep_scale() {
  const bool whole = stored != StoredType::kFloat32 && stored != StoredType::kFloat64;
  if (!scaled() || !(slope > 0) || !whole) return;
  grid.type = sample_type_for(stored);
  grid.slope = std::exchange(slope, 1);
  grid.intercept = std::exchange(intercept, 0);
}

void VolumeSource::set_axes(const GridAxes& axes) {
  grid.origin = axes.origin;
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    const Vec3& step = axes.directions[a];
    const double length = std::hypot(step.x, step.y, step.z);
    grid.spacing[axis] = length;
    if (length > 0) grid.directions[a] = {step.x / length, step.y / length, step.z / length};
  }
  grid.check(name);
}

std::string VolumeSource::size_text() const {
  const auto& n = grid.dimensions;
  return fmt::format("{} bytes for {} x {} x {} samples of {}", sample_file_bytes(), n[0], n[1], n[2],
                     stored_name(stored));
}

void VolumeSource::check_size() const {
  grid.check(name);
  constexpr std::uint64_t kMost = std::uint64_t{1} << 62;
  const std::uint64_t sample = components * stored_bytes(stored);
  if (components == 0 || components > 1'000'000 || grid.samples() > kMost / sample) {
    const auto& n = grid.dimensions;
    fail(
        "{}: expected one to a million numbers per sample, and no more than a file can hold, found {} for {} "
        "x {} x {}",
        name, components, n[0], n[1], n[2]);
  }
}

}  // namespace adamas::io
