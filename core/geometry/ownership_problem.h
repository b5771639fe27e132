#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace adamas::inline core {

/// A linear function on a tetrahedron, by its values at the four vertices. `key` identifies the function
/// across cells: exact ties between two functions are decided in favour of the smaller key.
struct LinearFunction {
  std::array<double, 4> values;
  std::uint64_t key;
};

/// Determines the owner of a point of a tetrahedron (docs/method.md, Who owns a point of a cell): each
/// candidate is the least of its linear functions, and the owner of a point is the candidate with the
/// greatest value there. It needs at least one candidate, each with a function.
struct OwnershipProblem {
  /// Products of smaller values with the weights of points where functions cross would be rounded to nothing.
  static constexpr double kLeastValue = 0x1p-300;
  struct Candidate {
    std::uint32_t owner;  ///< a body or material index
    std::uint32_t first;  ///< its functions are functions[first, first + count)
    std::uint32_t count;
  };
  std::vector<LinearFunction> functions;
  std::vector<Candidate> candidates;

  void clear() {
    functions.clear();
    candidates.clear();
  }
  /// Starts a new candidate; functions added later belong to it.
  void add_candidate(std::uint32_t owner) {
    candidates.push_back({owner, static_cast<std::uint32_t>(functions.size()), 0});
  }
  /// Values below `kLeastValue` count as zero.
  void add_function(std::array<double, 4> values, std::uint64_t key);
  /// Value of a candidate at a point given by barycentric weights.
  [[nodiscard]] double value(const Candidate& candidate, const std::array<double, 4>& weights) const;
  /// Owner of the point: greatest value, ties by key.
  [[nodiscard]] std::uint32_t owner(const std::array<double, 4>& weights) const;
};

/// Barycentric weights of a point with respect to the tetrahedron of the problem.
using Weights = std::array<double, 4>;
/// The weights of the vertices.
inline constexpr std::array<Weights, 4> kVertexWeights{Weights{1, 0, 0, 0}, Weights{0, 1, 0, 0},
                                                       Weights{0, 0, 1, 0}, Weights{0, 0, 0, 1}};

/// A part of a tetrahedron that has one owner.
struct OwnedTetrahedron {
  std::uint32_t owner;
  std::array<Weights, 4> corners;
};

/// A convex polygon with one owner.
struct OwnedPolygon {
  std::uint32_t owner;
  std::vector<Weights> corners;
};

/// A convex polygon where the regions of two owners touch; seen from `front`'s side it runs counter-clockwise
/// when the tetrahedron is positively oriented.
struct ContactPolygon {
  struct Corner {
    Weights weights;
    /// The functions that are equal here and the faces it lies on, in canonical order, which is the same in
    /// every cell.
    std::array<std::uint64_t, 4> functions;
    std::uint8_t zero_weights;  ///< bit i: weight i is zero by construction
    /// The functions that are equal on the line of the edge to the next corner: three, or two on a face.
    std::array<std::uint64_t, 3> line_functions;
    std::uint8_t line_zero_weights;
  };
  std::uint32_t front, back;
  std::vector<Corner> corners;
};

/// The polygon where two functions are equal in a tetrahedron; seen from the side where the first one is
/// greater, it runs counter-clockwise when the tetrahedron is positively oriented. Each corner is on an edge
/// of the tetrahedron.
struct TetrahedronSection {
  struct Corner {
    std::uint8_t low, high;  ///< the ends of the edge, in the order of vertices
    std::uint8_t face;       ///< the vertex opposite to the face along which the next corner is reached
    double t;                ///< the weight of `high`
    [[nodiscard]] Weights weights() const {
      Weights w{};
      w[low] = 1 - t;
      w[high] = t;
      return w;
    }
    /// Bit i: weight i is zero by construction.
    [[nodiscard]] std::uint8_t zero_weights() const {
      return static_cast<std::uint8_t>(0xfu & ~(1u << low) & ~(1u << high));
    }
  };
  std::size_t count = 0;  ///< 0 if the functions are nowhere equal
  std::array<Corner, 4> corners;
};

/// Finds where two functions are equal, seen from the side of the first one. Ties count as in
/// contact_polygons(); of two functions with one key the first one has the greater infinitesimal.
TetrahedronSection section_between(const LinearFunction& f, const LinearFunction& g);

/// Two candidates of a problem that own the whole tetrahedron, each with one function, and each the owner of
/// a vertex where it is the greater one.
struct TwoOwners {
  const OwnershipProblem::Candidate *first, *second;
};
/// Finds them by the values at the vertices; returns none if there may be other owners or only one.
std::optional<TwoOwners> two_owners(const OwnershipProblem& problem);

/// Divides the unit weights tetrahedron into parts of one owner; appends to `parts`. The parts' volumes add
/// up to the whole, also those of each owner's parts to its own, to round-off. Where functions are almost
/// equal a part may be inside out, its volume negative, and others too great by as much.
void partition_tetrahedron(const OwnershipProblem& problem, std::vector<OwnedTetrahedron>& parts);

/// Divides a convex polygon, given by weights, into convex parts of one owner; appends to `parts`.
void partition_polygon(const OwnershipProblem& problem, const std::vector<Weights>& polygon,
                       std::vector<OwnedPolygon>& parts);

/// Removes functions that are surely nowhere the least of their candidate, which stays what it is.
void drop_high_functions(OwnershipProblem& problem);

/// Removes dominated candidates, whose greatest value is below what another one surely reaches everywhere.
/// The others can then be divided faster.
void drop_dominated(OwnershipProblem& problem);

/// Removes candidates that own and touch no part of the tetrahedron, and functions that are nowhere the least
/// of their candidate, or nowhere in what it owns. What touches stays, so that contacts still fit those of
/// other tetrahedra.
void keep_owners(OwnershipProblem& problem);

/// The polygons where two owners touch inside the tetrahedron; appends them to `contacts`. Which polygons
/// there are, and between which functions their corners lie, is decided exactly, for functions that are each
/// increased by an infinitesimal, which is greater for smaller keys. So polygons of one tetrahedron, and of
/// two that share a face, fit together however close functions are to each other. The positions of corners
/// have the accuracy of doubles.
void contact_polygons(const OwnershipProblem& problem, std::vector<ContactPolygon>& contacts);

/// Does what keep_owners() does, and appends the contact polygons of what is left: where it has many
/// functions, one division of the tetrahedron serves both, after which polygons may come in another order and
/// be divided in another way.
void keep_owners(OwnershipProblem& problem, std::vector<ContactPolygon>& contacts);

/// The volume of a part as a fraction of the tetrahedron's; positive if it has the same orientation.
double volume_fraction(const std::array<Weights, 4>& corners);

}  // namespace adamas::inline core
