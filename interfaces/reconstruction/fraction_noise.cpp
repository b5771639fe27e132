#include "interfaces/reconstruction/fraction_noise.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "core/base/loop_progress.h"
#include "core/base/parallel.h"
#include "core/base/simd.h"
#include "interfaces/reconstruction/error_criterion.h"
#include "interfaces/reconstruction/grid_sites.h"
#include "interfaces/reconstruction/interface_planes.h"
#include "interfaces/reconstruction/normal_distribution.h"
#include "interfaces/reconstruction/numbered_entries.h"
#include "interfaces/reconstruction/site_values.h"
#include "interfaces/reconstruction/walls.h"

namespace adamas::interfaces {

namespace {

using Entry = SiteValues::Entry;

/// The parts of the time that distances take until errors are estimated, and until all sites are predicted.
constexpr double kEstimateShare = 0.2, kPredictedShare = 0.9;
/// Neighbours count up to this distance in sites along each axis.
constexpr std::size_t kReach = 2;
constexpr int kSquaredReach = ErrorCriterion::kSquaredReach;

/// The prediction of a smooth surface through neighbours for an entry.
struct LeftOut {
  double value = 0;      ///< the entry's distance, predicted without its own value
  double fraction = 0;   ///< the fraction for this distance
  double own = 0;        ///< the weight of its own distance in a surface fitted to it and its neighbours
  double curved = 0;     ///< mean curvature, signed, in cells
  bool is_alone = true;  ///< whether the neighbours hold no third material
  bool known = false;
};

/// The greatest degree of products of two terms of a quadric.
constexpr std::size_t kDegree = 4;
/// The number of a quadric's terms, which are products of powers of x, y and z. The constant is the last one.
constexpr std::size_t kTerms = 10, kConstant = 9;
constexpr std::array<std::array<std::uint8_t, 3>, kTerms> kPowers{{{2, 0, 0},
                                                                   {0, 2, 0},
                                                                   {0, 0, 2},
                                                                   {1, 1, 0},
                                                                   {1, 0, 1},
                                                                   {0, 1, 1},
                                                                   {1, 0, 0},
                                                                   {0, 1, 0},
                                                                   {0, 0, 1},
                                                                   {0, 0, 0}}};

/// Weights, or weights times values, at the sites of a cube round a site.
class CubeOfSites {
 public:
  static constexpr std::size_t kSide = 2 * kReach + 1;
  using Powers = std::array<std::array<double, kDegree + 1>, kSide>;  ///< of coordinates along an axis
  /// Sums of products with powers of coordinates: moments[a][b][c] for x^a y^b z^c.
  using Moments = std::array<std::array<std::array<double, kDegree + 1>, kDegree + 1>, kDegree + 1>;

  double& at(int di, int dj, int dk) { return numbers_[index(dk)][index(dj)][index(di)]; }
  void clear() { numbers_ = {}; }

  /// Sums up along one axis after another, which takes a fraction of the products for each site. Moments up
  /// to kMost are set.
  template <std::size_t kMost>
  void sum(const std::array<Powers, 3>& powers, Moments& moments) const {
    for (std::size_t a = 0; a <= kMost; ++a) {
      for (std::size_t b = 0; a + b <= kMost; ++b) moments[a][b].fill(0);
    }
    for (int dk = -kReachSigned; dk <= kReachSigned; ++dk) {
      std::array<std::array<double, kDegree + 1>, kDegree + 1> plane{};
      for (int dj = -kReachSigned; dj <= kReachSigned; ++dj) {
        if (dj * dj + dk * dk > kSquaredReach) continue;
        std::array<double, kMost + 1> row{};
        for (std::size_t i = 0; i < kSide; ++i) {
          for (std::size_t a = 0; a <= kMost; ++a)
            row[a] += numbers_[index(dk)][index(dj)][i] * powers[0][i][a];
        }
        for (std::size_t a = 0; a <= kMost; ++a) {
          for (std::size_t b = 0; a + b <= kMost; ++b) plane[a][b] += row[a] * powers[1][index(dj)][b];
        }
      }
      for (std::size_t a = 0; a <= kMost; ++a) {
        for (std::size_t b = 0; a + b <= kMost; ++b) {
          for (std::size_t c = 0; a + b + c <= kMost; ++c)
            moments[a][b][c] += plane[a][b] * powers[2][index(dk)][c];
        }
      }
    }
  }

