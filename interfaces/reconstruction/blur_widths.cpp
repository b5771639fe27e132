#include "interfaces/reconstruction/blur_widths.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "core/base/loop_progress.h"
#include "core/base/median.h"
#include "core/base/parallel.h"
#include "interfaces/reconstruction/cut_volumes.h"
#include "interfaces/reconstruction/grid_sites.h"
#include "interfaces/reconstruction/interface_planes.h"
#include "interfaces/reconstruction/normal_distribution.h"
#include "interfaces/reconstruction/site_box.h"
#include "interfaces/reconstruction/site_values.h"
#include "interfaces/reconstruction/walls.h"

namespace adamas::interfaces {

namespace {

using Entry = SiteValues::Entry;

/// Steps of at most this width, in cells, belong to sharp interfaces.
constexpr double kSharp = 0.34;
/// The greatest width, in cells.
constexpr double kWidest = 4;
/// Fractions from kLeastClear to 1 - kLeastClear show whether a step is sharp. A step is blurred if the
/// errors of a sharp plane's prediction at the neighbours exceed those of a blurred one's by at least
/// kLeastEvidence of their sum. kNothing keeps the quotient finite.
constexpr double kLeastClear = 0.01, kLeastEvidence = 0.2, kNothing = 0.02;
/// Widths are means over a neighbourhood that kBlends steps of diffusion by kBlend make, in squared distances
/// of sites.
constexpr int kBlends = 4;
constexpr double kBlend = 0.25;
/// The error of central differences in the product of variances from which a width is computed. In the sum
/// over a whole step it would be a third of the squared distance of sites; in a neighbourhood about as wide
/// it is less. The value was found on spheres.
constexpr double kWidens = 0.07;
/// A site is deep inside a blurred step if at least kMixedNeighbours of its kAllNeighbours neighbours are
/// mixed; only sites within kReachOfDeep sites of a deep one can be blurred.
constexpr int kMixedNeighbours = 22, kAllNeighbours = 26, kReachOfDeep = 6;
/// If less than this part of the mixed cells seems blurred, none is; if less than this part seems sharp, all
/// are blurred.
constexpr double kFew = 0.02;

/// The number of sites along each side of a brick.
constexpr std::size_t kBrick = 64;

/// The part that evidence takes of the time to find the widths of a material.
constexpr double kEvidenceShare = 0.4;

class WidthSearch {
 public:
  WidthSearch(const MultiMaterialData& data, SiteValues& values)
      : data_(data), values_(values), sites_(data.grid) {}

  void run() {
    for_each_material([](std::size_t, const Entry& entry) { return !entry.is_pure(); },
                      [&](std::uint16_t number, const auto& sites) { find(number, sites); });
  }

  /// Computes the widths of blurred entries at walls and near them again, except in sheets: fractions are
  /// relative there to what walls leave of the cells.
  void run_before_walls(const ThinSheets& sheets) {
    const SiteBox all(data_.grid, {0, 0, 0}, {data_.grid.sites(0), data_.grid.sites(1), data_.grid.sites(2)});
    std::vector<std::uint8_t> near(data_.grid.site_count(), 0);
    for (const std::uint32_t site : values_.wall_sites()) near[site] = 1;
    all.dilate(near, kBlends);
    std::vector<std::uint8_t> considered = near;
    all.dilate(considered, kBlends);
    for (const SheetPlace& place : sheets.places) near[place.site] = considered[place.site] = 0;
    for_each_material(
        [&](std::size_t site, const Entry& entry) { return entry.width > 0 && considered[site] != 0; },
        [&](std::uint16_t number, const auto& sites) { find_before_walls(number, sites, near); });
  }

 private:
  /// Calls visit(number, sites) for each material with the sites of its entries for which which(site, entry)
  /// is true.
  template <class Which, class Visit>
  void for_each_material(const Which& which, const Visit& visit) const {
    std::vector<std::vector<std::uint32_t>> sites(data_.materials.size());
    for (const std::uint32_t site : values_.mixed_sites()) {
      for (const Entry& entry : std::as_const(values_).at(site)) {
        if (which(site, entry)) sites[entry.material].push_back(site);
      }
    }
    for (std::uint16_t number = 0; number < sites.size(); ++number) {
      if (!sites[number].empty()) visit(number, sites[number]);
    }
  }

  /// The quantities from which the widths of steps are found, in a box of sites, before they are averaged
  /// over neighbourhoods.
  struct Steps {
    std::vector<float> densities, gradients, widened;  // squared; `widened` as in SiteBox::squared_gradient()

