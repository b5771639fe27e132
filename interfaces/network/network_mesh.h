#pragma once

#include <string>

#include "core/data/interface_mesh.h"
#include "interfaces/network/interface_network.h"

namespace adamas::interfaces {

/// Returns the interfaces of a network as a welded mesh without triangles that have one body on both sides.
/// `materials`: the names of the materials.
InterfaceMesh network_mesh(const InterfaceNetwork& network,
                           const IdVector<MaterialId, std::string>& materials, const std::string& source);

}  // namespace adamas::interfaces
