#include "interfaces/reconstruction/normal_distribution.h"

namespace adamas::interfaces {

const NormalTable& NormalTable::instance() {
  static const NormalTable kTable;
  return kTable;
}

NormalTable::NormalTable() {
  for (std::size_t n = 0; n < nodes_.size(); ++n) {
    const double x = (static_cast<double>(n) - kMiddle) / kPerUnit;
    nodes_[n] = {normal_probability(x), normal_density(x)};
  }
}

double normal_quantile(double p) {
  // The quantile is computed from the nearer tail, where nothing cancels, by a rational function (Abramowitz
  // and Stegun, Handbook of Mathematical Functions, 26.2.23), and two steps of Halley's method.
  if (p > 0.5) return -normal_quantile(1 - p);
  const double t = std::sqrt(-2 * std::log(p));
  double x =
      (2.515517 + t * (0.802853 + t * 0.010328)) / (1 + t * (1.432788 + t * (0.189269 + t * 0.001308))) - t;
  constexpr double kInTable = 1e-3;
  for (int step = 0; step < 2; ++step) {
    const NormalValue there =
        p < kInTable ? NormalValue{normal_probability(x), normal_density(x)} : NormalTable::instance().at(x);
    const double by = (there.probability - p) / there.density;
    x -= by / (1 + 0.5 * x * by);
  }
  return x;
}

}  // namespace adamas::interfaces
