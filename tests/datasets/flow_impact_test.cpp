// Tests the impact: admissible states at any speed and size, its geometry, and the data that are written of
// it.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/base/error.h"
#include "datasets/flow/impact.h"

namespace adamas {

using namespace datasets;

namespace {

template <class Check>
void for_each_cell(const FlowSolver<3>& flow, const Check& check) {
  const auto& n = flow.problem().cells;
  for (std::size_t k = 0; k < n[2]; ++k) {
    for (std::size_t j = 0; j < n[1]; ++j) {
      for (std::size_t i = 0; i < n[0]; ++i) check(i, j, k, flow.cell(i, j, k));
    }
  }
}

TEST(FlowImpact, StatesAreAdmissibleAtAnySpeedAndSize) {
  for (const double speed : {0.05, 1.2, 4.0, kGreatestImpactSpeed}) {
    for (const std::size_t n : {5u, 12u}) {
      ImpactOptions options;
      options.speed = speed;
      options.cells = {n, n, 2 * n};
      FlowSolver<3> flow = make_impact(options);
      flow.advance_to(4 / std::max(speed, 0.5));
      for_each_cell(flow, [&](std::size_t, std::size_t, std::size_t, const FlowCell<3>& cell) {
        double sum = 0;
        for (std::size_t m = 0; m < 3; ++m) {
          EXPECT_GE(cell.fractions[m], 0);
          EXPECT_GE(cell.densities[m], 0);
          EXPECT_TRUE(std::isfinite(cell.densities[m]));
          sum += cell.fractions[m];
        }
        EXPECT_NEAR(sum, 1, 1e-12);
        EXPECT_GT(cell.pressure, 0);
        EXPECT_TRUE(std::isfinite(cell.pressure));
        // This is a bound for the speed of a plate without mass that leaves the surface.
        EXPECT_LT(norm(cell.velocity), 2 * speed + 1);
      });
    }
  }
}

TEST(FlowImpact, ItsMassesAreThoseOfItsBodies) {
  ImpactOptions options;
  options.cells = {16, 16, 26};
  FlowSolver<3> flow = make_impact(options);
  const FlowLedger<3> start = flow.inside();
  EXPECT_NEAR(start.mass[0], 19.22 * std::numbers::pi / 4 * 1.6, 1e-2);
  EXPECT_NEAR(start.mass[1], 16.654 * 9 * 9 * 16, 1e-6);
  // At rest and without pressure a stiffened gas holds rho c^2 / (gamma - 1), where gamma = 4 s - 1.
  const double rest =
      16 * 81 * 16.654 * 0.3414 * 0.3414 / (4 * 1.201 - 2) + start.mass[0] * 0.403 * 0.403 / (4 * 1.237 - 2);
  EXPECT_NEAR(start.energy, 0.5 * start.mass[0] * 1.2 * 1.2 + rest, 1e-2);
  flow.advance_to(2);
  const FlowLedger<3> now = flow.inside();
  for (std::size_t m = 0; m < 3; ++m) {
    EXPECT_NEAR((now.mass[m] - flow.entered().mass[m]) / start.mass[m], 1, 1e-12);
  }
  EXPECT_NEAR((now.energy - flow.entered().energy) / start.energy, 1, 1e-12);
}

/// Returns the sum of absolute differences of the block's share between a flow and its image under x <-> y,
/// relative to what has moved.
double asymmetry(std::size_t n) {
  ImpactOptions options;
  options.cells = {n, n, n};
  options.box = {{0, 0, -4}, {4, 4, 4}};
  FlowSolver<3> flow = make_impact(options);
  const auto share = [&flow](std::size_t i, std::size_t j, std::size_t k) {
    return flow.cell(i, j, k).fractions[1];
  };
  std::vector<double> before;
  for_each_cell(flow,
                [&](auto, auto, auto, const FlowCell<3>& cell) { before.push_back(cell.fractions[1]); });
  flow.advance_to(1.5);
  double moved = 0, difference = 0;
  std::size_t at = 0;
  for_each_cell(flow, [&](std::size_t i, std::size_t j, std::size_t k, const FlowCell<3>& cell) {
    moved += std::abs(cell.fractions[1] - before[at++]);
    difference += std::abs(cell.fractions[1] - share(j, i, k));
  });
  return difference / moved;
}

TEST(FlowImpact, XAndYAreAlikeButForTheOrderOfSweeps) {
  EXPECT_LT(asymmetry(12), 0.03);
  EXPECT_LT(asymmetry(20), 0.03);
}

TEST(FlowImpact, AQuarterIsTheWholeBetweenMirrors) {
  ImpactOptions quarter, whole;
  quarter.cells = {8, 8, 10};
  quarter.box = {{0, 0, -4}, {4, 4, 4}};
  whole.cells = {16, 16, 10};
  whole.box = {{-4, -4, -4}, {4, 4, 4}};
  FlowSolver<3> part = make_impact(quarter), all = make_impact(whole);
  part.advance_to(1.5);
  all.advance_to(1.5);
  for_each_cell(part, [&all](std::size_t i, std::size_t j, std::size_t k, const FlowCell<3>& cell) {
    for (const std::size_t x : {8 + i, 7 - i}) {
      for (const std::size_t y : {8 + j, 7 - j}) {
        const FlowCell<3> other = all.cell(x, y, k);
        EXPECT_NEAR(cell.pressure, other.pressure, 1e-9);
        EXPECT_NEAR(cell.velocity.z, other.velocity.z, 1e-9);
        EXPECT_NEAR(cell.fractions[0], other.fractions[0], 1e-9);
        EXPECT_NEAR(cell.fractions[1], other.fractions[1], 1e-9);
      }
    }
  });
}

TEST(FlowImpact, TheDataAreTheFlow) {
  ImpactOptions options;
  options.cells = {12, 13, 14};
  options.box = {{0, 0, -4}, {4, 4, 4}};
  FlowSolver<3> flow = make_impact(options);
  flow.advance_to(1);
  MultiMaterialData data = flow_data(flow, "impact", kImpactUnits);
  data.check();
  EXPECT_EQ(data.grid.domain().min.z, -4);
  EXPECT_EQ(data.grid.domain().max.y, 4);
  const auto written = data.fractions;
  data.normalise();
  EXPECT_EQ(written, data.fractions);
  EXPECT_EQ(data.report.renormalised, 0u);
  ASSERT_EQ(data.fields.size(), 3u);
  const auto rounded = [](double value) { return static_cast<double>(static_cast<float>(value)); };
  double moved = 0;
  for_each_cell(flow, [&](std::size_t i, std::size_t j, std::size_t k, const FlowCell<3>& cell) {
    const std::size_t site = data.grid.site_index(i, j, k);
    for (std::size_t m = 0; m < 3; ++m) {
      const float fraction = written[MaterialId(m)][site];
      const double density = data.fields[0].material_values[MaterialId(m)][site];
      EXPECT_NEAR(static_cast<double>(fraction), cell.fractions[m], 2 * kLeastFraction);
      EXPECT_EQ(density, fraction > 0 ? rounded(cell.densities[m]) : 0);
      EXPECT_TRUE(fraction == 0 || static_cast<double>(fraction) >= kLeastFraction);
      moved += std::abs(static_cast<double>(fraction) - cell.fractions[m]);
    }
    EXPECT_EQ(data.fields[1].values[site], rounded(cell.pressure));
    EXPECT_EQ(data.fields[2].values[3 * site + 2], rounded(cell.velocity.z));
  });
  EXPECT_GT(moved, 0);
}

TEST(FlowImpact, BoxesAndSpeedsThatMakeNoSense) {
  for (const Box3& box :
       {Box3{{1, 0, -4}, {4, 4, 4}}, Box3{{0, 1, -4}, {4, 4, 4}}, Box3{{0, 0, 0}, {4, 4, 4}},
        Box3{{0, 0, -4}, {4, 4, 0}}, Box3{{-4, 0, -4}, {0, 4, 4}}}) {
    ImpactOptions options;
    options.box = box;
    EXPECT_FALSE(holds_impact(box));
    EXPECT_THROW(make_impact(options), Error);
  }
  for (const double speed : {0.0, -1.0, 11.0, std::nan("")}) {
    ImpactOptions options;
    options.speed = speed;
    EXPECT_THROW(make_impact(options), Error);
  }
}

}  // namespace
}  // namespace adamas
