#include <Eigen/SparseCholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "core/base/parallel.h"
#include "interfaces/reconstruction/cell_volumes.h"
#include "interfaces/reconstruction/grid_sites.h"
#include "interfaces/reconstruction/volume_correction.h"

namespace adamas {

namespace {

using Entry = SiteValues::Entry;

constexpr int kMostRounds = 12;
/// Derivatives stay as they are where a round leaves less than this part of what was missing.
constexpr double kFast = 0.01;
/// Totals are right that differ by no more than this part of the domain.
constexpr double kTotalTolerance = 2e-11;
/// What is missing may go to all mixed cells alike where it is no more than this part of each.
constexpr double kLittle = 2e-4;
/// Otherwise sites round which no mixed cell is off have the least share of an offset; it grows with this
/// power of the part of the mixed cells that are off.
constexpr double kLeastShare = 1e-4;
constexpr int kSharePower = 4;
/// Values move by at most this part of the grid's spacing in a round.
constexpr double kMostShift = 0.1;

/// One offset per material, of which a site gets a share: Newton's method for the volumes in the whole
/// domain. These are the gradient of a convex function of the offsets.
class TotalClosing {
 public:
  TotalClosing(const MultiMaterialData& data, SiteValues& values, const SiteCells& cells)
      : data_(data),
        values_(values),
        cells_(cells),
        step_(data.grid.least_spacing()),
        is_off_(data.grid.site_count(), 0) {}

  void run(const IdVector<MaterialId, double>& wanted, Progress& progress) {
    const auto count = static_cast<Eigen::Index>(data_.materials.size());
    if (count < 2) return;
    Eigen::SparseMatrix<double> growth(count, count);
    const auto measure_missing = [&](bool newton) {
      return missing_of(measure_totals(newton ? &growth : nullptr), wanted);
    };
    // Little may go to all mixed cells alike. Of more than that cells whose volumes are right get nearly
    // nothing: it goes where cells are off anyway.
    shares_.assign(values_.entries().size(), 1);
    Eigen::VectorXd missing = measure_missing(true);
    const double domain = data_.grid.domain().volume(),
                 cell = domain / static_cast<double>(data_.grid.site_count());
    if (missing.lpNorm<Eigen::Infinity>() > kLittle * cell * static_cast<double>(values_.mixed().size())) {
      find_shares();
      missing = measure_missing(true);
    }
    Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver;
    double before = std::numeric_limits<double>::infinity();  // missing at most
    bool newton = true;
    for (int round = 0; round < kMostRounds; ++round) {
      progress.step("closing volumes", static_cast<double>(round) / kMostRounds);
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
        const double offset = shares_[e] * offsets[static_cast<Eigen::Index>(values_.whole(entry.material))];
        shift(entry, std::clamp(offset, -kMostShift * step_, kMostShift * step_));
      }
      newton = round == 0 || most > kFast * before;
      before = most;
      missing = measure_missing(newton);
    }
  }

 private:
  /// A site's own cell counts as much as so many of its neighbours'.
  static constexpr int kOwnCount = 3;

  /// What the materials miss, but for one number that all do: adding it to all offsets changes nothing, and
  /// what fractions are beyond 1 cannot be had.
  [[nodiscard]] Eigen::VectorXd missing_of(const std::vector<double>& totals,
                                           const IdVector<MaterialId, double>& wanted) const {
    Eigen::VectorXd missing(static_cast<Eigen::Index>(totals.size()));
    for (std::size_t m = 0; m < totals.size(); ++m)
      missing[static_cast<Eigen::Index>(m)] =
          wanted[values_.material(static_cast<std::uint16_t>(m))] - totals[m];
    missing.array() -= missing.mean();
    return missing;
  }

  /// Finds each site's share by how many of the mixed cells round it were off when they were measured last.
  void find_shares() {
    std::vector<char> is_mixed(is_off_.size(), 0);
    for (const std::uint32_t site : values_.mixed()) is_mixed[site] = 1;
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

  /// Moves a value, which stays on its side where labels are smoothed.
  void shift(Entry& entry, double by) const {
    entry.value += by;
    if (values_.least() == 0) return;
    entry.value =
        entry.fraction > 0 ? std::max(entry.value, values_.least()) : std::min(entry.value, -values_.least());
  }
  /// How much an offset moves a value.
  [[nodiscard]] double share(std::uint32_t entry) const {
    const bool moves =
        entry != CellVolumes::kNone && std::abs(values_.entries()[entry].value) > values_.least();
    return moves ? shares_[entry] : 0;
  }

  static Eigen::SparseMatrix<double> diagonal(Eigen::Index count, double by) {
    Eigen::SparseMatrix<double> identity(count, count);
    identity.setIdentity();
    return by * identity;
  }

  /// The materials' volumes in the domain, and, where that is wanted, how they grow with offsets: few of many
  /// materials meet.
  std::vector<double> measure_totals(Eigen::SparseMatrix<double>* growth) {
    struct Sum {
      std::vector<double> volumes;
      std::vector<std::array<std::uint16_t, 2>> pairs;
      std::vector<double> growth;
    };
    const RectilinearGrid& grid = data_.grid;
    std::vector<Sum> layers(grid.sites(2));
    parallel_for(layers.size(), 1, [&](std::size_t k) {
      Sum& sum = layers[k];
      sum.volumes.assign(data_.materials.size(), 0);
      CellVolumes cell(grid, values_, cells_);
      for (std::size_t j = 0; j < grid.sites(1); ++j) {
        for (std::size_t i = 0; i < grid.sites(0); ++i) {
          const std::size_t site = grid.site_index(i, j, k);
          const double volume = grid.site_volume(i, j, k);
          const std::span<const Entry> own = static_cast<const SiteValues&>(values_).at(site);
          if (own.empty()) {
            sum.volumes[values_.sole_material(site)] += volume;
            continue;
          }
          cell.go_to(site);
          const std::vector<double>& parts = cell.measure(growth != nullptr);
          is_off_[site] = cell.greatest_difference() > kCellOff ? 1 : 0;
          for (std::size_t m = 0; m < parts.size(); ++m)
            sum.volumes[cell.materials()[m].number] += parts[m] * volume;
          for (const CellVolumes::Pair& pair : cell.pairs()) {
            sum.pairs.push_back({cell.materials()[cell.material_of(pair.first)].number,
                                 cell.materials()[cell.material_of(pair.second)].number});
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
    });
    std::vector<double> totals(data_.materials.size(), 0);
    std::vector<Eigen::Triplet<double>> sums;
    for (const Sum& sum : layers) {
      for (std::size_t m = 0; m < totals.size(); ++m) totals[m] += sum.volumes[m];
      for (std::size_t p = 0; p < sum.pairs.size(); ++p) {
        const int a = sum.pairs[p][0], b = sum.pairs[p][1];
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
  double step_;
  std::vector<char> is_off_;    // by site
  std::vector<double> shares_;  // by entry: how much of an offset it gets
};

}  // namespace

void close_totals(const MultiMaterialData& data, const IdVector<MaterialId, double>& wanted,
                  SiteValues& values, const SiteCells& cells, Progress& progress) {
  TotalClosing(data, values, cells).run(wanted, progress);
}

}  // namespace adamas
