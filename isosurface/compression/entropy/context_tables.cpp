#include "isosurface/compression/entropy/context_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/base/error.h"

namespace adamas::isosurface {
namespace {

using Counts = std::vector<std::uint64_t>;
using Frequencies = ContextTables::Frequencies;

constexpr std::uint32_t kScale = ContextTables::kScale;
/// A frequency is written as the number of its bits, in kWidthBits, and the bits below its leading 1.
constexpr int kWidthBits = 4;
/// A symbol that occurs less often in a table is coded by the escape.
constexpr std::uint64_t kLeastCount = 2;

double symbol_bits(std::uint32_t frequency) {
  static const std::array<double, kScale + 1> kBits = [] {
    std::array<double, kScale + 1> bits{};
    for (std::size_t f = 1; f < bits.size(); ++f)
      bits[f] = ContextTables::kScaleBits - std::log2(static_cast<double>(f));
    return bits;
  }();
  return kBits[frequency];
}

int gamma_bits(std::uint32_t value) { return 2 * std::bit_width(value) - 1; }
int frequency_bits(std::uint32_t frequency) {
  return kWidthBits + std::max(0, static_cast<int>(std::bit_width(frequency)) - 1);
}
/// Returns the number of bits that distinguish the tables so far and a new one.
int number_bits(std::size_t tables) { return static_cast<int>(std::bit_width(tables)); }

/// Returns the counts of the symbols that a table codes, and last that of the symbols coded by the escape.
Counts with_escape(std::span<const std::uint64_t> counts) {
  Counts result(counts.begin(), counts.end());
  std::uint64_t escaped = 0;
  for (std::uint64_t& count : result) {
    if (count >= kLeastCount) continue;
    escaped += count;
    count = 0;
  }
  result.push_back(escaped);
  return result;
}

/// Returns the frequency that is nearest to a count; it is at least 1.
std::uint32_t frequency_of(std::uint64_t count, double scale_per_count) {
  return std::max(1u, static_cast<std::uint32_t>(static_cast<double>(count) * scale_per_count + 0.5));
}

/// Changes frequencies by 1, each time at the least cost in bits, until their sum is kScale.
void balance(const Counts& counts, Frequencies& frequencies) {
  // Returns the number of bits that a frequency greater or less by 1 saves.
  const auto saved = [&](std::size_t s, int step) {
    const auto next = static_cast<std::uint32_t>(frequencies[s] + step);
    return static_cast<double>(counts[s]) * (symbol_bits(frequencies[s]) - symbol_bits(next));
  };
  std::uint32_t sum = std::accumulate(frequencies.begin(), frequencies.end(), std::uint32_t{0});
  while (sum != kScale) {
    const int step = sum < kScale ? 1 : -1;
    std::size_t best = frequencies.size();
    for (std::size_t s = 0; s < frequencies.size(); ++s) {
      if (frequencies[s] == 0 || frequencies[s] + step == 0) continue;
      if (best == frequencies.size() || saved(s, step) > saved(best, step)) best = s;
    }
    frequencies[best] = static_cast<std::uint16_t>(frequencies[best] + step);
    sum += static_cast<std::uint32_t>(step);
  }
}

Frequencies frequencies_of(std::span<const std::uint64_t> of_symbols) {
  const Counts counts = with_escape(of_symbols);
  Frequencies result(counts.size(), 0);
  const std::uint64_t total = std::accumulate(counts.begin(), counts.end(), std::uint64_t{0});
  result.back() = 1;
  if (total == 0) {
    result.front() = kScale - 1;
    return result;
  }
  const double scale = double{kScale} / static_cast<double>(total);
  for (std::size_t s = 0; s < counts.size(); ++s) {
    if (counts[s] > 0) result[s] = static_cast<std::uint16_t>(frequency_of(counts[s], scale));
  }
  balance(counts, result);
  return result;
}

/// Estimates the bits of a table and of its symbols.
double cost(std::span<const std::uint64_t> a, std::span<const std::uint64_t> b) {
  std::uint64_t total = 0, escaped = 0;
  for (std::size_t s = 0; s < a.size(); ++s) {
    const std::uint64_t count = a[s] + b[s];
    total += count;
    if (count < kLeastCount) escaped += count;
  }
  if (total == 0) return 0;
  const double scale = double{kScale} / static_cast<double>(total);
  std::uint32_t sum = 0, skipped = 0;
  double bits = 0;
  int table_bits = 0;
  const auto add = [&](std::uint64_t count) {
    const std::uint32_t frequency = frequency_of(count, scale);
    sum += frequency;
    bits += static_cast<double>(count) * symbol_bits(frequency);
    table_bits += frequency_bits(frequency);
  };
  add(escaped);
  bits += static_cast<double>(escaped) * static_cast<double>(std::bit_width(a.size() - 1));
  for (std::size_t s = 0; s < a.size(); ++s) {
    const std::uint64_t count = a[s] + b[s];
    if (count < kLeastCount) {
      ++skipped;
      continue;
    }
    if (skipped > 0) table_bits += kWidthBits + gamma_bits(skipped);
    skipped = 0;
    add(count);
  }
  // The balanced frequencies will be near these, divided by their sum.
  return table_bits + bits + static_cast<double>(total) * std::log2(static_cast<double>(sum) / kScale);
}

/// Clusters of contexts, and the cost of joining any two.
class Clusters {
 public:
  explicit Clusters(std::vector<Counts> counts) : counts_(std::move(counts)), size_(counts_.size()) {
    cluster_of_.resize(size_);
    std::iota(cluster_of_.begin(), cluster_of_.end(), std::size_t{0});
    extra_.assign(size_ * size_, 0);
    for (std::size_t n = 0; n < size_; ++n) costs_.push_back(own_cost(n));
    for (std::size_t a = 0; a < size_; ++a) {
      for (std::size_t b = a + 1; b < size_; ++b) update(a, b);
    }
  }

