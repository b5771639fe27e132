#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "adamas/resample.h"  // DistanceMode
#include "core/base/typed_id.h"
#include "core/data/interface_mesh.h"
#include "core/distance/closest_point_tree.h"
#include "core/geometry/vec3.h"
#include "interfaces/network/bodies.h"
#include "interfaces/network/box_tree.h"
#include "interfaces/ownership/interface_table.h"

namespace adamas::interfaces {

/// An interface that is near a point, and the point's signed distance to it (docs/method.md, Signed distances
/// at vertices): positive towards the lower of its two bodies.
struct NearInterface {
  InterfaceId interface;
  double signed_distance;
  Vec3 closest;
  /// The sign is that of a sheet continued beyond an open border, for the point lies in neither of the
  /// bodies.
  bool flagged = false;
};

/// The interfaces of a mesh, each between two bodies, ready for questions about points: which body a point
/// lies in, and how far it is from the interfaces round it. Coinciding points are welded; triangles in which
/// two points coincide, or with one body on both sides, are left out. Queries may run on several threads at
/// once.
class InterfaceNetwork {
 public:
  /// Triangles are grouped by interface and turned so that their normals point to the lower body, `a`.
  struct Interface {
    BodyId a, b;
    std::uint32_t first, count;  ///< its triangles
    Box3 bounds;
  };

  /// Finds the bodies itself. `domain`: where the interfaces may end; the mesh must be sound
  /// (check_interface_mesh).
  explicit InterfaceNetwork(const InterfaceMesh& mesh, std::optional<Box3> domain = std::nullopt);
  /// With known bodies: both sides of every triangle of the mesh, and the material of each body. Throws Error
  /// where the numbers of triangles differ or a body is out of range.
  InterfaceNetwork(const InterfaceMesh& mesh, std::optional<Box3> domain, Bodies bodies);

  /// Bodies, their materials and the interfaces between them, numbered in the order of their pairs of bodies.
  [[nodiscard]] const InterfaceTable& table() const { return table_; }
  [[nodiscard]] const Interface& interface(InterfaceId i) const { return interfaces_[i]; }
  [[nodiscard]] std::span<const Vec3> points() const { return points_; }
  /// All triangles, interface by interface.
  [[nodiscard]] std::span<const ClosestPointTree::Triangle> triangles() const { return triangles_; }
  [[nodiscard]] const std::array<Vec3, 3>& triangle_corners(std::uint32_t triangle) const {
    return tree_.triangle(triangle);
  }
  /// Unit normal, towards the lower body; zero for a triangle without area.
  [[nodiscard]] const Vec3& normal(std::uint32_t triangle) const { return normals_[triangle]; }
  [[nodiscard]] InterfaceId interface_of(std::uint32_t triangle) const { return interface_of_[triangle]; }
  /// Whether an edge of a single triangle lies inside the domain.
  [[nodiscard]] bool has_open_border() const { return open_; }
  /// Edges and rays that did not match, as `Bodies` reports them.
  [[nodiscard]] std::size_t inconsistencies() const { return inconsistencies_; }

  /// Closest points of the whole network, by number of triangle, and of one interface, by number within it.
  [[nodiscard]] const ClosestPointTree& tree() const { return tree_; }
  [[nodiscard]] const ClosestPointTree& tree(InterfaceId i) const {
    return trees_.empty() ? tree_ : trees_[i];
  }
  /// Closest point of all interfaces of a body, by number of triangle; none where it has none so near.
  [[nodiscard]] std::optional<ClosestPoint> closest_of_body(
      BodyId body, const Vec3& p, double max_distance = std::numeric_limits<double>::infinity()) const;

  /// The body that p lies in, by the angle-weighted pseudonormals of each body's boundary at the closest
  /// point (docs/method.md, Signed distances at vertices; Baerentzen and Aanaes for one body). Where the
  /// closest point is on an open border inside the domain, by winding numbers, or by the sheets there,
  /// thought to go on as planes, where these are far from 1; `flagged` (may be null) is set where they are,
  /// or where the two do not agree (docs/method.md, Gaps). Body 0 where there are no triangles.
  [[nodiscard]] BodyId body_at(const Vec3& p, bool* flagged = nullptr) const;

