#include "interfaces/reconstruction/site_values.h"

#include <algorithm>
#include <array>
#include <bit>
#include <optional>
#include <utility>

#include "adamas/geometry.h"
#include "core/base/error.h"
#include "core/base/large_pages.h"
#include "core/base/loop_progress.h"
#include "core/base/parallel.h"
#include "core/base/release_memory.h"
#include "interfaces/reconstruction/blur_widths.h"
#include "interfaces/reconstruction/dispersed_volume.h"
#include "interfaces/reconstruction/fraction_noise.h"
#include "interfaces/reconstruction/grid_sites.h"
#include "interfaces/reconstruction/interface_planes.h"
#include "interfaces/reconstruction/label_smoothing.h"
#include "interfaces/reconstruction/normal_distribution.h"
#include "interfaces/reconstruction/thin_sheets.h"
#include "interfaces/reconstruction/walls.h"

namespace adamas::interfaces {

namespace {

/// The least absolute value for smoothed labels, in voxels: invisible, but far above round-off.
constexpr double kLeastOfLabels = 0.02;
/// The greatest width of a step that an entry can have, in distances of sites.
constexpr double kWidestCoded = 64;
/// Values of blurred steps are limited to this many widths.
constexpr double kFarthest = 4;

}  // namespace

SiteValues::SiteValues(const MultiMaterialData& data, bool smooth, const FractionOptions& options,
                       Progress& progress) {
  set_lengths(data.grid);
  {
    const auto items = 3 * static_cast<double>(data.grid.site_count());
    const LoopProgress stage(progress, "finding materials of cells", {.items = items});
    find_entries(data);
  }
  findings_.mixed_cells = mixed_sites_.size();
  if (!smooth) {
    set_values_of_fractions(data, options, progress);
    return;
  }
  volumes_ = data.volumes();
  if (data.labels.empty()) fail("{}: expected labels to smooth, found volume fractions", data.source);
  least_label_value_ = kLeastOfLabels * data.grid.least_spacing();
  const LoopProgress stage(progress, "smoothing labels");
  smooth_label_values(data, *this);
}

void SiteValues::set_values_of_fractions(const MultiMaterialData& data, const FractionOptions& options,
                                         Progress& progress) {
  std::optional<LoopProgress> stage(std::in_place, progress, "finding widths");
  find_widths(data, options.known_blur(), *this);
  stage.emplace(progress, "finding thin sheets");
  ThinSheets sheets = find_thin_sheets(data, *this);
  const bool blurred = has_blurred();
  if (blurred) set_widths_of_sheets(data, sheets);
  findings_.dispersed = take_dispersed(data, sheets, options.keep_dispersed, *this);
  if (blurred && !options.known_blur()) settle_widths(data, sheets, *this);
  if (blurred && !has_blurred()) sheets = find_thin_sheets(data, *this);
  find_volumes(data);
  summarise_widths(data, *this, findings_);
  stage.emplace(progress, "setting distances");
  set_distances(data);
  double& error = findings_.fraction_error;
  const std::optional<double> known = options.known_error();
  error = known ? *known : fraction_noise(data, *this, sheets);
  if (error > kLeastError) smooth_within_noise(data, sheets, error, *this);
  split_at_sheets(data, sheets);
  set_values_at_walls(data.grid, *this);
  if (error > kLeastError) fit_sharp_loosely(data.grid);
}

SiteValues SiteValues::fractions(const MultiMaterialData& data) {
  SiteValues values;
  values.set_lengths(data.grid);
  values.find_entries(data);
  const double unit = data.grid.least_spacing();
  for (Entry& entry : values.entries_) entry.value = (static_cast<double>(entry.fraction) - 0.5) * unit;
  return values;
}

void SiteValues::set_lengths(const RectilinearGrid& grid) {
  far_value_ = interfaces::far_value(grid);
  width_unit_ = kWidestCoded * grid.least_spacing() / 65535;
}

bool SiteValues::has_blurred() const {
  return std::ranges::any_of(entries_, [](const Entry& entry) { return entry.width > 0; });
}

/// Makes sharp cells blurred, with the width of the cell itself, so that fractions with errors are fitted
/// without reproducing the errors.
void SiteValues::fit_sharp_loosely(const RectilinearGrid& grid) {
  const GridSites sites(grid);
  for (const std::uint32_t site : mixed_sites_) {
    const double width = kUniformDeviation * sites.least_side(site);
    for (Entry& entry : at(site)) {
      if (!entry.is_pure() && entry.width == 0) entry.width = coded_width(width);
    }
  }
}

/// Sums the volumes of entries' fractions and of sites that one material fills.
void SiteValues::find_volumes(const MultiMaterialData& data) {
  volumes_ = data.volumes();
  if (std::ranges::all_of(findings_.dispersed, [](double volume) { return volume == 0; })) return;
  // The dispersed part of a material goes to the others in its cells.
  const GridSites sites(data.grid);
  for (const std::uint32_t site : mixed_sites_) {
    const double volume = sites.cell(site).volume();
    for (const Entry& entry : at(site)) {
      const MaterialId m = material(entry.material);
      volumes_[m] +=
          volume * (static_cast<double>(entry.fraction) - static_cast<double>(data.fraction(m, site)));
    }
  }
}

/// Sets values to distances from the planes that cut off each mixed cell's fractions.
void SiteValues::set_distances(const MultiMaterialData& data) {
  const GridSites sites(data.grid);
  const InterfacePlanes planes = interface_planes(data, *this);
  parallel_for(mixed_sites_.size(), 1024, [&](std::size_t n) {
    const Vec3 size = sites.cell(mixed_sites_[n]).size();
    for (std::size_t e = first_entries_[mixed_sites_[n]]; e < first_entries_[mixed_sites_[n] + 1]; ++e) {
      if (entries_[e].is_pure()) continue;
      if (entries_[e].width > 0) {
        const double steps =
            normal_quantile(fraction_before_walls(*this, mixed_sites_[n], entries_[e].fraction));
        entries_[e].value = std::clamp(width(entries_[e]) * std::clamp(steps, -kFarthest, kFarthest),
                                       -greatest_value(), greatest_value());
        continue;
      }
      const InterfacePlane& plane = planes.of(e);
      entries_[e].value = plane.known() ? plane.distance
                                        : (static_cast<double>(entries_[e].fraction) - 0.5) *
                                              std::min({size.x, size.y, size.z});
    }
  });
  // Sites beside mixed cells get the mean of the distances from the planes round them, with the right sign.
  parallel_for(data.grid.site_count(), 4096, [&](std::size_t site) {
    if (first_entries_[site] == first_entries_[site + 1]) return;
    const Vec3 size = sites.cell(site).size();
    const auto ways = sites.ways_round<1>(site);
    const double half = 0.5 * std::min({size.x, size.y, size.z});
    const bool in_wall = std::ranges::any_of(
        at(site), [&](const Entry& entry) { return entry.fraction >= 1 && is_wall(entry); });
    for (std::size_t e = first_entries_[site]; e < first_entries_[site + 1]; ++e) {
      Entry& entry = entries_[e];
      if (!entry.is_pure()) continue;
      double sum = 0, weights = 0;
      sites.for_each_neighbour(site, [&](std::size_t other, int di, int dj, int dk) {
        const Vec3 d = -ways.to(di, dj, dk);
        for (std::size_t o = first_entries_[other]; o < first_entries_[other + 1]; ++o) {
          if (entries_[o].material != entry.material) continue;
          const bool blurred = entries_[o].width > 0;
          const InterfacePlane& plane = planes.of(o);
          if (!blurred && !plane.known()) continue;
          const double w = 1 / squared_norm(d);
          sum += w * (blurred ? entries_[o].value : plane.distance + dot(plane.towards, d));
          weights += w;
        }
      });
      const double side = entry.fraction > 0 ? 1 : -1;
      const double mean = weights > 0 ? sum / weights : 0;
      if (in_wall && weights > 0 && !is_wall(entry)) {
        // The interfaces before a wall continue into it, until set_values_at_walls().
        entry.value = mean;
        continue;
      }
      entry.value = side * std::clamp(side * mean, half, greatest_value());
    }
  });
}

/// Numbers the materials by their names, and finds the sites that hold one material only.
void SiteValues::find_sole_materials(const MultiMaterialData& data) {
  const std::size_t count = data.grid.site_count(), materials = data.materials.size();
  by_name_ = materials_by_name(data.materials);
  const std::vector<std::uint16_t> numbers = places_of(by_name_);
  sole_materials_.resize(count);
  const SiteArray<std::uint16_t> labels = data.labels.dense();
  parallel_for(count, 1 << 14, [&](std::size_t site) {
    sole_materials_[site] = static_cast<std::uint16_t>(materials);
    if (!labels.empty()) {
      sole_materials_[site] = numbers[labels[site]];
      return;
    }
    for (std::size_t n = 0; n < materials; ++n) {
      if (data.fractions[by_name_[n]][site] >= 1) sole_materials_[site] = static_cast<std::uint16_t>(n);
    }
  });
}

namespace {

/// The greatest number of materials for which a site's materials are marked in the bits of a number.
constexpr std::size_t kMostMarks = 16;

/// Finds the materials that have a value at the sites of rows along x, for few materials: a bit for each.
class MaterialMarks {
 public:
  /// `sole`: by site, the number of its only material; the count of materials if it has several. `names`: the
  /// materials by number.
  MaterialMarks(const MultiMaterialData& data, const std::vector<std::uint16_t>& sole,
                const std::vector<MaterialId>& names)
      : n_{data.grid.sites(0), data.grid.sites(1), data.grid.sites(2)},
        sole_(sole),
        materials_(names.size()),
        marks_(sole.size(), 0) {
    parallel_for(marks_.size(), 1 << 14, [&](std::size_t site) {
      if (sole[site] < materials_) {
        marks_[site] = static_cast<std::uint16_t>(1u << sole[site]);
        return;
      }
      unsigned marks = 0;
      for (std::size_t m = 0; m < materials_; ++m) marks |= data.fractions[names[m]][site] > 0 ? 1u << m : 0u;
      marks_[site] = static_cast<std::uint16_t>(marks);
    });
  }

