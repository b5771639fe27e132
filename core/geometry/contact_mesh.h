#pragma once

#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "core/data/interface_mesh.h"
#include "core/geometry/partition.h"
#include "core/geometry/vec3.h"

namespace adamas {

/// Contact polygons of some tetrahedra with keys that are the same in every tetrahedron that shares a corner.
/// Buffers can be filled on several threads and appended to one builder in a fixed order.
class ContactBuffer {
 public:
  /// Finds the contact polygons of one tetrahedron. `vertex_ids` identify its vertices across cells, in any
  /// order and orientation; the problem's functions follow that order.
  void add(const std::array<std::uint64_t, 4>& vertex_ids, const std::array<Vec3, 4>& positions,
           const OwnershipProblem& problem);
  [[nodiscard]] bool empty() const { return polygons_.empty(); }

 private:
  friend class ContactMeshBuilder;
  /// A 128-bit digest of the lattice feature a point lies on and of the functions that are equal there.
  struct Key {
    std::uint64_t low = 0, high = 0;
    bool operator==(const Key&) const = default;
  };
  struct KeyHash {
    std::size_t operator()(const Key& key) const { return key.low; }
  };
  struct Corner {
    Key key;
    Vec3 position;
    Key leaving;  ///< the mesh face or edge along which the way to the next corner runs; zero in the cell
    Key own;      ///< the mesh face or edge in whose inside the point lies, where crowded; zero elsewhere
    std::uint8_t zeros = 0;  ///< bit i: the weight of vertex i is zero, by construction or nearly
    bool crowded = false;    ///< other points may coincide with it
  };
  struct Polygon {
    std::uint32_t front, back;
    std::uint32_t first, count;
  };

  static Key digest(const std::array<std::uint64_t, 4>& ids, const std::array<std::uint64_t, 4>& functions);
  Corner make_corner(const ContactPolygon::Corner& corner, const std::array<std::uint64_t, 4>& ids,
                     const std::array<Vec3, 4>& positions) const;
  void insert_passed_points(std::size_t first_polygon, double tolerance);

  std::vector<Corner> corners_;
  std::vector<Polygon> polygons_;
};

/// Welds the contact polygons of a conforming tetrahedral mesh into a network of triangles: no cracks, no
/// T-junctions, and round every inner edge the sides of the triangles match up.
class ContactMeshBuilder {
 public:
  /// `tolerance`: points nearer than this that stem from different features are one (a length; far below any
  /// cell).
  explicit ContactMeshBuilder(double tolerance) : tolerance_(tolerance) {}

  void append(const ContactBuffer& buffer);
  /// Finds and appends the contact polygons of one tetrahedron.
  void add(const std::array<std::uint64_t, 4>& vertex_ids, const std::array<Vec3, 4>& positions,
           const OwnershipProblem& problem);
  /// The triangles; `front` and `back` are the owners of the problems. The builder is empty afterwards.
  InterfaceMesh finish();

 private:
  struct Polygon {
    std::uint32_t front, back;
    std::uint32_t first, count;
  };
  std::uint32_t point_of(const ContactBuffer::Corner& corner);
  void weld_crowded_points();
  void emit(const Polygon& polygon, InterfaceMesh& mesh);

  double tolerance_;
  std::vector<Vec3> points_;
  std::vector<std::uint32_t> crowded_;  ///< points that may coincide with others
  std::vector<std::uint32_t> welded_;   ///< point -> the point it became
  std::vector<std::uint32_t> corners_;
  std::vector<ContactBuffer::Key> leaving_;
  std::vector<Polygon> polygons_;
  std::unordered_map<ContactBuffer::Key, std::uint32_t, ContactBuffer::KeyHash> point_by_key_;
  std::unordered_map<ContactBuffer::Key, std::vector<std::uint32_t>, ContactBuffer::KeyHash>
      points_in_feature_;
};

}  // namespace adamas
