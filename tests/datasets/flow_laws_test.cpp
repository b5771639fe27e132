// Tests what a flow preserves: equilibria, masses, energy, symmetries, bytes.

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/parallel.h"
#include "datasets/flow/flow_solver.h"
#include "datasets/random_numbers.h"

namespace adamas {

using namespace datasets;

namespace {

using Cells = std::array<std::size_t, 3>;

const std::array<FlowMaterial, 3> kMaterials{{{"copper", gas_of_hugoniot(8.93, 0.394, 1.489)},
                                              {"tungsten", gas_of_hugoniot(19.22, 0.403, 1.237)},
                                              {"empty", {1.4, 0}}}};

FlowProblem<3> problem_with(FlowBoundary boundary, const Cells& cells) {
  FlowProblem<3> problem;
  problem.box = {{0, 0, 0}, {1, 1, 1}};
  problem.cells = cells;
  problem.materials = kMaterials;
  for (auto& ends : problem.boundaries) ends = {boundary, boundary};
  return problem;
}

/// Returns a cell with random shares of the materials, one time in three, or with a pure one. Densities are
/// those of two metals and of thin air.
FlowCell<3> random_matter(RandomNumbers& random) {
  FlowCell<3> cell;
  double sum = 0;
  const double pure = random.uniform(0, 3);
  for (std::size_t m = 0; m < 3; ++m) {
    cell.fractions[m] =
        pure < 2 ? (static_cast<double>(m) == std::floor(1.5 * pure) ? 1 : 0) : random.uniform(0, 1);
    sum += cell.fractions[m];
  }
  for (double& f : cell.fractions) f /= sum;
  cell.densities = {random.uniform(8, 12), random.uniform(18, 25), random.uniform(1e-3, 2e-3)};
  return cell;
}

/// Returns random cells by their index, the same ones for the same seed.
std::vector<FlowCell<3>> random_cells(const Cells& cells, std::uint64_t seed, double speed) {
  RandomNumbers random(seed);
  std::vector<FlowCell<3>> result;
  for (std::size_t at = 0; at < cells[0] * cells[1] * cells[2]; ++at) {
    FlowCell<3> cell = random_matter(random);
    cell.velocity = random.uniform(0, speed) * random.direction();
    cell.pressure = std::pow(10, random.uniform(-6, 0));
    result.push_back(cell);
  }
  return result;
}

FlowSolver<3> solver(const FlowProblem<3>& problem, const std::vector<FlowCell<3>>& cells) {
  return {"test", problem, [&](std::size_t i, std::size_t j, std::size_t k) {
            return cells[i + problem.cells[0] * (j + problem.cells[1] * k)];
          }};
}

TEST(FlowLaws, MaterialsInEquilibriumStayInIt) {
  for (const FlowBoundary boundary : {FlowBoundary::kPeriodic, FlowBoundary::kOutflow}) {
    const Cells size{9, 8, 11};
    auto cells = random_cells(size, 5, 0);
    const Vec3 u{0.7, -0.4, 0.5};
    for (FlowCell<3>& cell : cells) {
      cell.velocity = u;
      cell.pressure = 0.01;
    }
    FlowSolver<3> flow = solver(problem_with(boundary, size), cells);
    flow.advance_to(0.5);
    EXPECT_GT(flow.steps(), 10u);
    for (std::size_t k = 0; k < size[2]; ++k) {
      for (std::size_t j = 0; j < size[1]; ++j) {
        for (std::size_t i = 0; i < size[0]; ++i) {
          const FlowCell<3> cell = flow.cell(i, j, k);
          // The tolerance is relative to energies per volume, which are up to 10.
          EXPECT_NEAR(cell.pressure, 0.01, 1e-12);
          EXPECT_LT(norm(cell.velocity - u), 1e-11);
        }
      }
    }
  }
}

TEST(FlowLaws, AClosedBoxKeepsEachMassAndEnergy) {
  for (const bool opening : {false, true}) {
    for (const FlowBoundary boundary : {FlowBoundary::kMirror, FlowBoundary::kPeriodic}) {
      for (std::uint64_t seed = 1; seed <= 2; ++seed) {
        const Cells size{9, 6, 7};
        FlowProblem<3> problem = problem_with(boundary, size);
        if (opening) problem.opening = VoidOpening{2, 1e-6, 0.1};
        FlowSolver<3> flow = solver(problem, random_cells(size, seed, 0.3));
        const FlowLedger<3> before = flow.inside();
        flow.advance_to(1);
        EXPECT_GT(flow.steps(), 30u);
        const FlowLedger<3> after = flow.inside();
        for (std::size_t m = 0; m < 3; ++m) EXPECT_NEAR(after.mass[m] / before.mass[m], 1, 1e-12);
        EXPECT_NEAR(after.energy / before.energy, 1, 1e-12);
        // Nothing passes a mirror, not even by rounding.
        if (boundary == FlowBoundary::kMirror) {
          EXPECT_EQ(flow.entered().energy, 0);
        }
      }
    }
  }
}

TEST(FlowLaws, WhatLeavesIsInTheLedger) {
  const Cells size{8, 9, 10};
  FlowSolver<3> flow = solver(problem_with(FlowBoundary::kOutflow, size), random_cells(size, 4, 0.3));
  const FlowLedger<3> before = flow.inside();
  flow.advance_to(0.5);
  const FlowLedger<3> after = flow.inside();
  EXPECT_GT(std::abs(flow.entered().energy), 1e-3 * before.energy);
  for (std::size_t m = 0; m < 3; ++m) {
    EXPECT_NEAR((after.mass[m] - flow.entered().mass[m]) / before.mass[m], 1, 1e-12);
  }
  EXPECT_NEAR((after.energy - flow.entered().energy) / before.energy, 1, 1e-12);
}

/// Returns all numbers of all cells, in the order of the cells.
std::vector<double> numbers(const FlowSolver<3>& flow) {
  std::vector<double> result;
  const Cells& n = flow.problem().cells;
  for (std::size_t at = 0; at < n[0] * n[1] * n[2]; ++at) {
    const FlowCell<3> cell = flow.cell(at % n[0], at / n[0] % n[1], at / (n[0] * n[1]));
    result.insert(result.end(), cell.fractions.begin(), cell.fractions.end());
    result.insert(result.end(), cell.densities.begin(), cell.densities.end());
    result.insert(result.end(), {cell.velocity.x, cell.velocity.y, cell.velocity.z, cell.pressure});
  }
  return result;
}

TEST(FlowLaws, TheNumberOfThreadsChangesNothing) {
  const Cells size{17, 9, 11};
  FlowProblem<3> problem = problem_with(FlowBoundary::kOutflow, size);
  problem.opening = VoidOpening{2, 1e-6, 0.1};
  std::vector<std::vector<double>> results;
  for (const unsigned threads : {1u, 2u}) {
    set_thread_limit(threads);
    FlowSolver<3> flow = solver(problem, random_cells(size, 8, 0.5));
    flow.advance_to(0.03);
    results.push_back(numbers(flow));
    results.back().push_back(flow.entered().energy);
  }
  set_thread_limit(0);
  EXPECT_EQ(results[0], results[1]);
}

TEST(FlowLaws, AMirroredFlowIsTheFlowMirrored) {
  const Cells size{12, 5, 6};
  for (const FlowBoundary boundary :
       {FlowBoundary::kMirror, FlowBoundary::kPeriodic, FlowBoundary::kOutflow}) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const FlowProblem<3> problem = problem_with(boundary, size);
      const auto cells = random_cells(size, 11, 0.2);
      const auto mirror = [&](std::size_t at) {
        Cells c{at % size[0], at / size[0] % size[1], at / (size[0] * size[1])};
        c[axis] = size[axis] - 1 - c[axis];
        return c[0] + size[0] * (c[1] + size[1] * c[2]);
      };
      const Vec3 sign{axis == 0 ? -1.0 : 1, axis == 1 ? -1.0 : 1, axis == 2 ? -1.0 : 1};
      auto mirrored = cells;
      for (std::size_t at = 0; at < cells.size(); ++at) {
        mirrored[at] = cells[mirror(at)];
        Vec3& u = mirrored[at].velocity;
        u = {sign.x * u.x, sign.y * u.y, sign.z * u.z};
      }
      FlowSolver<3> a = solver(problem, cells), b = solver(problem, mirrored);
      a.advance_to(0.1);
      b.advance_to(0.1);
      EXPECT_EQ(a.steps(), b.steps());
      for (std::size_t at = 0; at < cells.size(); ++at) {
        const std::size_t to = mirror(at);
        const FlowCell<3> here = a.cell(at % size[0], at / size[0] % size[1], at / (size[0] * size[1]));
        const FlowCell<3> there = b.cell(to % size[0], to / size[0] % size[1], to / (size[0] * size[1]));
        EXPECT_NEAR(here.pressure, there.pressure, 1e-9);
        EXPECT_NEAR(here.velocity.x, sign.x * there.velocity.x, 1e-9);
        EXPECT_NEAR(here.velocity.y, sign.y * there.velocity.y, 1e-9);
        EXPECT_NEAR(here.velocity.z, sign.z * there.velocity.z, 1e-9);
        EXPECT_NEAR(here.fractions[0], there.fractions[0], 1e-9);
      }
    }
  }
}

