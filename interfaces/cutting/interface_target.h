#pragma once

#include <map>
#include <optional>
#include <vector>

#include "core/distance/closest_point_tree.h"
#include "interfaces/cutting/labelled_mesh.h"
#include "interfaces/mesh/interface_extraction.h"

namespace adamas::interfaces {

/// The places where bodies have to meet in a mesh that is being changed: two bodies at their interface, three
/// at their junction line, more at their common points.
class InterfaceTarget {
 public:
  /// `tolerance`: the greatest distance of the changed interfaces from these places.
  InterfaceTarget(const ExtractedInterfaces& interfaces, double tolerance);

  [[nodiscard]] double tolerance() const { return tolerance_; }
  /// Returns the closest point where these bodies meet; none if there is none within the distance `within`.
  [[nodiscard]] std::optional<Vec3> closest(const LabelledMesh::Sides& sides, const Vec3& p,
                                            double within) const;
  /// Returns whether these bodies may meet at p. `is_misplaced`: they already meet in the mesh where they
  /// should not, so p may be at any interface.
  [[nodiscard]] bool allows(const LabelledMesh::Sides& sides, const Vec3& p, bool is_misplaced = false) const;

 private:
  struct Part {
    std::vector<ClosestPointTree::Triangle> triangles;
    ClosestPointTree tree;
  };

  std::map<std::vector<std::uint32_t>, Part> parts_;  ///< the key is the set of bodies that meet, ascending
  std::map<std::uint32_t, Part> boundaries_;          ///< by body
  ClosestPointTree all_;
  double tolerance_;
};

}  // namespace adamas::interfaces
