#include "interfaces/reconstruction/total_closing.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include "core/base/disjoint_sets.h"
#include "core/base/parallel.h"
#include "core/base/release_memory.h"
#include "interfaces/reconstruction/cell_volumes.h"
#include "interfaces/reconstruction/grid_sites.h"
#include "interfaces/reconstruction/site_values.h"
#include "interfaces/reconstruction/sole_owners.h"

namespace adamas::interfaces {

namespace {

using Entry = SiteValues::Entry;

constexpr int kMostRounds = 30;
/// Derivatives are kept for another round if a round leaves less than this part of the missing volume.
constexpr double kFast = 0.01;
/// Totals may differ by at most this part of the domain.
constexpr double kTotalTolerance = 2e-11;
/// All mixed cells share a missing volume equally if it is at most this part of each.
constexpr double kLittle = 2e-4;
/// Otherwise the share of a site grows from kLeastShare, if no mixed cell round it is off, with this power of
/// the part of the mixed cells that are off.
constexpr double kLeastShare = 1e-4;
constexpr int kSharePower = 4;
/// The second derivative of the volume in a cell with respect to an offset, in units of the cell, is taken to
/// be at most this in the mean.
constexpr double kBend = 10;
/// A body's volume is closed only if at most this part of it is missing.
constexpr double kMostOfBody = 0.1;
/// Values move by at most this part of the grid's spacing in a round.
constexpr double kMostShift = 0.1;

/// The sums of this many groups are kept as a full matrix.
constexpr std::size_t kFewGroups = 64;

/// The groups of entries, each for a material or a body. Entries of one material at a site are in one group.
struct Groups {
  std::vector<std::uint32_t> by_entry;
  std::size_t count = 0;
};

/// Finds one offset per group, of which each site gets a share, by Newton's method for the volumes that
/// groups own in the cells of sites with values. The volumes of materials are the gradient of a convex
/// function of the offsets.
class TotalClosing {
 public:
  TotalClosing(const MultiMaterialData& data, SiteValues& values, const SiteCells& cells, Groups groups)
      : data_(data),
        values_(values),
        cells_(cells),
        groups_(std::move(groups)),
        step_(data.grid.least_spacing()),
        is_off_(data.grid.site_count(), 0) {}

  /// Returns the volumes of the groups.
  std::vector<double> measure() {
    shares_.clear();
    totals_ = measure_totals(true);
    return totals_;
  }

  /// Moves values until the groups have their volumes. `wanted`: the volumes by group; NaN for a group that
  /// may have any. The sum of all differences cannot be removed; it is left to the group `balance` or, if
  /// there is no such group, to all groups equally.
  void run(const std::vector<double>& wanted, std::size_t balance, Progress& progress) {
    balance_ = static_cast<Eigen::Index>(balance);
    const auto count = static_cast<Eigen::Index>(groups_.count);
    if (count < 2) return;
    const auto measure_missing = [&] { return missing_of(measure_totals(true), wanted); };
    // All mixed cells share a small missing volume. A larger one is given mainly to cells that are off
    // anyway.
    if (totals_.empty()) measure();
    Eigen::VectorXd missing = missing_of(totals_, wanted);
    const double domain = data_.grid.domain().volume(),
                 cell = domain / static_cast<double>(data_.grid.site_count());
    if (missing.lpNorm<Eigen::Infinity>() >
        kLittle * cell * static_cast<double>(values_.mixed_sites().size())) {
      find_shares();
      missing = measure_missing();
    }
    close(wanted, missing, progress);
    if (missing.lpNorm<Eigen::Infinity>() <= kTotalTolerance * domain) return;
    // All sites share the small rest.
    shares_.clear();
    missing = measure_missing();
    close(wanted, missing, progress);
  }

