#include "interfaces/reconstruction/fraction_noise.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "core/base/median.h"
#include "core/base/parallel.h"
#include "interfaces/reconstruction/grid_sites.h"
#include "interfaces/reconstruction/interface_planes.h"
#include "interfaces/reconstruction/normal_distribution.h"
#include "interfaces/reconstruction/normal_equations.h"
#include "interfaces/reconstruction/numbered_entries.h"
#include "interfaces/reconstruction/site_values.h"
#include "interfaces/reconstruction/walls.h"

namespace adamas::interfaces {

namespace {

using Entry = SiteValues::Entry;

/// Neighbours count up to this distance in sites, along each axis and squared.
constexpr std::size_t kReach = 2;
constexpr int kSquaredReach = 5;
/// The least number of neighbours for a surface.
constexpr std::size_t kLeastNeighbours = 14;
/// The least sum of the neighbours' weights; with less they are too far from the interface.
constexpr double kLeastWeight = 0.05;
/// Noise is estimated from fractions between kLeastClear and 1 - kLeastClear, of about kMostCells cells at
/// most, and only if there are kLeastCells.
constexpr double kLeastClear = 0.02;
constexpr std::size_t kMostCells = 20000, kLeastCells = 100;
/// The noise is unknown if less than this part of the cells can be predicted.
constexpr double kLeastPart = 0.1;
/// Squared differences above this many times the squared noise are not noise.
constexpr double kBeyond = 2;
/// Sharp interfaces differ from the prediction by this times the square of the mean curvature even without
/// errors.
constexpr double kOfCurved = 0.5;

/// The prediction of a smooth surface through neighbours for an entry.
struct LeftOut {
  double value = 0;      ///< the entry's distance, predicted without its own value
  double fraction = 0;   ///< the fraction for this distance
  double own = 0;        ///< the weight of its own distance in a surface fitted to it and its neighbours
  double curved = 0;     ///< mean curvature, signed, in cells
  bool is_alone = true;  ///< whether the neighbours hold no third material
  bool known = false;
};

/// The number of coefficients of a quadric.
constexpr int kTerms = 10;
using Terms = Eigen::Matrix<double, kTerms, 1>;
using TermSums = Eigen::Matrix<double, kTerms, kTerms>;

/// The neighbours of a site within the reach of a surface.
struct SurfaceNeighbours {
  /// `terms`: those of a quadric at the neighbour.
  struct Neighbour {
    std::size_t site;
    int squared;  ///< the squared distance, in sites
    std::array<double, kTerms> terms;
  };
  static constexpr std::size_t kMost = (2 * kReach + 1) * (2 * kReach + 1) * (2 * kReach + 1);
  std::size_t count = 0;
  std::array<Neighbour, kMost> all;

  SurfaceNeighbours(const GridSites& sites, std::size_t site) {
    const Vec3 size = sites.cell(site).size();
    const auto ways = sites.ways_round<static_cast<int>(kReach)>(site);
    sites.for_each_within(site, kReach, [&](std::size_t other, int di, int dj, int dk) {
      const int squared = di * di + dj * dj + dk * dk;
      if (squared == 0 || squared > kSquaredReach) return;
      const Vec3 way = ways.to(di, dj, dk);
      const double x = way.x / size.x, y = way.y / size.y, z = way.z / size.z;
      all[count++] = {other, squared, {1, x, y, z, x * x, y * y, z * z, x * y, x * z, y * z}};
    });
  }
};

/// The weighted values of neighbours through which a surface is fitted.
class SurfaceSamples {
 public:
  void add(const std::array<double, kTerms>& terms, double weight, double value) {
    samples_[count_++] = {&terms, weight, value};
  }
  [[nodiscard]] std::size_t count() const { return count_; }
  /// Sets the lower triangle of the sums of the normal equations, and their right side. Each sum is added in
  /// the order of samples.
  void sum(TermSums& sums, Terms& right) const {
    sum_squares<kTerms>(
        count_, [&](std::size_t n) { return samples_[n].terms->data(); },
        [&](std::size_t n) { return samples_[n].weight; }, sums);
    std::array<double, kTerms> totals{};
    for (std::size_t n = 0; n < count_; ++n) {
      const double by = samples_[n].weight * samples_[n].value;
      for (std::size_t i = 0; i < kTerms; ++i) totals[i] += by * (*samples_[n].terms)[i];
    }
    for (std::size_t i = 0; i < kTerms; ++i) right[static_cast<Eigen::Index>(i)] = totals[i];
  }

 private:
  struct Sample {
    const std::array<double, kTerms>* terms;
    double weight, value;
  };