  [[nodiscard]] std::size_t rows() const { return n_[1] * n_[2]; }
  /// Calls visit(site, marks) for the sites of a row that have values.
  template <class Visit>
  void for_each_in_row(std::size_t row, const Visit& visit) const {
    std::vector<std::uint16_t> round(n_[0], 0);
    const std::size_t j = row % n_[1], k = row / n_[1];
    for (std::size_t z = k > 0 ? k - 1 : k; z < std::min(k + 2, n_[2]); ++z) {
      for (std::size_t y = j > 0 ? j - 1 : j; y < std::min(j + 2, n_[1]); ++y) {
        const std::uint16_t* marks = marks_.data() + n_[0] * (y + n_[1] * z);
        for (std::size_t i = 0; i < n_[0]; ++i) round[i] = static_cast<std::uint16_t>(round[i] | marks[i]);
      }
    }
    for (std::size_t i = 0; i < n_[0]; ++i) {
      unsigned marks = round[i];
      if (i > 0) marks |= round[i - 1];
      if (i + 1 < n_[0]) marks |= round[i + 1];
      const std::size_t site = i + n_[0] * row;
      // A site has no values if one material fills it and all its neighbours.
      if (sole_[site] == materials_ || !std::has_single_bit(marks)) visit(site, marks);
    }
  }

