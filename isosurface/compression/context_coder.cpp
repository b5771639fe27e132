#include "isosurface/compression/context_coder.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <utility>

#include "core/base/error.h"
#include "isosurface/compression/context_clusters.h"
#include "isosurface/compression/elias_codes.h"

namespace adamas {
namespace {

/// Of the number of a table.
int map_bits(std::size_t tables) { return static_cast<int>(std::bit_width(tables - 1)); }

/// The symbols that are not rare keep a frequency, the others share that of the escape.
std::vector<std::uint16_t> frequencies_of(std::span<const std::uint64_t> counts) {
  constexpr std::uint64_t kRare = 2;
  std::uint64_t total = 0, rare = 0;
  for (const std::uint64_t count : counts) {
    total += count;
    if (count < kRare) rare += count;
  }
  std::vector<std::uint16_t> result(counts.size() + 1, 0);
  const auto share = [total](std::uint64_t count) {
    const auto part = static_cast<double>(count) / static_cast<double>(std::max<std::uint64_t>(total, 1));
    return static_cast<std::uint16_t>(std::max(1.0, part * ContextCoder::kScale));
  };
  std::uint32_t sum = result.back() = share(rare);
  for (std::size_t n = 0; n < counts.size(); ++n) {
    if (counts[n] >= kRare) sum += result[n] = share(counts[n]);
  }
  for (; sum > ContextCoder::kScale; --sum) --*std::ranges::max_element(result);
  auto& most = *std::ranges::max_element(result);
  most = static_cast<std::uint16_t>(most + ContextCoder::kScale - sum);
  return result;
}

}  // namespace

ContextCoder::ContextCoder(const ContextCounts& counts)
    : ContextCoder([&counts] {
        ContextClusters clusters = context_clusters(counts, kMostClusters);
        std::vector<Frequencies> tables;
        for (const auto& cluster : clusters.counts) tables.push_back(frequencies_of(cluster));
        return ContextCoder(counts.symbols(), std::move(clusters.map), std::move(tables));
      }()) {}

ContextCoder::ContextCoder(std::size_t symbols, std::vector<std::uint8_t> map,
                           std::vector<Frequencies> tables)
    : symbols_(symbols), map_(std::move(map)), tables_(std::move(tables)) {
  ADAMAS_ASSERT(symbols_ <= kMaxSymbols && tables_.size() <= kMaxTables);
  for (const Frequencies& frequencies : tables_) {
    std::uint32_t start = 0;
    for (std::size_t symbol = 0; symbol <= symbols_; ++symbol) {
      const std::uint32_t frequency = frequencies[symbol];
      ranges_.push_back({static_cast<std::uint16_t>(start), static_cast<std::uint16_t>(frequency)});
      const std::uint32_t name = symbol == symbols_ ? kEscape : static_cast<std::uint32_t>(symbol);
      for (std::uint32_t n = 0; n < frequency; ++n) entries_.push_back(name | frequency << 8 | n << 20);
      start += frequency;
    }
  }
}

void ContextCoder::write(BitWriter& out) const {
  out.put(tables_.size(), 8);
  for (const std::uint8_t table : map_) out.put(table, map_bits(tables_.size()));
  for (const Frequencies& frequencies : tables_) {
    put_gamma(out, frequencies[symbols_]);
    std::size_t next = 0;
    for (std::size_t symbol = 0; symbol < symbols_; ++symbol) {
      if (frequencies[symbol] == 0) continue;
      put_gamma(out, static_cast<std::uint32_t>(symbol - next + 1));
      put_gamma(out, frequencies[symbol]);
      next = symbol + 1;
    }
  }
}

ContextCoder::Frequencies ContextCoder::read_frequencies(BitReader& in, std::size_t symbols,
                                                         std::string_view name) {
  Frequencies result(symbols + 1, 0);
  std::uint32_t sum = take_gamma(in);
  if (sum == 0 || sum > kScale) fail("{}: expected frequencies that sum to {}, found others", name, kScale);
  result[symbols] = static_cast<std::uint16_t>(sum);
  for (std::size_t symbol = 0; sum < kScale; ++symbol) {
    const std::uint32_t gap = take_gamma(in), frequency = take_gamma(in);
    if (gap == 0 || frequency == 0) fail("{}: expected a symbol and its frequency, found none", name);
    symbol += gap - 1;
    sum += frequency;
    if (symbol >= symbols) fail("{}: expected a symbol below {}, found {}", name, symbols, symbol);
    if (sum > kScale) fail("{}: expected frequencies that sum to {}, found {}", name, kScale, sum);
    result[symbol] = static_cast<std::uint16_t>(frequency);
  }
  return result;
}

ContextCoder ContextCoder::read(BitReader& in, std::size_t contexts, std::size_t symbols,
                                std::string_view name) {
  in.refill();
  const std::size_t count = in.take(8);
  if (count == 0 || count > kMaxTables)
    fail("{}: expected 1 to {} tables, found {}", name, kMaxTables, count);
  std::vector<std::uint8_t> map;
  for (std::size_t n = 0; n < contexts; ++n) {
    in.refill();
    map.push_back(static_cast<std::uint8_t>(in.take(map_bits(count))));
    if (map.back() >= count) fail("{}: expected a table below {}, found {}", name, count, map.back());
  }
  std::vector<Frequencies> tables;
  for (std::size_t n = 0; n < count; ++n) tables.push_back(read_frequencies(in, symbols, name));
  if (in.overrun()) fail("{}: expected {} tables, found the end of the data", name, count);
  return {symbols, std::move(map), std::move(tables)};
}

}  // namespace adamas
