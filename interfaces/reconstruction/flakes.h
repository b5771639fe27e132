#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/data/interface_mesh.h"
#include "core/data/multi_material_data.h"
#include "interfaces/reconstruction/site_values.h"

namespace adamas::interfaces {

/// A body far smaller than a cell that the correction of volumes has cut off from cells which hold far more
/// of its material.
struct Flake {
  BodyId body;
  /// The neighbour with the greatest common area, among those whose material no other neighbour has.
  BodyId neighbour;
  std::uint32_t site;  ///< the site whose cell holds the middle of its bounding box
  double volume;       ///< in the cube of the unit of length
};

/// Finds the flakes of reconstructed interfaces; `bodies`: the bodies in front of each triangle and behind
/// it.
std::vector<Flake> find_flakes(const MultiMaterialData& data, const SiteValues& values,
                               const InterfaceMesh& mesh, const std::vector<std::array<BodyId, 2>>& bodies,
                               const IdVector<BodyId, MaterialId>& body_materials);

/// Gives flakes to their neighbours: removes the triangles between the two and changes the bodies of the
/// others and the materials of bodies. Returns the new number of each body.
IdVector<BodyId, BodyId> drop_flakes(const std::vector<Flake>& flakes, InterfaceMesh& mesh,
                                     std::vector<std::array<BodyId, 2>>& bodies,
                                     IdVector<BodyId, MaterialId>& body_materials);

}  // namespace adamas::interfaces
