#include "isosurface/gradients/smoothing_round.h"

#include <algorithm>

namespace adamas::isosurface {

void GradientScale::add(std::span<const Gradient> gradients) {
  for (const Gradient& g : gradients) {
    const double square = squared_length(g);
    sum_ += square;
    count_ += square > 0 ? 1 : 0;
  }
}

SmoothingRound::SmoothingRound(double least_square, std::size_t ni, std::size_t nj)
    : least_square_(least_square), ni_(ni), nj_(nj), before_(ni * nj), here_(ni * nj), held_(ni * nj) {}

void SmoothingRound::sum_row(std::span<const Gradient> plane, std::size_t j, Sums& sums) const {
  if (j >= nj_) {
    std::fill(sums.begin(), sums.end(), Sum{});
    return;
  }
  const Gradient* const row = plane.data() + j * ni_;
  const auto term = [this](const Gradient& g) {
    return squared_length(g) > least_square_ ? Sum{g[0], g[1], g[2], 1} : Sum{};
  };
  Sum before{}, here = term(row[0]);
  for (std::size_t i = 0; i < ni_; ++i) {
    const Sum after = i + 1 < ni_ ? term(row[i + 1]) : Sum{};
    sums[i] = blended(before, here, after);
    before = here;
    here = after;
  }
}

}  // namespace adamas::isosurface
