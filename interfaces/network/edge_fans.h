#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "adamas/geometry.h"
#include "core/data/interface_mesh.h"
#include "interfaces/network/domain_faces.h"

namespace adamas::interfaces {

/// A triangle at an edge.
struct Blade {
  std::uint32_t triangle;
  bool forward;       ///< the triangle runs along the edge from its lower point to its higher one
  bool flat = false;  ///< without area, so that its angle means nothing
  double angle = 0;   ///< round the edge, from an arbitrary zero, by the right-hand rule
};

/// The triangles round each edge of an interface mesh, in the order of their angles, and the wedges of space
/// between them. The front of a forward blade and the back of another one face increasing angles. Triangles
/// in which two points coincide are left out.
class EdgeFans {
 public:
  /// `mesh` and `domain` (may be null) must outlive this object. Indices must be within range. Edges lie in a
  /// face of the domain that are as near to it as `boundary`, in relation to the domain's diagonal.
  EdgeFans(const InterfaceMesh& mesh, const Box3* domain, double boundary = kOnDomainFace);

  [[nodiscard]] std::size_t size() const { return starts_.size() - 1; }
  /// Ends of an edge: the lower and the higher of two welded points.
  [[nodiscard]] std::array<std::uint32_t, 2> ends(std::size_t edge) const;
  /// Number of triangles at an edge.
  [[nodiscard]] std::size_t valence(std::size_t edge) const { return starts_[edge + 1] - starts_[edge]; }
  /// Whether an edge lies in a face of the domain.
  [[nodiscard]] bool on_domain_boundary(std::size_t edge) const;

  struct Fan {
    std::vector<Blade>
        blades;  ///< with ascending angles, except for nearly equal angles whose order the materials decide
    /// Wedge i lies between blade i and the next one round; the outside of the domain is in this one.
    std::size_t outside_wedge = kNone;
    bool consistent = true;  ///< both sides of each wedge inside the domain have the same material
    static constexpr std::size_t kNone = static_cast<std::size_t>(-1);
  };
  /// The blades of an edge and what lies between them. Replaces `fan`.
  void fan(std::size_t edge, Fan& fan) const;

  /// Side of a blade's triangle that faces increasing angles: 0 is the front, 1 the back.
  static int side_ahead(const Blade& b) { return b.forward ? 0 : 1; }
  static int side_behind(const Blade& b) { return b.forward ? 1 : 0; }
  [[nodiscard]] MaterialId material(std::uint32_t triangle, int side) const {
    const InterfaceTriangle& t = mesh_.triangles[triangle];
    return side == 0 ? t.front : t.back;
  }
  /// Returns the lowest point with the same coordinates.
  [[nodiscard]] std::uint32_t welded(std::uint32_t point) const { return welded_[point]; }

 private:
  struct HalfEdge {
    std::uint32_t low, high, triangle;
    bool forward;
  };

  /// Outward normal of the faces of the domain that contain the edge; zero where there are none.
  [[nodiscard]] Vec3 outward(std::size_t edge) const;
  [[nodiscard]] bool consistent(const Fan& fan) const;
  bool reorder_ties(Fan& fan) const;
  bool extend_order(const Fan& fan, std::vector<std::size_t>& order, std::size_t& steps) const;

  const InterfaceMesh& mesh_;
  const Box3* domain_;
  double boundary_;
  std::vector<std::uint32_t> welded_;
  std::vector<HalfEdge> half_edges_;
  std::vector<std::uint32_t> starts_;  ///< edge i has the half edges starts_[i] to starts_[i + 1]
};

/// The edges of a welded interface mesh round which three materials or more meet, each once, by its lower and
/// its higher point.
std::vector<std::array<std::uint32_t, 2>> junction_lines(const InterfaceMesh& mesh);

}  // namespace adamas::interfaces