 private:
  std::array<std::size_t, 3> n_;
  const std::vector<std::uint16_t>& sole_;
  std::size_t materials_;
  std::vector<std::uint16_t> marks_;  // by site: the materials that it holds
};

}  // namespace

/// Calls visit(site, materials) for each site with values, in parallel: the numbers, ascending, of the
/// materials that the site or a neighbour holds.
template <class Visit>
void SiteValues::for_each_site_with_values(const MultiMaterialData& data, const Visit& visit) const {
  if (by_name_.size() <= kMostMarks) {
    const MaterialMarks marks(data, sole_materials_, by_name_);
    parallel_for(marks.rows(), 16, [&](std::size_t row) {
      std::vector<std::uint16_t> found;
      marks.for_each_in_row(row, [&](std::size_t site, unsigned bits) {
        found.clear();
        for (; bits != 0; bits &= bits - 1)
          found.push_back(static_cast<std::uint16_t>(std::countr_zero(bits)));
        visit(site, found);
      });
    });
    return;
  }
  const GridSites sites(data.grid);
  parallel_chunks(data.grid.site_count(), 4096, [&](std::size_t begin, std::size_t end) {
    std::vector<std::uint16_t> found;
    for (std::size_t site = begin; site < end; ++site) {
      find_materials_at(data, sites, site, found);
      if (!found.empty()) visit(site, found);
    }
  });
}

/// Finds the numbers, ascending, of the materials that have a value at a site: those that the site or a
/// neighbour holds, or none if this is one material only.
void SiteValues::find_materials_at(const MultiMaterialData& data, const GridSites& sites, std::size_t site,
                                   std::vector<std::uint16_t>& found) const {
  found.clear();
  const std::size_t materials = by_name_.size();
  const auto differs = [&](std::size_t other) { return sole_materials_[other] != sole_materials_[site]; };
  if (sole_materials_[site] < materials && !sites.any_neighbour(site, differs)) return;
  const auto add = [&](std::size_t m) {
    const auto number = static_cast<std::uint16_t>(m);
    if (std::find(found.begin(), found.end(), number) == found.end()) found.push_back(number);
  };
  const auto add_site = [&](std::size_t s) {
    if (sole_materials_[s] < materials) return add(sole_materials_[s]);
    for (std::size_t n = 0; n < materials; ++n) {
      if (data.fractions[by_name_[n]][s] > 0) add(n);
    }
  };
  add_site(site);
  sites.for_each_neighbour(site, [&](std::size_t other, int, int, int) { add_site(other); });
  if (found.size() == 1 && sole_materials_[site] < materials) found.clear();
  std::sort(found.begin(), found.end());
}

/// Makes an entry for each material that has a value at a site, and lists the mixed sites.
void SiteValues::find_entries(const MultiMaterialData& data) {
  find_sole_materials(data);
  const std::size_t count = data.grid.site_count();
  reserve_in_large_pages(first_entries_, count + 1);
  first_entries_.assign(count + 1, 0);
  for_each_site_with_values(data, [&](std::size_t site, const std::vector<std::uint16_t>& found) {
    first_entries_[site + 1] = static_cast<std::uint32_t>(found.size());
  });
  std::uint64_t total = 0;
  for (std::size_t site = 0; site < count; ++site) {
    total += first_entries_[site + 1];
    if (total > 0xffffffffu)
      fail("{}: expected at most {} materials beside sites, found more", data.source, 0xffffffffu);
    first_entries_[site + 1] = static_cast<std::uint32_t>(total);
    if (sole_materials_[site] == by_name_.size()) mixed_sites_.push_back(static_cast<std::uint32_t>(site));
  }
  reserve_in_large_pages(entries_, total);
  entries_.resize(total);
  for_each_site_with_values(data, [&](std::size_t site, const std::vector<std::uint16_t>& found) {
    for (std::size_t n = 0; n < found.size(); ++n)
      entries_[first_entries_[site] + n] = {0, data.fraction(by_name_[found[n]], site), found[n]};
  });
}

/// Sets the widths of steps at sheets to those of the layers fitted there.
void SiteValues::set_widths_of_sheets(const MultiMaterialData& data, const ThinSheets& sheets) {
  const GridSites sites(data.grid);
  for (const SheetPlace& place : sheets.places) {
    const double length = length_along(place.slab.normal, sites.cell(place.site).size());
    for (Entry& entry : at(place.site)) {
      if (!entry.is_pure())
        entry.width = place.slab.width > 0 ? coded_width(place.slab.width * length) : std::uint16_t{0};
    }
  }
}

void SiteValues::keep_values_at(const std::vector<std::uint8_t>& kept) {
  std::uint32_t begin = 0, count = 0;
  for (std::size_t site = 0; site < kept.size(); ++site) {
    const std::uint32_t end = first_entries_[site + 1];
    if (kept[site] != 0) {
      for (std::uint32_t e = begin; e < end; ++e) entries_[count++] = entries_[e];
    }
    begin = end;
    first_entries_[site + 1] = count;
  }
  entries_.resize(count);
  entries_.shrink_to_fit();
  release_memory(sole_materials_);
  release_memory(mixed_sites_);
  release_memory(wall_sites_);
  release_memory(is_wall_);
  release_memory(layers_);
}

std::vector<MaterialId> materials_by_name(const IdVector<MaterialId, std::string>& names) {
  std::vector<MaterialId> result;
  for (MaterialId m(0); m.value < names.size(); ++m.value) result.push_back(m);
  std::stable_sort(result.begin(), result.end(),
                   [&](MaterialId a, MaterialId b) { return names[a] < names[b]; });
  return result;
}

std::vector<std::uint16_t> places_of(const std::vector<MaterialId>& materials) {
  std::vector<std::uint16_t> result(materials.size());
  for (std::size_t n = 0; n < materials.size(); ++n)
    result[materials[n].value] = static_cast<std::uint16_t>(n);
  return result;
}

double far_value(const RectilinearGrid& grid) {
  double widest = 0;
  for (const auto& x : grid.nodes) {
    for (std::size_t i = 1; i < x.size(); ++i) widest = std::max(widest, x[i] - x[i - 1]);
  }
  return -32 * widest;
}

void find_given_fractions(const MultiMaterialData& data, const SiteValues& values, std::size_t site,
                          std::vector<double>& given) {
  const std::span<const SiteValues::Entry> own = values.at(site);
  given.assign(own.size(), 0);
  double sum = 0;
  for (std::size_t e = 0; e < own.size(); ++e) {
    const std::uint16_t whole = values.material_number(own[e].material);
    bool first = true, held = false;
    for (std::size_t o = 0; o < own.size(); ++o) {
      if (values.material_number(own[o].material) != whole) continue;
      first = first && o >= e;
      held = held || own[o].fraction > 0;
    }
    if (first && held) given[e] = static_cast<double>(data.fraction(values.material(whole), site));
    sum += given[e];
  }
  for (double& g : given) g = sum > 0 ? g / sum : g;
}

}  // namespace adamas::interfaces
