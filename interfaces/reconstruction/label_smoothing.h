#pragma once

#include "core/data/multi_material_data.h"
#include "interfaces/reconstruction/site_values.h"

namespace adamas::interfaces {

/// Sets values for labels whose interfaces pass through the staircase of voxel faces instead of along it:
/// signed distances from the planes of the faces round a site, after the faces of each material's boundary
/// have been moved by Taubin's low-pass filter (A signal processing approach to fair surface design, 1995).
/// Each site keeps its label, see SiteValues::least_label_value(); therefore, along each axis, no point of an
/// interface is farther than half a voxel from the voxel faces and no voxel face farther than that from an
/// interface, and bodies that hold a site are those of the labels. Changes all values at sites of `values`,
/// which must be of the same data.
void smooth_label_values(const MultiMaterialData& data, SiteValues& values);

}  // namespace adamas::interfaces
