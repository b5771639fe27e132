#pragma once

#include <vector>

#include "core/base/typed_id.h"
#include "core/data/mesh_data.h"
#include "core/data/multi_material_data.h"
#include "core/data/solver_mesh.h"
#include "interfaces/mesh/resampled_mesh.h"

namespace adamas::interfaces {

/// One material's volume and the integrals of its fields over its region.
struct MaterialIntegral {
  double volume = 0;
  /// The integrals of all components of all fields, laid out as FieldInfo::offset says; NaN for a field that
  /// the material does not have.
  std::vector<double> integral;
  std::vector<double> mean;  ///< integral / volume; NaN without volume
};

/// Computes the integrals over a resampled mesh, exact to round-off, since fields are linear on each part of
/// a cell.
IdVector<MaterialId, MaterialIntegral> material_integrals(const ResampledMesh& mesh);

/// Computes the integrals over data on a grid: the sums over the sites of volume times fraction times value.
/// A mixed field's value counts for each material that the site holds.
IdVector<MaterialId, MaterialIntegral> material_integrals(const MultiMaterialData& data);

/// Computes the integrals over data on a mesh of cells, as above; a cell's value of a field on points is the
/// mean of its points'. `volumes`: those of the source's materials; what comes behind those of the data, the
/// outside, has no fields.
IdVector<MaterialId, MaterialIntegral> material_integrals(const MeshData& data,
                                                          const IdVector<MaterialId, double>& volumes);

/// Computes the integrals over a cut mesh whose blocks are the materials, exact to round-off, from the means
/// in its cells.
IdVector<MaterialId, MaterialIntegral> material_integrals(const SolverMesh& cut);

}  // namespace adamas::interfaces
