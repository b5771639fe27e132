#pragma once

#include <array>
#include <cstddef>
#include <utility>

namespace adamas::interfaces {

namespace normal_equations_detail {

template <int kColumn, int kUsed, class TermsOf, class WeightOf, class Matrix>
void sum_column(std::size_t count, const TermsOf& terms_of, const WeightOf& weight_of, Matrix& sums) {
  // A column begins at an even row, so that two rows are computed at a time.
  constexpr int kFirst = kColumn & ~1;
  std::array<double, static_cast<std::size_t>(kUsed - kFirst)> totals{};
  for (std::size_t n = 0; n < count; ++n) {
    const double* terms = terms_of(n);
    const double by = weight_of(n) * terms[kColumn];
    for (std::size_t i = 0; i < totals.size(); ++i) totals[i] += by * terms[kFirst + i];
  }
  for (std::size_t i = 0; i < totals.size(); ++i) sums(kFirst + static_cast<int>(i), kColumn) = totals[i];
}

}  // namespace normal_equations_detail

/// Sets the lower triangle of the first kUsed rows and columns of a matrix to the sum of weight * terms *
/// terms^T over samples; the rest is undefined afterwards. terms_of(n) points to the terms of the n-th
/// sample, weight_of(n) returns its weight. Each sum is added in the order of samples, as by Eigen's rank
/// updates, of which this costs a fraction for small matrices.
template <int kUsed, class TermsOf, class WeightOf, class Matrix>
void sum_squares(std::size_t count, const TermsOf& terms_of, const WeightOf& weight_of, Matrix& sums) {
  static_assert(kUsed % 2 == 0);
  [&]<int... kColumns>(std::integer_sequence<int, kColumns...>) {
    (normal_equations_detail::sum_column<kColumns, kUsed>(count, terms_of, weight_of, sums), ...);
  }
  (std::make_integer_sequence<int, kUsed>());
}

}  // namespace adamas::interfaces
