#include "isosurface/compression/context_clusters.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace adamas {
namespace {

using Counts = std::vector<std::uint64_t>;

/// About what a table costs, and each of its symbols.
constexpr double kTableBits = 10, kSymbolBits = 11;

/// Bits of all symbols of a cluster and of its table.
double cost(std::span<const std::uint64_t> a, std::span<const std::uint64_t> b) {
  std::uint64_t total = 0;
  double bits = kTableBits;
  for (std::size_t n = 0; n < a.size(); ++n) {
    const std::uint64_t count = a[n] + (b.empty() ? 0 : b[n]);
    if (count == 0) continue;
    const auto number = static_cast<double>(count);
    bits += kSymbolBits - number * std::log2(number);
    total += count;
  }
  const auto number = static_cast<double>(total);
  return total == 0 ? bits : bits + number * std::log2(number);
}

/// Which clusters there are, and what it would cost to join any two.
class Joiner {
 public:
  explicit Joiner(std::vector<Counts> clusters) : clusters_(std::move(clusters)), size_(clusters_.size()) {
    alive_.assign(size_, true);
    into_.resize(size_);
    extra_.assign(size_ * size_, 0);
    for (std::size_t n = 0; n < size_; ++n) {
      into_[n] = n;
      costs_.push_back(cost(clusters_[n], {}));
    }
    for (std::size_t a = 0; a < size_; ++a) {
      for (std::size_t b = a + 1; b < size_; ++b) update(a, b);
    }
  }

  void join(std::size_t most) {
    for (std::size_t left = size_; left > 1; --left) {
      std::size_t best_a = 0, best_b = 0;
      double best = std::numeric_limits<double>::infinity();
      for (std::size_t a = 0; a < size_; ++a) {
        if (!alive_[a]) continue;
        for (std::size_t b = a + 1; b < size_; ++b) {
          if (!alive_[b] || extra_[a * size_ + b] >= best) continue;
          best = extra_[a * size_ + b], best_a = a, best_b = b;
        }
      }
      if (best >= 0 && left <= most) return;
      join(best_a, best_b);
    }
  }

  [[nodiscard]] bool alive(std::size_t n) const { return alive_[n]; }
  [[nodiscard]] const Counts& counts(std::size_t n) const { return clusters_[n]; }
  [[nodiscard]] std::size_t of(std::size_t n) const { return into_[n]; }

 private:
  void join(std::size_t a, std::size_t b) {
    for (std::size_t n = 0; n < clusters_[a].size(); ++n) clusters_[a][n] += clusters_[b][n];
    alive_[b] = false;
    std::ranges::replace(into_, b, a);
    costs_[a] = cost(clusters_[a], {});
    for (std::size_t other = 0; other < size_; ++other) {
      if (alive_[other] && other != a) update(std::min(a, other), std::max(a, other));
    }
  }
  void update(std::size_t a, std::size_t b) {
    extra_[a * size_ + b] = cost(clusters_[a], clusters_[b]) - costs_[a] - costs_[b];
  }

  std::vector<Counts> clusters_;
  std::size_t size_;
  std::vector<bool> alive_;
  std::vector<std::size_t> into_;
  std::vector<double> costs_, extra_;  ///< extra: of joining a with b > a
};

}  // namespace

ContextClusters context_clusters(const ContextCounts& counts, std::size_t most) {
  constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();
  std::vector<Counts> used;
  std::vector<std::size_t> place(counts.contexts(), kNone);
  for (std::size_t context = 0; context < counts.contexts(); ++context) {
    const auto of = counts.of(context);
    if (std::ranges::all_of(of, [](std::uint64_t count) { return count == 0; })) continue;
    place[context] = used.size();
    used.emplace_back(of.begin(), of.end());
  }
  if (used.empty()) used.emplace_back(counts.symbols(), 0);
  Joiner joiner(used);
  joiner.join(most);

  ContextClusters result;
  std::vector<std::uint8_t> number(used.size(), 0);
  for (std::size_t n = 0; n < used.size(); ++n) {
    if (!joiner.alive(n)) continue;
    number[n] = static_cast<std::uint8_t>(result.counts.size());
    result.counts.push_back(joiner.counts(n));
  }
  std::uint8_t before = 0;
  for (const std::size_t n : place) {
    if (n != kNone) before = number[joiner.of(n)];
    result.map.push_back(before);
  }
  return result;
}

}  // namespace adamas