  std::size_t count_ = 0;
  std::array<Sample, SurfaceNeighbours::kMost> samples_;
};

class SmoothSurface {
 public:
  SmoothSurface(const MultiMaterialData& data, const SiteValues& values)
      : values_(values), sites_(data.grid) {}

  [[nodiscard]] SurfaceNeighbours neighbours(std::size_t site) const { return {sites_, site}; }

  /// Predicts an entry. With `alone`, finds out whether it is alone.
  [[nodiscard]] LeftOut leave_out(std::size_t site, const SurfaceNeighbours& neighbours, const Entry& entry,
                                  bool alone) const {
    const Vec3 size = sites_.cell(site).size();
    const double width = entry.width > 0 ? values_.width(entry) : std::min({size.x, size.y, size.z});
    SurfaceSamples samples;
    LeftOut result;
    for (std::size_t n = 0; n < neighbours.count; ++n) {
      const SurfaceNeighbours::Neighbour& neighbour = neighbours.all[n];
      const Entry* there = find_entry(values_.at(neighbour.site), entry.material);
      if (there == nullptr || there->is_pure() || (there->width > 0) != (entry.width > 0)) continue;
      const double steps = there->value / width;
      samples.add(neighbour.terms, std::exp(-0.5 * neighbour.squared - steps * steps), there->value);
      if (alone) result.is_alone = result.is_alone && has_no_third(site, neighbour.site);
    }
    if (samples.count() < kLeastNeighbours) return {};
    TermSums sums = TermSums::Zero();
    Terms right;
    samples.sum(sums, right);
    if (sums(0, 0) < kLeastWeight) return {};
    sums.diagonal().array() += 1e-9 * sums(0, 0);
    const Eigen::LDLT<TermSums> solver(sums);
    const Terms found = solver.solve(right), unit = solver.solve(Terms::Unit(0));
    const double own_steps = entry.value / width, w = std::exp(-own_steps * own_steps);
    if (!std::isfinite(found[0]) || !std::isfinite(unit[0])) return {};
    result.curved = (found[4] + found[5] + found[6]) / sites_.least_side(site);
    result.value = found[0];
    result.own = w * unit[0] / (1 + w * unit[0]);
    result.known = true;
    if (entry.width > 0) {
      result.fraction = part_before_walls(values_, site) * normal_probability(found[0] / width);
    } else {
      const Vec3 towards = normalized(Vec3{found[1] / size.x, found[2] / size.y, found[3] / size.z});
      result.fraction = part_behind_plane(towards, size, found[0]);
    }
    return result;
  }

 private:
  /// Returns whether all materials that the site `other` holds are at `site` too.
  [[nodiscard]] bool has_no_third(std::size_t site, std::size_t other) const {
    return std::ranges::all_of(values_.at(other), [&](const Entry& there) {
      const Entry* here = there.fraction > 0 ? find_entry(values_.at(site), there.material) : nullptr;
      return there.fraction <= 0 || (here != nullptr && here->fraction > 0);
    });
  }

