#pragma once

#include <cstddef>

#include "core/base/typed_id.h"
#include "interfaces/network/interface_network.h"

namespace adamas::interfaces {

/// What a network encloses in a box.
struct NetworkMeasures {
  IdVector<MaterialId, double> volumes;   ///< of each material, in the cube of the unit of length
  IdVector<BodyId, double> body_volumes;  ///< of each body, alike
  IdVector<InterfaceId, double> areas;    ///< of each interface of the network, inside the box
};

/// Volumes of so many materials and areas of the interfaces, to round-off, by the divergence theorem: what a
/// region has on the triangles, on the box's face x = max, on that face's edge y = max and at that edge's
/// end. Points within 1e-9 of the box's diagonal from a face count as on it. The volumes add up to the box's.
/// They are those of the materials where the interfaces are closed but for borders on the box's faces.
NetworkMeasures measure_network(const InterfaceNetwork& network, const Box3& box, std::size_t materials);

}  // namespace adamas::interfaces
