#include "core/io/whole_runs.h"

#include <algorithm>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include "core/io/whole_pieces.h"

namespace adamas::io {

namespace {

/// Returns the first index from `begin` on whose number is another one, or the count of numbers.
template <class Number>
std::size_t find_other(std::span<const Number> numbers, std::size_t begin, Number number) {
  constexpr std::size_t kBlock = 64;
  std::size_t i = begin;
  for (; i + kBlock <= numbers.size(); i += kBlock) {
    Number different = 0;
    for (std::size_t n = 0; n < kBlock; ++n)
      different = static_cast<Number>(different | (numbers[i + n] ^ number));
    if (different != 0) break;
  }
  while (i < numbers.size() && numbers[i] == number) ++i;
  return i;
}

/// Makes runs of whole numbers that arrive in pieces.
template <class Number>
class RunMaker {
 public:
  RunMaker(std::size_t length, std::size_t rows) : length_(length), builder_(length, rows) {}

  /// Takes the next numbers; returns false once too many differ.
  bool take(std::span<const Number> numbers) {
    while (!numbers.empty()) {
      const auto part = numbers.first(std::min(numbers.size(), length_ - column_));
      for (std::size_t i = 0; i < part.size(); i = find_other(part, i, last_)) {
        if (column_ + i > 0 && part[i] == last_) continue;
        if (known_.size() == kMostLabels && !known_.contains(part[i])) return false;
        last_ = part[i];
        const auto index = known_.try_emplace(last_, static_cast<std::uint16_t>(known_.size())).first->second;
        builder_.add(static_cast<std::uint32_t>(column_ + i), index);
      }
      column_ = (column_ + part.size()) % length_;
      numbers = numbers.subspan(part.size());
    }
    return true;
  }

  WholeRuns finish() && {
    std::vector<std::pair<Number, std::uint16_t>> sorted(known_.begin(), known_.end());
    std::sort(sorted.begin(), sorted.end());
    std::vector<std::uint16_t> places(sorted.size());
    WholeRuns result;
    for (std::size_t n = 0; n < sorted.size(); ++n) {
      places[sorted[n].second] = static_cast<std::uint16_t>(n);
      result.numbers.push_back(static_cast<std::int64_t>(sorted[n].first));
    }
    result.index = std::move(builder_).finish(places);
    return result;
  }

 private:
  std::size_t length_, column_ = 0;
  LabelBuilder builder_;
  std::unordered_map<Number, std::uint16_t> known_;  ///< numbers in the order in which they came
  Number last_ = 0;
};

/// Thrown where too many numbers differ, which ends the unpacking.
struct TooManyNumbers {};

template <class Number>
std::optional<WholeRuns> read_runs_of(const VolumeSource& source, std::string& remark) {
  const auto& n = source.grid.dimensions;
  RunMaker<Number> runs(n[0], n[1] * n[2]);
  const auto take = [&runs](std::span<const Number> numbers) {
    if (!runs.take(numbers)) throw TooManyNumbers();
  };
  try {
    if (const std::string found = for_each_piece<Number>(source, take); !found.empty()) remark = found;
  } catch (const TooManyNumbers&) {
    return {};
  }
  return std::move(runs).finish();
}

}  // namespace

std::optional<WholeRuns> read_whole_runs(const VolumeSource& source, std::string& remark) {
  std::optional<WholeRuns> result;
  if (source.grid.samples() == 0) return result;
  visit_whole_type(source.stored,
                   [&]<class Number>(Number) { result = read_runs_of<Number>(source, remark); });
  return result;
}

}  // namespace adamas::io
