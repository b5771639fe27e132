#include "interfaces/reconstruction/volume_correction.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/base/loop_progress.h"
#include "core/base/parallel.h"
#include "interfaces/reconstruction/blurred_fractions.h"
#include "interfaces/reconstruction/cell_volumes.h"
#include "interfaces/reconstruction/grid_sites.h"
#include "interfaces/reconstruction/sole_owners.h"
#include "interfaces/reconstruction/total_closing.h"
#include "interfaces/reconstruction/volume_system.h"

namespace adamas::interfaces {

namespace {

using Entry = SiteValues::Entry;

/// The greatest numbers of sweeps over cells that are far off, of rounds for all cells, and of times that
/// cells are added to these.
constexpr int kMostSweeps = 6, kMostRounds = 40, kMostTurns = 3;
/// A cell is far off if a volume differs from its fraction by more than this, relative to the cell.
constexpr double kFarOff = 0.03;
/// Cells that one material fills are corrected with the mixed ones if other materials get more than this of
/// them.
constexpr double kIntruded = 1e-4;
/// Cells are corrected again if more than this part of them has been added.
constexpr double kLeastJoined = 2e-2;
/// Rounds end when at most kMostOff of the cells are off, or when both the number of these and the system's
/// cost fall by less than kLeastGain. If more than kManyOff are off after kFirstRounds rounds, as with
/// smeared fractions, the gain must be kLeastGainOfMany.
constexpr double kMostOff = 6e-3, kLeastGain = 1e-2, kManyOff = 0.1, kLeastGainOfMany = 6e-2;
constexpr int kFirstRounds = 4;
/// The damping of a value in units of the grid: gains that need larger moves would make the surface rough. It
/// falls from round to round, but rises if a move has gone too far: if the cost round a site has become more
/// than kTooFar times what it was (Levenberg 1944 and Marquardt 1963, with a damping for each value).
constexpr double kDamping = 1e-3, kDampingFalls = 0.6, kDampingRises = 4, kTooFar = 1.5;
constexpr double kLeastDamping = 1e-4, kMostDamping = 1;
/// The greatest number of halvings of a move that increases costs.
constexpr int kMostHalvings = 4;
/// Smaller moves, in cells, need no new measurement.
constexpr double kStill = 1e-6;

class Correction {
 public:
  Correction(const MultiMaterialData& data, SiteValues& values, const SiteCells& cells)
      : data_(data),
        values_(values),
        grid_sites_(data.grid),
        cells_(cells),
        step_(data.grid.least_spacing()) {
    for (const std::uint32_t site : values.mixed_sites()) {
      if (values.is_blurred(site)) continue;
      sharp_.push_back(site);
      const auto [i, j, k] = grid_sites_.indices(site);
      colours_[i % 2 + 2 * (j % 2) + 4 * (k % 2)].push_back(site);
    }
  }

  void run(Progress& progress) {
    const bool blurred = sharp_.size() < values_.mixed_sites().size();
    if (blurred) fit_blurred(data_, values_, cells_, progress);
    changed_.assign(data_.grid.site_count(), 0);
    for (int sweep = 0; sweep < kMostSweeps; ++sweep) {
      progress.step("correcting volumes", -1);
      std::size_t off = 0;
      for (int colour = 0; colour < 8; ++colour) off += correct(colour, 1 + 8 * sweep + colour);
      values_.hold_layers();
      if (off == 0) break;
    }
    std::fill(changed_.begin(), changed_.end(), 0);
    for (int turn = 0; turn < kMostTurns && find_cells(); ++turn) {
      find_unknowns();
      correct_all(progress);
    }
    if (blurred) close_bodies(data_, values_, cells_, progress);
    close_totals(data_, values_.volumes(), values_, cells_, progress);
  }

 private:
  static constexpr std::size_t kChunk = 64, kBlock = 8;
  static constexpr std::uint32_t kNone = 0xffffffffu;

  [[nodiscard]] std::span<const Entry> entries(std::size_t site) const {
    return static_cast<const SiteValues&>(values_).at(site);
  }

  /// Returns whether a value at a site or a neighbour has changed since call number `since`.
  [[nodiscard]] bool has_changed(std::size_t site, int since) const {
    return changed_[site] >= since ||
           grid_sites_.any_neighbour(site, [&](std::size_t other) { return changed_[other] >= since; });
  }

