#include "workflow/slices/slice_input.h"

#include "core/data/volume_placement.h"
#include "interfaces/cross_section/cross_section.h"

namespace adamas::workflow {

using namespace interfaces;

std::vector<Vec3> SliceInput::outline(const Plane& plane) const {
  if (!turned) return clip_plane(plane, box());
  std::vector<Vec3> corners = clip_plane(plane_in_frame(*turned, plane), box());
  for (Vec3& p : corners) p = turned->in_space(p);
  return corners;
}

}  // namespace adamas::workflow
