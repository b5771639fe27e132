#include "cli/store_slab.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "core/base/error.h"
#include "core/geometry/length_limits.h"
#include "isosurface/storage/restore.h"
#include "isosurface/storage/sample_dispatch.h"

namespace adamas {

namespace {

/// Samples that are read at most: four for each pixel of a large picture, or a cube of 256^3.
constexpr std::uint64_t kMostSamples = std::uint64_t{1} << 24;

/// What of the box the layers of a level next to the plane span.
Box3 layers_at(const Box3& box, const VolumeGrid& grid, const Plane& plane, int level) {
  Box3 region = box;
  if (const auto axis = plane.axis()) {
    const double step = std::ldexp(grid.spacing[*axis], level);
    const double layers = std::floor((box.max[*axis] - box.min[*axis]) / step);
    const double at = (plane.origin[*axis] - box.min[*axis]) / step;
    const double below = std::clamp(std::floor(at), 0.0, std::max(0.0, layers - 1));
    region.min[*axis] = box.min[*axis] + below * step;
    region.max[*axis] = region.min[*axis] + step;
  }
  return region;
}

RectilinearGrid nodes_of(const VolumeGrid& volume) {
  RectilinearGrid grid;
  grid.centering = Centering::kPoints;
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    for (std::uint64_t n = 0; n < volume.dimensions[a]; ++n)
      grid.nodes[a].push_back(volume.origin[axis] + static_cast<double>(n) * volume.spacing[axis]);
  }
  return grid;
}

}  // namespace

MultiMaterialData store_slab(const StoreInput& input, const Plane& plane, Session& session) {
  const std::unique_ptr<StoreFile> file = open_store(input, session);
  const VolumeGrid& volume = file->header().grid;
  const Box3 box = volume.box();
  for (const std::uint64_t n : volume.dimensions) {
    if (n < 2) fail("{}: expected two samples or more along each axis, found {}", input.path, n);
  }
  check_lengths(input.path, box);
  check_lengths(input.path, {volume.origin, volume.origin + volume.spacing});
  if (clip_plane(plane, box).empty())
    fail("{}: expected a plane that cuts {}, found {}", input.path, box_text(box), to_string(plane));
  RestoredPart part;
  for (int level = 0; level <= file->grid().top(); ++level) {
    part = restored_part(volume, level, layers_at(box, volume, plane, level), input.path);
    if (part.grid.samples() <= kMostSamples) break;
  }
  for (const std::uint64_t n : part.grid.dimensions) {
    if (n < 2) fail("{}: expected two samples or more along each axis, found {}", input.path, n);
  }
  if (part.level > 0)
    session.console.note("the section is of one sample in {} along each axis", 1 << part.level);
  MultiMaterialData data;
  data.source = input.path;
  data.grid = nodes_of(part.grid);
  data.materials = IdVector<MaterialId, std::string>(1, "volume");
  data.labels.assign(part.grid.samples(), 0);
  Field field;
  field.name = kSampleField;
  field.values.reserve(part.grid.samples());
  with_sample_type(volume.type, [&](auto sample) {
    using Sample = decltype(sample);
    restore(
        *file, 0, part, store_memory(input),
        [&field](std::span<const std::byte> plane_bytes) {
          for (std::size_t at = 0; at < plane_bytes.size(); at += sizeof(Sample)) {
            Sample value;
            std::memcpy(&value, plane_bytes.data() + at, sizeof(Sample));
            field.values.push_back(static_cast<float>(value));
          }
        },
        session.console);
  });
  data.fields.push_back(std::move(field));
  return data;
}

}  // namespace adamas