 private:
  /// Runs Newton's method with the present shares, starting from the missing volumes and their derivatives.
  void close(const std::vector<double>& wanted, Eigen::VectorXd& missing, Progress& progress) {
    const Eigen::Index count = missing.size();
    const double domain = data_.grid.domain().volume();
    Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver;
    double before = std::numeric_limits<double>::infinity();  // the greatest missing volume
    double moved = 0;  // the greatest move since the derivatives were computed
    bool newton = true;
    for (int round = 0; round < kMostRounds; ++round) {
      progress.step("closing volumes", -1);
      const double most = missing.lpNorm<Eigen::Infinity>();
      if (most <= kTotalTolerance * domain) return;
      if (newton) {
        const double scale = Eigen::VectorXd(growth_.diagonal()).maxCoeff();
        if (!(scale > 0)) return;
        solver.compute(growth_ + diagonal(count, 1e-9 * scale));
        moved = 0;
      }
      Eigen::VectorXd offsets = solver.solve(missing);
      offsets.array() -= offsets.mean();
      shift_values(offsets);
      const double last = offsets.lpNorm<Eigen::Infinity>();
      moved += last;
      if (is_expected_closed(last, moved)) {
        missing.setZero();
        return;
      }
      newton = round == 0 || most > kFast * before;
      before = most;
      missing = missing_of(measure_totals(newton), wanted);
    }
  }

  /// Moves values by their shares of the groups' offsets.
  void shift_values(const Eigen::VectorXd& offsets) {
    const double most = kMostShift * step_;
    parallel_for(values_.entries().size(), 1 << 15, [&](std::size_t e) {
      const double offset = share_of(e) * offsets[static_cast<Eigen::Index>(groups_.by_entry[e])];
      shift(values_.entries()[e], std::clamp(offset, -most, most));
    });
  }

  /// Returns whether a step of Newton's method by at most `last` is expected to leave less than the
  /// tolerance, by what volumes bend; what is left shows when the interfaces are extracted. `moved`: the
  /// greatest move since the derivatives were computed, this step included.
  [[nodiscard]] bool is_expected_closed(double last, double moved) const {
    if (values_.least_label_value() > 0) return false;
    // Labels have values at sites that are not mixed.
    const double cells =
        static_cast<double>(values_.entries().size()) / static_cast<double>(data_.grid.site_count());
    return kBend * cells * (last / step_) * (moved / step_) <= kTotalTolerance;
  }

  /// A site's own cell counts as much as this many neighbouring cells.
  static constexpr int kOwnCount = 3;

  /// Returns the volumes that the groups lack. Their sum is 0, since the volumes add up to that of the cells.
  [[nodiscard]] Eigen::VectorXd missing_of(const std::vector<double>& totals,
                                           const std::vector<double>& wanted) const {
    Eigen::VectorXd missing(static_cast<Eigen::Index>(totals.size()));
    for (std::size_t g = 0; g < totals.size(); ++g)
      missing[static_cast<Eigen::Index>(g)] = std::isnan(wanted[g]) ? 0 : wanted[g] - totals[g];
    if (balance_ < missing.size()) {
      missing[balance_] -= missing.sum();
    } else {
      missing.array() -= missing.mean();
    }
    return missing;
  }

  /// Computes each site's share from the part of the mixed cells round it that were off when they were
  /// measured last.
  void find_shares() {
    std::vector<char> is_mixed(is_off_.size(), 0);
    for (const std::uint32_t site : values_.mixed_sites()) is_mixed[site] = 1;
    const GridSites sites(data_.grid);
    shares_.clear();
    for (std::size_t site = 0; site < is_mixed.size(); ++site) {
      const std::span<const Entry> own = static_cast<const SiteValues&>(values_).at(site);
      if (own.empty()) continue;
      int mixed = kOwnCount * is_mixed[site], off = is_mixed[site] * kOwnCount * is_off_[site];
      sites.for_each_neighbour(site, [&](std::size_t other, int, int, int) {
        mixed += is_mixed[other];
        off += is_mixed[other] * is_off_[other];
      });
      const double part = mixed == 0 ? 1 : std::pow(static_cast<double>(off) / mixed, kSharePower);
      shares_.insert(shares_.end(), own.size(), kLeastShare + (1 - kLeastShare) * part);
    }
  }

