#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "adamas/geometry.h"
#include "adamas/resample.h"  // DistanceMode
#include "core/base/typed_id.h"
#include "core/data/interface_mesh.h"
#include "core/distance/closest_point_forest.h"
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
  /// Whether the point lies in neither of the two bodies, so that the sign is that of the interface continued
  /// beyond an open border.
  bool flagged = false;
};

/// The interfaces of a mesh, each between two bodies, prepared for two queries: which body a point lies in,
/// and how far it is from the interfaces round it. Coinciding points are welded; triangles in which two
/// points coincide, or with one body on both sides, are left out. Queries may run on several threads at once.
class InterfaceNetwork {
 public:
  /// The triangles of an interface are stored together and oriented so that their normals point to the lower
  /// body, `a`.
  struct Interface {
    BodyId a, b;
    std::uint32_t first, count;  ///< the range of its triangles
  };

  /// Makes a network of a mesh and finds its bodies. `domain`: the box at whose faces interfaces may end. The
  /// mesh must be sound (check_interface_mesh).
  explicit InterfaceNetwork(const InterfaceMesh& mesh, std::optional<Box3> domain = std::nullopt);
  /// Makes a network of a mesh with known bodies: those on both sides of every triangle, and the material of
  /// each. Throws Error if the numbers of triangles differ or a body is out of range.
  InterfaceNetwork(InterfaceMesh mesh, std::optional<Box3> domain, Bodies bodies);

  /// Returns the bodies, their materials and the interfaces between them; interfaces are numbered in the
  /// order of their pairs of bodies.
  [[nodiscard]] const InterfaceTable& table() const { return table_; }
  [[nodiscard]] const Interface& interface(InterfaceId i) const { return interfaces_[i]; }
  [[nodiscard]] std::span<const Vec3> points() const { return forest_.points(); }
  /// Returns all triangles, interface by interface.
  [[nodiscard]] std::span<const ClosestPointTree::Triangle> triangles() const { return forest_.triangles(); }
  [[nodiscard]] std::array<Vec3, 3> triangle_corners(std::uint32_t triangle) const {
    return forest_.corners(triangle);
  }
  /// Returns the unit normal towards the lower body; zero for a triangle without area.
  [[nodiscard]] Vec3 normal(std::uint32_t triangle) const {
    const auto [a, b, c] = triangle_corners(triangle);
    return normalized(cross(b - a, c - a));
  }
  /// Returns the triangles that have this point as a corner, ascending.
  [[nodiscard]] std::span<const std::uint32_t> triangles_at(std::uint32_t point) const {
    return std::span(point_triangles_)
        .subspan(point_starts_[point], point_starts_[point + 1] - point_starts_[point]);
  }
  [[nodiscard]] InterfaceId interface_of(std::uint32_t triangle) const { return interface_of_[triangle]; }
  [[nodiscard]] std::span<const InterfaceId> interfaces_of_triangles() const { return interface_of_; }
  /// Returns whether an edge of a single triangle lies inside the domain.
  [[nodiscard]] bool has_open_border() const { return open_; }
  /// Returns the number of edges and rays that did not match, as `Bodies` reports them.
  [[nodiscard]] std::size_t inconsistencies() const { return inconsistencies_; }

  /// Return the trees for closest points: on the whole network, on one interface, on all interfaces of a
  /// body, and on the boundary of a material that has bodies, which is all interfaces of these. Triangles
  /// have the network's numbers in all of them.
  [[nodiscard]] const ClosestPointTree& tree() const { return forest_.all(); }
  [[nodiscard]] const ClosestPointTree& tree(InterfaceId i) const { return forest_.group(i.value); }
  [[nodiscard]] const ClosestPointTree& tree(BodyId body) const { return forest_.set(body.value); }
  [[nodiscard]] const ClosestPointTree& tree(MaterialId material) const {
    return forest_.set(table_.body_count() + material.value);
  }

  /// Returns the body that p lies in, by the angle-weighted pseudonormals of each body's boundary at the
  /// closest point (docs/method.md, Signed distances at vertices; Baerentzen and Aanaes for one body). If the
  /// closest point is on an open border inside the domain, winding numbers decide; if these are far from 1,
  /// the interfaces at the border decide, continued as planes. `flagged` (may be null) is set if the numbers
  /// are far from 1 or the two disagree (docs/method.md, Gaps). A network without triangles has body 0
  /// everywhere.
  [[nodiscard]] BodyId body_at(const Vec3& p, bool* flagged = nullptr) const;