  /// The interfaces with a distance of at most `radius` from p, in ascending order, given the body of p.
  /// Replaces `out`.
  void near_interfaces(const Vec3& p, double radius, BodyId body_of_p, std::vector<NearInterface>& out,
                       DistanceMode mode = DistanceMode::kExact) const;

 private:
  /// Bits of `borders_`: edge i or corner i of a triangle is on the border of its interface, or of the whole
  /// network.
  static constexpr unsigned kEdgeOfInterface = 0, kCornerOfInterface = 3, kEdgeOfNetwork = 6,
                            kCornerOfNetwork = 9;
  /// The triangle is (almost) without area, or has a point in common with one.
  static constexpr unsigned kFlat = 12, kNearFlat = 13;

  void group(const InterfaceMesh& mesh, const Bodies& bodies);
  void find_adjacency();
  void find_borders();
  [[nodiscard]] bool find_open_border() const;
  void find_flat();
  void mark_border_corner(std::uint32_t triangle, std::uint32_t point, bool of_interface);
  void build_trees();
  void build_vertex_trees() const;

  /// What meets at a point, by geometry: for places where triangles without area keep neighbours apart.
  struct Touch {
    std::uint32_t triangle;
    double weight;  ///< angle round the point; zero for a triangle without area
  };
  /// Triangles of a tree whose first one is `first`; returns whether a border passes through the point, given
  /// the bit of edge 0.
  bool find_touching(const ClosestPointTree& tree, std::uint32_t first, const Vec3& p, unsigned edge_bit,
                     std::vector<Touch>& out) const;
  [[nodiscard]] bool near_flat(std::uint32_t triangle, TriangleFeature feature) const;
  /// Calls visit(triangle, weight) for the triangles at a closest point: weights are angles, up to a common
  /// factor.
  template <class Visit>
  void for_each_at(std::uint32_t triangle, TriangleFeature feature, Visit&& visit) const;
  [[nodiscard]] bool on_border(std::uint32_t triangle, TriangleFeature feature, unsigned edge_bit,
                               unsigned corner_bit) const;
  [[nodiscard]] bool on_domain_boundary(const Vec3& p) const;
  /// Whether the closest point of an interface, a place on one of its triangles, is on an open border of the
  /// network inside the domain.
  [[nodiscard]] bool on_open_border(InterfaceId i, std::uint32_t triangle, TriangleFeature feature,
                                    const Vec3& closest) const;
  [[nodiscard]] BodyId body_beyond_border(const Vec3& p, BodyId continued, bool* flagged) const;
  [[nodiscard]] BodyId body_by_touch(const Vec3& p, const ClosestPoint& closest, bool* flagged) const;
  [[nodiscard]] BodyId body_by_arc(const Vec3& offset, std::uint32_t triangle, TriangleFeature feature) const;
  [[nodiscard]] Vec3 interface_normal(std::uint32_t triangle, TriangleFeature feature) const;
  [[nodiscard]] std::optional<ClosestPoint> nearest_vertex(InterfaceId i, const Vec3& p, double radius) const;
  [[nodiscard]] std::optional<NearInterface> near_interface(InterfaceId i, const Vec3& p, double radius,
                                                            BodyId body, DistanceMode mode) const;

  std::optional<Box3> domain_;
  std::vector<Vec3> points_;
  std::vector<ClosestPointTree::Triangle> triangles_;
  std::vector<Vec3> normals_;
  std::vector<InterfaceId> interface_of_;
  std::vector<std::uint16_t> borders_;
  InterfaceTable table_;
  IdVector<InterfaceId, Interface> interfaces_;
  std::vector<std::uint32_t> point_starts_;  ///< triangles at point i: point_triangles_[point_starts_[i] ...]
  std::vector<std::uint32_t> point_triangles_;
  std::size_t inconsistencies_ = 0;
  bool open_ = false;  ///< an edge of a single triangle lies inside the domain
  ClosestPointTree tree_;
  IdVector<InterfaceId, ClosestPointTree> trees_;  ///< empty where there is one interface
  BoxTree box_tree_;

  struct OnDemand;
  std::shared_ptr<OnDemand> on_demand_;
};

}  // namespace adamas::interfaces
