#pragma once

#include "core/data/multi_material_data.h"
#include "interfaces/reconstruction/site_values.h"

namespace adamas::interfaces {

/// Sets values for labels so that interfaces pass through the staircase of voxel faces instead of along it.
/// They are signed distances from the planes of the faces round a site, after the faces of each material's
/// boundary have been moved by Taubin's low-pass filter (A signal processing approach to fair surface design,
/// 1995). Each site keeps its label (see SiteValues::least_label_value()). Therefore, along each axis,
/// interfaces are at most half a voxel from the voxel faces and these from interfaces, and bodies that hold a
/// site are those of the labels. All values of `values`, which must belong to the same data, are replaced.
void smooth_label_values(const MultiMaterialData& data, SiteValues& values);

}  // namespace adamas::interfaces