    /// Returns the width at a place, after blend().
    [[nodiscard]] double width(std::size_t place, double widest) const {
      if (!(gradients[place] > 0)) return widest;
      return std::min(step_width(densities[place] / gradients[place], widened[place] / gradients[place]),
                      widest);
    }
  };

  [[nodiscard]] Steps steps(const std::vector<std::uint32_t>& sites, const std::vector<float>& fractions,
                            const SiteBox& box) const {
    Steps found;
    found.densities.resize(box.size());
    box.squared_gradient(fractions, found.gradients, found.widened);
    parallel_for(sites.size(), 4096, [&](std::size_t n) {
      const std::size_t place = box.place(sites[n]);
      const double d = normal_density(normal_quantile(static_cast<double>(fractions[place])));
      found.densities[place] = static_cast<float>(d * d);
    });
    return found;
  }

  static void blend(Steps& steps, const SiteBox& box, std::vector<float>& scratch) {
    for (std::size_t p = 0; p < box.size(); ++p) steps.widened[p] *= steps.gradients[p];
    for (auto* array : {&steps.gradients, &steps.widened, &steps.densities}) blend(*array, box, scratch);
  }
  static void blend(std::vector<float>& array, const SiteBox& box, std::vector<float>& scratch) {
    for (int n = 0; n < kBlends; ++n) box.blend(array, kBlend, scratch);
  }

  /// What a site shows of its step by itself.
  struct Evidence {
    float density = 0;  ///< the squared density
    float worse = 0;  ///< the excess of the errors of the sharp plane over those of the blurred one, relative
                      ///< to their sum
    bool is_known = false;  ///< whether both errors are known
  };

  [[nodiscard]] Evidence evidence_at(std::size_t site, const SiteArray<float>& fractions,
                                     const SiteBox& box) const {
    const std::array<std::size_t, 3> stride{1, data_.grid.sites(0),
                                            data_.grid.sites(0) * data_.grid.sites(1)};
    const auto gradient = box.squared_gradient_at(box.indices(site), [&](std::size_t axis, int d) {
      return d == 0  ? fractions[site]
             : d > 0 ? fractions[site + stride[axis]]
                     : fractions[site - stride[axis]];
    });
    const double quantile = normal_quantile(static_cast<double>(fractions[site])),
                 d = normal_density(quantile);
    Evidence found{static_cast<float>(d * d), 0, false};
    const std::array<double, 2> misses =
        compare(site, fractions, quantile, found.density, gradient.squared, gradient.widened);
    const double sum = misses[0] + misses[1];
    if (sum == 0) return found;
    found.worse = static_cast<float>((misses[0] - misses[1]) / (sum + kNothing));
    found.is_known = true;
    return found;
  }

  /// Finds the widths of a material's steps at its sites, which are in order, brick by brick.
  void find(std::uint16_t number, const std::vector<std::uint32_t>& sites) {
    const SiteArray<float>& fractions = data_.fractions[values_.material(number)];
    const SiteBox box = SiteBox::round(data_.grid, sites, 1);
    std::vector<Evidence> evidence(sites.size());
    const auto part = [&](double share) {
      return (number + share) / static_cast<double>(data_.materials.size());
    };
    LoopProgress::begin_part(part(kEvidenceShare), static_cast<double>(sites.size()));
    parallel_for(sites.size(), 256,
                 [&](std::size_t n) { evidence[n] = evidence_at(sites[n], fractions, box); });
    const std::vector<std::uint8_t> deep = find_deep(sites, fractions, box);
    std::array<std::size_t, 3> bricks{};
    for (int axis = 0; axis < 3; ++axis)
      bricks[static_cast<std::size_t>(axis)] = (box.sites(axis) + kBrick - 1) / kBrick;
    std::vector<std::vector<std::uint32_t>> sites_of(bricks[0] * bricks[1] *
                                                     bricks[2]);  // numbers in `sites`
    for (std::uint32_t n = 0; n < sites.size(); ++n) {
      const auto [i, j, k] = box.indices(sites[n]);
      sites_of[i / kBrick + bricks[0] * (j / kBrick + bricks[1] * (k / kBrick))].push_back(n);
    }
    LoopProgress::begin_part(part(1), static_cast<double>(sites_of.size()));
    parallel_for(sites_of.size(), 1, [&](std::size_t brick) {
      const std::vector<std::uint32_t>& own = sites_of[brick];
      if (own.empty()) return;
      const SiteBox local = box.part({brick % bricks[0] * kBrick, brick / bricks[0] % bricks[1] * kBrick,
                                      brick / (bricks[0] * bricks[1]) * kBrick},
                                     kBrick, kBlends + 1);
      const Blended blended(local, sites, evidence, fractions);
      for (const std::uint32_t n : own) {
        const std::size_t site = sites[n], place = local.place(site);
        const double h = sites_.least_side(site), width = blended.steps.width(place, kWidest * h);
        const auto f = static_cast<double>(fractions[site]);
        // Far in the tail of a step no neighbour shows which it is.
        const bool is_clear = blended.both[place] > 0
                                  ? blended.worse[place] >= kLeastEvidence * blended.both[place]
                                  : f < kLeastClear || f > 1 - kLeastClear;
        const bool is_blurred = is_clear && deep[box.place(site)] != 0 && width > kSharp * h;
        find_entry(values_.at(site), number)->width = is_blurred ? values_.coded_width(width) : 0;
      }
    });
  }

