#pragma once

#include <vector>

#include "adamas/grid_data.h"
#include "core/base/typed_id.h"
#include "interfaces/network/interface_network.h"

namespace adamas::interfaces {

/// Returns the body at each site of a grid, as InterfaceNetwork::body_at() does. Blocks of sites that no
/// interface enters are looked up once, so that the work grows with the number of sites near interfaces. If
/// interfaces have open borders or do not match, bodies end between triangles, and every site is looked up.
/// The result does not depend on the number of threads.
std::vector<BodyId> bodies_at_sites(const InterfaceNetwork& network, const RectilinearGrid& grid);

}  // namespace adamas::interfaces
