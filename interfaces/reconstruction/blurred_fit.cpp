#include "interfaces/reconstruction/blurred_fit.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "core/base/parallel.h"
#include "interfaces/reconstruction/blurred_fractions.h"
#include "interfaces/reconstruction/grid_sites.h"
#include "interfaces/reconstruction/site_entries.h"
#include "interfaces/reconstruction/walls.h"

namespace adamas::interfaces {

namespace {

using Entry = SiteValues::Entry;

/// Rounds, and those by means where fractions have errors, of which more would fit what is not there.
constexpr int kRounds = 5, kRoundsByMeans = 2;
/// So it is too where the median width, in cells, is less than this: what the model itself is off by would
/// make interfaces rough.
constexpr double kNarrow = 0.7;
/// A round moves values by this part of what seems to be missing, and by no more than this part of a cell.
constexpr double kRelax = 0.7, kMostMove = 0.5;
/// Fractions whose weights are less than this in all tell nothing.
constexpr double kNothing = 1e-12;

/// Moves the values of blurred entries by what their fractions miss, in rounds.
class Fit {
 public:
  Fit(const MultiMaterialData& data, SiteValues& values, const SiteCells& cells)
      : grid_(data.grid), values_(values), sites_(data.grid), predicted_(data, values, cells) {}

  void run(Progress& progress) {
    const FractionFindings& found = values_.findings();
    const bool by_means = found.fraction_error > SiteValues::kLeastError || found.blur_median < kNarrow;
    const int rounds = by_means ? kRoundsByMeans : kRounds;
    for (int round = 0; round < rounds; ++round) {
      progress.step("fitting blurred fractions", static_cast<double>(round) / rounds);
      predicted_.predict();
      find_missing();
      set_distances_at_walls(values_);
      move(by_means);
      set_values_at_walls(grid_, values_);
      values_.hold_layers();
    }
  }

 private:
  [[nodiscard]] std::size_t index(const Entry& entry) const { return values_.index(entry); }

  /// What the fractions of blurred entries are beyond those predicted.
  void find_missing() {
    missing_.assign(values_.entries().size(), 0);
    for (const std::uint32_t site : values_.mixed()) {
      const std::span<const Entry> own = std::as_const(values_).at(site);
      for (const Entry& entry : own) {
        if (entry.width == 0 && !values_.is_wall(entry)) continue;
        // A material's first entry has what is predicted.
        const std::size_t first = first_entry(values_, site, values_.whole(entry.material));
        missing_[index(entry)] = entry.fraction - predicted_.at(first);
      }
    }
  }

  /// How much a fraction tells about where the interface is.
  [[nodiscard]] double told(const Entry& entry) const {
    const double steps = entry.value / values_.width(entry);
    return std::exp(-steps * steps);
  }

  /// Moves values, by what is missing at each or by the mean of what is missing round each.
  void move(bool by_means) {
    const double most = values_.greatest();
    moves_.assign(missing_.size(), 0);
    parallel_for(values_.mixed().size(), 1024, [&](std::size_t n) {
      const std::size_t site = values_.mixed()[n];
      for (const Entry& entry : std::as_const(values_).at(site)) {
        if (entry.width > 0 || values_.is_wall(entry))
          moves_[index(entry)] =
              by_means && entry.width > 0 ? mean_missing(site, entry) : missing_[index(entry)];
      }
    });
    continue_moves();
    parallel_for(values_.mixed().size(), 1024, [&](std::size_t n) {
      const std::size_t site = values_.mixed()[n];
      const double farthest = kMostMove * sites_.least_side(site);
      const std::span<Entry> own = values_.at(site);
      for (Entry& entry : own) {
        if (values_.is_wall(entry) || entry.width == 0) continue;
        const double by = kRelax * values_.width(entry) * std::sqrt(2 * std::numbers::pi) *
                          static_cast<double>(moves_[index(entry)]);
        // Values of what lies across a sheet are below what others have, and stay there.
        entry.value = std::clamp(entry.value + std::clamp(by, -farthest, farthest),
                                 std::min(-most, entry.value), std::max(most, entry.value));
      }
      for (Entry& entry : own) {
        if (!values_.is_wall(entry)) continue;
        const double by = sites_.least_side(site) * static_cast<double>(moves_[index(entry)]);
        entry.value += std::clamp(by, -farthest, farthest);
      }
    });
  }

