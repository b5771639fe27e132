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
  BodyId neighbour;    ///< with the greatest area between, of those whose material no other neighbour has
  std::uint32_t site;  ///< in whose cell its middle lies
  double volume;       ///< in the cube of the unit of length
};

/// Flakes of reconstructed interfaces; `bodies`: in front of their triangles and behind.
std::vector<Flake> find_flakes(const MultiMaterialData& data, const SiteValues& values,
                               const InterfaceMesh& mesh, const std::vector<std::array<BodyId, 2>>& bodies,
                               const IdVector<BodyId, MaterialId>& body_materials);

/// Gives flakes to their neighbours: changes triangles, without those between the two, their bodies, and the
/// materials of bodies. Returns the new numbers of bodies.
IdVector<BodyId, BodyId> drop_flakes(const std::vector<Flake>& flakes, InterfaceMesh& mesh,
                                     std::vector<std::array<BodyId, 2>>& bodies,
                                     IdVector<BodyId, MaterialId>& body_materials);

}  // namespace adamas::interfaces
