#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "adamas/geometry.h"
#include "core/base/digest_numbers.h"
#include "core/geometry/ownership_problem.h"

namespace adamas::inline core {

/// Contact polygons of some tetrahedra with keys that are the same in every tetrahedron that shares a corner.
/// Buffers can be filled on several threads and appended to one builder in a fixed order.
class ContactBuffer {
 public:
  /// A digest of the feature a point lies on, the face of a tetrahedron's vertices that are not in `zeros`,
  /// and of the functions that are equal there.
  using Key = Digest;
  struct Corner {
    Key key;
    Vec3 position;
    Key leaving;   ///< the line along which the edge to the next corner runs
    bool crowded;  ///< other points may lie on the line or coincide with the corner
  };

  /// Finds the contact polygons of one tetrahedron. `vertex_ids` identify its vertices across cells, in any
  /// order and orientation; the problem's functions follow that order.
  void add(const std::array<std::uint64_t, 4>& vertex_ids, const std::array<Vec3, 4>& positions,
           const OwnershipProblem& problem);
  /// Adds the polygon between two owners that share a tetrahedron alone, each with one function. `ids` are
  /// ascending, and the functions follow their order.
  void add_between(const std::array<std::uint64_t, 4>& ids, const std::array<Vec3, 4>& positions,
                   const std::array<LinearFunction, 2>& functions,
                   const std::array<std::uint32_t, 2>& owners);
  /// Adds a polygon.
  void add_polygon(std::uint32_t front, std::uint32_t back, std::span<const Corner> corners) {
    polygons_.push_back({front, back, static_cast<std::uint32_t>(corners_.size()),
                         static_cast<std::uint32_t>(corners.size())});
    corners_.insert(corners_.end(), corners.begin(), corners.end());
  }
  [[nodiscard]] bool empty() const { return polygons_.empty(); }
  /// Returns whether both have the same polygons, wherever their corners are.
  [[nodiscard]] bool has_polygons_of(const ContactBuffer& other) const;
  void clear() {
    corners_.clear();
    polygons_.clear();
  }
  /// Makes room for so many polygons and corners of them.
  void reserve(std::size_t polygons, std::size_t corners) {
    polygons_.reserve(polygons);
    corners_.reserve(corners);
  }

  /// A function that is none, in lists of functions.
  static constexpr std::uint64_t kNoFunction = ~std::uint64_t{0};
  /// Points nearer to a vertex or an edge than this, in weights, may coincide with others.
  static constexpr double kSmallWeight = 1e-9;
  /// Returns the places of these numbers in ascending order.
  static std::array<std::size_t, 4> ascending(const std::array<std::uint64_t, 4>& ids);
  /// Returns the digest of a feature; `ids` are ascending.
  static Key digest(const std::array<std::uint64_t, 4>& ids, std::uint8_t zeros,
                    std::span<const std::uint64_t> functions);
  /// Calls visit(front, back, corners) for each polygon.
  template <class Visit>
  void for_each_polygon(Visit&& visit) const {
    for (const Polygon& polygon : polygons_)
      visit(polygon.front, polygon.back, std::span(corners_).subspan(polygon.first, polygon.count));
  }

 private:
  friend class ContactMeshBuilder;
  struct Polygon {
    std::uint32_t front, back;
    std::uint32_t first, count;
  };

  std::vector<Corner> corners_;
  std::vector<Polygon> polygons_;
};

}  // namespace adamas::inline core