  /// Moves a value; a smoothed label's value keeps its sign.
  void shift(Entry& entry, double by) const {
    entry.value += by;
    if (values_.least_label_value() == 0) return;
    entry.value = entry.fraction > 0 ? std::max(entry.value, values_.least_label_value())
                                     : std::min(entry.value, -values_.least_label_value());
  }
  /// Returns the share of an offset by which a value moves.
  [[nodiscard]] double share(std::uint32_t entry) const {
    const bool moves =
        entry != CellVolumes::kNone && std::abs(values_.entries()[entry].value) > values_.least_label_value();
    return moves ? share_of(entry) : 0;
  }
  [[nodiscard]] double share_of(std::size_t entry) const { return shares_.empty() ? 1 : shares_[entry]; }

  static Eigen::SparseMatrix<double> diagonal(Eigen::Index count, double by) {
    Eigen::SparseMatrix<double> identity(count, count);
    identity.setIdentity();
    return by * identity;
  }

  /// Returns the group of a material's entries at a site.
  [[nodiscard]] std::uint32_t group(std::size_t site, std::uint16_t material) const {
    return groups_.by_entry[first_entry(values_, site, material)];
  }

  /// The volumes of groups in one layer of cells, and derivatives of the volumes that pairs of groups
  /// exchange.
  struct LayerSums {
    std::vector<std::pair<std::uint32_t, double>> volumes;
    std::vector<std::array<std::uint32_t, 2>> pairs;
    std::vector<double> growth;
  };

  /// Returns the groups' volumes in the cells of sites with values. With `newton`, sets growth_ to their
  /// derivatives with respect to the offsets.
  std::vector<double> measure_totals(bool newton) {
    const SoleOwners owners(data_.grid, values_);
    std::vector<LayerSums> layers(data_.grid.sites(2));
    parallel_for(layers.size(), 1, [&](std::size_t k) { measure_layer(k, newton, owners, layers[k]); });
    std::vector<double> totals(groups_.count, 0);
    for (const LayerSums& sum : layers) {
      for (const auto& [g, volume] : sum.volumes) totals[g] += volume;
    }
    if (newton) set_growth(layers);
    return totals;
  }

  void measure_layer(std::size_t k, bool newton, const SoleOwners& owners, LayerSums& sum) {
    const RectilinearGrid& grid = data_.grid;
    std::vector<double> volumes(groups_.count, 0);
    std::vector<std::uint32_t> groups;  // of the materials in a cell
    CellVolumes cell(grid, values_, cells_);
    for (std::size_t j = 0; j < grid.sites(1); ++j) {
      for (std::size_t i = 0; i < grid.sites(0); ++i) {
        const std::size_t site = grid.site_index(i, j, k);
        if (std::as_const(values_).at(site).empty()) continue;
        const double volume = grid.site_volume(i, j, k);
        if (const std::uint16_t owner = owners.owner(site); owner != SoleOwners::kNone) {
          is_off_[site] = owners.greatest_difference(site, owner) > kCellOff ? 1 : 0;
          volumes[group(site, values_.material_number(owner))] += volume;
          continue;
        }
        cell.set_site(site);
        const std::vector<double>& parts = cell.measure(newton);
        is_off_[site] = cell.greatest_difference() > kCellOff ? 1 : 0;
        groups.clear();
        for (const CellVolumes::Material& material : cell.materials())
          groups.push_back(group(site, material.number));
        for (std::size_t m = 0; m < parts.size(); ++m) volumes[groups[m]] += parts[m] * volume;
        for (const CellVolumes::Pair& pair : cell.pairs()) {
          sum.pairs.push_back({groups[cell.material_of(pair.first)], groups[cell.material_of(pair.second)]});
          double by = 0;
          for (std::size_t n = 0; n < SiteCell::kNeighbours; ++n) {
            if (pair.growth[n] == 0) continue;
            by +=
                0.5 * (share(cell.entry(pair.first, n)) + share(cell.entry(pair.second, n))) * pair.growth[n];
          }
          sum.growth.push_back(by * volume);
        }
      }
    }
    for (std::uint32_t g = 0; g < volumes.size(); ++g) {
      if (volumes[g] != 0) sum.volumes.emplace_back(g, volumes[g]);
    }
  }

