#pragma once

#include <map>
#include <optional>
#include <vector>

#include "core/distance/closest_point_tree.h"
#include "interfaces/cutting/labelled_mesh.h"
#include "interfaces/mesh/extraction.h"

namespace adamas::interfaces {

/// Where the interfaces of a mesh that is being changed should be: each pair of bodies at its own interface,
/// three at their junction line, more at the points where they meet.
class InterfaceTarget {
 public:
  /// `tolerance`: how far the changed interfaces may be off.
  InterfaceTarget(const ExtractedInterfaces& interfaces, double tolerance);

  [[nodiscard]] double tolerance() const { return tolerance_; }
  /// The closest point of where these bodies meet, within a distance; none where there is none so near.
  [[nodiscard]] std::optional<Vec3> closest(const LabelledMesh::Sides& sides, const Vec3& p,
                                            double within) const;
  /// Whether a point where these bodies meet may be there. `astray`: they meet, in the mesh that is being
  /// changed, where they should not; then any interface will do.
  [[nodiscard]] bool allows(const LabelledMesh::Sides& sides, const Vec3& p, bool astray = false) const;

 private:
  struct Part {
    std::vector<ClosestPointTree::Triangle> triangles;
    ClosestPointTree tree;
  };

  std::map<std::vector<std::uint32_t>, Part> parts_;  ///< by the bodies that meet, ascending
  std::map<std::uint32_t, Part> boundaries_;          ///< by body
  ClosestPointTree all_;
  double tolerance_;
};

}  // namespace adamas::interfaces
