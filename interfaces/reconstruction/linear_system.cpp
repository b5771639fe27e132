#include "interfaces/reconstruction/linear_system.h"

#include <algorithm>
#include <cmath>

namespace adamas {

namespace {

constexpr int kMostSteps = 60;
/// The squared gradient, scaled, falls to this part.
constexpr double kSolved = 1e-5;
/// Rows that miss more than this, as a part of a cell, weigh less than others, down to the least weight.
constexpr double kSmall = 2e-3, kLeastWeight = 0.05;

double weight_of(double missing) {
  const double size = std::abs(missing);
  return size <= kSmall ? 1 : std::max(kSmall / size, kLeastWeight);
}

}  // namespace

double cost_of(double missing) {
  constexpr double kGreat = kSmall / kLeastWeight;
  const double size = std::abs(missing), size_of_linear = std::min(size, kGreat);
  if (size <= kSmall) return size * size;
  return kSmall * (2 * size_of_linear - kSmall) +
         kLeastWeight * (size * size - size_of_linear * size_of_linear);
}

double LinearSystem::cost() const {
  double sum = 0;
  for (const double m : missing) sum += cost_of(m);
  return sum;
}

std::size_t LinearSystem::cells_off() const {
  std::size_t sum = 0;
  for (const Block& block : blocks) sum += block.cells_off;
  return sum;
}

void LinearSystem::multiply(const std::vector<double>& x, std::vector<double>& rows) const {
  std::fill(rows.begin(), rows.end(), 0.0);
  for (const auto& [exchanges, coefficients, off] : blocks) {
    for (const Exchange& exchange : exchanges) {
      double sum = 0;
      for (std::uint32_t c = exchange.first; c < exchange.first + exchange.count; ++c)
        sum += static_cast<double>(coefficients[c].by) * x[coefficients[c].unknown];
      rows[exchange.gains] += sum;
      rows[exchange.loses] -= sum;
    }
  }
}

void LinearSystem::multiply_transposed(const std::vector<double>& rows, std::vector<double>& x) const {
  std::fill(x.begin(), x.end(), 0.0);
  for (const auto& [exchanges, coefficients, off] : blocks) {
    for (const Exchange& exchange : exchanges) {
      const double gain = rows[exchange.gains] - rows[exchange.loses];
      for (std::uint32_t c = exchange.first; c < exchange.first + exchange.count; ++c)
        x[coefficients[c].unknown] += static_cast<double>(coefficients[c].by) * gain;
    }
  }
}

/// The inverse of the normal equations' diagonal.
std::vector<double> LinearSystem::preconditioner(const std::vector<double>& weight, std::size_t unknowns,
                                                 double damping) const {
  std::vector<double> scale(unknowns, damping);
  for (const auto& [exchanges, coefficients, off] : blocks) {
    for (const Exchange& exchange : exchanges) {
      const double w = weight[exchange.gains] + weight[exchange.loses];
      for (std::uint32_t c = exchange.first; c < exchange.first + exchange.count; ++c) {
        const auto by = static_cast<double>(coefficients[c].by);
        scale[coefficients[c].unknown] += w * by * by;
      }
    }
  }
  for (double& s : scale) s = 1 / s;
  return scale;
}

std::vector<double> LinearSystem::solve(std::size_t unknowns, double damping) const {
  const std::size_t rows = missing.size();
  std::vector<double> weight(rows), residual(rows), image(rows);  // the residual is weighted
  for (std::size_t i = 0; i < rows; ++i) {
    weight[i] = weight_of(missing[i]);
    residual[i] = weight[i] * missing[i];
  }
  const std::vector<double> scale = preconditioner(weight, unknowns, damping);
  std::vector<double> x(unknowns, 0), gradient(unknowns), way(unknowns, 0);
  double before = 1, enough = 0;
  for (int step = 0; step < kMostSteps; ++step) {
    multiply_transposed(residual, gradient);
    double now = 0;
    for (std::size_t i = 0; i < unknowns; ++i) {
      gradient[i] -= damping * x[i];
      now += scale[i] * gradient[i] * gradient[i];
    }
    if (step == 0) enough = kSolved * now;
    if (now <= enough) break;
    const double turn = step == 0 ? 0 : now / before;
    double squares = 0;
    for (std::size_t i = 0; i < unknowns; ++i) {
      way[i] = scale[i] * gradient[i] + turn * way[i];
      squares += damping * way[i] * way[i];
    }
    multiply(way, image);
    for (std::size_t i = 0; i < rows; ++i) squares += weight[i] * image[i] * image[i];
    const double length = now / squares;
    for (std::size_t i = 0; i < unknowns; ++i) x[i] += length * way[i];
    for (std::size_t i = 0; i < rows; ++i) residual[i] -= length * weight[i] * image[i];
    before = now;
  }
  return x;
}

}  // namespace adamas
