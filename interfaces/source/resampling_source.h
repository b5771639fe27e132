#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "adamas/fractions.h"
#include "core/geometry/vec3.h"
#include "interfaces/network/interface_network.h"
#include "interfaces/source/field_source.h"

namespace adamas::interfaces {

/// What is resampled: a box, the interfaces in it, who owns each point, and the fields of each material.
struct ResamplingSource {
  std::string name;  ///< for messages
  Box3 box;
  IdVector<MaterialId, std::string> materials;
  std::shared_ptr<const InterfaceNetwork> network;
  /// The body that owns a point; the flag tells that it is doubtful, for it rests on an open border of the
  /// input.
  std::function<BodyId(const Vec3&, bool* flagged)> body_at;
  std::shared_ptr<const FieldSource> fields;  ///< null where the input has none
  IdVector<MaterialId, double>
      volumes;  ///< of the materials, as the input states them; empty where it does not
  /// Of the bodies of the network; those of a material add up to its volume. Empty where not known.
  IdVector<BodyId, double> body_volumes;
  /// What was found of the fractions that the interfaces are from; none where these are given.
  std::optional<FractionFindings> findings;
  double voxel = 0;  ///< the least spacing of the grid that the input is given on; 0 where there is none
};

}  // namespace adamas::interfaces
