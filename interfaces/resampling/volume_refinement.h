#pragma once

#include <limits>
#include <utility>
#include <vector>

#include "interfaces/resampling/refinement.h"
#include "interfaces/resampling/resampling_state.h"

namespace adamas::interfaces {

/// The volume that cells are split for a body to have.
struct VolumeGoal {
  /// The body's volume in the input; or what the body's interfaces enclose, where that is too far off for
  /// smaller cells to help.
  double volume = 0;
  double tolerance = std::numeric_limits<double>::infinity();
  double cells = 0;  ///< number of cells at its boundary that show its shape
};

/// Splits cells until each body has its volume, but for the part of it that the options allow.
class VolumeRefinement {
 public:
  /// The state and the refinement must outlive this object.
  VolumeRefinement(ResamplingState& state, Refinement& refinement) : state_(state), refinement_(refinement) {}

  /// Splits cells at the boundaries of bodies whose volumes are off, until they are as wanted or no splitting
  /// helps. Returns whether anything was split, or interfaces shall be moved from now on. Does nothing where
  /// no error of volumes is wanted.
  bool refine();
  /// The number of bodies whose volumes are not as wanted; 0 before the first refine().
  [[nodiscard]] std::size_t bodies_off() const;
  /// What splitting aims at; empty where no error of volumes is wanted, or none was looked at.
  [[nodiscard]] const IdVector<BodyId, VolumeGoal>& goals() const { return goals_; }
  /// Why splitting ended for each body whose volume is off; as long as the goals.
  [[nodiscard]] const IdVector<BodyId, RefinementEnd>& ends() const { return ends_; }

 private:
  /// The volumes of bodies while cells are split.
  struct VolumeWatch {
    IdVector<BodyId, double> volumes;
    std::vector<TetrahedronId> created;  ///< leaves when they were made
  };
  struct Cell {
    TetrahedronId leaf;
    double gained = 0;  ///< estimated volume that it gives the body beyond what the input gives it
    double bound = 0;   ///< bound of that volume
  };
  /// A body whose volume is off, with the leaves at its boundary.
  struct BodyOff {
    BodyId body;
    std::vector<Cell> cells;
    double best = std::numeric_limits<double>::infinity();  ///< least difference from its volume yet
    double cells_at_best = 0;
  };
  /// A leaf to be split, with how much of a body's tolerance it gains.
  using ChosenCell = std::pair<double, TetrahedronId>;

  void find_goals();
  [[nodiscard]] double allowed(BodyId body) const;
  [[nodiscard]] bool is_off(BodyId body, double volume) const;
  void update(VolumeWatch& watch, const std::vector<TetrahedronId>& parents,
              const std::vector<TetrahedronId>& created) const;
  void add_cells(const std::vector<TetrahedronId>& cells, std::vector<BodyOff>& off) const;
  void choose_cells(BodyOff& off, double volume, std::vector<ChosenCell>& chosen);
  bool split_for(std::vector<BodyOff>& off, VolumeWatch& watch);
  bool split_for_all();

  ResamplingState& state_;
  Refinement& refinement_;
  IdVector<BodyId, VolumeGoal> goals_;  ///< known once they are needed
  IdVector<BodyId, RefinementEnd> ends_;
  double slack_ = 0;  ///< part of a body's volume that moving interfaces may still make up
};

}  // namespace adamas::interfaces
