#include "isosurface/extraction/surface_request.h"

#include <utility>

#include "adamas/text.h"
#include "core/base/error.h"
#include "core/data/volume_placement.h"

namespace adamas::isosurface {

void set_region(SurfaceRequest& request, const VolumeGrid& grid, const Box3& region) {
  FrameRegion in_frame = region_in_frame(grid, region);
  request.region = in_frame.box;
  request.sides = std::move(in_frame.sides);
}

void check_surface_request(const std::string& name, const VolumeGrid& grid, const SurfaceRequest& request,
                           const std::optional<Box3>& region) {
  check_two_samples(name, grid);
  const Box3 box = grid.frame_box();
  for (int axis = 0; axis < 3; ++axis) {
    if (box.min[axis] < box.max[axis]) continue;
    fail("{}: expected samples at places that differ, found all at {} along {}", name, box.min[axis],
         "xyz"[axis]);
  }
  if (!request.region) return;
  for (int axis = 0; axis < 3; ++axis) {
    if (request.region->min[axis] < box.max[axis] && request.region->max[axis] > box.min[axis]) continue;
    fail("{}: expected a region in {}, found {}", name, box_text(grid.box()), box_text(*region));
  }
}

}  // namespace adamas::isosurface
