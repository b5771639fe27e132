#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/data/mesh_set.h"
#include "core/data/multi_material_data.h"
#include "core/data/polyhedral_mesh.h"

namespace adamas::inline core {

/// A field on the cells or the points of a mesh.
struct MeshField : Field {
  Centering centering = Centering::kCells;
};

/// Simulation data with several materials on a mesh of polyhedra: volume fractions per material and cell, or
/// a label per cell, and fields.
struct MeshData {
  std::string source;  ///< the file or generator, for messages
  PolyhedralMesh mesh;
  IdVector<MaterialId, std::string> materials;
  Fractions fractions;                ///< by cell; empty where `labels` is given
  std::vector<std::uint16_t> labels;  ///< the index of the one material of each cell; else empty
  std::vector<MeshField> fields;
  std::vector<MeshSet> sets;  ///< side sets and node sets, which have no part in what is computed
  FractionReport report;

  [[nodiscard]] float fraction(MaterialId m, std::size_t cell) const {
    return labels.empty() ? fractions[m][cell] : (labels[cell] == m.value ? 1.0f : 0.0f);
  }
  /// Does what normalise_fractions() does, and fills `report`.
  void normalise();
  /// The volume of each material, as the fractions or labels say, in the cube of the unit of length.
  [[nodiscard]] IdVector<MaterialId, double> volumes() const;
  /// Checks the data as MultiMaterialData::check() does.
  void check() const;
};

}  // namespace adamas::inline core