  /// Sets growth_ to the sums of derivatives, added in the order of sites. The matrix is sparse, since few of
  /// many groups meet.
  void set_growth(const std::vector<LayerSums>& layers) {
    std::vector<Eigen::Triplet<double>> entries;
    const auto add_entry = [&](std::uint64_t m, std::uint64_t n, double by) {
      entries.emplace_back(static_cast<int>(m), static_cast<int>(n), by);
    };
    if (groups_.count <= kFewGroups) {
      std::vector<double> sums(groups_.count * groups_.count, 0);
      std::vector<char> meet(sums.size(), 0);
      add_growth(layers, [&](std::uint64_t m, std::uint64_t n, double by) {
        sums[m * groups_.count + n] += by;
        meet[m * groups_.count + n] = 1;
      });
      for (std::size_t e = 0; e < sums.size(); ++e) {
        if (meet[e] != 0) add_entry(e / groups_.count, e % groups_.count, sums[e]);
      }
    } else {
      std::unordered_map<std::uint64_t, double> sums;
      add_growth(layers, [&](std::uint64_t m, std::uint64_t n, double by) { sums[m << 32 | n] += by; });
      for (const auto& [key, by] : sums) add_entry(key >> 32, key & 0xffffffffu, by);
    }
    growth_.resize(static_cast<Eigen::Index>(groups_.count), static_cast<Eigen::Index>(groups_.count));
    growth_.setFromTriplets(entries.begin(), entries.end());
  }

  /// Calls add(m, n, by) for all contributions to the derivative of group m's volume with respect to group
  /// n's offset, in the order of sites.
  template <class Add>
  static void add_growth(const std::vector<LayerSums>& layers, const Add& add) {
    for (const LayerSums& sum : layers) {
      for (std::size_t p = 0; p < sum.pairs.size(); ++p) {
        for (const std::uint64_t m : sum.pairs[p]) {
          for (const std::uint64_t n : sum.pairs[p]) add(m, n, m == n ? sum.growth[p] : -sum.growth[p]);
        }
      }
    }
  }

  const MultiMaterialData& data_;
  SiteValues& values_;
  const SiteCells& cells_;
  Groups groups_;
  Eigen::Index balance_ = 0;
  Eigen::SparseMatrix<double> growth_;  // the derivatives of groups' volumes with respect to offsets
  std::vector<double> totals_;          // the volumes of groups that measure() found
  double step_;
  std::vector<char> is_off_;    // by site
  std::vector<double> shares_;  // by entry: its share of an offset; empty if all have the share 1
};

/// Groups entries by bodies: connected sites where a material has the greatest value, and sites round them
/// that hold some of it, each in the nearest body.
class BodyGroups {
 public:
  BodyGroups(const MultiMaterialData& data, const SiteValues& values)
      : values_(values), sites_(data.grid), group_by_entry_(values.entries().size(), kNone) {
    number(data.grid);
    spread(data.grid.site_count());
    // Entries that are near no body form a group of their own, whose volume stays.
    for (std::uint32_t& group : group_by_entry_) {
      if (group == kNone) group = count_;
    }
  }

  [[nodiscard]] Groups take_groups() { return {std::move(group_by_entry_), std::size_t{count_} + 1}; }

 private:
  static constexpr std::uint32_t kNone = 0xffffffffu;

  /// Successive sites along x with one owner.
  struct Run {
    std::uint32_t begin, end;
    std::uint16_t owner;
  };

  /// Returns the number of the material with the greatest value at a site.
  [[nodiscard]] std::uint16_t owner(std::size_t site) const {
    const std::span<const Entry> own = values_.at(site);
    if (own.empty()) return values_.sole_material(site);
    return values_.material_number(std::ranges::max_element(own, {}, &Entry::value)->material);
  }

  [[nodiscard]] std::vector<Run> runs_of_row(std::size_t first, std::size_t count) const {
    std::vector<Run> runs;
    for (std::size_t site = first; site < first + count; ++site) {
      const std::uint16_t own = owner(site);
      const auto begin = static_cast<std::uint32_t>(site);
      if (runs.empty() || runs.back().owner != own)
        runs.push_back({begin, begin + 1, own});
      else
        ++runs.back().end;
    }
    return runs;
  }