  /// Corrects the cells of a colour that are far off, one by one, and returns their number. Cells of one
  /// colour do not touch each other. A material without a surface in a cell that should hold one gets it
  /// here. `now` counts the calls; only sites near changes since the last call for this colour are examined.
  std::size_t correct(int colour, int now) {
    const auto& sites = colours_[static_cast<std::size_t>(colour)];
    std::vector<std::size_t> off((sites.size() + kChunk - 1) / kChunk);
    parallel_chunks(sites.size(), kChunk, [&](std::size_t begin, std::size_t end) {
      CellVolumes cell(data_.grid, values_, cells_);
      for (std::size_t n = begin; n < end; ++n) {
        if (now > 8 && !has_changed(sites[n], now - 8)) continue;
        if (!correct(sites[n], cell)) continue;
        changed_[sites[n]] = now;
        ++off[begin / kChunk];
      }
    });
    std::size_t sum = 0;
    for (const std::size_t n : off) sum += n;
    return sum;
  }

  bool correct(std::size_t site, CellVolumes& cell) {
    cell.set_site(site);
    const std::vector<double>& volumes = cell.measure();
    if (cell.greatest_difference() <= kFarOff) return false;
    std::vector<std::size_t> present;
    for (std::size_t m = 0; m < cell.materials().size(); ++m) {
      if (cell.materials()[m].fraction > 0) present.push_back(m);
    }
    if (present.size() == 2) {
      raise(cell, present[0], present[1], volumes);
    } else {
      for (const std::size_t m : present) raise(cell, m, m, m == present[0] ? volumes : cell.measure());
    }
    for (std::size_t row = 0; row < cell.rows(); ++row) {
      const std::uint32_t entry = cell.entry(row, SiteCell::kSelf);
      if (entry != CellVolumes::kNone) values_.entries()[entry].value = cell.value_at_site(row);
    }
    return true;
  }

  /// Raises the values of the m-th material, and lowers those of the n-th, if that is another one, by as
  /// much, until the m-th volume is right. Volumes grow with values, so two steps of the secant method are
  /// enough. `volumes`: those before.
  void raise(CellVolumes& cell, std::size_t m, std::size_t n, const std::vector<double>& volumes) const {
    const double most = values_.greatest_value();
    cell.store_values();
    const auto set = [&](double shift) {
      const double part = m == n ? shift : 0.5 * shift;
      cell.move_values(m, part, most);
      if (m != n) cell.move_values(n, -part, most);
    };
    const double before = volumes[m], missing = cell.materials()[m].fraction - before;
    const double guess = std::clamp(2.5 * missing * step_, -step_, step_);
    if (guess == 0) return;
    set(guess);
    const double slope = (cell.measure()[m] - before) / guess;
    if (slope * step_ > 0.02) set(std::clamp(missing / slope, -2 * step_, 2 * step_));
  }

  /// Returns whether a site or a neighbour is blurred.
  [[nodiscard]] bool is_near_blurred(std::size_t site) const {
    if (sharp_.size() == values_.mixed_sites().size()) return false;
    return values_.is_blurred(site) ||
           grid_sites_.any_neighbour(site, [&](std::size_t other) { return values_.is_blurred(other); });
  }

  /// Finds the cells to correct; returns whether enough have joined them to correct again.
  bool find_cells() {
    if (sharp_.empty()) return false;
    std::vector<char> chosen(data_.grid.site_count(), 0);
    for (const std::uint32_t site : sharp_) chosen[site] = 1;
    for (const std::uint32_t site : cells_to_correct_) chosen[site] = 1;
    const SoleOwners owners(data_.grid, values_);
    parallel_chunks(chosen.size(), 64 * kChunk, [&](std::size_t begin, std::size_t end) {
      CellVolumes cell(data_.grid, values_, cells_);
      for (std::size_t site = begin; site < end; ++site) {
        if (chosen[site] != 0 || entries(site).empty()) continue;
        const std::uint16_t owner = owners.owner(site);
        if (owner != SoleOwners::kNone && owners.greatest_difference(site, owner) <= kIntruded) continue;
        if (is_near_blurred(site)) continue;
        cell.set_site(site);
        cell.measure();
        chosen[site] = cell.greatest_difference() > kIntruded ? 1 : 0;
      }
    });
    const std::size_t before = cells_to_correct_.size();
    cells_to_correct_.clear();
    row_of_.assign(1, 0);
    for (std::uint32_t site = 0; site < chosen.size(); ++site) {
      if (chosen[site] == 0) continue;
      cells_to_correct_.push_back(site);
      row_of_.push_back(row_of_.back() + static_cast<std::uint32_t>(entries(site).size()));
    }
    return static_cast<double>(cells_to_correct_.size()) > (1 + kLeastJoined) * static_cast<double>(before);
  }

