// Compares shock tubes of one and of two materials with the exact solution of the Riemann problem.

#include <gtest/gtest.h>

#include <cmath>

#include "datasets/flow/flow_solver.h"
#include "tests/support/exact_riemann.h"

namespace adamas {

using namespace datasets;

namespace {

using test::ExactRiemann;
using test::GasState;

/// Mean absolute differences, each relative to the greatest jump.
struct TubeErrors {
  double density = 0, velocity = 0, pressure = 0, volume = 0;
};

struct Tube {
  GasState left, right;
  double diaphragm, time;
};

/// Returns the errors of the tube on [0, 1] along an axis, with N = 1 material, or 2.
template <std::size_t N>
TubeErrors run_tube(const Tube& tube, std::size_t cells, std::size_t axis) {
  FlowProblem<N> problem;
  problem.box = {{0, 0, 0}, {1, 1, 1}};
  problem.cells = {1, 1, 1};
  problem.cells[axis] = cells;
  problem.materials[0] = {"left", {tube.left.gamma, tube.left.stiffness}};
  problem.materials[N - 1] = {"right", {tube.right.gamma, tube.right.stiffness}};
  const auto x_of = [&](std::size_t i, std::size_t j, std::size_t k) {
    return (static_cast<double>(std::array{i, j, k}[axis]) + 0.5) / static_cast<double>(cells);
  };
  FlowSolver<N> flow("tube", problem, [&](std::size_t i, std::size_t j, std::size_t k) {
    const bool on_left = x_of(i, j, k) < tube.diaphragm;
    const GasState& s = on_left ? tube.left : tube.right;
    FlowCell<N> cell;
    cell.fractions[on_left ? 0 : N - 1] = 1;
    cell.densities[0] = N == 1 ? s.density : tube.left.density;
    cell.densities[N - 1] = N == 1 ? s.density : tube.right.density;
    cell.velocity = s.velocity * Vec3{axis == 0 ? 1.0 : 0, axis == 1 ? 1.0 : 0, axis == 2 ? 1.0 : 0};
    cell.pressure = s.pressure;
    return cell;
  });
  flow.advance_to(tube.time);
  const ExactRiemann exact(tube.left, tube.right);
  const double density_jump = std::abs(tube.left.density - tube.right.density);
  const double pressure_jump = std::max(exact.pressure(), std::abs(tube.left.pressure - tube.right.pressure));
  TubeErrors errors;
  for (std::size_t s = 0; s < cells; ++s) {
    std::array<std::size_t, 3> at{};
    at[axis] = s;
    const FlowCell<N> cell = flow.cell(at[0], at[1], at[2]);
    const double speed = (x_of(at[0], at[1], at[2]) - tube.diaphragm) / tube.time;
    const GasState expected = exact.at(speed);
    double density = 0;
    for (std::size_t m = 0; m < N; ++m) density += cell.fractions[m] * cell.densities[m];
    const double velocity = std::array{cell.velocity.x, cell.velocity.y, cell.velocity.z}[axis];
    const double part = 1 / static_cast<double>(cells);
    errors.density += part * std::abs(density - expected.density) / density_jump;
    errors.velocity += part * std::abs(velocity - expected.velocity) / std::abs(exact.velocity());
    errors.pressure += part * std::abs(cell.pressure - expected.pressure) / pressure_jump;
    errors.volume += part * std::abs(cell.fractions[0] - (N == 1 || speed < exact.velocity() ? 1 : 0));
  }
  return errors;
}

const Tube kSod{{1, 0, 1, 1.4, 0}, {0.125, 0, 0.1, 1.4, 0}, 0.5, 0.2};
/// Water at 1 GPa and air at 0.1 MPa, in kg/m3, m/s and Pa (Saurel and Abgrall 1999).
const Tube kWaterAir{{1000, 0, 1e9, 4.4, 6e8}, {50, 0, 1e5, 1.4, 0}, 0.7, 2.4e-4};
/// Copper that strikes tungsten, as in the impact.
const Tube kMetals{{8.93, 1.2, 1e-6, 4.956, 0.2797}, {19.22, 0, 1e-6, 3.948, 0.7907}, 0.5, 0.3};

TEST(FlowTubes, TheExactSolutionKnowsSod) {
  // The values are those of Toro's book, table 4.3, test 1.
  const ExactRiemann exact(kSod.left, kSod.right);
  EXPECT_NEAR(exact.pressure(), 0.30313, 1e-5);
  EXPECT_NEAR(exact.velocity(), 0.92745, 1e-5);
  EXPECT_NEAR(exact.at(0.9).density, 0.42632, 1e-5);
  EXPECT_NEAR(exact.at(1.0).density, 0.26557, 1e-5);
}

/// Expects first order over two doublings. Limited schemes have the order 2/3 at a contact of one material
/// and 1 at shocks; sharp interfaces have 1.
void expect_first_order(const std::string& what, double coarse, double fine) {
  const double order = 0.5 * std::log2(coarse / fine);
  EXPECT_GT(order, 0.75) << what;
  EXPECT_LT(order, 1.25) << what;
}

template <std::size_t N>
void expect_convergence(const Tube& tube) {
  const TubeErrors coarse = run_tube<N>(tube, 100, 0), fine = run_tube<N>(tube, 400, 0);
  expect_first_order("density", coarse.density, fine.density);
  expect_first_order("velocity", coarse.velocity, fine.velocity);
  expect_first_order("pressure", coarse.pressure, fine.pressure);
  if (N > 1) expect_first_order("volume", coarse.volume, fine.volume);
  // The errors are already small: they are the parts of the tube that differ by the whole jump.
  EXPECT_LT(fine.density + fine.velocity + fine.pressure + fine.volume, 0.02);
}

TEST(FlowTubes, SodConvergesToTheExactSolution) { expect_convergence<1>(kSod); }

TEST(FlowTubes, WaterAndAirConvergeToTheExactSolution) { expect_convergence<2>(kWaterAir); }

TEST(FlowTubes, CollidingMetalsConvergeToTheExactSolution) { expect_convergence<2>(kMetals); }

TEST(FlowTubes, AllAxesAreAlike) {
  for (const Tube& tube : {kWaterAir, kMetals}) {
    const TubeErrors x = run_tube<2>(tube, 64, 0);
    for (const std::size_t axis : {1u, 2u}) {
      const TubeErrors other = run_tube<2>(tube, 64, axis);
      EXPECT_EQ(x.density, other.density);
      EXPECT_EQ(x.velocity, other.velocity);
      EXPECT_EQ(x.pressure, other.pressure);
      EXPECT_EQ(x.volume, other.volume);
    }
  }
}

}  // namespace
}  // namespace adamas
