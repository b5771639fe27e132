#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "core/base/typed_id.h"
#include "core/geometry/vec3.h"
#include "interfaces/network/winding_tree.h"
#include "interfaces/ownership/interface_table.h"

namespace adamas::interfaces {

class InterfaceNetwork;

/// Generalized winding numbers of the bodies of a network (docs/method.md, Gaps): 1 in a body and 0 elsewhere
/// where the interfaces are closed, and between where they have gaps.
class BodyWinding {
 public:
  /// `domain`: where the interfaces may end.
  BodyWinding(const InterfaceNetwork& network, const std::optional<Box3>& domain);

  struct Answer {
    BodyId body;        ///< the one with the greatest number in the material with the greatest
    double number = 0;  ///< of that material: near 1 where the answer is sure
  };
  [[nodiscard]] Answer at(const Vec3& p) const;
  /// Of each body; replaces `numbers`.
  void numbers_at(const Vec3& p, IdVector<BodyId, double>& numbers) const;

 private:
  /// An edge on the domain's boundary or beyond, where an interface ends; it goes on from there away from the
  /// domain's centre.
  struct Strip {
    InterfaceId interface;
    Vec3 from, to;  ///< as the triangle runs
  };
  void find_strips(const InterfaceNetwork& network, const Box3& domain);
  void find_offsets(const InterfaceNetwork& network, const std::optional<Box3>& domain);
  void sum_angles(const Vec3& p, IdVector<BodyId, double>& numbers) const;

  InterfaceTable table_;
  IdVector<InterfaceId, WindingTree> trees_;
  std::vector<Strip> strips_;
  Vec3 center_;                       ///< of the domain
  IdVector<BodyId, double> offsets_;  ///< what each body has of the sphere at infinity
};

}  // namespace adamas::interfaces
