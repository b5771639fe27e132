#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "adamas/geometry.h"
#include "adamas/grid_data.h"
#include "adamas/progress.h"
#include "core/base/error.h"
#include "core/data/multi_material_data.h"
#include "datasets/flow/line_sweep.h"

namespace adamas::datasets {

/// A material of a flow.
struct FlowMaterial {
  std::string name;
  StiffenedGas gas;
};

/// The state of one cell.
template <std::size_t N>
struct FlowCell {
  std::array<double, N> fractions{};  ///< adding up to 1
  std::array<double, N> densities{};  ///< the density of each material, its mass over its own volume
  Vec3 velocity;
  double pressure = 0;
};

/// A flow of N materials in a box of equal cells.
template <std::size_t N>
struct FlowProblem {
  Box3 box;
  std::array<std::size_t, 3> cells{};
  std::array<FlowMaterial, N> materials;
  /// The boundaries at the low and the high end of each axis. kGiven is not allowed; FlowSolver::set_beyond
  /// sets it.
  std::array<std::array<FlowBoundary, 2>, 3> boundaries{};
  std::optional<VoidOpening> opening;
  double courant = 0.45;  ///< the part of a cell that the fastest wave crosses in a step, below 1
};

/// The mass of each material, and the energy.
template <std::size_t N>
struct FlowLedger {
  std::array<double, N> mass{};
  double energy = 0;
};

/// Solves the five-equation model of compressible materials that share velocity and pressure (Allaire, Clerc
/// and Kokh 2002) with stiffened gases: MUSCL-Hancock with HLLC along lines, for the three directions one
/// after the other in alternating orders (Strang 1968). An axis with one cell is not swept. See
/// docs/method.md, "The flow solver". The result does not depend on the number of threads.
template <std::size_t N>
class FlowSolver {
 public:
  /// `cell` returns the initial state of cell (i, j, k). Throws Error, naming `name`, for an invalid problem,
  /// cells with an inadmissible state, and more cells than fit in memory.
  FlowSolver(std::string name, FlowProblem<N> problem,
             const std::function<FlowCell<N>(std::size_t, std::size_t, std::size_t)>& cell);

  /// Checks the numbers of cells: throws Error, naming `name`, if there is no cell or if there are more than
  /// fit in memory.
  static void check_cells(const std::string& name, const std::array<std::size_t, 3>& cells);

  /// Advances the flow to a time, in the problem's unit; the last step is shortened. Throws Error, naming the
  /// cell and the time, if the flow leaves the range of the materials' laws, and Cancelled.
  void advance_to(double time, Progress& progress = SilentProgress::instance());

  /// Sets the state outside an end of an axis from now on (FlowBoundary::kGiven).
  void set_beyond(std::size_t axis, std::size_t end, const FlowCell<N>& state);

  [[nodiscard]] const FlowProblem<N>& problem() const { return problem_; }
  [[nodiscard]] double time() const { return time_; }
  [[nodiscard]] std::size_t steps() const { return steps_; }
  /// The number of cells that were computed with first order instead of second.
  [[nodiscard]] std::size_t first_order_cells() const { return first_order_; }
  [[nodiscard]] FlowCell<N> cell(std::size_t i, std::size_t j, std::size_t k) const;
  /// The contents of the box at present.
  [[nodiscard]] FlowLedger<N> inside() const;
  /// What has entered through the box's faces, minus what has left.
  [[nodiscard]] const FlowLedger<N>& entered() const { return entered_; }

 private:
  using V = Variables<N>;
  using Conserved = std::array<double, V::kCount>;
  [[nodiscard]] Conserved conserved(const FlowCell<N>& cell) const;
  /// The index in the state of variable v on lines along an axis.
  static std::size_t variable_along(std::size_t axis, std::size_t v);
  [[nodiscard]] LineEnd<N> line_end(std::size_t axis, std::size_t end) const;
  [[nodiscard]] std::size_t index(std::size_t i, std::size_t j, std::size_t k) const {
    return i + problem_.cells[0] * (j + problem_.cells[1] * k);
  }
  [[nodiscard]] double fastest() const;
  void sweep(std::size_t axis, double step);
  [[noreturn]] void fail_in(std::size_t axis, std::size_t cell, std::size_t line, std::size_t layer) const;

  std::string name_;
  FlowProblem<N> problem_;
  MixtureLaw<N> law_;
  std::array<double, 3> size_{};  ///< the size of a cell
  std::array<std::vector<double>, V::kCount> state_;
  std::array<std::array<Conserved, 2>, 3> beyond_{};  ///< the given states outside the ends of axes
  FlowLedger<N> entered_;
  double time_ = 0;
  std::size_t steps_ = 0, first_order_ = 0;
};

/// The names of the units of a flow.
struct FlowUnits {
  std::string density, pressure, velocity;
};

/// Smaller fractions are not written: below it a material's density in a cell has no meaning.
inline constexpr double kLeastFraction = 1e-3;

/// The present state of the flow: volume fractions, the field "density" per material (its own mass over its
/// own volume, zero where it is absent), and "pressure" and "velocity", which materials share. In the output,
/// fractions below kLeastFraction become zero and the others of the cell grow to fill it; the flow itself is
/// not changed.
template <std::size_t N>
MultiMaterialData flow_data(const FlowSolver<N>& flow, const std::string& source, const FlowUnits& units);

}  // namespace adamas::datasets