  /// Whether what an entry's fraction misses tells nothing, since a wall is near.
  [[nodiscard]] bool is_untold(std::size_t site, const Entry& entry) const {
    if (values_.at_walls().empty() || values_.is_wall(entry)) return false;
    return predicted_.is_near_wall(first_entry(values_, site, values_.whole(entry.material)));
  }

  /// Moves entries near walls as those round them that are farther away, ring by ring. What no such is near
  /// moves by what it misses itself.
  void continue_moves() {
    if (values_.at_walls().empty()) return;
    struct Place {
      std::size_t site, entry;
    };
    std::vector<Place> left;
    std::vector<char> known(moves_.size(), 1);
    for (const std::uint32_t site : values_.mixed()) {
      for (const Entry& entry : std::as_const(values_).at(site)) {
        if (entry.width == 0 || !is_untold(site, entry)) continue;
        known[index(entry)] = 0;
        left.push_back({site, index(entry)});
      }
    }
    for (bool changed = true; changed;) {
      std::vector<float> means(left.size());
      std::vector<char> found(left.size(), 0);
      parallel_for(left.size(), 1024, [&](std::size_t n) {
        found[n] = find_mean_move(left[n].site, left[n].entry, known, means[n]) ? 1 : 0;
      });
      std::vector<Place> rest;
      for (std::size_t n = 0; n < left.size(); ++n) {
        if (found[n] == 0) {
          rest.push_back(left[n]);
        } else {
          moves_[left[n].entry] = means[n], known[left[n].entry] = 1;
        }
      }
      changed = rest.size() < left.size();
      left = std::move(rest);
    }
  }

  /// The mean move of a material's known entries at the neighbours of a site; whether there are any.
  [[nodiscard]] bool find_mean_move(std::size_t site, std::size_t entry, const std::vector<char>& known,
                                    float& mean) const {
    const std::uint16_t material = std::as_const(values_).entries()[entry].material;
    float sum = 0, count = 0;
    sites_.for_each_neighbour(site, [&](std::size_t other, int, int, int) {
      const Entry* there = find_entry(std::as_const(values_).at(other), material);
      if (there != nullptr && there->width > 0 && known[index(*there)] != 0)
        sum += moves_[index(*there)], ++count;
    });
    mean = count > 0 ? sum / count : 0;
    return count > 0;
  }

  [[nodiscard]] float mean_missing_of_wall(std::size_t site, const Entry& entry) const {
    float weights = 1, sum = missing_[index(entry)];
    sites_.for_each_neighbour(site, [&](std::size_t other, int di, int dj, int dk) {
      const Entry* there = find_entry(std::as_const(values_).at(other), entry.material);
      if (there == nullptr || !values_.is_wall(*there) || there->settled()) return;
      const float w = 1.0f / static_cast<float>(1 << (di * di + dj * dj + dk * dk));
      sum += w * missing_[index(*there)];
      weights += w;
    });
    return sum / weights;
  }

  [[nodiscard]] float mean_missing(std::size_t site, const Entry& entry) const {
    if (values_.is_wall(entry)) return mean_missing_of_wall(site, entry);
    double weights = told(entry), sum = weights * static_cast<double>(missing_[index(entry)]);
    sites_.for_each_neighbour(site, [&](std::size_t other, int di, int dj, int dk) {
      for (const Entry& there : std::as_const(values_).at(other)) {
        if (there.material != entry.material || there.width == 0 || is_untold(other, there)) continue;
        const double w = told(there) / (1 << (di * di + dj * dj + dk * dk));
        sum += w * static_cast<double>(missing_[index(there)]);
        weights += w;
      }
    });
    return weights > kNothing ? static_cast<float>(sum / weights) : 0;
  }

  const RectilinearGrid& grid_;
  SiteValues& values_;
  GridSites sites_;
  BlurredFractions predicted_;
  std::vector<float> missing_, moves_;  // by entry
};

}  // namespace

void fit_blurred(const MultiMaterialData& data, SiteValues& values, const SiteCells& cells,
                 Progress& progress) {
  Fit(data, values, cells).run(progress);
}

}  // namespace adamas::interfaces
