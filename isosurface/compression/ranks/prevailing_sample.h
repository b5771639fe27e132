#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <optional>

#include "isosurface/compression/page_order.h"
#include "isosurface/compression/ranks/ranked_codec.h"
#include "isosurface/volume/page.h"

namespace adamas::isosurface {

/// Finds the most frequent sample of a volume, as a word: for example, the background of a scan, or the limit
/// at which samples were clamped. Volumes of more than a byte have one only where their ranks fit in a byte.
template <class Word>
class PrevailingSample {
 public:
  /// Begins to count. `ranks` is null where samples are coded as they are.
  explicit PrevailingSample(const SampleRanks* ranks) : ranks_(ranks) {}

  /// Counts the samples of the page's own points.
  void add(const PageShape& shape, const PagePoints<Word>& samples) {
    if (!may_prevail()) return;
    for_each_own_place(shape, [&](std::size_t place) {
      const std::uint32_t word = samples[place];
      ++counts_[ranks_ == nullptr ? word : ranks_->rank(word)];
    });
  }

  /// Returns the most frequent sample; none where less than a quarter of the points have it.
  [[nodiscard]] std::optional<Word> found() const {
    const auto most = std::ranges::max_element(counts_);
    const std::uint64_t all = std::accumulate(counts_.begin(), counts_.end(), std::uint64_t{0});
    if (all == 0 || *most < all / 4) return {};
    const auto number = static_cast<std::size_t>(most - counts_.begin());
    return static_cast<Word>(ranks_ == nullptr ? number : ranks_->values()[number]);
  }

 private:
  std::array<std::uint64_t, 256> counts_{};
  const SampleRanks* ranks_;

  [[nodiscard]] bool may_prevail() const {
    return ranks_ == nullptr ? sizeof(Word) == 1 : ranks_->values().size() <= counts_.size();
  }
};

}  // namespace adamas::isosurface
