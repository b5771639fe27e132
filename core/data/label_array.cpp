#include "core/data/label_array.h"

#include <algorithm>
#include <numeric>

#include "core/base/parallel.h"

namespace adamas::inline core {

namespace {

constexpr std::size_t kRows = 1024;

/// Makes the runs of dense labels.
std::shared_ptr<const LabelRows> runs_of(const std::uint16_t* labels, std::size_t count, std::size_t length) {
  auto result = std::make_shared<LabelRows>();
  result->length = length;
  const std::size_t rows = length > 0 ? count / length : 0;
  result->first.assign(rows + 1, 0);
  parallel_for(rows, kRows, [&](std::size_t row) {
    const std::uint16_t* own = labels + row * length;
    std::uint32_t runs = 1;
    for (std::size_t i = 1; i < length; ++i) runs += own[i] != own[i - 1] ? 1 : 0;
    result->first[row + 1] = runs;
  });
  std::uint64_t total = 0;
  for (std::uint32_t& first : result->first) {
    total += first;
    if (total > LabelRows::kMostRuns) return nullptr;
    first = static_cast<std::uint32_t>(total);
  }
  result->starts.resize(total);
  result->labels.resize(total);
  parallel_for(rows, kRows, [&](std::size_t row) {
    const std::uint16_t* own = labels + row * length;
    std::uint32_t run = result->first[row];
    for (std::size_t i = 0; i < length; ++i) {
      if (i > 0 && own[i] == own[i - 1]) continue;
      result->starts[run] = static_cast<std::uint32_t>(i);
      result->labels[run++] = own[i];
    }
  });
  return result;
}

}  // namespace

std::uint32_t LabelRows::find(std::size_t i, std::size_t row) const {
  const auto begin = starts.begin() + first[row], behind = starts.begin() + first[row + 1];
  return static_cast<std::uint32_t>(std::upper_bound(begin, behind, i) - starts.begin()) - 1;
}

LabelArray LabelArray::constant(std::size_t length, std::size_t rows, Label label) {
  LabelBuilder result(length, rows);
  for (std::size_t row = 0; row < rows; ++row) result.add(0, label);
  return std::move(result).finish();
}

SiteArray<LabelArray::Label> LabelArray::dense() const {
  if (!rows_) return SiteArray<Label>::borrowed({dense_.data(), dense_.size()});
  std::vector<Label> result(size());
  parallel_for(rows_->rows(), kRows, [&](std::size_t row) {
    Label* own = result.data() + row * rows_->length;
    for_each_run(row, rows_->length, [&](std::size_t begin, std::size_t end, Label label) {
      std::fill(own + begin, own + end, label);
    });
  });
  return result;
}

std::shared_ptr<const LabelRows> LabelArray::rows(std::size_t length) const {
  if (rows_ && rows_->length == length) return rows_;
  const SiteArray<Label> labels = dense();
  return runs_of(labels.data(), labels.size(), length);
}

std::optional<std::size_t> LabelArray::find_from(std::size_t least) const {
  const auto is_greater = [least](Label label) { return label >= least; };
  if (!rows_) {
    const auto found = std::find_if(dense_.begin(), dense_.end(), is_greater);
    return found == dense_.end() ? std::nullopt
                                 : std::optional(static_cast<std::size_t>(found - dense_.begin()));
  }
  const auto found = std::find_if(rows_->labels.begin(), rows_->labels.end(), is_greater);
  if (found == rows_->labels.end()) return {};
  const auto run = static_cast<std::uint32_t>(found - rows_->labels.begin());
  const auto behind = std::upper_bound(rows_->first.begin(), rows_->first.end(), run);
  return static_cast<std::size_t>(behind - rows_->first.begin() - 1) * rows_->length + rows_->starts[run];
}

LabelArray LabelArray::part(std::size_t length, std::size_t begin, std::size_t end,
                            std::span<const std::size_t> rows, bool back) const {
  LabelBuilder result(end - begin, rows.size());
  std::vector<std::pair<std::uint32_t, Label>> runs;
  for (const std::size_t row : rows) {
    runs.clear();
    for_each_run(row, length, [&](std::size_t first, std::size_t last, Label label) {
      if (last <= begin || first >= end) return;
      const std::size_t start = back ? end - std::min(last, end) : std::max(first, begin) - begin;
      runs.emplace_back(static_cast<std::uint32_t>(start), label);
    });
    if (back) std::reverse(runs.begin(), runs.end());
    for (const auto& [start, label] : runs) result.add(start, label);
  }
  return std::move(result).finish();
}

LabelArray LabelArray::as_runs(std::size_t length) const {
  std::vector<std::size_t> rows(length > 0 ? size() / length : 0);
  std::iota(rows.begin(), rows.end(), std::size_t{0});
  return part(length, 0, length, rows);
}

std::vector<LabelArray::Label>& LabelArray::own() {
  if (rows_) {
    dense_ = dense();
    rows_.reset();
  }
  return dense_.own();
}

void LabelBuilder::add(std::uint32_t start, std::uint16_t label) {
  if (is_dense_) {
    const std::size_t row = start > 0 ? begun_ - 1 : begun_;
    fill(row * length_ + start);
  } else {
    if (start == 0) runs_.first.push_back(static_cast<std::uint32_t>(runs_.starts.size()));
    runs_.starts.push_back(start);
    runs_.labels.push_back(label);
  }
  if (start == 0) ++begun_;
  last_ = label;
  constexpr std::size_t kRun = sizeof(runs_.starts[0]) + sizeof(label);
  const std::size_t runs = runs_.starts.size();
  if (!is_dense_ && (runs >= LabelRows::kMostRuns || runs * kRun > length_ * rows_ * sizeof(label)))
    make_dense();
}

/// Changes what was added to dense labels; the last run ends where the next one begins.
void LabelBuilder::make_dense() {
  is_dense_ = true;
  const std::uint32_t last_start = runs_.starts.back();
  runs_.first.push_back(static_cast<std::uint32_t>(runs_.starts.size()));
  dense_.reserve(length_ * rows_);
  for (std::size_t row = 0; row < begun_; ++row) {
    for (std::uint32_t run = runs_.first[row]; run < runs_.first[row + 1]; ++run)
      dense_.resize(row * length_ + (run + 1 < runs_.first[row + 1] ? runs_.starts[run + 1] : length_),
                    runs_.labels[run]);
  }
  dense_.resize((begun_ - 1) * length_ + last_start);
  runs_ = {};
}

LabelArray LabelBuilder::finish(std::span<const std::uint16_t> numbers) && {
  if (is_dense_) fill(begun_ * length_);
  std::vector<std::uint16_t>& labels = is_dense_ ? dense_ : runs_.labels;
  if (!numbers.empty()) {
    for (std::uint16_t& label : labels) label = numbers[label];
  }
  if (is_dense_) return std::move(dense_);
  runs_.length = length_;
  runs_.first.push_back(static_cast<std::uint32_t>(runs_.starts.size()));
  runs_.starts.shrink_to_fit();
  runs_.labels.shrink_to_fit();
  return LabelArray(std::move(runs_));
}

}  // namespace adamas::inline core
