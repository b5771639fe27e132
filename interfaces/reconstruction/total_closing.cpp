#include "interfaces/reconstruction/total_closing.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <unordered_set>
#include <utility>
#include <vector>

#include "core/base/parallel.h"
#include "interfaces/reconstruction/cell_volumes.h"
#include "interfaces/reconstruction/grid_sites.h"
#include "interfaces/reconstruction/site_values.h"

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
/// A body's volume is closed only if at most this part of it is missing.
constexpr double kMostOfBody = 0.1;
/// Values move by at most this part of the grid's spacing in a round.
constexpr double kMostShift = 0.1;

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
  std::vector<double> measure() { return measure_totals(nullptr); }

  /// Moves values until the groups have their volumes. `wanted`: the volumes by group; NaN for a group that
  /// may have any. The sum of all differences cannot be removed; it is left to the group `balance` or, if
  /// there is no such group, to all groups equally.
  void run(const std::vector<double>& wanted, std::size_t balance, Progress& progress) {
    balance_ = static_cast<Eigen::Index>(balance);
    const auto count = static_cast<Eigen::Index>(groups_.count);
    if (count < 2) return;
    Eigen::SparseMatrix<double> growth(count, count);
    const auto measure_missing = [&](bool newton) {
      return missing_of(measure_totals(newton ? &growth : nullptr), wanted);
    };
    // All mixed cells share a small missing volume. A larger one is given mainly to cells that are off
    // anyway.
    shares_.assign(values_.entries().size(), 1);
    Eigen::VectorXd missing = measure_missing(true);
    const double domain = data_.grid.domain().volume(),
                 cell = domain / static_cast<double>(data_.grid.site_count());
    if (missing.lpNorm<Eigen::Infinity>() >
        kLittle * cell * static_cast<double>(values_.mixed_sites().size())) {
      find_shares();
      missing = measure_missing(true);
    }
    close(wanted, missing, growth, progress);
    if (missing.lpNorm<Eigen::Infinity>() <= kTotalTolerance * domain) return;
    // All sites share the small rest.
    shares_.assign(values_.entries().size(), 1);
    missing = measure_missing(true);
    close(wanted, missing, growth, progress);
  }

 private:
  /// Runs Newton's method with the present shares, starting from the missing volumes and their derivatives.
  void close(const std::vector<double>& wanted, Eigen::VectorXd& missing, Eigen::SparseMatrix<double>& growth,
             Progress& progress) {
    const Eigen::Index count = missing.size();
    const double domain = data_.grid.domain().volume();
    Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver;
    double before = std::numeric_limits<double>::infinity();  // the greatest missing volume
    bool newton = true;
    for (int round = 0; round < kMostRounds; ++round) {
      progress.step("closing volumes", -1);
      const double most = missing.lpNorm<Eigen::Infinity>();
      if (most <= kTotalTolerance * domain) return;
      if (newton) {
        const double scale = Eigen::VectorXd(growth.diagonal()).maxCoeff();
        if (!(scale > 0)) return;
        solver.compute(growth + diagonal(count, 1e-9 * scale));
      }
      Eigen::VectorXd offsets = solver.solve(missing);
      offsets.array() -= offsets.mean();
      for (std::size_t e = 0; e < shares_.size(); ++e) {
        Entry& entry = values_.entries()[e];
        const double offset = shares_[e] * offsets[static_cast<Eigen::Index>(groups_.by_entry[e])];
        shift(entry, std::clamp(offset, -kMostShift * step_, kMostShift * step_));
      }
      newton = round == 0 || most > kFast * before;
      before = most;
      missing = missing_of(measure_totals(newton ? &growth : nullptr), wanted);
    }
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
    return moves ? shares_[entry] : 0;
  }

  static Eigen::SparseMatrix<double> diagonal(Eigen::Index count, double by) {
    Eigen::SparseMatrix<double> identity(count, count);
    identity.setIdentity();
    return by * identity;
  }

  /// Returns the group of a material's entries at a site.
  [[nodiscard]] std::uint32_t group(std::size_t site, std::uint16_t material) const {
    return groups_.by_entry[first_entry(values_, site, material)];
  }

  /// Returns the groups' volumes in the cells of sites with values. Sets `growth`, unless it is null, to
  /// their derivatives with respect to the offsets; the matrix is sparse, since few of many groups meet.
  std::vector<double> measure_totals(Eigen::SparseMatrix<double>* growth) {
    struct Sum {
      std::vector<std::pair<std::uint32_t, double>> volumes;
      std::vector<std::array<std::uint32_t, 2>> pairs;
      std::vector<double> growth;
    };
    const RectilinearGrid& grid = data_.grid;
    std::vector<Sum> layers(grid.sites(2));
    parallel_for(layers.size(), 1, [&](std::size_t k) {
      Sum& sum = layers[k];
      std::vector<double> volumes(groups_.count, 0);
      CellVolumes cell(grid, values_, cells_);
      for (std::size_t j = 0; j < grid.sites(1); ++j) {
        for (std::size_t i = 0; i < grid.sites(0); ++i) {
          const std::size_t site = grid.site_index(i, j, k);
          const double volume = grid.site_volume(i, j, k);
          if (static_cast<const SiteValues&>(values_).at(site).empty()) continue;
          cell.set_site(site);
          const std::vector<double>& parts = cell.measure(growth != nullptr);
          is_off_[site] = cell.greatest_difference() > kCellOff ? 1 : 0;
          for (std::size_t m = 0; m < parts.size(); ++m)
            volumes[group(site, cell.materials()[m].number)] += parts[m] * volume;
          for (const CellVolumes::Pair& pair : cell.pairs()) {
            sum.pairs.push_back({group(site, cell.materials()[cell.material_of(pair.first)].number),
                                 group(site, cell.materials()[cell.material_of(pair.second)].number)});
            double by = 0;
            for (std::size_t n = 0; n < SiteCell::kNeighbours; ++n) {
              if (pair.growth[n] == 0) continue;
              by += 0.5 * (share(cell.entry(pair.first, n)) + share(cell.entry(pair.second, n))) *
                    pair.growth[n];
            }
            sum.growth.push_back(by * volume);
          }
        }
      }
      for (std::uint32_t g = 0; g < volumes.size(); ++g) {
        if (volumes[g] != 0) sum.volumes.emplace_back(g, volumes[g]);
      }
    });
    std::vector<double> totals(groups_.count, 0);
    std::vector<Eigen::Triplet<double>> sums;
    for (const Sum& sum : layers) {
      for (const auto& [g, volume] : sum.volumes) totals[g] += volume;
      for (std::size_t p = 0; p < sum.pairs.size(); ++p) {
        const auto a = static_cast<int>(sum.pairs[p][0]), b = static_cast<int>(sum.pairs[p][1]);
        for (const int m : {a, b}) {
          for (const int n : {a, b}) sums.emplace_back(m, n, m == n ? sum.growth[p] : -sum.growth[p]);
        }
      }
    }
    if (growth != nullptr) growth->setFromTriplets(sums.begin(), sums.end());
    return totals;
  }

  const MultiMaterialData& data_;
  SiteValues& values_;
  const SiteCells& cells_;
  Groups groups_;
  Eigen::Index balance_ = 0;
  double step_;
  std::vector<char> is_off_;    // by site
  std::vector<double> shares_;  // by entry: its share of an offset
};

