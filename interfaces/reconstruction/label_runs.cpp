#include "interfaces/reconstruction/label_runs.h"

#include <utility>

#include "core/base/disjoint_sets.h"
#include "core/base/error.h"

namespace adamas::interfaces {

LabelRuns::LabelRuns(const MultiMaterialData& data, std::vector<std::uint16_t> numbers)
    : n_{data.grid.sites(0), data.grid.sites(1), data.grid.sites(2)},
      rows_(data.labels.rows(n_[0])),
      numbers_(std::move(numbers)) {
  if (!rows_) fail("{}: expected fewer changes of labels, found too many", data.source);
}

void LabelRuns::read(std::size_t i, std::size_t row, std::span<std::uint16_t> found) const {
  const std::uint32_t behind = rows_->first[row + 1];
  std::uint32_t run = find(i, row);
  for (std::uint16_t& number : found) {
    if (run + 1 < behind && rows_->starts[run + 1] <= i) ++run;
    number = this->number(run);
    ++i;
  }
}

std::vector<std::uint32_t> LabelRuns::roots() const {
  DisjointSets sets(size());
  const std::vector<std::uint32_t>& starts = rows_->starts;
  // Joins the runs of a row with those of another one that begin before their ends, or there, and end behind
  // their begins.
  const auto join_rows = [&](std::size_t row, std::size_t other) {
    const std::uint32_t row_end = first_of_row(row + 1), other_end = first_of_row(other + 1);
    std::uint32_t a = first_of_row(row), b = first_of_row(other);
    while (a < row_end && b < other_end) {
      const std::uint32_t a_end = end(a, row_end), b_end = end(b, other_end);
      if (rows_->labels[a] == rows_->labels[b] && starts[b] <= a_end && starts[a] < b_end) sets.join(a, b);
      // The run whose reach ends first meets nothing further.
      if (b_end <= a_end) {
        ++b;
      } else {
        ++a;
      }
    }
  };
  for (std::size_t k = 0; k < n_[2]; ++k) {
    for (std::size_t j = 0; j < n_[1]; ++j) {
      const std::size_t row = j + n_[1] * k;
      if (j + 1 < n_[1]) join_rows(row, row + 1);
      if (k + 1 < n_[2]) join_rows(row, row + n_[1]);
      if (j + 1 < n_[1] && k + 1 < n_[2]) join_rows(row, row + n_[1] + 1);
    }
  }
  return std::move(sets).roots();
}

}  // namespace adamas::interfaces
