#pragma once

#include <string>

#include "core/data/interface_mesh.h"
#include "interfaces/network/interface_network.h"

namespace adamas::interfaces {

/// The interfaces of a network between materials, as they are kept for queries: welded, without triangles
/// that have one body on both sides. `materials` names those of the network's bodies.
InterfaceMesh network_mesh(const InterfaceNetwork& network,
                           const IdVector<MaterialId, std::string>& materials, const std::string& source);

}  // namespace adamas::interfaces
