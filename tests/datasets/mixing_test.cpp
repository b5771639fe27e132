// Compares the flow of `generate mixing` with exact solutions, laws and the theory of Richtmyer.

#include "datasets/flow/mixing.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <cstring>
#include <numbers>

#include "core/base/parallel.h"
#include "datasets/flow/mixing_samples.h"
#include "datasets/flow/ripples.h"
#include "tests/support/exact_riemann.h"

namespace adamas {

using namespace datasets;

namespace {

using test::ExactRiemann;
using test::GasState;

constexpr GasState kAirAtRest{1.204, 0, 101325, 1.4, 0}, kHexafluorideAtRest{6.07, 0, 101325, 1.094, 0};

/// Returns the state of the air behind the shock, as seen from the gases at rest.
GasState shocked_air(const ShockedInterface& shock) {
  return {shock.shock_density, shock.shock_velocity, shock.shock_pressure, 1.4, 0};
}

TEST(ShockedInterface, AgreesWithTheExactSolution) {
  for (const double mach : {1.01, 1.5, 2.0, 6.0, 10.0}) {
    const ShockedInterface shock = mixing_shock(mach);
    EXPECT_NEAR(shock.shock_speed, mach * std::sqrt(1.4 * 101325 / 1.204), 1e-9 * shock.shock_speed);
    // Before the interface is struck there is the shock alone.
    const ExactRiemann before(shocked_air(shock), kAirAtRest);
    EXPECT_NEAR(before.at(0.999 * shock.shock_speed).pressure / shock.shock_pressure, 1, 1e-9);
    EXPECT_NEAR(before.at(1.001 * shock.shock_speed).pressure / kAirAtRest.pressure, 1, 1e-9);
    // Afterwards there are two shocks, one backwards and one forwards.
    const ExactRiemann after(shocked_air(shock), kHexafluorideAtRest);
    EXPECT_NEAR(after.pressure() / shock.pressure, 1, 1e-9);
    EXPECT_NEAR(after.velocity() / shock.velocity, 1, 1e-9);
    const double room = 1e-3 * shock.through_speed;
    EXPECT_NEAR(after.at(shock.reflected_speed + room).density / shock.reflected_density, 1, 1e-9);
    EXPECT_NEAR(after.at(shock.reflected_speed - room).density / shock.shock_density, 1, 1e-9);
    EXPECT_NEAR(after.at(shock.through_speed - room).density / shock.through_density, 1, 1e-9);
    EXPECT_NEAR(after.at(shock.through_speed + room).density / kHexafluorideAtRest.density, 1, 1e-9);
  }
}

/// Mean differences between a tube without ripples and the exact solution after the interface was struck,
/// relative to the states on both sides of the interface.
struct TubeErrors {
  double density = 0, velocity = 0, pressure = 0;
};

TubeErrors tube_errors(std::size_t cells, double mach) {
  const ShockedInterface shock = mixing_shock(mach);
  MixingOptions options;
  options.cells = {1, 1, cells};
  options.mach = mach;
  MixingFlow flow(options);
  const double since = 0.03 / (shock.velocity - shock.reflected_speed);
  flow.advance_to(mixing_strike_time(mach) + since);
  const ExactRiemann exact(shocked_air(shock), kHexafluorideAtRest);
  TubeErrors errors;
  for (std::size_t k = 0; k < cells; ++k) {
    const double part = 1 / static_cast<double>(cells);
    const double z = (static_cast<double>(k) + 0.5) * part * kMixingLength;
    const GasState expected = exact.at((z - mixing_place()) / since + shock.velocity);
    const FlowCell<2> cell = flow.solver().cell(0, 0, k);
    errors.density += part * std::abs(mixing_density(cell) - expected.density) / shock.through_density;
    errors.velocity += part * std::abs(cell.velocity.z + shock.velocity - expected.velocity) / shock.velocity;
    errors.pressure += part * std::abs(cell.pressure - expected.pressure) / shock.pressure;
  }
  return errors;
}

TEST(Mixing, WithoutRipplesItConvergesToTheExactSolution) {
  for (const double mach : {1.5, 4.0}) {
    const TubeErrors coarse = tube_errors(100, mach), fine = tube_errors(400, mach);
    for (const auto& [c, f] : {std::pair{coarse.density, fine.density},
                               {coarse.velocity, fine.velocity},
                               {coarse.pressure, fine.pressure}}) {
      EXPECT_LT(f, 0.01) << mach;
      // The order is about one, as for all flows with jumps.
      const double order = 0.5 * std::log2(c / f);
      EXPECT_GT(order, 0.6) << mach;
      EXPECT_LT(order, 1.4) << mach;
    }
  }
}

TEST(Mixing, OpenEndsLetShocksPass) {
  MixingOptions options;
  options.cells = {1, 1, 100};
  MixingFlow flow(options);
  flow.advance_to(2 * kMixingTime);
  const ShockedInterface shock = mixing_shock(options.mach);
  for (std::size_t k = 0; k < 100; ++k) {
    const FlowCell<2> cell = flow.solver().cell(0, 0, k);
    EXPECT_NEAR(cell.pressure / shock.pressure, 1, 0.03) << k;
    EXPECT_NEAR(cell.velocity.z / shock.velocity, 0, 0.03) << k;
    EXPECT_EQ(cell.fractions[kAir] > 0.5, k < 50) << k;
  }
}

TEST(Mixing, WhatEntersAndLeavesIsAccountedFor) {
  MixingOptions options;
  options.cells = {12, 8, 16};
  options.ripples = 0.05;
  MixingFlow flow(options);
  const FlowLedger<2> before = flow.solver().inside();
  flow.advance_to(kMixingTime);
  const FlowLedger<2> after = flow.solver().inside(), entered = flow.solver().entered();
  for (std::size_t m = 0; m < 2; ++m) {
    EXPECT_GT(entered.mass[m], 0.01 * before.mass[m]);
    EXPECT_NEAR((after.mass[m] - entered.mass[m]) / before.mass[m], 1, 1e-12);
  }
  EXPECT_NEAR((after.energy - entered.energy) / before.energy, 1, 1e-12);
}

/// Returns the Fourier coefficient of the interface's height for this number of waves along x.
std::complex<double> wave_of(const FlowSolver<2>& flow, double waves) {
  const auto& n = flow.problem().cells;
  std::complex<double> sum = 0;
  for (std::size_t i = 0; i < n[0]; ++i) {
    double air = 0;
    for (std::size_t k = 0; k < n[2]; ++k) air += flow.cell(i, 0, k).fractions[kAir];
    const double x = (static_cast<double>(i) + 0.5) / static_cast<double>(n[0]);
    sum += std::polar(air * kMixingLength / static_cast<double>(n[2]), -2 * std::numbers::pi * waves * x);
  }
  return 2.0 / static_cast<double>(n[0]) * sum;
}

TEST(Mixing, RipplesGrowAtFirstAsRichtmyerSays) {
  MixingOptions options;
  options.cells = {96, 1, 96};
  options.ripples = 0.004;
  options.mach = 1.2;
  const ShockedInterface shock = mixing_shock(options.mach);
  MixingFlow flow(options);
  const double width = flow.solver().problem().box.max.x;
  const std::complex<double> start = wave_of(flow.solver(), 2);
  const double k = 2 * std::numbers::pi * 2 / width, struck = mixing_strike_time(options.mach);
  // At this time the shocks are half a wave away, and the ripple is not yet steep.
  const double first = struck + 3 / (k * (shock.through_speed - shock.velocity)), second = first + 1e-4;
  flow.advance_to(first);
  const std::complex<double> early = wave_of(flow.solver(), 2);
  flow.advance_to(second);
  const std::complex<double> late = wave_of(flow.solver(), 2);
  ASSERT_LT(k * std::abs(late), 0.1);
  const double speed = std::real((late - early) * std::conj(start)) / std::abs(start) / (second - first);
  const double squeezed = std::abs(start) * (1 - shock.velocity / shock.shock_speed);
  const double atwood =
      (shock.through_density - shock.reflected_density) / (shock.through_density + shock.reflected_density);
  // On 192 and 288 cells the two speeds differ by 0.6% and 0.1%.
  EXPECT_NEAR(speed / (k * shock.velocity * atwood * squeezed), 1, 0.1);
}

TEST(Mixing, RipplesHaveTheirHeightAndComeBackAtOtherResolutions) {
  const auto part = [](const Ripples& ripples, std::size_t i, std::size_t j) {
    double height = 0;
    for (double low = -20; low < 20; ++low) height += 1 - ripples.part_above(i, j, low);
    return height - 20;
  };
  const Ripples fine({64, 48, 64}, 1, 5, 3), coarse({32, 24, 32}, 2, 5, 3), other({32, 24, 32}, 2, 6, 3);
  double mean = 0, square = 0, difference = 0, other_difference = 0;
  for (std::size_t j = 0; j < 24; ++j) {
    for (std::size_t i = 0; i < 32; ++i) {
      const double of_fine = 0.25 * (part(fine, 2 * i, 2 * j) + part(fine, 2 * i + 1, 2 * j) +
                                     part(fine, 2 * i, 2 * j + 1) + part(fine, 2 * i + 1, 2 * j + 1));
      const double height = 2 * part(coarse, i, j);
      mean += height / (32 * 24);
      square += height * height / (32 * 24);
      difference = std::max(difference, std::abs(height - of_fine));
      other_difference = std::max(other_difference, std::abs(height - 2 * part(other, i, j)));
    }
  }
  EXPECT_NEAR(mean, 0, 1e-5);
  // Each column is a mean over a cell.
  EXPECT_NEAR(std::sqrt(square), 3, 0.15);
  EXPECT_LT(difference, 0.06);
  EXPECT_GT(other_difference, 3);
}

TEST(Mixing, SamplesStandForTheFieldsOnOneScale) {
  MixingOptions options;
  options.cells = {10, 9, 16};
  MixingFlow flow(options);
  for (const SampleType type : {SampleType::kUint8, SampleType::kUint16, SampleType::kFloat32}) {
    MixingSamples samples(options.cells, options.mach, type);
    for (const double time : {0.0, 2e-4}) {
      flow.advance_to(time);
      samples.update(flow.solver());
      for (const MixingField& field : samples.fields()) {
        ASSERT_EQ(field.samples.size(), samples.grid().bytes());
        const double off = type == SampleType::kFloat32 ? 1e-3 : 0.501 * field.scale.slope();
        EXPECT_EQ(field.cut_off, 0u);
        for (std::size_t at = 0; at < 10 * 9 * 16; ++at) {
          const FlowCell<2> cell = flow.solver().cell(at % 10, at / 10 % 9, at / 90);
          double sample = 0;
          if (type == SampleType::kUint8) sample = static_cast<double>(field.samples[at]);
          if (type == SampleType::kUint16) {
            std::uint16_t s = 0;
            std::memcpy(&s, &field.samples[2 * at], 2);
            sample = s;
          }
          if (type == SampleType::kFloat32) {
            float s = 0;
            std::memcpy(&s, &field.samples[4 * at], 4);
            sample = static_cast<double>(s);
          }
          const bool is_density = std::string_view(field.name) == "density";
          const double value = is_density ? mixing_density(cell) : mixing_entropy(cell);
          ASSERT_NEAR(field.scale.slope() * sample + field.scale.intercept(), value, off) << field.name;
          ASSERT_LE(field.least, value);
          ASSERT_GE(field.greatest, value);
        }
      }
    }
  }
}

TEST(Mixing, EntropyStaysInSmoothFlowsAndRisesInShocks) {
  FlowCell<2> cell;
  cell.fractions = {1, 0};
  cell.densities = {1.204, 6.07};
  cell.pressure = 101325;
  EXPECT_NEAR(mixing_entropy(cell), 0, 1e-10);
  // The air is compressed without a shock.
  cell.densities[kAir] *= 2;
  cell.pressure *= std::pow(2, 1.4);
  EXPECT_NEAR(mixing_entropy(cell), 0, 1e-9);
  const ShockedInterface shock = mixing_shock(2);
  cell.densities[kAir] = shock.shock_density;
  cell.pressure = shock.shock_pressure;
  EXPECT_GT(mixing_entropy(cell), 50);
}

TEST(Mixing, TheNumberOfThreadsChangesNothing) {
  std::vector<std::vector<std::byte>> found;
  for (const unsigned threads : {1u, 2u, 3u}) {
    set_thread_limit(threads);
    MixingOptions options;
    options.cells = {16, 12, 20};
    MixingFlow flow(options);
    flow.advance_to(3e-4);
    MixingSamples samples(options.cells, options.mach, SampleType::kFloat32);
    samples.update(flow.solver());
    found.push_back(samples.fields()[0].samples);
    found.push_back(samples.fields()[1].samples);
  }
  set_thread_limit(0);
  for (std::size_t i = 2; i < found.size(); ++i) EXPECT_EQ(found[i], found[i - 2]);
}

TEST(Mixing, AbsurdOptionsAreRefused) {
  for (const MixingOptions& options :
       {MixingOptions{{8, 8, 7}}, MixingOptions{{0, 8, 8}}, MixingOptions{{1000000, 1000000, 1000}},
        MixingOptions{{8, 8, 8}, 0, 1}, MixingOptions{{8, 8, 8}, 0, 11}, MixingOptions{{8, 8, 8}, 0, NAN}}) {
    try {
      MixingFlow flow(options);
      ADD_FAILURE() << "expected an error";
    } catch (const Error& e) {
      EXPECT_NE(std::string(e.what()).find("mixing: expected"), std::string::npos) << e.what();
    }
  }
}

}  // namespace
}  // namespace adamas