  /// Finds the unknowns: the values, in the cells to correct, of materials with a fraction there.
  void find_unknowns() {
    unknowns_.clear();
    site_of_.clear();
    unknown_of_.assign(values_.entries().size(), kNone);
    for (const std::uint32_t site : cells_to_correct_) {
      for (const Entry& entry : entries(site)) {
        if (entry.fraction <= 0) continue;
        unknown_of_[index_of(entry)] = static_cast<std::uint32_t>(unknowns_.size());
        unknowns_.push_back(static_cast<std::uint32_t>(index_of(entry)));
        site_of_.push_back(site);
      }
    }
  }
  [[nodiscard]] std::size_t index_of(const Entry& entry) const { return values_.index(entry); }
  [[nodiscard]] std::uint32_t unknown(std::uint32_t entry) const {
    return entry == CellVolumes::kNone ? kNone : unknown_of_[entry];
  }

  /// Moves all values together until most volumes are right, by the Gauss-Newton method with steps that are
  /// halved if they go too far.
  void correct_all(Progress& progress) {
    if (unknowns_.empty()) return;
    VolumeSystem system;
    system.missing.resize(row_of_.back());
    linearise(system);
    double best = system.cost();
    std::size_t off = system.cells_off();
    damping_.assign(unknowns_.size(), kDamping / (step_ * step_));
    for (int round = 0; round < kMostRounds; ++round) {
      progress.step("correcting volumes", -1);
      if (static_cast<double>(off) <= kMostOff * static_cast<double>(cells_to_correct_.size())) return;
      std::vector<double> move = system.solve(damping_);
      for (double& m : move) m = std::clamp(m, -0.5 * step_, 0.5 * step_);
      const double sum = step(system, move, best);
      const std::size_t off_before = off;
      off = system.cells_off();
      const bool many = round >= kFirstRounds &&
                        static_cast<double>(off) > kManyOff * static_cast<double>(cells_to_correct_.size());
      const double left = 1 - (many ? kLeastGainOfMany : kLeastGain);
      const bool settled =
          sum > left * best && static_cast<double>(off) > left * static_cast<double>(off_before);
      best = std::min(sum, best);
      if (settled) return;
    }
  }

  /// Moves values. If that does not reduce the cost, the move is shortened: first at sites where it increases
  /// the cost, then everywhere; if nothing helps, values do not change. Returns the system's cost afterwards.
  double step(VolumeSystem& system, const std::vector<double>& move, double best) {
    std::vector<double> start, shares(unknowns_.size(), 1);
    for (const std::uint32_t entry : unknowns_) start.push_back(values_.entries()[entry].value);
    const std::vector<double> before = costs_round_sites(system.missing);
    const auto try_shares = [&] {
      place(start, move, shares);
      linearise(system);
      return system.cost();
    };
    for (int halving = 0; halving <= kMostHalvings; ++halving) {
      const double sum = try_shares();
      const std::vector<double> after = costs_round_sites(system.missing);
      if (halving == 0) damp(before, after);
      if (sum <= best) return sum;
      for (std::size_t i = 0; i < unknowns_.size(); ++i) {
        if (after[site_of_[i]] > before[site_of_[i]])
          shares[i] = halving + 1 < kMostHalvings ? 0.5 * shares[i] : 0;
      }
    }
    for (int halving = 1; halving <= kMostHalvings; ++halving) {
      std::fill(shares.begin(), shares.end(), std::ldexp(1.0, -halving));
      if (const double sum = try_shares(); sum <= best) return sum;
    }
    std::fill(shares.begin(), shares.end(), 0);
    return try_shares();
  }

  /// Adapts the damping to the effect of a whole move.
  void damp(const std::vector<double>& before, const std::vector<double>& after) {
    const double unit = 1 / (step_ * step_);
    for (std::size_t i = 0; i < unknowns_.size(); ++i) {
      const bool too_far = after[site_of_[i]] > kTooFar * before[site_of_[i]];
      damping_[i] = std::clamp(damping_[i] * (too_far ? kDampingRises : kDampingFalls), kLeastDamping * unit,
                               kMostDamping * unit);
    }
  }

  /// Returns the cost of missing volumes in the cells of each site and its neighbours.
  [[nodiscard]] std::vector<double> costs_round_sites(const std::vector<double>& missing) const {
    std::vector<double> own(data_.grid.site_count(), 0), sums(own.size(), 0);
    for (std::size_t n = 0; n < cells_to_correct_.size(); ++n) {
      for (std::uint32_t row = row_of_[n]; row < row_of_[n + 1]; ++row)
        own[cells_to_correct_[n]] += VolumeSystem::cost_of(missing[row]);
    }
    parallel_for(cells_to_correct_.size(), 1024, [&](std::size_t n) {
      double sum = own[cells_to_correct_[n]];
      grid_sites_.for_each_neighbour(cells_to_correct_[n],
                                     [&](std::size_t other, int, int, int) { sum += own[other]; });
      sums[cells_to_correct_[n]] = sum;
    });
    return sums;
  }

