#pragma once

#include <cstddef>

#include "core/base/typed_id.h"
#include "interfaces/network/interface_network.h"

namespace adamas::interfaces {

/// The volumes and areas of a network in a box.
struct NetworkMeasures {
  IdVector<MaterialId, double> volumes;   ///< by material, in the cube of the unit of length
  IdVector<BodyId, double> body_volumes;  ///< by body, in the same unit
  IdVector<InterfaceId, double> areas;    ///< by interface of the network, inside the box
};

/// Computes the volumes of materials and the areas of interfaces, exact to round-off, by the divergence
/// theorem: the parts of a region's boundary are those on the triangles, on the box's face x = max, on that
/// face's edge y = max and at that edge's end. `materials`: the number of materials. Points within 1e-9 of
/// the box's diagonal from a face count as on it. The volumes add up to the box's. They are those of the
/// materials if the interfaces are closed except for borders on the box's faces.
NetworkMeasures measure_network(const InterfaceNetwork& network, const Box3& box, std::size_t materials);

}  // namespace adamas::interfaces
