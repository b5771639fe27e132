#include "isosurface/compression/context_groups.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <optional>

#include "core/base/assert.h"
#include "core/base/error.h"

namespace adamas {
namespace {

using Counts = std::vector<std::uint64_t>;

Counts sum(const Counts& a, const Counts& b) {
  Counts result(a);
  for (std::size_t s = 0; s < b.size(); ++s) result[s] += b[s];
  return result;
}

/// Merges the two groups for which that saves most, until it saves nothing.
class Grouping {
 public:
  Grouping(const ContextTallies& counts, int escape_bits) : escape_bits_(escape_bits) {
    for (std::size_t context = 0; context < counts.size(); ++context) {
      if (std::ranges::all_of(counts[context], [](std::uint64_t n) { return n == 0; })) continue;
      groups_.push_back({counts[context], bits(counts[context]), {context}, {}});
    }
    for (std::size_t a = 0; a < groups_.size(); ++a) {
      for (std::size_t b = 0; b < a; ++b) groups_[a].savings.push_back(saving(a, b));
    }
  }

  /// The contexts of each group.
  std::vector<std::vector<std::size_t>> merged() {
    while (merge_best()) {
    }
    std::vector<std::vector<std::size_t>> result;
    for (Group& group : groups_) {
      if (!group.contexts.empty()) result.push_back(std::move(group.contexts));
    }
    return result;
  }

 private:
  struct Group {
    Counts counts;
    double bits;
    std::vector<std::size_t> contexts;  ///< none once it is merged with another
    std::vector<double> savings;        ///< of merging with each group before
  };

  [[nodiscard]] double bits(const Counts& counts) const {
    const SymbolFrequencies frequencies(counts);
    return frequencies.written_bits() + frequencies.coded_bits(counts, escape_bits_);
  }
  [[nodiscard]] double saving(std::size_t a, std::size_t b) const {
    return groups_[a].bits + groups_[b].bits - bits(sum(groups_[a].counts, groups_[b].counts));
  }

  bool merge_best() {
    double best = 0;
    std::size_t into = 0, from = 0;
    for (std::size_t a = 0; a < groups_.size(); ++a) {
      if (groups_[a].contexts.empty()) continue;
      for (std::size_t b = 0; b < a; ++b) {
        if (groups_[b].contexts.empty() || groups_[a].savings[b] <= best) continue;
        best = groups_[a].savings[b];
        into = b;
        from = a;
      }
    }
    if (best <= 0) return false;
    Group& group = groups_[into];
    group.counts = sum(group.counts, groups_[from].counts);
    group.bits = bits(group.counts);
    group.contexts.insert(group.contexts.end(), groups_[from].contexts.begin(), groups_[from].contexts.end());
    groups_[from].contexts.clear();
    for (std::size_t b = 0; b < into; ++b) {
      if (!groups_[b].contexts.empty()) group.savings[b] = saving(into, b);
    }
    for (std::size_t a = into + 1; a < groups_.size(); ++a) {
      if (!groups_[a].contexts.empty()) groups_[a].savings[into] = saving(a, into);
    }
    return true;
  }

  int escape_bits_;
  std::vector<Group> groups_;
};

/// Bits that can tell the groups so far and a new one from each other.
int group_bits(std::size_t groups) { return static_cast<int>(std::bit_width(groups)); }

}  // namespace

ContextGroups::ContextGroups(const ContextTallies& counts, int escape_bits) {
  ADAMAS_ASSERT(!counts.empty() && counts.size() < 256);
  const auto merged = Grouping(counts, escape_bits).merged();
  constexpr std::size_t kNone = 256;
  std::vector<std::size_t> of_context(counts.size(), kNone);
  for (std::size_t g = 0; g < merged.size(); ++g) {
    for (const std::size_t context : merged[g]) of_context[context] = g;
  }
  // Contexts that never came go with the one before, or with the first that came.
  const auto first = std::ranges::find_if(of_context, [](std::size_t g) { return g != kNone; });
  std::size_t previous = first == of_context.end() ? 0 : *first;
  std::vector<std::optional<std::uint8_t>> number(std::max<std::size_t>(merged.size(), 1));
  for (const std::size_t g : of_context) {
    if (g != kNone) previous = g;
    if (!number[previous]) {
      number[previous] = static_cast<std::uint8_t>(frequencies_.size());
      Counts total(counts.front().size(), 0);
      if (!merged.empty()) {
        for (const std::size_t context : merged[previous]) total = sum(total, counts[context]);
      }
      frequencies_.emplace_back(total);
    }
    groups_.push_back(*number[previous]);
  }
}

void ContextGroups::write(BitWriter& out) const {
  std::size_t groups = 0;
  for (const std::uint8_t group : groups_) {
    out.put(group, group_bits(groups));
    if (group == groups) frequencies_[groups++].write(out);
  }
}

ContextGroups ContextGroups::read(BitReader& in, std::size_t contexts, std::size_t symbols,
                                  std::string_view name) {
  ContextGroups result;
  for (std::size_t context = 0; context < contexts; ++context) {
    in.refill();
    const std::size_t group = in.take(group_bits(result.frequencies_.size()));
    if (group > result.frequencies_.size()) {
      fail("{}: expected at most {} as the group of context {}, found {}", name, result.frequencies_.size(),
           context, group);
    }
    if (group == result.frequencies_.size()) {
      result.frequencies_.push_back(
          SymbolFrequencies::read(in, symbols, fmt::format("{}: context {}", name, context)));
    }
    result.groups_.push_back(static_cast<std::uint8_t>(group));
  }
  return result;
}

}  // namespace adamas