/// Groups entries by bodies: connected sites where a material has the greatest value, and sites round them
/// that hold some of it, each in the nearest body.
class BodyGroups {
 public:
  BodyGroups(const MultiMaterialData& data, const SiteValues& values)
      : values_(values), sites_(data.grid), group_by_entry_(values.entries().size(), kNone) {
    for (std::size_t site = 0; site < data.grid.site_count(); ++site) {
      if (const std::size_t entry = owner(site); entry != kNoEntry && group_by_entry_[entry] == kNone)
        collect(site, values_.material_number(values_.entries()[entry].material));
    }
    spread(data.grid.site_count());
    // Entries that are near no body form a group of their own, whose volume stays.
    for (std::uint32_t& group : group_by_entry_) {
      if (group == kNone) group = count_;
    }
  }

  [[nodiscard]] Groups groups() const { return {group_by_entry_, std::size_t{count_} + 1}; }

 private:
  static constexpr std::uint32_t kNone = 0xffffffffu;
  static constexpr std::size_t kNoEntry = std::numeric_limits<std::size_t>::max();

  [[nodiscard]] std::size_t owner(std::size_t site) const {
    const std::span<const Entry> own = values_.at(site);
    if (own.empty()) return kNoEntry;
    const auto most = std::ranges::max_element(own, {}, &Entry::value);
    return first_entry(values_, site, values_.material_number(most->material));
  }

  void set(std::size_t site, std::uint16_t material, std::uint32_t group) {
    for (const Entry& entry : values_.at(site)) {
      if (values_.material_number(entry.material) == material) group_by_entry_[values_.index(entry)] = group;
    }
  }

  /// Marks the body of a site. The search passes through sites without values too, which have no entries to
  /// mark.
  void collect(std::size_t site, std::uint16_t material) {
    set(site, material, count_);
    reached_.assign(1, site);
    for (std::size_t next = 0; next < reached_.size(); ++next) {
      sites_.for_each_neighbour(reached_[next], [&](std::size_t other, int, int, int) {
        if (values_.at(other).empty()) {
          if (values_.sole_material(other) == material && inner_.insert(other).second)
            reached_.push_back(other);
          return;
        }
        const std::size_t entry = owner(other);
        if (group_by_entry_[entry] != kNone ||
            values_.material_number(values_.entries()[entry].material) != material)
          return;
        set(other, material, count_);
        reached_.push_back(other);
      });
    }
    ++count_;
  }

  /// Adds entries that are in no body to those of neighbours, ring by ring.
  void spread(std::size_t site_count) {
    std::vector<std::size_t> front;
    for (std::size_t site = 0; site < site_count; ++site) {
      if (!values_.at(site).empty()) front.push_back(site);
    }
    for (bool changed = true; changed;) {
      std::vector<std::pair<std::size_t, std::uint32_t>> found;
      std::vector<std::size_t> left;
      for (const std::size_t site : front) {
        bool open = false;
        for (const Entry& entry : values_.at(site)) {
          const std::size_t e = values_.index(entry);
          if (group_by_entry_[e] != kNone) continue;
          std::uint32_t group = kNone;
          sites_.for_each_neighbour(site, [&](std::size_t other, int, int, int) {
            for (const Entry& there : values_.at(other)) {
              if (values_.material_number(there.material) == values_.material_number(entry.material))
                group = std::min(group, group_by_entry_[values_.index(there)]);
            }
          });
          if (group != kNone) found.emplace_back(e, group);
          open = open || group == kNone;
        }
        if (open) left.push_back(site);
      }
      for (const auto& [e, group] : found) group_by_entry_[e] = group;
      changed = !found.empty();
      front = std::move(left);
    }
  }

  const SiteValues& values_;
  GridSites sites_;
  std::vector<std::uint32_t> group_by_entry_;
  std::uint32_t count_ = 0;
  std::vector<std::size_t> reached_;
  std::unordered_set<std::size_t> inner_;
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
  Groups groups = BodyGroups(data, values).groups();
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
