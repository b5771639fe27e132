#include "interfaces/mesh_reconstruction/mesh_fit.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "core/base/loop_progress.h"
#include "core/base/parallel.h"
#include "core/base/sort_unique.h"
#include "interfaces/reconstruction/cell_volumes.h"
#include "interfaces/reconstruction/volume_system.h"

namespace adamas::interfaces {

namespace {

using Index = MeshSubdivision::Index;
using Entry = MeshValues::Entry;

constexpr std::uint32_t kNone = 0xffffffffu;
/// Rounds end when at most kMostOff of the mixed cells are off, none by more than kFarOff, or when the cost
/// falls by less than kLeastGain.
constexpr int kMostRounds = 40;
constexpr double kMostOff = 2e-2, kFarOff = 5e-3, kLeastGain = 0.02;
/// A value moves by at most this part of a cell's extent in a round. A move that raises the cost is halved,
/// at most so often.
constexpr double kMostMove = 0.5;
constexpr int kMostHalvings = 4;
/// The damping of a value in extents of its cell: gains that need larger moves would make the surface rough.
/// It rises where moves go too far, and falls again (Levenberg 1944 and Marquardt 1963).
constexpr double kLeastDamping = 1e-3, kMostDamping = 1, kDampingFalls = 0.6, kDampingRises = 4;
/// Materials without a surface in a cell of which they fill more than kMuch are raised in at most so many
/// sweeps, each time by as much as a plane would move that had their volume, in cells of this derivative of
/// volume by extent, or less.
constexpr int kMostSweeps = 12;
constexpr double kMuch = 0.03, kLeastGrowth = 0.5, kMostRaise = 0.2;
/// For damping, extents are at least this part of the greatest one.
constexpr double kLeastExtent = 1e-6;

class Fit {
 public:
  Fit(const std::vector<double>& extents, MeshValues& values, MeshVolumes& volumes)
      : extents_(extents),
        values_(values),
        volumes_(volumes),
        first_rows_{0},
        rows_of_cells_(values.subdivision().mesh().cell_count(), kNone) {
    for (const Index c : values.active_cells()) {
      const std::span<const Entry> own = std::as_const(values).at(c);
      rows_of_cells_[c] = first_rows_.back();
      first_rows_.push_back(first_rows_.back() + static_cast<std::uint32_t>(own.size()));
      mixed_ += std::ranges::any_of(own, is_mixed) ? 1 : 0;
    }
    system_.missing.resize(first_rows_.back());
  }

  void run(Progress& progress) {
    const LoopProgress loops(progress);
    linearise();
    for (int sweep = 0; sweep < kMostSweeps && raise_absent(); ++sweep) linearise();
    double cost = system_.cost(), damping = kLeastDamping;
    for (int round = 0; round < kMostRounds; ++round) {
      progress.step("correcting volumes", static_cast<double>(round) / kMostRounds);
      if (is_good()) return;
      const int halvings = move(damping, cost);
      if (halvings > kMostHalvings && damping == kMostDamping) return;
      damping =
          std::clamp(damping * (halvings == 0 ? kDampingFalls : kDampingRises), kLeastDamping, kMostDamping);
      if (halvings > kMostHalvings) continue;
      const double before = std::exchange(cost, system_.cost());
      if (cost > (1 - kLeastGain) * before) return;
    }
  }

 private:
  static bool is_mixed(const Entry& entry) { return entry.fraction > 0 && entry.fraction < 1; }

  [[nodiscard]] bool is_good() const {
    return static_cast<double>(system_.cells_off()) <= kMostOff * static_cast<double>(mixed_) &&
           std::ranges::all_of(system_.missing, [](double missing) { return std::abs(missing) <= kFarOff; });
  }

  /// Raises values of materials that have no surface in a cell which holds much of them, as in a film, so
  /// that their volumes there do not depend on any value. Returns whether there are such.
  bool raise_absent() {
    bool any = false;
    for (std::size_t n = 0; n < values_.active_cells().size(); ++n) {
      const std::span<Entry> own = values_.at(values_.active_cells()[n]);
      for (std::size_t e = 0; e < own.size(); ++e) {
        // How much of it the regions of a material have in a cell of a film is not known so well.
        if (!(own[e].fraction > kMuch) || volumes_.parts(n)[e] > 0 || values_.is_part(own[e].material))
          continue;
        own[e].value += std::min(static_cast<double>(own[e].fraction) / kLeastGrowth, kMostRaise) *
                        extents_[first_rows_[n] + e];
        any = true;
      }
    }
    return any;
  }

  /// Moves values, and halves the move until the cost is less than it was. Returns how often; after more than
  /// kMostHalvings values are what they were.
  int move(double damping, double cost) {
    std::vector<double> damping_of_each, start;
    const double least = kLeastExtent * *std::ranges::max_element(extents_);
    for (const double extent : extents_)
      damping_of_each.push_back(damping / std::pow(std::max(extent, least), 2));
    for (const Index c : values_.active_cells()) {
      for (const Entry& entry : std::as_const(values_).at(c)) start.push_back(entry.value);
    }
    const std::vector<double> moves = system_.solve(damping_of_each);
    for (int halvings = 0;; ++halvings) {
      const double share = halvings > kMostHalvings ? 0 : std::ldexp(1.0, -halvings);
      std::size_t at = 0;
      for (const Index c : values_.active_cells()) {
        for (Entry& entry : values_.at(c)) {
          const double most = kMostMove * extents_[at];
          entry.value = start[at] + share * std::clamp(moves[at], -most, most);
          ++at;
        }
      }
      linearise();
      if (share == 0 || system_.cost() < cost) return halvings;
    }
  }