  /// Sets values to the start plus shares of the move, but keeps sheets from tearing.
  void place(const std::vector<double>& start, const std::vector<double>& move,
             const std::vector<double>& shares) {
    std::vector<double> before;
    for (std::size_t i = 0; i < start.size(); ++i) {
      double& value = values_.entries()[unknowns_[i]].value;
      before.push_back(value);
      value = start[i] + shares[i] * move[i];
    }
    values_.hold_layers();
    for (std::size_t i = 0; i < start.size(); ++i) {
      if (std::abs(values_.entries()[unknowns_[i]].value - before[i]) > kStill * step_)
        changed_[site_of_[i]] = 1;
    }
  }

  /// Updates the system in blocks where values have changed.
  void linearise(VolumeSystem& system) {
    const bool fresh = system.blocks.empty();
    system.blocks.resize((cells_to_correct_.size() + kBlock - 1) / kBlock);
    parallel_chunks(cells_to_correct_.size(), kBlock, [&](std::size_t begin, std::size_t end) {
      if (!fresh && std::none_of(cells_to_correct_.begin() + static_cast<std::ptrdiff_t>(begin),
                                 cells_to_correct_.begin() + static_cast<std::ptrdiff_t>(end),
                                 [&](std::uint32_t site) { return has_changed(site, 1); }))
        return;
      VolumeSystem::Block& block = system.blocks[begin / kBlock];
      block.clear(row_of_[begin], row_of_[end]);
      CellVolumes cell(data_.grid, values_, cells_);
      for (std::size_t n = begin; n < end; ++n) {
        cell.set_site(cells_to_correct_[n]);
        const std::vector<double>& volumes = cell.measure(true);
        block.cells_off += cell.greatest_difference() > kCellOff ? 1 : 0;
        for (std::size_t m = 0; m < volumes.size(); ++m)
          system.missing[row_of_[n] + m] = cell.materials()[m].fraction - volumes[m];
        for (const CellVolumes::Pair& pair : cell.pairs()) add_exchange(cell, pair, row_of_[n], block);
      }
    });
    std::fill(changed_.begin(), changed_.end(), 0);
  }

  void add_exchange(const CellVolumes& cell, const CellVolumes::Pair& pair, std::uint32_t row,
                    VolumeSystem::Block& block) const {
    const auto first = static_cast<std::uint32_t>(block.coefficients.size());
    for (std::size_t n = 0; n < SiteCell::kNeighbours; ++n) {
      if (pair.growth[n] == 0) continue;
      const auto by = static_cast<float>(pair.growth[n]);
      const std::uint32_t gains = unknown(cell.entry(pair.first, n)),
                          loses = unknown(cell.entry(pair.second, n));
      if (gains != kNone) block.coefficients.push_back({gains, by});
      if (loses != kNone) block.coefficients.push_back({loses, -by});
    }
    block.exchanges.push_back({row + static_cast<std::uint32_t>(cell.material_of(pair.first)),
                               row + static_cast<std::uint32_t>(cell.material_of(pair.second)), first,
                               static_cast<std::uint32_t>(block.coefficients.size()) - first});
  }

  const MultiMaterialData& data_;
  SiteValues& values_;
  GridSites grid_sites_;
  const SiteCells& cells_;
  double step_;
  std::vector<int> changed_;          // by site: the number of the call that changed it last
  std::vector<std::uint32_t> sharp_;  // mixed sites that are not blurred
  // These sites in groups whose cells do not touch each other.
  std::array<std::vector<std::uint32_t>, 8> colours_;
  std::vector<std::uint32_t> cells_to_correct_;
  std::vector<std::uint32_t> row_of_;      // the first row of each cell to correct
  std::vector<std::uint32_t> unknowns_;    // entries that are moved
  std::vector<std::uint32_t> site_of_;     // the site of each unknown
  std::vector<std::uint32_t> unknown_of_;  // by entry
  std::vector<double> damping_;            // by unknown
};

}  // namespace

void correct_volumes(const MultiMaterialData& data, SiteValues& values, const SiteCells& cells,
                     Progress& progress) {
  const LoopProgress loops(progress);
  Correction(data, values, cells).run(progress);
}

}  // namespace adamas::interfaces
