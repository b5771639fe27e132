#include "isosurface/gradients/gradient_smoothing.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/base/assert.h"
#include "core/base/parallel.h"

namespace adamas {

namespace {

/// Gradients are degenerate below this part of the root mean square.
constexpr double kDegenerate = 1e-6;

double squared_length(const Gradient& g) {
  const double x = g[0], y = g[1], z = g[2];
  return x * x + y * y + z * z;
}

/// A sum of gradients and of their weights.
using Sum = std::array<float, 4>;

/// (a + c) + 2 b, which is the same for a reflected block.
Sum blended(const Sum& a, const Sum& b, const Sum& c) {
  Sum result;
  for (std::size_t n = 0; n < 4; ++n) result[n] = (a[n] + c[n]) + 2 * b[n];
  return result;
}

class Smoother {
 public:
  Smoother(std::span<Gradient> gradients, const std::array<std::size_t, 3>& dimensions)
      : gradients_(gradients), dimensions_(dimensions), nothing_(dimensions[0]) {
    double sum = 0;
    std::size_t count = 0;
    for (const Gradient& g : gradients) {
      const double square = squared_length(g);
      sum += square;
      count += square > 0 ? 1 : 0;
    }
    mean_square_ = count > 0 ? sum / static_cast<double>(count) : 0;
    least_square_ = kDegenerate * kDegenerate * mean_square_;
    for (auto& plane : planes_) plane.resize(dimensions[0] * dimensions[1]);
  }

  [[nodiscard]] double mean_square() const { return mean_square_; }
  [[nodiscard]] bool is_degenerate(const Gradient& g) const { return !(squared_length(g) > least_square_); }

  /// Every gradient becomes update(index, average), where there is an average.
  template <class Update>
  void round(Update&& update) {
    sum_rows(0);
    for (std::size_t k = 0; k < dimensions_[2]; ++k) {
      if (k + 1 < dimensions_[2]) sum_rows(k + 1);
      update_plane(k, update);
    }
  }

 private:
  void sum_rows(std::size_t k);
  template <class Update>
  void update_plane(std::size_t k, Update&& update);

  /// Sums along i of the row at (j, k), or zeros beyond the block; of the planes k - 1, k and k + 1 alone.
  [[nodiscard]] const Sum* sums(std::size_t j, std::size_t k) const {
    if (j >= dimensions_[1] || k >= dimensions_[2]) return nothing_.data();
    return planes_[k % 3].data() + j * dimensions_[0];
  }
  [[nodiscard]] std::size_t row_grain() const { return 1 + 4096 / dimensions_[0]; }

  std::span<Gradient> gradients_;
  std::array<std::size_t, 3> dimensions_;
  double mean_square_ = 0, least_square_ = 0;
  std::array<std::vector<Sum>, 3> planes_;  ///< plane k is at k % 3
  std::vector<Sum> nothing_;
};

void Smoother::sum_rows(std::size_t k) {
  const auto [ni, nj, nk] = dimensions_;
  const std::size_t count = ni;
  const Gradient* const plane = gradients_.data() + k * ni * nj;
  std::vector<Sum>& sums_of_plane = planes_[k % 3];
  const auto term = [this](const Gradient& g) { return is_degenerate(g) ? Sum{} : Sum{g[0], g[1], g[2], 1}; };
  parallel_for(nj, row_grain(), [&](std::size_t j) {
    const Gradient* const row = plane + j * count;
    Sum* const to = sums_of_plane.data() + j * count;
    Sum before{}, here = term(row[0]);
    for (std::size_t i = 0; i < count; ++i) {
      const Sum after = i + 1 < count ? term(row[i + 1]) : Sum{};
      to[i] = blended(before, here, after);
      before = here;
      here = after;
    }
  });
}

template <class Update>
void Smoother::update_plane(std::size_t k, Update&& update) {
  const std::size_t count = dimensions_[0];
  parallel_for(dimensions_[1], row_grain(), [&, this](std::size_t j) {
    std::array<const Sum*, 9> rows;
    // Beyond the first row and plane the indices wrap to values that are beyond the last.
    for (std::size_t n = 0; n < 9; ++n) rows[n] = sums(j + n % 3 - 1, k + n / 3 - 1);
    const std::size_t first = (k * dimensions_[1] + j) * count;
    for (std::size_t i = 0; i < count; ++i) {
      std::array<Sum, 3> by_plane;
      for (std::size_t n = 0; n < 3; ++n) {
        by_plane[n] = blended(rows[3 * n][i], rows[3 * n + 1][i], rows[3 * n + 2][i]);
      }
      const Sum sum = blended(by_plane[0], by_plane[1], by_plane[2]);
      if (sum[3] == 0) continue;
      const Gradient average{sum[0] / sum[3], sum[1] / sum[3], sum[2] / sum[3]};
      if (!is_degenerate(average)) gradients_[first + i] = update(first + i, average);
    }
  });
}

/// As near to the average as the freedom `most` |g| |average - g| allows.
Gradient constrained(const Gradient& g, const Gradient& average, double most) {
  const Gradient step{average[0] - g[0], average[1] - g[1], average[2] - g[2]};
  const double product = std::sqrt(squared_length(g)) * std::sqrt(squared_length(step));
  if (product <= most) return average;
  const double part = most / product;
  Gradient result;
  for (std::size_t n = 0; n < 3; ++n) {
    result[n] = static_cast<float>(double{g[n]} + part * double{step[n]});
  }
  return result;
}

}  // namespace

std::size_t smooth_gradients(std::span<Gradient> gradients, const std::array<std::size_t, 3>& dimensions,
                             const GradientSmoothingOptions& options, Progress& progress) {
  ADAMAS_ASSERT(gradients.size() == dimensions[0] * dimensions[1] * dimensions[2]);
  ADAMAS_ASSERT(options.free_rounds >= 0 && options.constrained_rounds >= 0 && options.freedom >= 0);
  if (gradients.empty()) return 0;
  Smoother smoother(gradients, dimensions);
  int done = 0;
  const auto step = [&] {
    const int all = options.free_rounds + options.constrained_rounds;
    progress.step("smoothing gradients", static_cast<double>(done++) / all);
  };
  // What holds a gradient in the second phase; zero where it was degenerate, and nothing holds it.
  std::vector<Gradient> anchors;
  if (options.constrained_rounds > 0) anchors.assign(gradients.begin(), gradients.end());
  for (int n = 0; n < options.free_rounds; ++n) {
    step();
    smoother.round([](std::size_t, const Gradient& average) { return average; });
  }
  for (std::size_t i = 0; i < anchors.size(); ++i) {
    anchors[i] = smoother.is_degenerate(anchors[i]) ? Gradient{} : gradients[i];
  }
  const double most = options.freedom * smoother.mean_square();
  for (int n = 0; n < options.constrained_rounds; ++n) {
    step();
    smoother.round([&](std::size_t i, const Gradient& average) {
      const Gradient& g = anchors[i];
      return squared_length(g) > 0 ? constrained(g, average, most) : average;
    });
  }
  return static_cast<std::size_t>(std::count_if(
      gradients.begin(), gradients.end(), [&](const Gradient& g) { return smoother.is_degenerate(g); }));
}

}  // namespace adamas
