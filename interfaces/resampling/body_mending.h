#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "interfaces/resampling/body_comparison.h"
#include "interfaces/resampling/refinement.h"
#include "interfaces/resampling/resampling_state.h"
#include "interfaces/resampling/shown_interfaces.h"
#include "interfaces/resampling/volume_refinement.h"

namespace adamas::interfaces {

/// The middle between two opposite sides of a body.
struct ThinPlace {
  Vec3 middle;
  double thickness = 0;
  BodyId body;
};

/// Thin places of bodies of a network, of which there may be very many.
class ThinPlaces {
 public:
  /// The network must outlive this object. Places are sought from points with a distance of about `spacing`,
  /// or more if they would be too many for all bodies.
  ThinPlaces(const InterfaceNetwork& network, double spacing);

  /// Adds the places within the box where the marked bodies are at most `thickest` thick, in the order of the
  /// triangles. They are sought from points of each triangle along its normals.
  void add(const IdVector<BodyId, char>& marked, const Box3& box, double thickest);
  [[nodiscard]] std::uint32_t size() const { return static_cast<std::uint32_t>(found_.size()); }
  [[nodiscard]] BodyId body(std::uint32_t i) const;
  [[nodiscard]] Vec3 middle(std::uint32_t i) const;
  [[nodiscard]] double thickness(std::uint32_t i) const { return found_[i].thickness; }
  [[nodiscard]] ThinPlace operator[](std::uint32_t i) const { return {middle(i), thickness(i), body(i)}; }

 private:
  /// A place, by the point from which it was found.
  struct Found {
    std::uint32_t triangle;
    std::uint32_t point : 31;  ///< the number of the point in the triangle
    std::uint32_t side : 1;    ///< whether the body is behind the triangle
    double thickness;
  };

  [[nodiscard]] int points_along_side(const std::array<Vec3, 3>& corners) const;
  [[nodiscard]] Vec3 inwards(std::uint32_t triangle, std::size_t side) const;

  const InterfaceNetwork& network_;
  double spacing_;
  std::size_t stride_ = 1;  ///< of small triangles, only every so many-th is used
  std::vector<Found> found_;
};

/// The faults of the bodies that the leaves show.
struct ShownBodies {
  BodyFaults faults;
  std::size_t leaves = 0;
  std::optional<std::size_t> given_away;  ///< the number of thin places that are given to other bodies, once
                                          ///< known

  /// Returns whether fewer bodies are lost or joined, or so many fewer are torn that the additional leaves
  /// are worth it.
  [[nodiscard]] bool are_better_than(const ShownBodies& other) const;
  /// Returns the number of leaves up to which refinement continues without any improvement.
  [[nodiscard]] std::size_t most_leaves() const;
};

/// Mends bodies that the leaves of a state lose, join or tear, by moving interfaces or by splitting cells. A
/// body is torn if the mesh gives thin places of it to other bodies.
class BodyMending {
 public:
  /// All parts must outlive this object.
  BodyMending(ResamplingState& state, Refinement& refinement, const VolumeRefinement& volumes,
              ShownInterfaces& shown)
      : state_(state), refinement_(refinement), volumes_(volumes), shown_(shown), bodies_(state.source) {}

  /// Interfaces and what was found of their bodies.
  struct Shown {
    ExtractedInterfaces extracted;
    BodyComparison::Findings bodies;
  };

  /// Compares the bodies of the interfaces that were extracted last with those of the input, unless this was
  /// done.
  void measure();
  /// Extracts the interfaces that the leaves show now and compares their bodies, but measures no distances;
  /// returns those before.
  Shown extract_and_measure();
  /// Returns to interfaces that were shown before, after the leaves were made to show them again, and to
  /// their distances, if these were measured.
  void go_back(Shown shown, std::optional<InterfaceComparison> distances = {});
  [[nodiscard]] const BodyReport& report() const { return bodies_.report(); }
  /// Returns the faults of the bodies that were compared last.
  [[nodiscard]] ShownBodies shown_bodies() const { return {faults(), state_.hierarchy.leaf_count(), {}}; }

  /// Mends torn bodies by moving the signed distances at vertices, and measures the shown interfaces again.
  /// The moves are kept if at most one fault out of `part`, which is at least 2, is left, no more bodies are
  /// lost or joined, and distances and volumes are still within the wanted errors; else they are undone.
  /// Returns whether they are kept.
  bool move_interfaces(std::size_t part);
  /// Splits cells where the mesh loses, joins or tears bodies, until the number of places given to other
  /// bodies has fallen so far that the bodies should be measured again. Returns the reason if nothing can be
  /// split or splitting is not worth it; none otherwise. `best`: the best bodies shown so far.
  [[nodiscard]] std::optional<RefinementEnd> split_cells(ShownBodies& best);

 private:
  /// Numbers of thin places with the leaves that hold them, in the order of leaves.
  using PlacesByLeaf = std::vector<std::pair<TetrahedronId, std::uint32_t>>;
  /// A move of an interface at the corners of a leaf by a distance, which is positive if its first body
  /// gains.
  struct InterfaceMove {
    TetrahedronId leaf;
    InterfaceId interface;
    double by = 0;
  };
  /// Signed distances of vertices from interfaces.
  using Distances = std::map<std::pair<VertexId, InterfaceId>, double>;
  struct TornLeaves {
    std::vector<TetrahedronId> leaves;
    std::size_t places = 0;  ///< the number of places within bodies that are given to others
  };

  [[nodiscard]] BodyFaults faults() const { return bodies_.faults(state_.options.interface_error); }
  void find_places();
  [[nodiscard]] IdVector<BodyId, char> wrong_bodies() const;
  [[nodiscard]] PlacesByLeaf places_by_leaf(const IdVector<BodyId, char>& bodies) const;
  template <class T, class Visit>
  [[nodiscard]] std::vector<std::pair<std::uint32_t, T>> collect_at(const PlacesByLeaf& places,
                                                                    Visit&& visit) const;

  [[nodiscard]] std::optional<InterfaceMove> move_at(const ThinPlace& place, TetrahedronId leaf, BodyId owner,
                                                     const CellOwnership& owners) const;
  [[nodiscard]] static std::vector<VertexId> vertices_of(const Distances& distances);
  Distances move_for_wrong_bodies();
  bool apply(const std::vector<std::pair<std::uint32_t, InterfaceMove>>& moves, Distances& originals);
  void restore(const Distances& originals);
  [[nodiscard]] std::vector<TetrahedronId> leaves_at(const std::vector<VertexId>& corners) const;
  void move_back(const Distances& originals, const std::vector<VertexId>& corners, double share);

  [[nodiscard]] TornLeaves torn_leaves() const;
  bool split_for_lost_bodies();

  ResamplingState& state_;
  Refinement& refinement_;
  const VolumeRefinement& volumes_;
  ShownInterfaces& shown_;
  BodyComparison bodies_;
  std::optional<ThinPlaces> places_;  ///< of the bodies that were wrong when places were needed
  IdVector<BodyId, char> sought_;     ///< marks these bodies
  bool moving_is_hopeless_ = false;   ///< whether moving has not made bodies better
  std::size_t measured_ = 0;          ///< the number of the interfaces whose bodies are compared
};

}  // namespace adamas::interfaces
