#include "isosurface/compression/package_merge.h"

#include <algorithm>
#include <cstddef>

#include "core/base/assert.h"

namespace adamas {
namespace {

/// The coins of one denomination, sorted by weight: symbols and pairs of coins of the next smaller one.
struct Coins {
  std::vector<std::uint64_t> weights;
  std::vector<bool> is_symbol;
};

std::vector<std::size_t> used_symbols_by_count(std::span<const std::uint64_t> counts) {
  std::vector<std::size_t> symbols;
  for (std::size_t s = 0; s < counts.size(); ++s) {
    if (counts[s] > 0) symbols.push_back(s);
  }
  std::stable_sort(symbols.begin(), symbols.end(),
                   [counts](std::size_t a, std::size_t b) { return counts[a] < counts[b]; });
  return symbols;
}

/// All symbols, and the coins of the smaller denomination in pairs; the symbol first where both weigh the
/// same.
Coins merged_with_pairs(std::span<const std::uint64_t> symbol_weights, const Coins& smaller) {
  Coins coins;
  const std::size_t pairs = smaller.weights.size() / 2;
  const auto pair_weight = [&smaller](std::size_t n) {
    return smaller.weights[2 * n] + smaller.weights[2 * n + 1];
  };
  std::size_t symbol = 0, pair = 0;
  while (symbol < symbol_weights.size() || pair < pairs) {
    const bool take_symbol =
        pair == pairs || (symbol < symbol_weights.size() && symbol_weights[symbol] <= pair_weight(pair));
    coins.weights.push_back(take_symbol ? symbol_weights[symbol++] : pair_weight(pair++));
    coins.is_symbol.push_back(take_symbol);
  }
  return coins;
}

}  // namespace

std::vector<std::uint8_t> package_merge(std::span<const std::uint64_t> counts, int limit) {
  std::vector<std::uint8_t> lengths(counts.size(), 0);
  const std::vector<std::size_t> symbols = used_symbols_by_count(counts);
  ADAMAS_ASSERT(limit >= 1 && limit <= 32 && symbols.size() <= std::uint64_t{1} << limit);
  if (symbols.size() == 1) lengths[symbols[0]] = 1;
  if (symbols.size() < 2) return lengths;

  std::vector<std::uint64_t> weights;
  for (const std::size_t s : symbols) weights.push_back(counts[s]);
  // From the smallest denomination, 2^-limit, to 1/2.
  std::vector<Coins> lods;
  for (int lod = 0; lod < limit; ++lod) {
    lods.push_back(merged_with_pairs(weights, lods.empty() ? Coins{} : lods.back()));
  }
  // The lightest coins of 1/2 that are worth n - 1 make the code. Pairs are taken in order, and are made of
  // the first coins of the LOD below; each time that a symbol is taken its word grows by one bit.
  std::size_t taken = 2 * (symbols.size() - 1);
  for (auto lod = lods.rbegin(); lod != lods.rend(); ++lod) {
    ADAMAS_ASSERT(taken <= lod->is_symbol.size());
    const auto begin = lod->is_symbol.begin();
    const auto taken_symbols =
        static_cast<std::size_t>(std::count(begin, begin + static_cast<std::ptrdiff_t>(taken), true));
    for (std::size_t n = 0; n < taken_symbols; ++n) ++lengths[symbols[n]];
    taken = 2 * (taken - taken_symbols);
  }
  return lengths;
}

}  // namespace adamas
