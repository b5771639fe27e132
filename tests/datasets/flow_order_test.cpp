// Tests smooth flows with known solutions: the measured order is two.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "datasets/flow/flow_solver.h"

namespace adamas {

using namespace datasets;

namespace {

constexpr double kTurn = 2 * std::numbers::pi;

double order(double coarse, double fine) { return std::log2(coarse / fine); }

/// Returns a periodic box [0, 1)^3 of one material, or of two equal ones that share every cell.
template <std::size_t N>
FlowProblem<N> periodic(const std::array<std::size_t, 3>& cells, const StiffenedGas& gas, double side = 1) {
  FlowProblem<N> problem;
  problem.box = {{0, 0, 0}, {side, side, side}};
  problem.cells = cells;
  for (auto& material : problem.materials) material = {"gas", gas};
  for (auto& ends : problem.boundaries) ends = {FlowBoundary::kPeriodic, FlowBoundary::kPeriodic};
  return problem;
}

double middle(std::size_t i, std::size_t cells, double side = 1) {
  return side * (static_cast<double>(i) + 0.5) / static_cast<double>(cells);
}

/// Returns the error of a density wave along a space diagonal; the components of its velocity are all
/// different.
double wave_error(std::size_t n) {
  const auto density = [](double x, double y, double z) {
    return 1 + 0.3 * std::sin(kTurn * x) * std::cos(kTurn * y) + 0.2 * std::sin(kTurn * z);
  };
  const Vec3 u{1, -0.5, 0.25};
  FlowSolver<1> flow("wave", periodic<1>({n, n, n}, {1.4, 0}),
                     [&](std::size_t i, std::size_t j, std::size_t k) {
                       FlowCell<1> cell;
                       cell.fractions = {1};
                       cell.densities = {density(middle(i, n), middle(j, n), middle(k, n))};
                       cell.velocity = u;
                       cell.pressure = 1;
                       return cell;
                     });
  const double time = 0.5;
  flow.advance_to(time);
  double error = 0;
  for (std::size_t at = 0; at < n * n * n; ++at) {
    const std::size_t i = at % n, j = at / n % n, k = at / (n * n);
    const double exact =
        density(middle(i, n) - time * u.x, middle(j, n) - time * u.y, middle(k, n) - time * u.z);
    error += std::abs(flow.cell(i, j, k).densities[0] - exact) / static_cast<double>(n * n * n);
  }
  return error;
}

TEST(FlowOrder, AnAdvectedDensityWave) {
  const double b = wave_error(12), c = wave_error(24);
  EXPECT_GT(order(b, c), 1.7);
  EXPECT_LT(order(b, c), 2.5);
}

/// Returns the error of a wave of finite height that runs to the right through a stiffened gas. The velocity
/// u is constant along lines of speed u + c until they meet, c = c0 + (gamma - 1) / 2 u, and the entropy is
/// constant.
double simple_wave_error(std::size_t n) {
  const StiffenedGas gas{4.4, 0.6};
  const double c0 = std::sqrt(gas.gamma * (1 + gas.stiffness)), height = 0.1, time = 0.15;
  const auto start = [&](double x) { return height * std::sin(kTurn * x); };
  const auto state = [&](double u) {
    const double c = c0 + 0.5 * (gas.gamma - 1) * u;
    const double density = std::pow(c / c0, 2 / (gas.gamma - 1));
    FlowCell<1> cell;
    cell.fractions = {1};
    cell.densities = {density};
    cell.velocity = {u, 0, 0};
    cell.pressure = (1 + gas.stiffness) * std::pow(density, gas.gamma) - gas.stiffness;
    return cell;
  };
  FlowSolver<1> flow("wave", periodic<1>({n, 1, 1}, gas),
                     [&](std::size_t i, std::size_t, std::size_t) { return state(start(middle(i, n))); });
  flow.advance_to(time);
  double error = 0;
  for (std::size_t i = 0; i < n; ++i) {
    double u = 0;
    for (int round = 0; round < 200; ++round) {
      u = start(middle(i, n) - time * (c0 + 0.5 * (gas.gamma + 1) * u));
    }
    const FlowCell<1> exact = state(u), found = flow.cell(i, 0, 0);
    error += (std::abs(found.densities[0] - exact.densities[0]) + std::abs(found.velocity.x - u) +
              std::abs(found.pressure - exact.pressure)) /
             static_cast<double>(n);
  }
  return error;
}

TEST(FlowOrder, ASimpleWaveInAStiffenedGas) {
  const double a = simple_wave_error(64), b = simple_wave_error(128), c = simple_wave_error(256);
  EXPECT_GT(order(a, b), 1.7);
  EXPECT_GT(order(b, c), 1.7);
  EXPECT_LT(order(a, c), 5);
}

/// Returns the error of a vortex in equilibrium that is carried along a diagonal (Shu 1998). It tests that
/// the directions work together.
double vortex_error(std::size_t n) {
  constexpr double kSide = 10, kStrength = 5, kGamma = 1.4;
  const auto state = [&](double x, double y) {
    const double r2 = x * x + y * y, bell = kStrength / kTurn * std::exp(0.5 * (1 - r2));
    const double temperature = 1 - (kGamma - 1) / (2 * kGamma) * bell * bell;
    FlowCell<2> cell;
    cell.fractions = {0.25, 0.75};
    cell.densities.fill(std::pow(temperature, 1 / (kGamma - 1)));
    cell.velocity = {1 - y * bell, 0.5 + x * bell, 0};
    cell.pressure = std::pow(temperature, kGamma / (kGamma - 1));
    return cell;
  };
  FlowSolver<2> flow("vortex", periodic<2>({n, n, 1}, {kGamma, 0}, kSide),
                     [&](std::size_t i, std::size_t j, std::size_t) {
                       return state(middle(i, n, kSide) - 4, middle(j, n, kSide) - 4.5);
                     });
  const double time = 2;
  flow.advance_to(time);
  double error = 0;
  for (std::size_t j = 0; j < n; ++j) {
    for (std::size_t i = 0; i < n; ++i) {
      const FlowCell<2> exact = state(middle(i, n, kSide) - 4 - time, middle(j, n, kSide) - 4.5 - 0.5 * time);
      const FlowCell<2> found = flow.cell(i, j, 0);
      error += (std::abs(found.densities[0] - exact.densities[0]) + norm(found.velocity - exact.velocity) +
                std::abs(found.pressure - exact.pressure)) /
               static_cast<double>(n * n);
    }
  }
  return error;
}

TEST(FlowOrder, AVortex) {
  const double a = vortex_error(40), b = vortex_error(80);
  EXPECT_GT(order(a, b), 1.7);
  EXPECT_LT(order(a, b), 3);
}

}  // namespace
}  // namespace adamas
