#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "adamas/geometry.h"
#include "core/base/typed_id.h"
#include "interfaces/network/winding_tree.h"
#include "interfaces/ownership/interface_table.h"

namespace adamas::interfaces {

class InterfaceNetwork;

/// Generalized winding numbers of the bodies of a network (docs/method.md, Gaps): 1 in a body and 0 elsewhere
/// if the interfaces are closed; values between these if they have gaps.
class BodyWinding {
 public:
  /// `domain`: the box at whose faces the interfaces may end.
  BodyWinding(const InterfaceNetwork& network, const std::optional<Box3>& domain);

  struct Answer {
    BodyId body;        ///< the body with the greatest number, among those of the material with the greatest
                        ///< sum
    double number = 0;  ///< the sum over that material's bodies; near 1 if the answer is certain
  };
  [[nodiscard]] Answer at(const Vec3& p) const;
  /// Sets `numbers` to the winding number of each body.
  void numbers_at(const Vec3& p, IdVector<BodyId, double>& numbers) const;

 private:
  /// An edge on the domain's boundary or beyond, where an interface ends. The interface is continued from
  /// there away from the domain's centre.
  struct Strip {
    InterfaceId interface;
    Vec3 from, to;  ///< in the direction of the triangle's corners
  };
  void find_strips(const InterfaceNetwork& network, const Box3& domain);
  void find_offsets(const InterfaceNetwork& network, const std::optional<Box3>& domain);
  void sum_angles(const Vec3& p, IdVector<BodyId, double>& numbers) const;

  InterfaceTable table_;
  IdVector<InterfaceId, WindingTree> trees_;
  std::vector<Strip> strips_;
  Vec3 center_;                       ///< the centre of the domain
  IdVector<BodyId, double> offsets_;  ///< each body's part of the sphere at infinity
};

}  // namespace adamas::interfaces
