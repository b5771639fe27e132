#pragma once

#include <vector>

#include "adamas/grid_data.h"
#include "core/base/typed_id.h"
#include "core/geometry/vec3.h"
#include "interfaces/network/interface_network.h"

namespace adamas::interfaces {

/// The body at each site of a grid, as InterfaceNetwork::body_at tells it. Blocks of sites that no interface
/// enters are asked for once, so that the work grows with the sites near interfaces; not so where interfaces
/// have open borders or do not match, since there bodies end between triangles. The same on any number of
/// threads.
std::vector<BodyId> bodies_at_sites(const InterfaceNetwork& network, const RectilinearGrid& grid);

}  // namespace adamas::interfaces
