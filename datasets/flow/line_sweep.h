#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "datasets/flow/mixture.h"

namespace adamas::datasets {

/// Opens and closes empty space, which is a material: metals do not hold together under tension but leave
/// void, and void closes before pressure builds up.
struct VoidOpening {
  std::size_t material = 0;  ///< the number of the material that stands for empty space, an ideal gas
  double pressure = 0;       ///< least pressure of a cell; above 0
  double density = 0;        ///< thinner void is compressed by any greater pressure
};

/// The fluxes through the faces of kLanes pairs of cells: for each conserved variable, and the velocity of
/// the material on the face.
template <std::size_t N>
struct FaceFlux {
  Row<N> flow;
  std::array<double, kLanes> velocity;
};

/// The state outside an end of the domain: that of the last cell, its mirror image, that at the other end, or
/// a given state.
enum class FlowBoundary { kOutflow, kMirror, kPeriodic, kGiven };

/// An end of a line.
template <std::size_t N>
struct LineEnd {
  FlowBoundary boundary = FlowBoundary::kOutflow;
  std::array<double, Variables<N>::kCount> given{};  ///< the conserved variables outside it, for kGiven
};

/// Up to kLanes lines of cells side by side, in the arrays of the conserved variables; the momentum along the
/// line comes first.
template <std::size_t N>
struct FlowLines {
  std::array<double*, Variables<N>::kCount> variables;  ///< the variables of the first cell of the first line
  std::size_t cells = 0;                                ///< number of cells of each line
  std::size_t stride = 1;                               ///< distance from a cell to the next
  std::size_t lanes = kLanes;                           ///< number of lines
  std::size_t lane_stride = 1;                          ///< distance from a line to the next
};

/// The effect of a step on FlowLines.
template <std::size_t N>
struct LineResult {
  /// Sums over the lines of what entered at the low and at the high end, per area and time.
  std::array<std::array<double, Variables<N>::kCount>, 2> entered{};
  std::size_t first_order = 0;  ///< number of cells that were computed again without slopes
  /// The first cell without an admissible state, if there is one.
  std::optional<std::size_t> bad_cell;
  std::size_t bad_lane = 0;
};

/// Advances the equations by a step in one direction on lines of cells, with second order in space and time.
/// If that leaves a state without a speed of sound, the step is repeated with first order round that cell.
template <std::size_t N>
class LineSweep {
 public:
  explicit LineSweep(const MixtureLaw<N>& law, std::optional<VoidOpening> opening = {})
      : law_(law), opening_(opening) {}

  /// `ratio` is the step over the size of a cell. Lines with a bad cell are not changed.
  LineResult<N> advance(const FlowLines<N>& lines, double ratio, const std::array<LineEnd<N>, 2>& ends);

 private:
  using Lane = std::array<double, kLanes>;
  void load(const FlowLines<N>& lines, const std::array<LineEnd<N>, 2>& ends);
  void find_fluxes(double ratio);
  void update(double ratio);
  void settle();
  void find_thin(const Row<N>& q, Lane& thin) const;
  std::size_t distrust(const std::array<LineEnd<N>, 2>& ends, LineResult<N>& result);
  void store(const FlowLines<N>& lines) const;

  MixtureLaw<N> law_;
  std::optional<VoidOpening> opening_;
  std::size_t cells_ = 0;
  // The rows include two ghost cells at either end.
  std::vector<Row<N>> before_, primitive_;
  std::vector<Lane> order_;
  // One flux per face.
  std::vector<FaceFlux<N>> faces_;
  std::vector<Row<N>> after_;
  // One entry per cell: 1 in the lanes without an admissible state.
  std::vector<Lane> bad_;
};

}  // namespace adamas::datasets
