#pragma once

#include <string>

#include "adamas/progress.h"
#include "core/data/interface_mesh.h"
#include "core/data/mesh_data.h"
#include "interfaces/mesh_reconstruction/mesh_values.h"

namespace adamas::interfaces {

/// The name of the material beyond the boundary of a mesh that does not fill the box round it.
inline constexpr const char* kOutside = "outside";

/// The materials of the data, and kOutside if the mesh does not fill the box round it.
IdVector<MaterialId, std::string> materials_with_outside(const MeshData& data);

/// Extracts the interfaces where the greatest value changes from one material to another, and the boundary of
/// the mesh as an interface to the outside.
InterfaceMesh interfaces_of_values(const MeshData& data, const MeshValues& values, Progress& progress);

/// Makes interfaces of the faces between cells of different labels, and of the boundary of the mesh.
InterfaceMesh interfaces_of_labels(const MeshData& data);

}  // namespace adamas::interfaces
