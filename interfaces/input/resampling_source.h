#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "adamas/fractions.h"
#include "adamas/geometry.h"
#include "interfaces/fields/field_source.h"
#include "interfaces/network/interface_network.h"

namespace adamas::interfaces {

/// The input of resampling: a box, the interfaces in it, the owner of each point, and the fields of each
/// material.
struct ResamplingSource {
  std::string name;  ///< the name of the input in messages
  Box3 box;
  IdVector<MaterialId, std::string> materials;
  std::shared_ptr<const InterfaceNetwork> network;
  /// Returns the body that owns a point. The flag (may be null) is set if the body is uncertain because it
  /// depends on an open border of the input.
  std::function<BodyId(const Vec3&, bool* flagged)> body_at;
  std::shared_ptr<const FieldSource> fields;  ///< null if the input has none
  /// The volumes of the materials that the input states; empty if it states none.
  IdVector<MaterialId, double> volumes;
  /// The volumes of the network's bodies; those of a material add up to its volume. Empty if they are not
  /// known.
  IdVector<BodyId, double> body_volumes;
  /// The findings about the fractions from which the interfaces were reconstructed; none if interfaces are
  /// given.
  std::optional<FractionFindings> findings;
  double voxel = 0;  ///< the least spacing of the input's grid, or the size of a typical cell of its
                     ///< mesh; 0 if it has neither
};

}  // namespace adamas::interfaces
