#include "isosurface/compression/symbol_frequencies.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numeric>

#include "core/base/assert.h"
#include "core/base/error.h"

namespace adamas {
namespace {

/// Bits of the number that says how many bits a frequency has.
constexpr int kWidthBits = 4;

/// Bits that a symbol of this frequency takes.
double symbol_bits(std::uint32_t frequency) {
  static const std::array<double, SymbolFrequencies::kScale> kBits = [] {
    std::array<double, SymbolFrequencies::kScale> bits{};
    for (std::size_t f = 1; f < bits.size(); ++f) {
      bits[f] = SymbolFrequencies::kScaleBits - std::log2(static_cast<double>(f));
    }
    return bits;
  }();
  return kBits[frequency];
}

int number_bits(std::size_t symbols) { return static_cast<int>(std::bit_width(symbols)); }

/// Number of symbols before the escape up to the last one with a frequency.
std::size_t used(std::span<const std::uint16_t> values) {
  std::size_t count = values.size() - 1;
  while (count > 0 && values[count - 1] == 0) --count;
  return count;
}

}  // namespace

SymbolFrequencies::SymbolFrequencies(std::span<const std::uint64_t> counts) : values_(counts.size() + 1, 0) {
  ADAMAS_ASSERT(!counts.empty() && counts.size() < kMaxSymbols);
  values_.back() = 1;
  const std::uint64_t total = std::accumulate(counts.begin(), counts.end(), std::uint64_t{0});
  if (total == 0) {
    values_.front() = kScale - 1;
    return;
  }
  for (std::size_t s = 0; s < counts.size(); ++s) {
    if (counts[s] == 0) continue;
    const double share = static_cast<double>(counts[s]) / static_cast<double>(total);
    values_[s] = static_cast<std::uint16_t>(std::max(1.0, std::floor(share * (kScale - 1) + 0.5)));
  }
  balance(counts);
}

void SymbolFrequencies::balance(std::span<const std::uint64_t> counts) {
  const auto sum = [this] { return std::accumulate(values_.begin(), values_.end(), std::uint32_t{0}); };
  // What one more or one less is worth, in bits.
  const auto change = [&](std::size_t s, int step) {
    const auto next = static_cast<std::uint32_t>(values_[s] + step);
    return static_cast<double>(counts[s]) * (symbol_bits(values_[s]) - symbol_bits(next));
  };
  for (std::uint32_t now = sum(); now != kScale; now = sum()) {
    const int step = now < kScale ? 1 : -1;
    std::size_t best = counts.size();
    for (std::size_t s = 0; s < counts.size(); ++s) {
      if (values_[s] == 0 || values_[s] + step == 0) continue;
      if (best == counts.size() || change(s, step) > change(best, step)) best = s;
    }
    values_[best] = static_cast<std::uint16_t>(values_[best] + step);
  }
}

double SymbolFrequencies::written_bits() const {
  const std::size_t count = used(values_);
  int bits = number_bits(values_.size()) + kWidthBits * static_cast<int>(count);
  for (std::size_t s = 0; s < count; ++s) bits += std::max(0, std::bit_width(values_[s]) - 1);
  return bits;
}

double SymbolFrequencies::coded_bits(std::span<const std::uint64_t> counts, int escape_bits) const {
  double bits = 0;
  for (std::size_t s = 0; s < counts.size(); ++s) {
    if (counts[s] == 0) continue;
    const double each = values_[s] > 0 ? symbol_bits(values_[s]) : symbol_bits(values_.back()) + escape_bits;
    bits += static_cast<double>(counts[s]) * each;
  }
  return bits;
}

void SymbolFrequencies::write(BitWriter& out) const {
  const std::size_t count = used(values_);
  out.put(count, number_bits(values_.size()));
  for (std::size_t s = 0; s < count; ++s) {
    const int width = std::bit_width(values_[s]);
    out.put(static_cast<std::uint64_t>(width), kWidthBits);
    if (width > 1) out.put(values_[s] ^ 1u << (width - 1), width - 1);
  }
}

SymbolFrequencies SymbolFrequencies::read(BitReader& in, std::size_t symbols, std::string_view name) {
  ADAMAS_ASSERT(symbols > 1 && symbols <= kMaxSymbols);
  in.refill();
  const std::size_t count = in.take(number_bits(symbols));
  if (count == 0 || count >= symbols) {
    fail("{}: expected 1 to {} frequencies, found {}", name, symbols - 1, count);
  }
  SymbolFrequencies result;
  result.values_.assign(symbols, 0);
  std::uint32_t sum = 0;
  for (std::size_t s = 0; s < count; ++s) {
    in.refill();
    const int width = static_cast<int>(in.take(kWidthBits));
    if (width > kScaleBits) fail("{}: expected a frequency below {}, found {} bits", name, kScale, width);
    if (width > 0) {
      const std::uint64_t value = std::uint64_t{1} << (width - 1) | in.take(width - 1);
      result.values_[s] = static_cast<std::uint16_t>(value);
    }
    sum += result.values_[s];
  }
  if (in.overrun()) fail("{}: expected {} frequencies, found the end of the data", name, count);
  if (result.values_[count - 1] == 0) fail("{}: expected a last frequency above 0, found 0", name);
  if (sum >= kScale) fail("{}: expected frequencies with a sum below {}, found {}", name, kScale, sum);
  result.values_.back() = static_cast<std::uint16_t>(kScale - sum);
  return result;
}

}  // namespace adamas