 private:
  static constexpr int kReachSigned = static_cast<int>(kReach);
  static std::size_t index(int d) { return static_cast<std::size_t>(d + kReachSigned); }

  std::array<std::array<std::array<double, kSide>, kSide>, kSide> numbers_{};
};

/// The normal equations of a quadric.
class QuadricEquations {
 public:
  QuadricEquations(const CubeOfSites::Moments& squares, const CubeOfSites::Moments& values) {
    for (std::size_t i = 0; i < kTerms; ++i) {
      const auto& p = kPowers[i];
      for (std::size_t j = 0; j <= i; ++j) {
        const auto& q = kPowers[j];
        lower_[i][j] = squares[p[0] + q[0]][p[1] + q[1]][p[2] + q[2]];
      }
      solution_[i] = values[p[0]][p[1]][p[2]];
    }
  }

  /// Solves the equations, with `damping` added to the diagonal, by Cholesky's method without roots.
  void solve(double damping) {
    for (std::size_t j = 0; j < kTerms; ++j) {
      std::array<double, kTerms> scaled;
      double own = lower_[j][j] + damping;
      for (std::size_t k = 0; k < j; ++k) {
        scaled[k] = lower_[j][k] * pivots_[k];
        own -= lower_[j][k] * scaled[k];
      }
      pivots_[j] = own;
      const double by = 1 / own;
      for (std::size_t i = j + 1; i < kTerms; ++i) {
        double rest = lower_[i][j];
        for (std::size_t k = 0; k < j; ++k) rest -= lower_[i][k] * scaled[k];
        lower_[i][j] = rest * by;
      }
    }
    for (std::size_t i = 0; i < kTerms; ++i) {
      for (std::size_t k = 0; k < i; ++k) solution_[i] -= lower_[i][k] * solution_[k];
    }
    for (std::size_t i = kTerms; i-- > 0;) {
      solution_[i] /= pivots_[i];
      for (std::size_t k = i + 1; k < kTerms; ++k) solution_[i] -= lower_[k][i] * solution_[k];
    }
  }
  [[nodiscard]] double coefficient(std::size_t term) const { return solution_[term]; }
  /// Returns the growth of the constant with its own right side: an entry of the inverse matrix.
  [[nodiscard]] double growth_of_constant() const { return 1 / pivots_[kConstant]; }

 private:
  std::array<std::array<double, kTerms>, kTerms> lower_;
  std::array<double, kTerms> pivots_, solution_;
};

/// Fits smooth surfaces through the distances at the neighbours of sites.
class SmoothSurface {
 public:
  SmoothSurface(const MultiMaterialData& data, const SiteValues& values)
      : values_(values), sites_(data.grid) {}

  /// Predicts the entries of a site that are not pure: found[e] becomes the prediction for the e-th one. With
  /// `alone`, finds out which are alone.
  void leave_out(std::size_t site, bool alone, std::vector<LeftOut>& found) {
    const std::span<const Entry> own = values_.at(site);
    const Vec3 size = sites_.cell(site).size();
    gather(site, size, alone);
    const auto ways = sites_.ways_round<static_cast<int>(kReach)>(site);
    std::array<CubeOfSites::Powers, 3> powers{};
    for (std::size_t a = 0; a < 3; ++a) {
      for (std::size_t i = 0; i < CubeOfSites::kSide; ++i) {
        const double x =
            ways.along(a, static_cast<int>(i) - static_cast<int>(kReach)) / size[static_cast<int>(a)];
        powers[a][i] = {1, x, x * x, x * x * x, x * x * x * x};
      }
    }
    found.assign(own.size(), {});
    for (std::size_t e = 0; e < own.size(); ++e) {
      if (!own[e].is_pure() && samples_[e].count >= ErrorCriterion::kLeastNeighbours)
        predict(site, size, own[e], samples_[e], powers, found[e]);
    }
  }

 private:
  /// The neighbours' distances into the material of one entry, with their weights.
  struct Samples {
    CubeOfSites weights, weighted;
    std::size_t count;
    double width;
    bool is_alone;
  };

