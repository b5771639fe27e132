#include "interfaces/reconstruction/volume_system.h"

#include <algorithm>
#include <cmath>

#include "core/base/loop_progress.h"

namespace adamas::interfaces {

namespace {

constexpr int kMostSteps = 60;
/// Conjugate gradients end when the scaled squared gradient has fallen to this part.
constexpr double kSolved = 1e-5;
/// Rows that miss more than this, as a part of a cell, weigh less than others, down to the least weight.
constexpr double kSmall = 2e-3, kLeastWeight = 0.05;

double weight_of(double missing) {
  const double size = std::abs(missing);
  return size <= kSmall ? 1 : std::max(kSmall / size, kLeastWeight);
}

}  // namespace

double VolumeSystem::cost_of(double missing) {
  constexpr double kGreat = kSmall / kLeastWeight;
  const double size = std::abs(missing), size_of_linear = std::min(size, kGreat);
  if (size <= kSmall) return size * size;
  return kSmall * (2 * size_of_linear - kSmall) +
         kLeastWeight * (size * size - size_of_linear * size_of_linear);
}

double VolumeSystem::cost() const {
  double sum = 0;
  for (const double m : missing) sum += cost_of(m);
  return sum;
}

std::size_t VolumeSystem::cells_off() const {
  std::size_t sum = 0;
  for (const Block& block : blocks) sum += block.cells_off;
  return sum;
}

/// Adds to `rows` what the volumes of a block's cells gain by a move of the unknowns.
void VolumeSystem::add_gains(const Block& block, const std::vector<double>& move, std::vector<double>& rows) {
  for (const Exchange& exchange : block.exchanges) {
    double sum = 0;
    for (std::uint32_t c = exchange.first; c < exchange.first + exchange.count; ++c)
      sum += static_cast<double>(block.coefficients[c].by) * move[block.coefficients[c].unknown];
    rows[exchange.gains] += sum;
    rows[exchange.loses] -= sum;
  }
}

/// Adds the product of the transposed matrix of a block and the rows.
void VolumeSystem::add_gradients(const Block& block, const std::vector<double>& rows,
                                 std::vector<double>& gradient) {
  for (const Exchange& exchange : block.exchanges) {
    const double gain = rows[exchange.gains] - rows[exchange.loses];
    for (std::uint32_t c = exchange.first; c < exchange.first + exchange.count; ++c)
      gradient[block.coefficients[c].unknown] += static_cast<double>(block.coefficients[c].by) * gain;
  }
}

/// Returns the inverse of the normal equations' diagonal.
std::vector<double> VolumeSystem::preconditioner(const std::vector<double>& weight,
                                                 const std::vector<double>& damping) const {
  std::vector<double> scale = damping;
  for (const Block& block : blocks) {
    for (const Exchange& exchange : block.exchanges) {
      const double w = weight[exchange.gains] + weight[exchange.loses];
      for (std::uint32_t c = exchange.first; c < exchange.first + exchange.count; ++c) {
        const auto by = static_cast<double>(block.coefficients[c].by);
        scale[block.coefficients[c].unknown] += w * by * by;
      }
    }
  }
  for (double& s : scale) s = 1 / s;
  return scale;
}

std::vector<double> VolumeSystem::solve(const std::vector<double>& damping) const {
  const std::size_t unknowns = damping.size();
  const std::size_t row_count = missing.size();
  std::vector<double> weight(row_count), rows(row_count), gradient(unknowns, 0);
  for (std::size_t i = 0; i < row_count; ++i) {
    weight[i] = weight_of(missing[i]);
    rows[i] = weight[i] * missing[i];
  }
  for (const Block& block : blocks) add_gradients(block, rows, gradient);
  const std::vector<double> scale = preconditioner(weight, damping);
  std::vector<double> x(unknowns, 0), way(unknowns, 0), bend(unknowns);
  double before = 1, enough = 0;
  for (int step = 0; step < kMostSteps; ++step) {
    LoopProgress::check();
    double now = 0;
    for (std::size_t i = 0; i < unknowns; ++i) now += scale[i] * gradient[i] * gradient[i];
    if (step == 0) enough = kSolved * now;
    if (now <= enough) break;
    const double turn = step == 0 ? 0 : now / before;
    for (std::size_t i = 0; i < unknowns; ++i) {
      way[i] = scale[i] * gradient[i] + turn * way[i];
      bend[i] = damping[i] * way[i];
    }
    // No other block has a block's rows, so one pass over the coefficients is enough, while the rows are in
    // the cache.
    std::fill(rows.begin(), rows.end(), 0.0);
    for (const Block& block : blocks) {
      add_gains(block, way, rows);
      for (std::uint32_t i = block.first_row; i < block.last_row; ++i) rows[i] *= weight[i];
      add_gradients(block, rows, bend);
    }
    double squares = 0;
    for (std::size_t i = 0; i < unknowns; ++i) squares += way[i] * bend[i];
    const double length = now / squares;
    for (std::size_t i = 0; i < unknowns; ++i) {
      x[i] += length * way[i];
      gradient[i] -= length * bend[i];
    }
    before = now;
  }
  return x;
}

}  // namespace adamas::interfaces
