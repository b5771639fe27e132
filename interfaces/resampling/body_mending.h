#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
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

/// What is wrong with the bodies that the leaves show.
struct ShownBodies {
  BodyFaults faults;
  std::size_t leaves = 0;
  std::optional<std::size_t> given_away;  ///< thin places of bodies that are given to others, once known

  /// Whether fewer bodies are lost or joined, or so many fewer torn that it is worth the leaves.
  [[nodiscard]] bool are_better_than(const ShownBodies& other) const;
  /// The greatest number of leaves up to which nothing need have become better.
  [[nodiscard]] std::size_t most_leaves() const;
};

/// Mends bodies that the leaves of a state lose, join or tear, by moving interfaces or by splitting cells. A
/// body is torn where the mesh gives its thin places to other bodies.
class BodyMending {
 public:
  /// All parts must outlive this object.
  BodyMending(ResamplingState& state, Refinement& refinement, const VolumeRefinement& volumes,
              ShownInterfaces& shown)
      : state_(state), refinement_(refinement), volumes_(volumes), shown_(shown), bodies_(state.source) {}

  /// Compares the bodies of the interfaces that were last measured with those of the input.
  void measure() { bodies_.measure(shown_.extracted()); }
  [[nodiscard]] const BodyReport& report() const { return bodies_.report(); }
  /// What is wrong with the bodies that were last compared.
  [[nodiscard]] ShownBodies shown_bodies() const { return {faults(), state_.hierarchy.leaf_count(), {}}; }

  /// Mends torn bodies by moving the signed distances at vertices, and measures what is shown anew. The moves
  /// stay if they leave at most one fault out of `part`, which is 2 or more, lose and join no more bodies,
  /// and keep distances and volumes as they were wanted; else they are undone. Returns whether they stay.
  bool move_interfaces(std::size_t part);
  /// Splits cells where the mesh loses, joins or tears bodies, until so many fewer places are given to other
  /// bodies that these should be measured again. Returns why there is nothing to split or splitting is not
  /// worth it; none otherwise. `best`: the best that was shown so far.
  [[nodiscard]] std::optional<RefinementEnd> split_cells(ShownBodies& best);

 private:
  /// Numbers of thin places with the leaves that hold them, in order.
  using PlacesByLeaf = std::vector<std::pair<TetrahedronId, std::uint32_t>>;
  /// Moves an interface at the corners of a leaf by a distance, positive towards its first body's gain.
  struct InterfaceMove {
    TetrahedronId leaf;
    InterfaceId interface;
    double by = 0;
  };
  /// Signed distances of vertices from interfaces.
  using Distances = std::map<std::pair<VertexId, InterfaceId>, double>;
  struct TornLeaves {
    std::vector<TetrahedronId> leaves;
    std::size_t places = 0;  ///< number of places within bodies that are given to others
  };
  /// Receives a place, its leaf, who owns the place, and who owns what of the leaf.
  using PlaceVisitor = std::function<void(std::uint32_t, TetrahedronId, BodyId, const CellOwnership&)>;

  [[nodiscard]] BodyFaults faults() const { return bodies_.faults(state_.options.interface_error); }
  void find_places();
  [[nodiscard]] IdVector<BodyId, char> wrong_bodies() const;
  [[nodiscard]] PlacesByLeaf places_by_leaf(const IdVector<BodyId, char>& bodies) const;
  void for_each_place(const PlacesByLeaf& places, const PlaceVisitor& visit) const;

  [[nodiscard]] std::optional<InterfaceMove> move_at(const ThinPlace& place, TetrahedronId leaf, BodyId owner,
                                                     const CellOwnership& owners) const;
  Distances move_for_wrong_bodies();
  bool apply(const std::vector<std::optional<InterfaceMove>>& moves, Distances& originals);
  [[nodiscard]] std::vector<TetrahedronId> leaves_at(const std::vector<VertexId>& corners) const;
  void move_back(const Distances& originals, const std::vector<VertexId>& corners, double share);

  [[nodiscard]] TornLeaves torn_leaves() const;
  bool split_for_lost_bodies();

  ResamplingState& state_;
  Refinement& refinement_;
  const VolumeRefinement& volumes_;
  ShownInterfaces& shown_;
  BodyComparison bodies_;
  std::optional<std::vector<ThinPlace>> places_;  ///< known once they are needed
  bool moving_is_hopeless_ = false;               ///< it has made bodies worse
};

}  // namespace adamas::interfaces
