#include "interfaces/reconstruction/label_runs.h"

#include <algorithm>

#include "core/base/disjoint_sets.h"
#include "core/base/error.h"
#include "core/base/parallel.h"

namespace adamas::interfaces {

LabelRuns::LabelRuns(const MultiMaterialData& data, const std::vector<std::uint16_t>& numbers)
    : n_{data.grid.sites(0), data.grid.sites(1), data.grid.sites(2)} {
  const std::size_t count = n_[1] * n_[2];
  const std::uint16_t* labels = data.labels.data();
  rows_.assign(count + 1, 0);
  parallel_for(count, 1024, [&](std::size_t row) {
    const std::uint16_t* own = labels + row * n_[0];
    std::uint32_t runs = 1;
    for (std::size_t i = 1; i < n_[0]; ++i) runs += own[i] != own[i - 1] ? 1 : 0;
    rows_[row + 1] = runs;
  });
  std::uint64_t total = 0;
  for (std::uint32_t& first : rows_) {
    total += first;
    if (total > 0xfffffff0u) fail("{}: expected fewer changes of labels, found too many", data.source);
    first = static_cast<std::uint32_t>(total);
  }
  starts_.resize(total);
  numbers_.resize(total);
  parallel_for(count, 1024, [&](std::size_t row) {
    const std::uint16_t* own = labels + row * n_[0];
    std::uint32_t run = rows_[row];
    for (std::size_t i = 0; i < n_[0]; ++i) {
      if (i > 0 && own[i] == own[i - 1]) continue;
      starts_[run] = static_cast<std::uint32_t>(i);
      numbers_[run++] = numbers[own[i]];
    }
  });
}

std::uint32_t LabelRuns::find(std::size_t i, std::size_t row) const {
  const auto first = starts_.begin() + rows_[row], last = starts_.begin() + rows_[row + 1];
  return static_cast<std::uint32_t>(std::upper_bound(first, last, i) - starts_.begin()) - 1;
}

std::vector<std::uint32_t> LabelRuns::roots() const {
  DisjointSets sets(size());
  const auto end = [&](std::uint32_t run, std::uint32_t row_end) {
    return run + 1 < row_end ? starts_[run + 1] : static_cast<std::uint32_t>(n_[0]);
  };
  // Joins the runs of a row with those of another one that begin before their ends, or there, and end behind
  // their begins.
  const auto join_rows = [&](std::size_t row, std::size_t other) {
    const std::uint32_t row_end = rows_[row + 1], other_end = rows_[other + 1];
    std::uint32_t a = rows_[row], b = rows_[other];
    while (a < row_end && b < other_end) {
      const std::uint32_t a_end = end(a, row_end), b_end = end(b, other_end);
      if (numbers_[a] == numbers_[b] && starts_[b] <= a_end && starts_[a] < b_end) sets.join(a, b);
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
