#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "interfaces/resampling/exchanged_volumes.h"
#include "interfaces/resampling/resampling_state.h"

namespace adamas::interfaces {

/// The interfaces of a state's leaves where they can be moved without a change of what touches what. A leaf
/// is *divided* if two bodies share it by one polygon, on which the two functions of their interface are
/// equal. There a vertex's distance from that interface may change as long as it keeps its sign; at the
/// vertices of leaves that are shared in another way nothing moves. So all polygons of all leaves
/// remain, with other corners.
class MovableInterfaces {
 public:
  /// A move for each interface. A vertex takes as much of it as it may.
  using Moves = IdVector<InterfaceId, double>;

  /// The state must outlive this object, its leaves must stay, and what they show must be known
  /// (find_contacts). No distance may change by more than `most`.
  MovableInterfaces(ResamplingState& state, double most);

  /// Returns the least and the greatest move of an interface that makes any difference.
  [[nodiscard]] const std::array<double, 2>& range(InterfaceId i) const { return ranges_[i]; }
  /// Computes the volumes and exchanges after moves.
  [[nodiscard]] ExchangedVolumes measure(const Moves& moves) const;
  /// Returns a bound of how far moves take the corners of the polygons of a divided leaf; 0 for other leaves.
  [[nodiscard]] double displacement(TetrahedronId leaf, const Moves& moves) const;
  /// Returns the greatest displacement of all leaves.
  [[nodiscard]] double displacement(const Moves& moves) const;
  /// Allows the corners of the polygons of a leaf no greater displacement than this from now on.
  void limit(TetrahedronId leaf, double displacement);
  /// The same for all leaves.
  void limit_all(double displacement);
  /// Lets all vertices of a leaf stay where they are from now on.
  void hold(TetrahedronId leaf);
  /// Finds ranges() again after limits have changed.
  void update_ranges();

  /// Gives the state's vertices the distances that they have after moves, and finds what leaves show then.
  /// Returns the leaves with other polygons than before, because others own a part of them.
  [[nodiscard]] std::vector<TetrahedronId> move(const Moves& moves);

 private:
  /// The distance of a vertex from an interface, and how it may change.
  struct Place {
    double distance = 0;
    double least = 0, greatest = 0;

    [[nodiscard]] double moved(double by) const;
  };
  static constexpr std::uint32_t kNoPlace = 0xffffffffu;
  /// A leaf that two bodies share.
  struct DividedLeaf {
    TetrahedronId leaf;
    InterfaceId interface;
    double volume = 0;
    std::array<std::uint32_t, 4> places{};  ///< by vertex; kNoPlace for one far from the interface
    std::array<double, 4> values{};  ///< half of the difference of the functions of the first and second body
  };

  void find_leaves();
  void let_move(Place& place) const;
  [[nodiscard]] std::vector<std::pair<BodyId, double>> volumes_in(TetrahedronId leaf,
                                                                  CellOwnership& owners) const;
  [[nodiscard]] bool moves_at(TetrahedronId leaf, const Moves& moves) const;
  void set_places();
  [[nodiscard]] std::array<double, 4> values(const DividedLeaf& divided, const Moves& moves) const;
  void limit(const DividedLeaf& divided, double displacement);
  [[nodiscard]] double displacement(const DividedLeaf& divided, const Moves& moves) const;

  ResamplingState& state_;
  double most_;
  IdVector<VertexId, std::uint32_t> first_places_;  ///< places follow the near interfaces of each vertex
  std::vector<Place> places_;
  std::vector<DividedLeaf> divided_;
  /// What divided leaves show before they are moved.
  std::shared_ptr<const std::vector<CellContacts>> contacts_;
  IdVector<TetrahedronId, std::uint32_t> divided_of_;  ///< by leaf; kNoPlace if it is not divided
  std::vector<TetrahedronId> whole_;                   ///< leaves with one owner
  std::vector<TetrahedronId> shared_;                  ///< leaves that are shared in another way
  IdVector<BodyId, double> elsewhere_;  ///< the volumes of the bodies in leaves that are not divided
  IdVector<InterfaceId, std::array<double, 2>> ranges_;
};

}  // namespace adamas::interfaces
