#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/data/site_array.h"

namespace adamas::inline core {

/// Labels of sites as runs: a run is a longest part of a row of sites with one label. Rows follow each other.
struct LabelRows {
  std::size_t length = 0;             ///< the number of sites of each row
  std::vector<std::uint32_t> first;   ///< by row: its first run; behind the last row, the number of runs
  std::vector<std::uint32_t> starts;  ///< by run: the index of its first site in the row
  std::vector<std::uint16_t> labels;  ///< by run

  /// More runs cannot be numbered.
  static constexpr std::uint64_t kMostRuns = 0xfffffff0u;

  [[nodiscard]] std::size_t rows() const { return first.empty() ? 0 : first.size() - 1; }
  /// Returns the run that holds the i-th site of a row.
  [[nodiscard]] std::uint32_t find(std::size_t i, std::size_t row) const;
  /// Returns the index behind the last site of a run of a row.
  [[nodiscard]] std::uint32_t end(std::uint32_t run, std::size_t row) const {
    return run + 1 < first[row + 1] ? starts[run + 1] : static_cast<std::uint32_t>(length);
  }
};

/// A label for each site of a grid, the sites in rows along x: as runs if they were made so, which takes
/// memory for the changes of labels only, or as a dense array, of its own or borrowed as in SiteArray.
class LabelArray {
 public:
  using Label = std::uint16_t;

  LabelArray() = default;
  LabelArray(SiteArray<Label> dense) : dense_(std::move(dense)) {}
  LabelArray(std::vector<Label> dense) : dense_(std::move(dense)) {}
  /// Makes an array of rows with one label.
  static LabelArray constant(std::size_t length, std::size_t rows, Label label);
  explicit LabelArray(LabelRows rows) : rows_(std::make_shared<const LabelRows>(std::move(rows))) {}

  /// Whether there are no runs, so that dense() copies nothing.
  [[nodiscard]] bool is_dense() const { return rows_ == nullptr; }
  [[nodiscard]] std::size_t size() const { return rows_ ? rows_->length * rows_->rows() : dense_.size(); }
  [[nodiscard]] bool empty() const { return size() == 0; }
  /// Returns the label of a site, which is searched for in its row if there are runs.
  Label operator[](std::size_t site) const {
    return rows_ ? rows_->labels[rows_->find(site % rows_->length, site / rows_->length)] : dense_[site];
  }
  /// Calls visit(begin, end, label) for the runs of a row of `length` sites in their order, with the indices
  /// of the first site and behind the last one in the row.
  template <class Visit>
  void for_each_run(std::size_t row, std::size_t length, Visit&& visit) const;
  /// Returns all labels one after another; borrowed from this object if it is dense.
  [[nodiscard]] SiteArray<Label> dense() const;
  /// Returns the runs of rows of `length` sites, which stay as long as they are used; null if there are too
  /// many.
  [[nodiscard]] std::shared_ptr<const LabelRows> rows(std::size_t length) const;
  /// Returns the first site whose label is `least` or greater.
  [[nodiscard]] std::optional<std::size_t> find_from(std::size_t least) const;
  /// Returns the labels of the sites from `begin` to before `end`, or back, in each of the rows in `rows` of
  /// `length` sites.
  [[nodiscard]] LabelArray part(std::size_t length, std::size_t begin, std::size_t end,
                                std::span<const std::size_t> rows, bool back = false) const;
  /// Returns the same labels as runs of rows of `length` sites, unless these take more memory.
  [[nodiscard]] LabelArray as_runs(std::size_t length) const;

  /// Returns the dense labels for changes; runs and borrowed labels are copied first.
  std::vector<Label>& own();
  Label& operator[](std::size_t site) { return own()[site]; }
  auto begin() { return own().begin(); }
  auto end() { return own().end(); }
  void resize(std::size_t count) { own().resize(count); }
  void push_back(Label label) { own().push_back(label); }
  void assign(std::size_t count, Label label) { *this = std::vector<Label>(count, label); }
  void clear() { *this = {}; }

  friend bool operator==(const LabelArray& a, const LabelArray& b) { return a.dense() == b.dense(); }

 private:
  std::shared_ptr<const LabelRows> rows_;  ///< null if the labels are dense
  SiteArray<Label> dense_;
};

/// Makes an array of labels of runs that are added one after another. If these take more memory than dense
/// labels, the array becomes dense.
class LabelBuilder {
 public:
  LabelBuilder(std::size_t length, std::size_t rows) : length_(length), rows_(rows) {}

  /// Adds the next run of a row, of another label than the one before; the first one of a row starts at 0.
  void add(std::uint32_t start, std::uint16_t label);
  /// Returns the labels when all rows are added; a label becomes the entry of `numbers` at its value, if
  /// there are some. Different labels have different entries.
  [[nodiscard]] LabelArray finish(std::span<const std::uint16_t> numbers = {}) &&;

 private:
  void make_dense();
  void fill(std::size_t end) { dense_.resize(end, last_); }

  std::size_t length_, rows_;
  LabelRows runs_;
  bool is_dense_ = false;
  std::vector<std::uint16_t> dense_;  ///< the labels before the last run, if they are dense
  std::size_t begun_ = 0;             ///< the number of rows that have begun
  std::uint16_t last_ = 0;            ///< the label of the last run
};

template <class Visit>
void LabelArray::for_each_run(std::size_t row, std::size_t length, Visit&& visit) const {
  if (rows_ && rows_->length == length) {
    for (std::uint32_t run = rows_->first[row]; run < rows_->first[row + 1]; ++run)
      visit(std::size_t{rows_->starts[run]}, std::size_t{rows_->end(run, row)}, rows_->labels[run]);
    return;
  }
  std::size_t begin = 0;
  const auto at = [&](std::size_t i) { return std::as_const(*this)[row * length + i]; };
  for (std::size_t i = 1; i <= length; ++i) {
    if (i < length && at(i) == at(begin)) continue;
    visit(begin, i, at(begin));
    begin = i;
  }
}

}  // namespace adamas::inline core