  /// The means of steps and evidence over neighbourhoods in a box. Those at sites within kBlends + 1 of a
  /// side where the box is cut out of a larger one are not right.
  struct Blended {
    Steps steps;
    std::vector<float> worse, both;  ///< `both`: the part of the neighbourhood where both errors are known

    Blended(const SiteBox& box, const std::vector<std::uint32_t>& sites,
            const std::vector<Evidence>& evidence, const SiteArray<float>& fractions)
        : worse(box.size()), both(box.size()) {
      std::vector<float> scratch(box.size());
      box.for_each([&](std::size_t place, std::size_t site) { scratch[place] = fractions[site]; });
      box.squared_gradient(scratch, steps.gradients, steps.widened);
      steps.densities.resize(box.size());
      box.for_each_row([&](std::size_t first_place, std::size_t first_site, std::size_t count) {
        auto at = std::lower_bound(sites.begin(), sites.end(), first_site);
        for (; at != sites.end() && *at < first_site + count; ++at) {
          const Evidence& found = evidence[static_cast<std::size_t>(at - sites.begin())];
          const std::size_t place = first_place + (*at - first_site);
          steps.densities[place] = found.density;
          worse[place] = found.worse;
          both[place] = found.is_known ? 1.0f : 0.0f;
        }
      });
      blend(steps, box, scratch);
      for (auto* array : {&worse, &both}) blend(*array, box, scratch);
    }
  };

  /// Finds widths at sites near walls as find() does, but does not decide whether steps are blurred. Steps at
  /// walls take the widths of the steps round them.
  void find_before_walls(std::uint16_t number, const std::vector<std::uint32_t>& sites,
                         const std::vector<std::uint8_t>& near) {
    const SiteArray<float>& fractions = data_.fractions[values_.material(number)];
    const SiteBox box = SiteBox::round(data_.grid, sites, 1);
    std::vector<float> f(box.size()), scratch;
    box.for_each([&](std::size_t place, std::size_t site) { f[place] = open_fraction(site, fractions); });
    Steps found = steps(sites, f, box);
    box.for_each([&](std::size_t place, std::size_t site) {
      if (has_wall(values_, site)) found.densities[place] = found.gradients[place] = 0;
    });
    blend(found, box, scratch);
    for (const std::uint32_t site : sites) {
      const std::size_t place = box.place(site);
      if (near[site] != 0 && found.gradients[place] > 0)
        find_entry(values_.at(site), number)->width =
            values_.coded_width(found.width(place, kWidest * sites_.least_side(site)));
    }
  }

  /// Returns the fraction of a material relative to what walls leave of the cell; if they leave little, of
  /// the cell and its neighbours together.
  [[nodiscard]] float open_fraction(std::size_t site, const SiteArray<float>& fractions) const {
    constexpr double kLittle = 0.3;
    if (!has_wall(values_, site)) return fractions[site];
    double left = part_before_walls(values_, site), sum = fractions[site];
    if (left < kLittle) {
      sites_.for_each_neighbour(site, [&](std::size_t other, int, int, int) {
        left += part_before_walls(values_, other);
        sum += fractions[other];
      });
    }
    return static_cast<float>(std::min(1.0, sum / left));
  }

  /// Marks the sites near cells nearly all of whose neighbours are mixed, which only a blurred step can
  /// cause.
  [[nodiscard]] std::vector<std::uint8_t> find_deep(const std::vector<std::uint32_t>& sites,
                                                    const SiteArray<float>& fractions,
                                                    const SiteBox& box) const {
    std::vector<std::uint8_t> deep(box.size(), 0);
    parallel_for(sites.size(), 1024, [&](std::size_t n) {
      int mixed = 0, neighbours = 0;
      sites_.for_each_neighbour(sites[n], [&](std::size_t other, int, int, int) {
        ++neighbours;
        mixed += fractions[other] > 0 && fractions[other] < 1 ? 1 : 0;
      });
      deep[box.place(sites[n])] = kAllNeighbours * mixed >= kMixedNeighbours * neighbours ? 1 : 0;
    });
    box.dilate(deep, kReachOfDeep);
    return deep;
  }