  /// Joins the two clusters of least cost again and again, while that saves bits or there are more than
  /// `most` clusters.
  void join(std::size_t most) {
    for (std::size_t left = size_; left > 1; --left) {
      std::size_t best_a = 0, best_b = 0;
      double best = std::numeric_limits<double>::infinity();
      for (std::size_t a = 0; a < size_; ++a) {
        if (cluster_of_[a] != a) continue;
        for (std::size_t b = a + 1; b < size_; ++b) {
          if (cluster_of_[b] != b || extra_[a * size_ + b] >= best) continue;
          best = extra_[a * size_ + b], best_a = a, best_b = b;
        }
      }
      if (best >= 0 && left <= most) return;
      join(best_a, best_b);
    }
  }

  /// Returns the cluster that has the nth of the initial counts. counts() returns those of a cluster.
  [[nodiscard]] std::size_t cluster_of(std::size_t n) const { return cluster_of_[n]; }
  [[nodiscard]] const Counts& counts(std::size_t cluster) const { return counts_[cluster]; }

 private:
  [[nodiscard]] double own_cost(std::size_t n) const {
    return cost(counts_[n], Counts(counts_[n].size(), 0));
  }
  void join(std::size_t a, std::size_t b) {
    for (std::size_t s = 0; s < counts_[a].size(); ++s) counts_[a][s] += counts_[b][s];
    std::ranges::replace(cluster_of_, b, a);
    costs_[a] = own_cost(a);
    for (std::size_t other = 0; other < size_; ++other) {
      if (cluster_of_[other] == other && other != a) update(std::min(a, other), std::max(a, other));
    }
  }
  void update(std::size_t a, std::size_t b) {
    extra_[a * size_ + b] = cost(counts_[a], counts_[b]) - costs_[a] - costs_[b];
  }