  const SiteValues& values_;
  GridSites sites_;
};

/// Returns the noise that the method finds for fractions without errors: the surface through the neighbours'
/// distances is less exact the narrower the step is, up to the error for a sphere of 16 cells. `width`: the
/// width of the steps, in cells.
double error_of_method(double width) {
  constexpr double kSharp = 0.014, kFrom = 0.58, kFalls = 4.2;
  return kSharp * std::exp(-kFalls * std::max(0.0, width - kFrom));
}

/// Returns the mixed sites that are not at a sheet.
std::vector<std::uint32_t> sites_off_sheets(const SiteValues& values, const ThinSheets& sheets) {
  std::vector<std::uint32_t> sites;
  auto place = sheets.places.begin();
  for (const std::uint32_t site : values.mixed_sites()) {
    while (place != sheets.places.end() && place->site < site) ++place;
    if (place == sheets.places.end() || place->site != site) sites.push_back(site);
  }
  return sites;
}

}  // namespace

double fraction_noise(const MultiMaterialData& data, const SiteValues& values, const ThinSheets& sheets) {
  const std::vector<std::uint32_t> mixed = sites_off_sheets(values, sheets);
  const SmoothSurface surface(data, values);
  const std::size_t stride = mixed.size() / kMostCells + 1;
  struct Sample {
    double off = -1, curved = 0;
    std::uint16_t material = 0;
    bool is_sharp = false;
  };
  std::vector<Sample> samples((mixed.size() + stride - 1) / stride);
  parallel_for(samples.size(), 64, [&](std::size_t n) {
    const std::size_t site = mixed[n * stride];
    const SurfaceNeighbours neighbours = surface.neighbours(site);
    for (const Entry& entry : values.at(site)) {
      const auto f = static_cast<double>(entry.fraction);
      if (f < kLeastClear || f > 1 - kLeastClear) continue;
      const LeftOut found = surface.leave_out(site, neighbours, entry, true);
      if (!found.known || (entry.width == 0 && !found.is_alone)) continue;
      const double off = std::abs(found.fraction - f);
      if (off > samples[n].off) samples[n] = {off, found.curved, entry.material, entry.width == 0};
    }
  });
  std::erase_if(samples, [](const Sample& sample) { return sample.off < 0; });
  const double sampled = kLeastPart * static_cast<double>(values.mixed_sites().size() / stride);
  if (samples.size() < kLeastCells || static_cast<double>(samples.size()) < sampled) return sheets.noise;
  // Distances from planes in cells are less exact for a curved interface, by the material's median curvature.
  std::vector<std::vector<double>> curved(values.number_count());
  for (const Sample& sample : samples) curved[sample.material].push_back(sample.curved);
  std::vector<double> means(curved.size(), 0), off;
  for (std::size_t m = 0; m < means.size(); ++m) {
    if (!curved[m].empty()) means[m] = median(curved[m]);
  }
  for (const Sample& sample : samples) {
    const double mean = means[sample.material];
    off.push_back(sample.is_sharp ? std::max(0.0, sample.off - kOfCurved * mean * mean) : sample.off);
  }
  const double found = kDeviationByMedian * median(off), own = error_of_method(values.findings().blur_median);
  return found > own ? std::sqrt(found * found - own * own) : 0;
}

void smooth_within_noise(const MultiMaterialData& data, const ThinSheets& sheets, double noise,
                         SiteValues& values) {
  const SmoothSurface surface(data, values);
  const std::vector<std::uint32_t> mixed = sites_off_sheets(values, sheets);
  // What is needed of a prediction: the value, the fraction and the own weight.
  using Prediction = std::array<double, 3>;
  NumberedEntries numbers(values.entries().size());
  for (const std::uint32_t site : mixed) {
    for (const Entry& entry : std::as_const(values).at(site)) {
      if (!entry.is_pure()) numbers.add(values.index(entry));
    }
  }
  numbers.number_all();
  const auto index = [&](const Entry& entry) { return numbers.number(values.index(entry)); };
  std::vector<Prediction> found(numbers.size());
  std::vector<float> squares(found.size(), -1);  // below 0 where no prediction is known
  parallel_for(mixed.size(), 64, [&](std::size_t n) {
    const SurfaceNeighbours neighbours = surface.neighbours(mixed[n]);
    for (const Entry& entry : std::as_const(values).at(mixed[n])) {
      if (entry.is_pure()) continue;
      const LeftOut predicted = surface.leave_out(mixed[n], neighbours, entry, false);
      if (!predicted.known) continue;
      const double off = predicted.fraction - static_cast<double>(entry.fraction);
      found[index(entry)] = {predicted.value, predicted.fraction, predicted.own};
      squares[index(entry)] = static_cast<float>(off * off);
    }
  });
  const GridSites sites(data.grid);
  parallel_for(mixed.size(), 256, [&](std::size_t n) {
    const std::size_t site = mixed[n];
    float sum = 0;
    for (Entry& entry : values.at(site)) {
      if (const float square = squares[index(entry)]; square >= 0) {
        const auto& [value_there, fraction_there, own] = found[index(entry)];
        // The mean of the squared differences round the site separates noise from the fractions' own
        // variation.
        double mean = static_cast<double>(square);
        int count = 1;
        sites.for_each_neighbour(site, [&](std::size_t other, int, int, int) {
          for (const Entry& there : std::as_const(values).at(other)) {
            if (there.material != entry.material) continue;
            const auto other_square = static_cast<double>(squares[index(there)]);
            if (other_square >= 0) mean += other_square, ++count;
          }
        });
        mean /= count;
        const double kept = std::max(0.0, 1 - kBeyond * noise * noise / std::max(mean, 1e-12)),
                     part = kept + (1 - kept) * own;
        entry.value = value_there + part * (entry.value - value_there);
        const double fraction =
            fraction_there + part * (static_cast<double>(entry.fraction) - fraction_there);
        entry.fraction = static_cast<float>(std::clamp(fraction, 1e-6, 1 - 1e-6));
      }
      sum += entry.fraction;
    }
    for (Entry& entry : values.at(site)) {
      if (!entry.is_pure()) entry.fraction = std::clamp(entry.fraction / sum, 1e-6f, 1 - 1e-6f);
    }
  });
}

}  // namespace adamas::interfaces