  /// Returns the standard deviation of a step. `ratio`: its squared density divided by its squared gradient
  /// from central differences. `widened`: as in SiteBox::squared_gradient().
  static double step_width(double ratio, double widened) {
    const double w = kWidens * widened;
    return std::sqrt(std::max(0.0, -0.5 * w + std::sqrt(0.25 * w * w + ratio * ratio)));
  }

  /// Returns two sums of squared differences between the fractions round a site and predicted ones: for the
  /// sharp plane that cuts the site's fraction off its cell, and for a blurred step. `quantile`: that of the
  /// site's fraction.
  [[nodiscard]] std::array<double, 2> compare(std::size_t site, const SiteArray<float>& fractions,
                                              double quantile, float squared_density, float squared_gradient,
                                              float widened) const {
    const auto f = static_cast<double>(fractions[site]);
    if (f < kLeastClear || f > 1 - kLeastClear || squared_gradient <= 0) return {0, 0};
    const Vec3 towards = normalized(fraction_gradient(sites_, site, {fractions.begin(), fractions.size()}));
    if (!(squared_norm(towards) > 0)) return {0, 0};
    const auto ways = sites_.ways_round<1>(site);
    const double width = step_width(static_cast<double>(squared_density / squared_gradient),
                                    static_cast<double>(widened)),
                 sharp = plane_distance(towards, sites_.cell(site).size(), f), blurred = quantile;
    // Most grids have cells of one size.
    const bool even = sites_.has_even_cells_round(site);
    const std::array<double, 3> sides = plane_sides(towards, sites_.cell(site).size());
    std::array<double, 2> misses{0, 0};
    std::array<double, kAllNeighbours> there{}, steps{};
    std::size_t count = 0;
    sites_.for_each_neighbour(site, [&](std::size_t other, int di, int dj, int dk) {
      const double by = dot(towards, ways.to(di, dj, dk));
      there[count] = static_cast<double>(fractions[other]);
      const double a =
          there[count] -
          box_volume_below(even ? sides : plane_sides(towards, sites_.cell(other).size()), sharp + by);
      misses[0] += a * a;
      steps[count++] = blurred + by / std::max(width, 1e-9);
    });
    // Two are looked up at a time; what fills up the last pair adds nothing.
    const NormalTable& table = NormalTable::instance();
    for (std::size_t n = 0; n < count; n += 2) {
      const auto [first, second] = table.at_both(steps[n], steps[n + 1]);
      const double a = there[n] - first.probability, b = there[n + 1] - second.probability;
      misses[1] += a * a;
      if (n + 1 < count) misses[1] += b * b;
    }
    return misses;
  }