  /// Joins the runs of two rows that touch by faces, edges or corners. `away`: the distance from a site of
  /// the first row to that of the second one at the same place along x.
  static void join_rows(const std::vector<Run>& runs, std::array<std::uint32_t, 2> a,
                        std::array<std::uint32_t, 2> b, std::uint32_t away, DisjointSets& sets) {
    while (a[0] < a[1] && b[0] < b[1]) {
      const Run &first = runs[a[0]], &second = runs[b[0]];
      const std::uint32_t begin = second.begin - away, end = second.end - away;
      if (first.begin <= end && begin <= first.end && first.owner == second.owner) sets.join(a[0], b[0]);
      // Runs that end at the same place may both touch the next one of the other row.
      if (first.end < end) {
        ++a[0];
      } else if (end < first.end) {
        ++b[0];
      } else {
        if (a[0] + 1 < a[1] && runs[a[0] + 1].owner == second.owner) sets.join(a[0] + 1, b[0]);
        if (b[0] + 1 < b[1] && runs[b[0] + 1].owner == first.owner) sets.join(a[0], b[0] + 1);
        ++a[0], ++b[0];
      }
    }
  }

  /// Numbers the bodies in the order of their first sites with values, and marks these sites' entries of the
  /// bodies' materials.
  void number(const RectilinearGrid& grid) {
    const std::size_t nx = grid.sites(0), ny = grid.sites(1), nz = grid.sites(2);
    std::vector<std::vector<Run>> rows(ny * nz);
    parallel_for(rows.size(), 64, [&](std::size_t row) { rows[row] = runs_of_row(row * nx, nx); });
    std::vector<Run> runs;
    std::vector<std::uint32_t> first_of_row(1, 0);
    for (std::vector<Run>& row : rows) {
      runs.insert(runs.end(), row.begin(), row.end());
      first_of_row.push_back(static_cast<std::uint32_t>(runs.size()));
      release_memory(row);
    }
    DisjointSets sets(runs.size());
    const auto range = [&](std::size_t row) { return std::array{first_of_row[row], first_of_row[row + 1]}; };
    for (std::size_t row = 0; row < rows.size(); ++row) {
      const std::size_t j = row % ny, k = row / ny;
      const auto join = [&](std::size_t rows_away) {
        join_rows(runs, range(row - rows_away), range(row), static_cast<std::uint32_t>(rows_away * nx), sets);
      };
      if (j > 0) join(1);
      if (k == 0) continue;
      join(ny);
      if (j > 0) join(ny + 1);
      if (j + 1 < ny) join(ny - 1);
    }
    const std::vector<std::uint32_t> roots = std::move(sets).roots();
    std::vector<std::uint32_t> number_of(runs.size(), kNone);
    for (std::size_t run = 0; run < runs.size(); ++run) {
      for (std::size_t site = runs[run].begin; site < runs[run].end; ++site) {
        if (values_.at(site).empty()) continue;
        std::uint32_t& group = number_of[roots[run]];
        if (group == kNone) group = count_++;
        set(site, runs[run].owner, group);
      }
    }
  }

  void set(std::size_t site, std::uint16_t material, std::uint32_t group) {
    for (const Entry& entry : values_.at(site)) {
      if (values_.material_number(entry.material) == material) group_by_entry_[values_.index(entry)] = group;
    }
  }

  [[nodiscard]] bool is_open(std::size_t site) const {
    return std::ranges::any_of(
        values_.at(site), [&](const Entry& entry) { return group_by_entry_[values_.index(entry)] == kNone; });
  }

  /// Returns the least group of a material's entries at the neighbours of a site; kNone if there is none.
  [[nodiscard]] std::uint32_t least_round(std::size_t site, std::uint16_t material) const {
    std::uint32_t group = kNone;
    sites_.for_each_neighbour(site, [&](std::size_t other, int, int, int) {
      for (const Entry& there : values_.at(other)) {
        if (values_.material_number(there.material) == material)
          group = std::min(group, group_by_entry_[values_.index(there)]);
      }
    });
    return group;
  }