TEST(FlowLaws, AFlowThatCannotBeIsAnError) {
  const Cells size{4, 1, 1};
  const FlowProblem<3> problem = problem_with(FlowBoundary::kMirror, size);
  const auto with = [&](const std::function<void(FlowCell<3>&)>& change) {
    auto cells = random_cells(size, 1, 0);
    change(cells[2]);
    FlowSolver<3> flow = solver(problem, cells);
    flow.advance_to(0.1);
  };
  EXPECT_NO_THROW(with([](FlowCell<3>&) {}));
  EXPECT_THROW(with([](FlowCell<3>& c) { c.densities = {}; }), Error);
  EXPECT_THROW(with([](FlowCell<3>& c) { c.densities[0] = c.fractions[0] = NAN; }), Error);
  EXPECT_THROW(with([](FlowCell<3>& c) { c.velocity.x = INFINITY; }), Error);
  EXPECT_THROW(with([](FlowCell<3>& c) { c.pressure = -10; }), Error);
  FlowProblem<3> none = problem;
  none.cells = {0, 1, 1};
  EXPECT_THROW(solver(none, {}), Error);
  none.cells = {1u << 20u, 1u << 20u, 1u << 20u};
  EXPECT_THROW(solver(none, {}), Error);
}

}  // namespace
}  // namespace adamas
