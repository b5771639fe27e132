#pragma once

#include <optional>
#include <span>
#include <vector>

#include "adamas/probe.h"
#include "core/data/multi_material_data.h"
#include "interfaces/input/resampling_source.h"
#include "interfaces/mesh/resampled_mesh.h"
#include "interfaces/probe/cell_locator.h"
#include "interfaces/reconstruction/label_parts.h"

namespace adamas::interfaces {

/// Samples a resampled mesh at points, with each material's field up to its interfaces; components of fields
/// are where FieldInfo::offset says. The result does not depend on the number of threads.
std::vector<PointSample> probe(const ResampledMesh& mesh, const CellLocator& locator,
                               std::span<const Vec3> points);
std::vector<PointSample> probe(const ResampledMesh& mesh, std::span<const Vec3> points);

/// Samples the input; a source of data on a grid is made by make_grid_source.
std::vector<PointSample> probe(const ResamplingSource& source, std::span<const Vec3> points);

/// Samples labels as their source would be sampled, without the interfaces that are far from all points.
/// Returns none where this needs interfaces far away. `parts`: of the data.
std::optional<std::vector<PointSample>> probe(const MultiMaterialData& data, const LabelParts& parts,
                                              std::span<const Vec3> points);

}  // namespace adamas::interfaces
