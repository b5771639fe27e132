#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "adamas/progress.h"
#include "core/base/typed_id.h"
#include "core/distance/closest_point_tree.h"
#include "interfaces/cell_errors/field_error.h"
#include "interfaces/input/resampling_source.h"
#include "interfaces/mesh/conforming_mesh.h"

namespace adamas::interfaces {

/// Upper bounds of the two directed distances between a mesh's interfaces and the input's, in units of
/// length.
struct TwoSidedDistance {
  double to_input = 0;    ///< the greatest distance of a point of the mesh's interfaces from the input's
  double from_input = 0;  ///< the greatest distance of a point of the input's interfaces from the mesh's
  [[nodiscard]] double greatest() const { return std::max(to_input, from_input); }
};

/// Measures both distances of the parts in the source's box. `target`: a relevant distance; bounds are within
/// 1% of the distances or within 1% of the target.
TwoSidedDistance measure_distance(const ResamplingSource& source, std::span<const Vec3> points,
                                  std::span<const ClosestPointTree::Triangle> triangles, double target,
                                  const Progress& progress = SilentProgress::instance());

/// The figures of a mesh.
struct MeshFigures {
  std::size_t tetrahedra = 0, vertices = 0;
  DihedralRange dihedral;
  double condition_number = 0;  ///< an estimate for heat conduction (stiffness_condition_number)
  TwoSidedDistance distance;
  std::vector<FieldFigures> fields;      ///< by field of the source
  IdVector<MaterialId, double> volumes;  ///< by material
};

}  // namespace adamas::interfaces
