#include "datasets/fraction_blur.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/base/hash.h"
#include "core/base/parallel.h"
#include "datasets/random_numbers.h"

namespace adamas::datasets {

namespace {

/// Fractions nearer to 0 or 1 get no noise, so that cells of one material stay so.
constexpr double kMixed = 1e-4;
constexpr std::size_t kRowsPerChunk = 64;

/// The weights of the Gaussian from the middle one on.
std::vector<double> half_gaussian(double blur) {
  std::vector<double> weights(static_cast<std::size_t>(4 * blur + 1) + 1);
  double sum = 0;
  for (std::size_t k = 0; k < weights.size(); ++k) {
    // If the blur is close to zero, the quotient is infinite, and its weight 0.
    const double distance = k == 0 ? 0 : static_cast<double>(k) / blur;
    weights[k] = std::exp(-0.5 * distance * distance);
    sum += (k == 0 ? 1 : 2) * weights[k];
  }
  for (double& weight : weights) weight /= sum;
  return weights;
}

/// The rows of cells along one axis.
struct Rows {
  std::size_t length, stride, count;
  [[nodiscard]] std::size_t first(std::size_t row) const {
    return row / stride * stride * length + row % stride;
  }
};

void blur_row(float* first, const Rows& rows, const std::vector<double>& weights, std::vector<double>& row) {
  const std::size_t reach = weights.size() - 1;
  row.resize(rows.length + 2 * reach);
  for (std::size_t i = 0; i < row.size(); ++i) {
    const std::size_t from = std::clamp(i, reach, reach + rows.length - 1) - reach;
    row[i] = static_cast<double>(first[from * rows.stride]);
  }
  for (std::size_t i = 0; i < rows.length; ++i) {
    const double* const middle = row.data() + reach + i;
    double sum = weights[0] * *middle;
    for (std::size_t k = 1; k <= reach; ++k) sum += weights[k] * (middle[k] + *(middle - k));
    first[i * rows.stride] = static_cast<float>(sum);
  }
}

}  // namespace

void check(const FractionBlur& blur) {
  if (!(blur.blur >= 0 && blur.blur <= kGreatestBlur))
    wrong_usage("--blur: expected a number from 0 to {}, found '{}'", kGreatestBlur, blur.blur);
  if (!(blur.noise >= 0 && blur.noise <= kGreatestNoise))
    wrong_usage("--noise: expected a part from 0 to {}, or from 0% to {}%, found '{}'", kGreatestNoise,
                100 * kGreatestNoise, blur.noise);
}

void blur_cells(std::span<float> values, const std::array<std::size_t, 3>& cells, double blur) {
  if (blur == 0) return;
  const std::vector<double> weights = half_gaussian(blur);
  std::size_t stride = 1;
  for (const std::size_t length : cells) {
    const Rows rows{length, stride, values.size() / length};
    parallel_chunks(rows.count, kRowsPerChunk, [&](std::size_t begin, std::size_t end) {
      std::vector<double> row;
      for (std::size_t r = begin; r < end; ++r) blur_row(values.data() + rows.first(r), rows, weights, row);
    });
    stride *= length;
  }
}

void add_noise(std::vector<double>& fractions, double noise, std::uint64_t seed, std::size_t cell) {
  RandomNumbers random(mix64(seed) ^ cell);
  std::vector<double> noisy = fractions;
  double sum = 0;
  for (double& f : noisy) {
    if (f > kMixed && f < 1 - kMixed) f = std::clamp(f + noise * random.normal(), 0.0, 1.0);
    sum += f;
  }
  if (!(sum > 0)) return;
  for (double& f : noisy) f /= sum;
  fractions = std::move(noisy);
}

}  // namespace adamas::datasets