  /// Measures volumes, and finds how they depend on values.
  void linearise() {
    constexpr std::size_t kBlock = 64;
    values_.interpolate();
    volumes_.measure(true);
    const std::vector<Index>& active = values_.active_cells();
    system_.blocks.resize((active.size() + kBlock - 1) / kBlock);
    parallel_chunks(active.size(), kBlock, [&](std::size_t begin, std::size_t end) {
      VolumeSystem::Block& block = system_.blocks[begin / kBlock];
      block.clear(first_rows_[begin], first_rows_[end]);
      for (std::size_t n = begin; n < end; ++n) {
        block.cells_off += set_missing(n) > kCellOff ? 1 : 0;
        for (const MeshVolumes::Exchange& exchange : volumes_.exchanges(n)) add_exchange(n, exchange, block);
      }
    });
  }

  /// Sets the missing volumes of an active cell; returns the greatest. Regions of a material have one
  /// together, that of the first one.
  double set_missing(std::size_t n) {
    const std::span<const Entry> own = std::as_const(values_).at(values_.active_cells()[n]);
    const std::span<double> missing = std::span(system_.missing).subspan(first_rows_[n], own.size());
    std::ranges::fill(missing, 0);
    for (std::size_t e = 0; e < own.size(); ++e)
      missing[first_of_material(values_, own, own[e].material)] +=
          static_cast<double>(own[e].fraction) - volumes_.parts(n)[e];
    double most = 0;
    for (const double each : missing) most = std::max(most, std::abs(each));
    return most;
  }

  void add_exchange(std::size_t n, const MeshVolumes::Exchange& exchange, VolumeSystem::Block& block) const {
    const Index cell = values_.active_cells()[n];
    const std::uint32_t gains = row(cell, exchange.first), loses = row(cell, exchange.second);
    if (gains == kNone || loses == kNone || gains == loses) return;
    // The sums, by unknown, are all 0 before and after.
    thread_local std::vector<double> sums;
    thread_local std::vector<std::uint32_t> touched;
    if (sums.size() < first_rows_.back()) sums.resize(first_rows_.back(), 0);
    touched.clear();
    const auto add = [&](Index point, std::uint16_t material, double growth) {
      values_.for_each_source(point, material, [&](Index source, double weight) {
        const std::uint32_t unknown = this->unknown(source, material);
        if (unknown == kNone) return;
        if (sums[unknown] == 0) touched.push_back(unknown);
        sums[unknown] += weight * growth;
      });
    };
    for (const auto& [point, growth] : exchange.of_points) {
      add(point, exchange.first, growth);
      add(point, exchange.second, -growth);
    }
    sort_unique(touched);
    const auto first = static_cast<std::uint32_t>(block.coefficients.size());
    for (const std::uint32_t unknown : touched)
      block.coefficients.push_back({unknown, static_cast<float>(std::exchange(sums[unknown], 0))});
    block.exchanges.push_back(
        {gains, loses, first, static_cast<std::uint32_t>(block.coefficients.size()) - first});
  }

  /// Returns the row of a material in a cell, by one of its numbers: the number of its first entry among
  /// those of active cells; kNone if it has none.
  [[nodiscard]] std::uint32_t row(Index cell, std::uint16_t number) const {
    if (rows_of_cells_[cell] == kNone) return kNone;
    const std::span<const Entry> own = std::as_const(values_).at(cell);
    const std::size_t found = first_of_material(values_, own, number);
    return found == own.size() ? kNone : rows_of_cells_[cell] + static_cast<std::uint32_t>(found);
  }
  /// Returns the unknown of a number in a cell, that of its entry; kNone if it has none.
  [[nodiscard]] std::uint32_t unknown(Index cell, std::uint16_t number) const {
    if (rows_of_cells_[cell] == kNone) return kNone;
    const std::span<const Entry> own = std::as_const(values_).at(cell);
    const auto found = std::ranges::find(own, number, &Entry::material);
    return found == own.end() ? kNone
                              : rows_of_cells_[cell] + static_cast<std::uint32_t>(found - own.begin());
  }

  const std::vector<double>& extents_;
  MeshValues& values_;
  MeshVolumes& volumes_;
  std::vector<std::uint32_t> first_rows_;     // by active cell, and the end
  std::vector<std::uint32_t> rows_of_cells_;  // by cell: its first row, or kNone
  std::size_t mixed_ = 0;                     // the number of cells with several materials
  VolumeSystem system_;
};

}  // namespace

void fit_volumes(const std::vector<double>& extents, MeshValues& values, MeshVolumes& volumes,
                 Progress& progress) {
  Fit(extents, values, volumes).run(progress);
}

}  // namespace adamas::interfaces
