#pragma once

#include <functional>
#include <limits>
#include <utility>
#include <vector>

#include "interfaces/resampling/refinement.h"
#include "interfaces/resampling/resampling_state.h"

namespace adamas::interfaces {

/// The volume of a body for which cells are split.
struct VolumeGoal {
  double wanted = 0;    ///< the body's volume in the input
  double enclosed = 0;  ///< the volume that its interfaces in the input enclose, which smaller cells lead to
  double tolerance = std::numeric_limits<double>::infinity();
  double cells = 0;  ///< the number of cells at its boundary that show its shape
};

/// Splits cells until each body has its volume, up to the relative error that the options allow.
class VolumeRefinement {
 public:
  /// The state and the refinement must outlive this object.
  VolumeRefinement(ResamplingState& state, Refinement& refinement) : state_(state), refinement_(refinement) {}

  /// Splits cells at the boundaries of bodies whose volumes are off, until they are within the wanted error
  /// or splitting does not help. Returns whether anything was split. Does nothing if no error of volumes is
  /// wanted. If volumes are conserved, part of each volume is left to moves of interfaces.
  bool refine();
  /// Moves interfaces for volumes by `move`. As long as that leaves bodies whose volumes are off, takes it
  /// back, splits cells so that less is left to moves, measures by `measure`, and moves again.
  void alternate(const std::function<void()>& move, const std::function<void()>& measure);
  /// Returns the number of bodies whose volumes are not within the wanted error; 0 before the first refine().
  [[nodiscard]] std::size_t bodies_off() const;
  /// Returns the goals of splitting; empty if no error of volumes is wanted or none was measured.
  [[nodiscard]] const IdVector<BodyId, VolumeGoal>& goals() const { return goals_; }
  /// Returns why splitting ended for each body whose volume is off; as many as the goals.
  [[nodiscard]] const IdVector<BodyId, RefinementEnd>& ends() const { return ends_; }

 private:
  /// The volumes of bodies while cells are split.
  struct VolumeWatch {
    IdVector<BodyId, double> volumes;
    std::vector<TetrahedronId> created;  ///< tetrahedra that were leaves when they were created
  };
  struct Cell {
    TetrahedronId leaf;
    double gained = 0;  ///< the estimated excess of the body's volume in the cell over that in the input
    double bound = 0;   ///< a bound of that volume
  };
  /// A body whose volume is off, with the leaves at its boundary.
  struct BodyOff {
    BodyId body;
    std::vector<Cell> cells;
    double best = std::numeric_limits<double>::infinity();  ///< the least difference from its goal so far
    double cells_at_best = 0;
  };
  /// A leaf to be split, with its excess volume relative to the body's tolerance.
  using ChosenCell = std::pair<double, TetrahedronId>;

  void find_goals();
  [[nodiscard]] double allowed(BodyId body) const;
  [[nodiscard]] double goal(BodyId body) const;
  [[nodiscard]] bool is_off(BodyId body, double volume) const;
  void update(VolumeWatch& watch, const std::vector<TetrahedronId>& parents,
              const std::vector<TetrahedronId>& created) const;
  void add_cells(const std::vector<TetrahedronId>& cells, std::vector<BodyOff>& off) const;
  void choose_cells(BodyOff& off, double volume, std::vector<ChosenCell>& chosen);
  bool split_for(std::vector<BodyOff>& off, VolumeWatch& watch);
  bool split_for_all();
  bool leave_less_to_moves();

  ResamplingState& state_;
  Refinement& refinement_;
  IdVector<BodyId, VolumeGoal> goals_;  ///< computed when they are first needed
  IdVector<BodyId, RefinementEnd> ends_;
  double slack_ = 0;  ///< the part of a body's volume that is left to moving interfaces
};

}  // namespace adamas::interfaces