  void gather(std::size_t site, const Vec3& size, bool alone) {
    static const std::array<double, kSquaredReach + 1> kNear = [] {
      std::array<double, kSquaredReach + 1> made{};
      for (int squared = 0; squared <= kSquaredReach; ++squared)
        made[static_cast<std::size_t>(squared)] = std::exp(-0.5 * squared);
      return made;
    }();
    const std::span<const Entry> own = values_.at(site);
    if (samples_.size() < own.size()) samples_.resize(own.size());
    for (std::size_t e = 0; e < own.size(); ++e) {
      Samples& samples = samples_[e];
      samples.weights.clear(), samples.weighted.clear();
      samples.count = 0;
      samples.width = width_of(own[e], size);
      samples.is_alone = true;
    }
    sites_.for_each_within(site, kReach, [&](std::size_t other, int di, int dj, int dk) {
      const int squared = di * di + dj * dj + dk * dk;
      if (squared == 0 || squared > kSquaredReach) return;
      const std::span<const Entry> there = values_.at(other);
      const bool no_third = !alone || has_no_third(site, other);
      for (std::size_t e = 0; e < own.size(); ++e) {
        if (own[e].is_pure()) continue;
        const Entry* entry = find_entry(there, own[e].material);
        if (entry == nullptr || entry->is_pure() || (entry->width > 0) != (own[e].width > 0)) continue;
        Samples& samples = samples_[e];
        const double steps = entry->value / samples.width,
                     weight = kNear[static_cast<std::size_t>(squared)] * std::exp(-steps * steps);
        samples.weights.at(di, dj, dk) = weight;
        samples.weighted.at(di, dj, dk) = weight * entry->value;
        ++samples.count;
        samples.is_alone = samples.is_alone && no_third;
      }
    });
  }

  [[nodiscard]] double width_of(const Entry& entry, const Vec3& size) const {
    return entry.width > 0 ? values_.width(entry) : std::min({size.x, size.y, size.z});
  }

  void predict(std::size_t site, const Vec3& size, const Entry& entry, const Samples& samples,
               const std::array<CubeOfSites::Powers, 3>& powers, LeftOut& result) const {
    CubeOfSites::Moments squares, values;
    with_wide_lanes([&](auto) {
      samples.weights.sum<kDegree>(powers, squares);
      samples.weighted.sum<kDegree / 2>(powers, values);
    });
    const double weights = squares[0][0][0];
    if (weights < ErrorCriterion::kLeastWeight) return;
    QuadricEquations equations(squares, values);
    equations.solve(1e-9 * weights);
    const double value = equations.coefficient(kConstant), unit = equations.growth_of_constant(),
                 own_steps = entry.value / samples.width, w = std::exp(-own_steps * own_steps);
    if (!std::isfinite(value) || !std::isfinite(unit)) return;
    result.curved = (equations.coefficient(0) + equations.coefficient(1) + equations.coefficient(2)) /
                    sites_.least_side(site);
    result.value = value;
    result.own = w * unit / (1 + w * unit);
    result.is_alone = samples.is_alone;
    result.known = true;
    if (entry.width > 0) {
      result.fraction = part_before_walls(values_, site) * normal_probability(value / samples.width);
    } else {
      const Vec3 towards =
          normalized(Vec3{equations.coefficient(6) / size.x, equations.coefficient(7) / size.y,
                          equations.coefficient(8) / size.z});
      result.fraction = part_behind_plane(towards, size, value);
    }
  }

  /// Returns whether all materials that the site `other` holds are at `site` too.
  [[nodiscard]] bool has_no_third(std::size_t site, std::size_t other) const {
    return std::ranges::all_of(values_.at(other), [&](const Entry& there) {
      const Entry* here = there.fraction > 0 ? find_entry(values_.at(site), there.material) : nullptr;
      return there.fraction <= 0 || (here != nullptr && here->fraction > 0);
    });
  }

