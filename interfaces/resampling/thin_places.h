#pragma once

#include <vector>

#include "interfaces/network/interface_network.h"

namespace adamas::interfaces {

/// The middle between two opposite sides of a body.
struct ThinPlace {
  Vec3 middle;
  double thickness = 0;
  BodyId body;
};

/// Places within the box where bodies are no thicker than `thickest`: seen from points of each triangle that
/// are about `spacing` from each other, along its normals. Where that would take too many points, they are
/// farther apart. In the order of the triangles.
std::vector<ThinPlace> thin_places(const InterfaceNetwork& network, const Box3& box, double thickest,
                                   double spacing);

}  // namespace adamas::interfaces