  /// Sets `out` to the interfaces within a distance of `radius` from p, ascending. `body_of_p`: the body that
  /// p lies in.
  void near_interfaces(const Vec3& p, double radius, BodyId body_of_p, std::vector<NearInterface>& out,
                       DistanceMode mode = DistanceMode::kExact) const;

 private:
  /// The first bits of `borders_`: edge i or corner i of a triangle is on the border of its interface, or of
  /// the whole network.
  static constexpr unsigned kEdgeOfInterface = 0, kCornerOfInterface = 3, kEdgeOfNetwork = 6,
                            kCornerOfNetwork = 9;
  /// More bits of `borders_`: the triangle has nearly no area, or it has a point in common with such a
  /// triangle.
  static constexpr unsigned kFlat = 12, kNearFlat = 13;

  /// Sets the table, the interfaces and what belongs to each triangle; returns the triangles.
  std::vector<ClosestPointTree::Triangle> group(const InterfaceMesh& mesh, const Bodies& bodies);
  [[nodiscard]] std::vector<std::vector<std::uint32_t>> interfaces_of_bodies_and_materials() const;
  void find_adjacency();
  void find_borders();
  [[nodiscard]] bool find_open_border() const;
  void find_flat();
  void mark_border_corner(std::uint32_t triangle, std::uint32_t point, bool of_interface);
  void build_vertex_trees() const;

  /// A triangle at a point, found by its position, since triangles without area may separate neighbours in
  /// the topology.
  struct TouchingTriangle {
    std::uint32_t triangle;
    double weight;  ///< the angle at the point; zero for a triangle without area
  };
  /// Sets `out` to the triangles of a tree at a point. Returns whether a border, given by the bit of edge 0,
  /// passes through the point.
  bool find_touching(const ClosestPointTree& tree, const Vec3& p, unsigned edge_bit,
                     std::vector<TouchingTriangle>& out) const;
  [[nodiscard]] bool near_flat(std::uint32_t triangle, TriangleFeature feature) const;
  /// Calls visit(triangle, weight) for the triangles at a closest point. Weights are angles, up to a common
  /// factor.
  template <class Visit>
  void for_each_at(std::uint32_t triangle, TriangleFeature feature, Visit&& visit) const;
  [[nodiscard]] bool on_border(std::uint32_t triangle, TriangleFeature feature, unsigned edge_bit,
                               unsigned corner_bit) const;
  [[nodiscard]] bool on_domain_boundary(const Vec3& p) const;
  /// Returns whether the closest point of an interface is on an open border of the network inside the domain.
  [[nodiscard]] bool on_open_border(InterfaceId i, std::uint32_t triangle, TriangleFeature feature,
                                    const Vec3& closest) const;
  [[nodiscard]] BodyId body_beyond_border(const Vec3& p, BodyId continued, bool* flagged) const;
  [[nodiscard]] BodyId body_by_touching(const Vec3& p, const ClosestPoint& closest, bool* flagged) const;
  [[nodiscard]] BodyId body_by_arc(const Vec3& offset, std::uint32_t triangle, TriangleFeature feature) const;
  [[nodiscard]] Vec3 interface_normal(std::uint32_t triangle, TriangleFeature feature) const;
  [[nodiscard]] std::optional<ClosestPoint> nearest_vertex(InterfaceId i, const Vec3& p, double radius) const;
  [[nodiscard]] std::optional<NearInterface> near_interface(InterfaceId i, const Vec3& p, double radius,
                                                            BodyId body, DistanceMode mode) const;

  std::optional<Box3> domain_;
  ClosestPointForest forest_;  ///< its groups are the interfaces, its sets the bodies and then the materials
  std::vector<InterfaceId> interface_of_;
  std::vector<std::uint16_t> borders_;
  InterfaceTable table_;
  IdVector<InterfaceId, Interface> interfaces_;
  /// The triangles at point i begin at point_triangles_[point_starts_[i]].
  std::vector<std::uint32_t> point_starts_;
  std::vector<std::uint32_t> point_triangles_;
  std::size_t inconsistencies_ = 0;
  bool open_ = false;  ///< whether an edge of a single triangle lies inside the domain
  BoxTree box_tree_;

  struct OnDemand;
  std::shared_ptr<OnDemand> on_demand_;
};

/// Returns the interfaces of a network as a welded mesh without triangles that have one body on both sides.
/// `materials`: the names of the materials.
InterfaceMesh network_mesh(const InterfaceNetwork& network,
                           const IdVector<MaterialId, std::string>& materials, const std::string& source);

/// Returns the bodies in front of each triangle of that mesh and behind it.
std::vector<std::array<BodyId, 2>> triangle_bodies(const InterfaceNetwork& network);

}  // namespace adamas::interfaces