  const SiteValues& values_;
  GridSites sites_;
  std::vector<Samples> samples_;  // by entry of the site
};

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
  const std::size_t stride = ErrorCriterion::stride(mixed.size());
  std::vector<ErrorCriterion::Sample> samples((mixed.size() + stride - 1) / stride);
  LoopProgress::begin_part(kEstimateShare, static_cast<double>(samples.size()));
  parallel_chunks(samples.size(), 64, [&](std::size_t begin, std::size_t end) {
    SmoothSurface surface(data, values);
    std::vector<LeftOut> predicted;
    for (std::size_t n = begin; n < end; ++n) {
      const std::size_t site = mixed[n * stride];
      surface.leave_out(site, true, predicted);
      for (std::size_t e = 0; e < predicted.size(); ++e) {
        const Entry& entry = values.at(site)[e];
        const LeftOut& found = predicted[e];
        const auto f = static_cast<double>(entry.fraction);
        if (f < ErrorCriterion::kLeastClear || f > 1 - ErrorCriterion::kLeastClear) continue;
        if (!found.known || (entry.width == 0 && !found.is_alone)) continue;
        const double off = std::abs(found.fraction - f);
        if (off > samples[n].off) samples[n] = {off, found.curved, entry.material, entry.width == 0};
      }
    }
  });
  return ErrorCriterion::deviation(std::move(samples), values.mixed_sites().size() / stride,
                                   values.number_count(), values.findings().blur_median)
      .value_or(sheets.noise);
}

namespace {

/// What the entries round an entry predict for it.
class Predictions {
 public:
  /// Predicts the entries of these sites that are not pure.
  Predictions(const MultiMaterialData& data, const SiteValues& values,
              const std::vector<std::uint32_t>& mixed)
      : values_(values), sites_(data.grid), numbers_(values.entries().size()) {
    for (const std::uint32_t site : mixed) {
      for (const Entry& entry : values.at(site)) {
        if (!entry.is_pure()) numbers_.add(values.index(entry));
      }
    }
    numbers_.number_all();
    found_.resize(numbers_.size());
    squares_.assign(numbers_.size(), -1);
    LoopProgress::begin_part(kPredictedShare, static_cast<double>(mixed.size()));
    parallel_chunks(mixed.size(), 64, [&](std::size_t begin, std::size_t end) {
      SmoothSurface surface(data, values);
      std::vector<LeftOut> predicted;
      for (std::size_t n = begin; n < end; ++n) {
        surface.leave_out(mixed[n], false, predicted);
        for (std::size_t e = 0; e < predicted.size(); ++e) {
          if (!predicted[e].known) continue;
          const Entry& entry = values.at(mixed[n])[e];
          const double off = predicted[e].fraction - static_cast<double>(entry.fraction);
          found_[index(entry)] = {predicted[e].value, predicted[e].fraction, predicted[e].own};
          squares_[index(entry)] = static_cast<float>(off * off);
        }
      }
    });
  }

  /// Moves an entry of a site towards its prediction, if there is one, as far as noise of this size explains
  /// the difference.
  void smooth(std::size_t site, double noise, Entry& entry) const {
    const float square = squares_[index(entry)];
    if (square < 0) return;
    const auto& [value_there, fraction_there, own] = found_[index(entry)];
    // The mean of the squared differences round the site separates noise from the fractions' own variation.
    double mean = static_cast<double>(square);
    int count = 1;
    sites_.for_each_neighbour(site, [&](std::size_t other, int, int, int) {
      for (const Entry& there : values_.at(other)) {
        if (there.material != entry.material) continue;
        const auto other_square = static_cast<double>(squares_[index(there)]);
        if (other_square >= 0) mean += other_square, ++count;
      }
    });
    mean /= count;
    const double part = ErrorCriterion::part_kept(mean, noise, own);
    entry.value = value_there + part * (entry.value - value_there);
    const double fraction = fraction_there + part * (static_cast<double>(entry.fraction) - fraction_there);
    entry.fraction = static_cast<float>(std::clamp(fraction, 1e-6, 1 - 1e-6));
  }

 private:
  struct Prediction {
    double value, fraction, own;
  };

  [[nodiscard]] std::uint32_t index(const Entry& entry) const {
    return numbers_.number(values_.index(entry));
  }

  const SiteValues& values_;
  GridSites sites_;
  NumberedEntries numbers_;
  std::vector<Prediction> found_;
  std::vector<float> squares_;  // of differences from predictions; below 0 where no prediction is known
};

}  // namespace

void smooth_within_noise(const MultiMaterialData& data, const ThinSheets& sheets, double noise,
                         SiteValues& values) {
  const std::vector<std::uint32_t> mixed = sites_off_sheets(values, sheets);
  const Predictions predictions(data, values, mixed);
  parallel_for(mixed.size(), 256, [&](std::size_t n) {
    const std::size_t site = mixed[n];
    float sum = 0;
    for (Entry& entry : values.at(site)) {
      predictions.smooth(site, noise, entry);
      sum += entry.fraction;
    }
    for (Entry& entry : values.at(site)) {
      if (!entry.is_pure()) entry.fraction = std::clamp(entry.fraction / sum, 1e-6f, 1 - 1e-6f);
    }
  });
}

}  // namespace adamas::interfaces
