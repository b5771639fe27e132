#include "interfaces/reconstruction/linear_system.h"

#include <algorithm>

namespace adamas {

namespace {

constexpr int kMostSteps = 80;
/// The squared gradient falls to this part.
constexpr double kSolved = 1e-5;

}  // namespace

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

double sum_of_squares(const std::vector<double>& v) {
  double sum = 0;
  for (const double x : v) sum += x * x;
  return sum;
}

std::vector<double> LinearSystem::solve(std::size_t unknowns, double damping) const {
  std::vector<double> x(unknowns, 0), gradient(unknowns), residual = missing, image(residual.size());
  multiply_transposed(residual, gradient);
  std::vector<double> way = gradient;
  double now = sum_of_squares(gradient);
  const double enough = kSolved * now;
  for (int step = 0; step < kMostSteps && now > enough; ++step) {
    multiply(way, image);
    const double length = now / (sum_of_squares(image) + damping * sum_of_squares(way));
    for (std::size_t i = 0; i < unknowns; ++i) x[i] += length * way[i];
    for (std::size_t i = 0; i < residual.size(); ++i) residual[i] -= length * image[i];
    multiply_transposed(residual, gradient);
    for (std::size_t i = 0; i < unknowns; ++i) gradient[i] -= damping * x[i];
    const double next = sum_of_squares(gradient);
    for (std::size_t i = 0; i < unknowns; ++i) way[i] = gradient[i] + next / now * way[i];
    now = next;
  }
  return x;
}

}  // namespace adamas
