#include "interfaces/reconstruction/total_closing.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "core/base/parallel.h"
#include "interfaces/reconstruction/cell_volumes.h"

namespace adamas {

namespace {

using Entry = SiteValues::Entry;

constexpr int kMostClosings = 12;
/// Of the domain.
constexpr double kTotalTolerance = 2e-11;

class TotalClosing {
 public:
  TotalClosing(const MultiMaterialData& data, SiteValues& values, const SiteCells& cells)
      : data_(data), values_(values), cells_(cells), step_(data.grid.least_spacing()) {}

  /// One offset per material, the same everywhere: Newton's method for the volumes in the whole domain.
  void run(const IdVector<MaterialId, double>& wanted, Progress& progress) {
    const auto count = static_cast<Eigen::Index>(data_.materials.size());
    if (count < 2) return;
    const double domain = data_.grid.domain().volume();
    for (int round = 0; round < kMostClosings; ++round) {
      progress.step("closing volumes", static_cast<double>(round) / kMostClosings);
      Eigen::SparseMatrix<double> growth(count, count);
      const std::vector<double> totals = measure_totals(growth);
      Eigen::VectorXd missing(count);
      for (Eigen::Index m = 0; m < count; ++m)
        missing[m] =
            wanted[values_.material(static_cast<std::uint16_t>(m))] - totals[static_cast<std::size_t>(m)];
      // Adding one number to all offsets changes nothing, and what fractions are beyond 1 cannot be had.
      missing.array() -= missing.mean();
      const double scale = Eigen::VectorXd(growth.diagonal()).maxCoeff();
      if (!(scale > 0) || missing.lpNorm<Eigen::Infinity>() <= kTotalTolerance * domain) return;
      const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(growth + diagonal(count, 1e-9 * scale));
      Eigen::VectorXd offsets = solver.solve(missing);
      offsets.array() -= offsets.mean();
      for (Entry& entry : values_.entries())
        shift(entry, std::clamp(offsets[static_cast<Eigen::Index>(values_.whole(entry.material))],
                                -0.1 * step_, 0.1 * step_));
    }
  }

 private:
  /// Moves a value, which stays on its side where labels are smoothed.
  void shift(Entry& entry, double by) const {
    entry.value += by;
    if (values_.least() == 0) return;
    entry.value =
        entry.fraction > 0 ? std::max(entry.value, values_.least()) : std::min(entry.value, -values_.least());
  }
  /// Whether an offset moves a value.
  [[nodiscard]] bool moves(std::uint32_t entry) const {
    return entry != CellVolumes::kNone && std::abs(values_.entries()[entry].value) > values_.least();
  }

  static Eigen::SparseMatrix<double> diagonal(Eigen::Index count, double by) {
    Eigen::SparseMatrix<double> identity(count, count);
    identity.setIdentity();
    return by * identity;
  }

  /// The materials' volumes in the domain, and how they grow with offsets: few of many materials meet.
  std::vector<double> measure_totals(Eigen::SparseMatrix<double>& growth) const {
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
          const std::vector<double>& parts = cell.measure(true);
          for (std::size_t m = 0; m < parts.size(); ++m)
            sum.volumes[cell.materials()[m].number] += parts[m] * volume;
          for (const CellVolumes::Pair& pair : cell.pairs()) {
            sum.pairs.push_back({cell.materials()[cell.material_of(pair.first)].number,
                                 cell.materials()[cell.material_of(pair.second)].number});
            double by = 0;
            for (std::size_t n = 0; n < SiteCell::kNeighbours; ++n) {
              const int movable = static_cast<int>(moves(cell.entry(pair.first, n))) +
                                  static_cast<int>(moves(cell.entry(pair.second, n)));
              by += 0.5 * movable * pair.growth[n];
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
    growth.setFromTriplets(sums.begin(), sums.end());
    return totals;
  }

  const MultiMaterialData& data_;
  SiteValues& values_;
  const SiteCells& cells_;
  double step_;
};

}  // namespace

void close_totals(const MultiMaterialData& data, const IdVector<MaterialId, double>& wanted,
                  SiteValues& values, const SiteCells& cells, Progress& progress) {
  TotalClosing(data, values, cells).run(wanted, progress);
}

}  // namespace adamas
