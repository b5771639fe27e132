#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "adamas/geometry.h"
#include "core/data/interface_mesh.h"
#include "interfaces/network/domain_faces.h"

namespace adamas::interfaces {

/// A triangle at an edge.
struct Blade {
  std::uint32_t triangle;
  bool forward;       ///< whether the triangle runs along the edge from its lower point to its higher one
  bool flat = false;  ///< whether it has no area, so that its angle is meaningless
  double angle = 0;   ///< the angle round the edge, from an arbitrary zero, by the right-hand rule
};

/// The triangles round each edge of an interface mesh, in the order of their angles, and the wedges of space
/// between them. The front of a forward blade and the back of another one face increasing angles. Triangles
/// in which two points coincide are left out.
class EdgeFans {
 public:
  /// `mesh` and `domain` (may be null) must outlive this object. Indices must be within range. An edge counts
  /// as in a face of the domain if its distance is at most `boundary`, relative to the domain's diagonal.
  EdgeFans(const InterfaceMesh& mesh, const Box3* domain, double boundary = kOnDomainFace);

  [[nodiscard]] std::size_t size() const { return edges_.size() - 1; }
  /// Returns the ends of an edge: the lower and the higher of two welded points.
  [[nodiscard]] std::array<std::uint32_t, 2> ends(std::size_t edge) const;
  /// Returns the number of triangles at an edge.
  [[nodiscard]] std::size_t valence(std::size_t edge) const {
    return edges_[edge + 1].first - edges_[edge].first;
  }
  /// Returns whether an edge lies in a face of the domain.
  [[nodiscard]] bool on_domain_boundary(std::size_t edge) const;

  struct Fan {
    std::vector<Blade> blades;  ///< ascending by angle; the materials decide the order of nearly equal angles
    /// The wedge that contains the outside of the domain; wedge i lies between blade i and the next one.
    std::size_t outside_wedge = kNone;
    bool consistent = true;  ///< whether both sides of each wedge inside the domain have the same material
    static constexpr std::size_t kNone = static_cast<std::size_t>(-1);
  };
  /// Sets `fan` to the blades of an edge and the wedges between them.
  void fan(std::size_t edge, Fan& fan) const;
  /// Does the same, but computes no angles, and puts blades in no order, where there are at most two of them
  /// and the edge lies inside the domain: the wedges are the same then, perhaps in the other order.
  void wedges(std::size_t edge, Fan& fan) const;

  /// Returns the side of a blade's triangle that faces increasing angles: 0 for the front, 1 for the back.
  static int side_ahead(const Blade& b) { return b.forward ? 0 : 1; }
  static int side_behind(const Blade& b) { return b.forward ? 1 : 0; }
  [[nodiscard]] MaterialId material(std::uint32_t triangle, int side) const {
    const InterfaceTriangle& t = mesh_.triangles[triangle];
    return side == 0 ? t.front : t.back;
  }
  /// Returns the lowest point with the same coordinates.
  [[nodiscard]] std::uint32_t welded(std::uint32_t point) const { return welded_[point]; }

 private:
  /// A triangle at an edge, whose lower end is that of the edge.
  struct HalfEdge {
    std::uint32_t high, packed;  ///< the number of the triangle, times two, plus 1 if it runs forward
    [[nodiscard]] std::uint32_t triangle() const { return packed / 2; }
    [[nodiscard]] bool forward() const { return packed % 2 != 0; }
  };
  struct Edge {
    std::uint32_t low, first;  ///< its half edges end where those of the next edge begin
  };
  /// Calls visit(low, half edge) for the edges of each triangle.
  template <class Visit>
  void for_each_half_edge(Visit&& visit) const;
  void sort_half_edges(std::vector<std::uint32_t> starts);

  /// Returns the sum of the outward normals of the domain's faces that contain the edge; zero if there are
  /// none.
  [[nodiscard]] Vec3 outward(std::size_t edge) const;
  void order(std::size_t edge, const Vec3& normal, Fan& fan) const;
  [[nodiscard]] bool consistent(const Fan& fan) const;
  bool reorder_ties(Fan& fan) const;
  bool extend_order(const Fan& fan, std::vector<std::size_t>& order, std::size_t& steps) const;

  const InterfaceMesh& mesh_;
  const Box3* domain_;
  double boundary_;
  std::vector<std::uint32_t> welded_;
  std::vector<HalfEdge> half_edges_;
  std::vector<Edge> edges_;  ///< and an end mark
};

/// Returns the edges of a welded interface mesh at which at least three materials meet, each once, as its
/// lower and its higher point, ascending.
std::vector<std::array<std::uint32_t, 2>> junction_lines(const InterfaceMesh& mesh);
/// The same of triangles that a function returns by their numbers.
std::vector<std::array<std::uint32_t, 2>> junction_lines(
    std::size_t points, std::size_t triangles,
    const std::function<InterfaceTriangle(std::uint32_t)>& triangle_at);

/// Returns for each point the lowest index of a point with the same coordinates.
std::vector<std::uint32_t> weld_points(std::span<const Vec3> points);

}  // namespace adamas::interfaces