  std::vector<Counts> counts_;
  std::size_t size_;
  /// The cluster of each initial count; an existing cluster is its own.
  std::vector<std::size_t> cluster_of_;
  std::vector<double> costs_, extra_;  ///< extra_: cost of joining a with b > a
};

void write_frequency(BitWriter& out, std::uint32_t frequency) {
  const int width = static_cast<int>(std::bit_width(frequency));
  out.put(static_cast<std::uint64_t>(width), kWidthBits);
  out.put(frequency ^ 1u << (width - 1), width - 1);
}

/// Writes a table: the escape's frequency, then those of the symbols until the sum is kScale. A width of 0
/// and a gamma code stand for a run of symbols without a frequency.
void write_table(BitWriter& out, const Frequencies& frequencies) {
  write_frequency(out, frequencies.back());
  std::uint32_t skipped = 0;
  for (const std::uint16_t frequency : std::span(frequencies).first(frequencies.size() - 1)) {
    if (frequency == 0) {
      ++skipped;
      continue;
    }
    if (skipped > 0) {
      out.put(0, kWidthBits);
      put_gamma(out, skipped);
      skipped = 0;
    }
    write_frequency(out, frequency);
  }
}

/// Reads a frequency; 0 where symbols without a frequency follow.
std::uint32_t read_frequency(BitReader& in, std::string_view name) {
  in.refill();
  const int width = static_cast<int>(in.take(kWidthBits));
  if (width > ContextTables::kScaleBits + 1)
    fail("{}: expected a frequency up to {}, found one of {} bits", name, kScale, width);
  return width == 0 ? 0 : 1u << (width - 1) | static_cast<std::uint32_t>(in.take(width - 1));
}

Frequencies read_table(BitReader& in, std::size_t symbols, std::string_view name) {
  Frequencies result(symbols + 1, 0);
  std::uint32_t sum = read_frequency(in, name);
  if (sum == 0) fail("{}: expected a frequency of the escape above 0, found 0", name);
  result[symbols] = static_cast<std::uint16_t>(sum);
  for (std::size_t symbol = 0; sum < kScale; ++symbol) {
    std::uint32_t frequency = read_frequency(in, name);
    if (frequency == 0) {
      const std::uint32_t skipped = take_gamma(in);
      frequency = read_frequency(in, name);
      symbol += skipped;
      if (skipped == 0 || frequency == 0)
        fail("{}: expected a frequency after those that are 0, found none", name);
    }
    if (symbol >= symbols) fail("{}: expected a symbol below {}, found {}", name, symbols, symbol);
    result[symbol] = static_cast<std::uint16_t>(frequency);
    sum += frequency;
  }
  if (sum != kScale) fail("{}: expected frequencies that sum to {}, found {}", name, kScale, sum);
  if (in.overrun()) fail("{}: expected a table of frequencies, found the end of the data", name);
  return result;
}

}  // namespace

ContextTables::ContextTables(const ContextCounts& counts) : symbols_(counts.symbols()) {
  ADAMAS_ASSERT(symbols_ > 0 && symbols_ <= kMaxSymbols && counts.contexts() > 0);
  constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();
  std::vector<Counts> used;
  std::vector<std::size_t> place(counts.contexts(), kNone);
  for (std::size_t context = 0; context < counts.contexts(); ++context) {
    const auto counted = counts.counts(context);
    if (std::ranges::all_of(counted, [](std::uint64_t count) { return count == 0; })) continue;
    place[context] = used.size();
    used.emplace_back(counted.begin(), counted.end());
  }
  if (used.empty()) used.emplace_back(symbols_, 0);
  Clusters clusters(used);
  clusters.join(kMaxTables);

  std::vector<std::size_t> number(used.size(), kNone);
  std::size_t cluster = clusters.cluster_of(0);
  for (const std::size_t n : place) {
    if (n != kNone) cluster = clusters.cluster_of(n);
    if (number[cluster] == kNone) {
      number[cluster] = tables_.size();
      tables_.push_back(frequencies_of(clusters.counts(cluster)));
    }
    table_of_context_.push_back(static_cast<std::uint8_t>(number[cluster]));
  }
}

void ContextTables::write(BitWriter& out) const {
  std::size_t tables = 0;
  for (const std::uint8_t table : table_of_context_) {
    out.put(table, number_bits(tables));
    if (table == tables) write_table(out, tables_[tables++]);
  }
}

ContextTables ContextTables::read(BitReader& in, std::size_t contexts, std::size_t symbols,
                                  std::string_view name) {
  ContextTables result(symbols);
  for (std::size_t context = 0; context < contexts; ++context) {
    in.refill();
    const std::size_t known = result.tables_.size(), table = in.take(number_bits(known));
    if (table > known || table >= kMaxTables) {
      fail("{}: expected at most {} as the table of context {}, found {}", name,
           std::min(known, kMaxTables - 1), context, table);
    }
    if (table == known)
      result.tables_.push_back(read_table(in, symbols, fmt::format("{}: context {}", name, context)));
    result.table_of_context_.push_back(static_cast<std::uint8_t>(table));
  }
  if (in.overrun()) fail("{}: expected {} contexts, found the end of the data", name, contexts);
  return result;
}

}  // namespace adamas::isosurface
