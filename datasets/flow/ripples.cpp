#include "datasets/flow/ripples.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/parallel.h"
#include "datasets/random_numbers.h"

namespace adamas::datasets {

namespace {

constexpr double kTurn = 2 * std::numbers::pi;
constexpr double kCellsOfAWave = 4;

}  // namespace

Ripples::Ripples(const std::array<std::size_t, 3>& cells, double size, std::uint64_t seed, double height)
    : columns_(cells[0]), heights_(cells[0] * cells[1]) {
  find_waves(cells, seed);
  // The mean square of each cosine is one half.
  const double amplitude = height / size * std::sqrt(2 / std::max(1.0, static_cast<double>(waves_.size())));
  const auto part = [](std::size_t cell, std::size_t point, std::size_t count) {
    const double at = static_cast<double>(cell) + (static_cast<double>(point) + 0.5) / kPoints;
    return at / static_cast<double>(count);
  };
  parallel_for(cells[1], 1, [&](std::size_t j) {
    for (std::size_t i = 0; i < cells[0]; ++i) {
      for (std::size_t p = 0; p < kPoints * kPoints; ++p) {
        const double x = part(i, p % kPoints, cells[0]), y = part(j, p / kPoints, cells[1]);
        double sum = 0;
        for (const Wave& w : waves_) sum += std::cos(kTurn * (w.along_x * x + w.along_y * y) + w.phase);
        heights_[i + columns_ * j][p] = static_cast<float>(amplitude * sum);
      }
    }
  });
}

void Ripples::find_waves(const std::array<std::size_t, 3>& cells, std::uint64_t seed) {
  RandomNumbers random(seed);
  const double nx = static_cast<double>(cells[0]), ny = static_cast<double>(cells[1]);
  const double width = std::max(nx, ny);
  // A wave and the one of opposite direction are the same.
  for (double x = 0; x <= kMostWaves; ++x) {
    for (double y = -kMostWaves; y <= kMostWaves; ++y) {
      if (x == 0 && y <= 0) continue;
      const double phase = random.uniform(0, kTurn);
      const double waves = std::hypot(x * width / nx, y * width / ny);
      if (waves < kFewestWaves || waves > kMostWaves) continue;
      if (kCellsOfAWave * x > nx || kCellsOfAWave * std::abs(y) > ny) continue;
      waves_.push_back({x, y, phase});
    }
  }
}

double Ripples::part_above(std::size_t i, std::size_t j, double low) const {
  double sum = 0;
  for (const float height : heights_[i + columns_ * j])
    sum += std::clamp(low + 1 - static_cast<double>(height), 0.0, 1.0);
  return sum / (kPoints * kPoints);
}

}  // namespace adamas::datasets