  const MultiMaterialData& data_;
  SiteValues& values_;
  GridSites sites_;
};

/// Marks the sites of materials that have at most half of every cell and form no sheet; blurred, they would
/// own nothing.
std::vector<char> faint_sites(const MultiMaterialData& data, const ThinSheets& sheets,
                              const SiteValues& values) {
  std::vector<float> most(data.materials.size(), 0);
  std::vector<char> is_sheet(most.size(), 0), faint(data.grid.site_count(), 0);
  for (const SheetPlace& place : sheets.places) is_sheet[place.material] = 1;
  for (std::uint16_t number = 0; number < most.size(); ++number) {
    for (const float f : data.fractions[values.material(number)]) most[number] = std::max(most[number], f);
  }
  for (const std::uint32_t site : values.mixed_sites()) {
    const bool is_faint = std::ranges::any_of(values.at(site), [&](const Entry& entry) {
      return !entry.is_pure() && is_sheet[entry.material] == 0 && most[entry.material] <= 0.5f;
    });
    faint[site] = is_faint ? 1 : 0;
  }
  return faint;
}

enum : char { kFull, kSharpCell, kBlurredCell };

/// Returns the kinds of cells after each mixed cell has taken the kind of most mixed cells round it.
std::vector<char> settled_kinds(const SiteValues& values, const GridSites& sites,
                                const std::vector<char>& kinds) {
  std::vector<char> settled = kinds;
  parallel_for(values.mixed_sites().size(), 1024, [&](std::size_t n) {
    const std::size_t site = values.mixed_sites()[n];
    int mixed = 0, blurred = 0;
    sites.for_each_neighbour(site, [&](std::size_t other, int, int, int) {
      mixed += kinds[other] != kFull ? 1 : 0;
      blurred += kinds[other] == kBlurredCell ? 1 : 0;
    });
    if (2 * blurred < mixed) settled[site] = kSharpCell;
    if (2 * blurred > mixed) settled[site] = kBlurredCell;
  });
  return settled;
}

/// Returns the mean width, coded, of a material's blurred entries at the neighbours of a site; if there are
/// none, the greatest width at the site; if there is none either, `other`.
std::uint16_t mean_width(const SiteValues& values, const GridSites& sites, std::size_t site,
                         std::uint16_t material, std::uint16_t other) {
  std::uint32_t sum = 0, count = 0;
  sites.for_each_neighbour(site, [&](std::size_t neighbour, int, int, int) {
    const Entry* entry = find_entry(values.at(neighbour), material);
    if (entry != nullptr && entry->width > 0) sum += entry->width, ++count;
  });
  if (count > 0) return static_cast<std::uint16_t>(sum / count);
  std::uint16_t greatest = 0;
  for (const Entry& entry : values.at(site)) greatest = std::max(greatest, entry.width);
  return greatest > 0 ? greatest : other;
}

/// Returns the median of the widths of blurred entries, coded; 0 if there are none.
std::uint16_t median_width(const SiteValues& values) {
  std::vector<std::uint16_t> widths;
  for (const Entry& entry : values.entries()) {
    if (entry.width > 0) widths.push_back(entry.width);
  }
  return widths.empty() ? std::uint16_t{0} : median(widths);
}

}  // namespace

void summarise_widths(const MultiMaterialData& data, const SiteValues& values, FractionFindings& findings) {
  const GridSites sites(data.grid);
  std::vector<double> widths;
  for (const std::uint32_t site : values.mixed_sites()) {
    double greatest = 0;
    for (const Entry& entry : values.at(site)) greatest = std::max(greatest, values.width(entry));
    if (greatest == 0) continue;
    widths.push_back(greatest / sites.least_side(site));
  }
  if (widths.empty()) return;
  findings.blur_median = median(widths);
  findings.blur_greatest = *std::max_element(widths.begin(), widths.end());
  findings.blur_share = static_cast<double>(widths.size()) / static_cast<double>(values.mixed_sites().size());
}

void settle_widths(const MultiMaterialData& data, const ThinSheets& sheets, SiteValues& values) {
  const GridSites sites(data.grid);
  std::vector<char> kinds(data.grid.site_count(), kFull);
  for (const std::uint32_t site : values.mixed_sites())
    kinds[site] = values.is_blurred(site) ? kBlurredCell : kSharpCell;
  const std::vector<char> settled = settled_kinds(values, sites, kinds);
  const auto mixed = static_cast<double>(values.mixed_sites().size());
  const auto blurred = static_cast<double>(std::ranges::count(settled, kBlurredCell));
  const bool none = blurred < kFew * mixed, all = mixed - blurred < kFew * mixed;
  const std::vector<char> faint = faint_sites(data, sheets, values);
  std::vector<char> is_blurred(settled.size(), 0);
  for (const std::uint32_t site : values.mixed_sites())
    is_blurred[site] = !none && (all || settled[site] == kBlurredCell) && faint[site] == 0 ? 1 : 0;
  find_walls(data.grid, sheets, is_blurred, values);
  const std::uint16_t typical = median_width(values);
  std::vector<std::pair<Entry*, std::uint16_t>> found;
  for (const std::uint32_t site : values.mixed_sites()) {
    for (Entry& entry : values.at(site)) {
      if (is_blurred[site] == 0 || values.is_wall(entry)) {
        found.emplace_back(&entry, std::uint16_t{0});
      } else if (!entry.is_pure() &&
                 (kinds[site] == kSharpCell || (has_wall(values, site) && entry.width == 0))) {
        found.emplace_back(&entry, mean_width(values, sites, site, entry.material, typical));
      }
    }
  }
  for (const auto& [entry, width] : found) entry->width = width;
  if (!values.wall_sites().empty()) WidthSearch(data, values).run_before_walls(sheets);
}

void find_widths(const MultiMaterialData& data, std::optional<double> blur, SiteValues& values) {
  if (!data.labels.empty() || (blur && *blur == 0)) return;
  if (blur) {
    const GridSites sites(data.grid);
    for (const std::uint32_t site : values.mixed_sites()) {
      const double width = sites.least_side(site) * std::sqrt(*blur * *blur + 1.0 / 12);
      for (Entry& entry : values.at(site)) {
        if (!entry.is_pure()) entry.width = values.coded_width(width);
      }
    }
  } else {
    WidthSearch(data, values).run();
  }
}

}  // namespace adamas::interfaces