  /// Adds entries that are in no body to those of neighbours, ring by ring. An entry that has no such
  /// neighbour is looked at again only beside what the last ring has added.
  void spread(std::size_t site_count) {
    struct Found {
      std::uint32_t site, entry, group;
    };
    std::vector<std::uint32_t> front;
    for (std::size_t site = 0; site < site_count; ++site) {
      if (is_open(site)) front.push_back(static_cast<std::uint32_t>(site));
    }
    std::vector<char> is_fresh(site_count, 1);
    std::vector<Found> found;
    for (bool changed = true, first = true; changed; first = false) {
      std::vector<Found> next = parallel_collect<Found>(
          front.size(), 1024, [&](std::size_t begin, std::size_t end, std::vector<Found>& list) {
            for (std::size_t n = begin; n < end; ++n) {
              const std::uint32_t site = front[n];
              if (!sites_.any_neighbour(site, [&](std::size_t other) { return is_fresh[other] != 0; }))
                continue;
              for (const Entry& entry : values_.at(site)) {
                const std::size_t e = values_.index(entry);
                if (group_by_entry_[e] != kNone) continue;
                const std::uint32_t group = least_round(site, values_.material_number(entry.material));
                if (group != kNone) list.push_back({site, static_cast<std::uint32_t>(e), group});
              }
            }
          });
      if (first) std::fill(is_fresh.begin(), is_fresh.end(), char{0});
      for (const Found& each : found) is_fresh[each.site] = 0;
      for (const Found& each : next) {
        group_by_entry_[each.entry] = each.group;
        is_fresh[each.site] = 1;
      }
      found = std::move(next);
      changed = !found.empty();
      std::erase_if(front, [&](std::uint32_t site) { return !is_open(site); });
    }
  }

  const SiteValues& values_;
  GridSites sites_;
  std::vector<std::uint32_t> group_by_entry_;
  std::uint32_t count_ = 0;
};

}  // namespace

void close_totals(const MultiMaterialData& data, const IdVector<MaterialId, double>& wanted,
                  SiteValues& values, const SiteCells& cells, Progress& progress) {
  Groups groups{std::vector<std::uint32_t>(values.entries().size()), data.materials.size()};
  for (std::size_t e = 0; e < groups.by_entry.size(); ++e)
    groups.by_entry[e] = values.material_number(values.entries()[e].material);
  std::vector<double> left(data.materials.size());
  for (std::uint16_t m = 0; m < left.size(); ++m) left[m] = wanted[values.material(m)];
  const GridSites sites(data.grid);
  for (std::size_t site = 0; site < data.grid.site_count(); ++site) {
    if (std::as_const(values).at(site).empty()) left[values.sole_material(site)] -= sites.cell(site).volume();
  }
  TotalClosing(data, values, cells, std::move(groups)).run(left, left.size(), progress);
}

void close_bodies(const MultiMaterialData& data, SiteValues& values, const SiteCells& cells,
                  Progress& progress) {
  Groups groups = BodyGroups(data, values).take_groups();
  const GridSites sites(data.grid);
  std::vector<double> wanted(groups.count, 0);
  std::vector<double> given;
  for (std::size_t site = 0; site < data.grid.site_count(); ++site) {
    const std::span<const Entry> own = std::as_const(values).at(site);
    if (own.empty()) continue;
    find_given_fractions(data, values, site, given);
    const double volume = sites.cell(site).volume();
    const auto first = static_cast<std::size_t>(own.data() - values.entries().data());
    for (std::size_t e = 0; e < own.size(); ++e) wanted[groups.by_entry[first + e]] += volume * given[e];
  }
  wanted.back() = std::numeric_limits<double>::quiet_NaN();
  const auto largest = std::max_element(wanted.begin(), wanted.end() - 1);
  const auto balance = static_cast<std::size_t>(largest - wanted.begin());
  TotalClosing closing(data, values, cells, std::move(groups));
  // Bodies whose volume differs much from that of their fractions stay as they are.
  const std::vector<double> totals = closing.measure();
  for (std::size_t g = 0; g + 1 < wanted.size(); ++g) {
    if (std::abs(wanted[g] - totals[g]) > kMostOfBody * wanted[g])
      wanted[g] = std::numeric_limits<double>::quiet_NaN();
  }
  closing.run(wanted, balance, progress);
}

}  // namespace adamas::interfaces
