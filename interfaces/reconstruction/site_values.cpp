#include "interfaces/reconstruction/site_values.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "adamas/geometry.h"
#include "core/base/error.h"
#include "core/base/loop_progress.h"
#include "core/base/parallel.h"
#include "interfaces/reconstruction/dispersed.h"
#include "interfaces/reconstruction/fraction_noise.h"
#include "interfaces/reconstruction/grid_sites.h"
#include "interfaces/reconstruction/interface_planes.h"
#include "interfaces/reconstruction/interface_widths.h"
#include "interfaces/reconstruction/label_smoothing.h"
#include "interfaces/reconstruction/normal_distribution.h"
#include "interfaces/reconstruction/sheet_values.h"
#include "interfaces/reconstruction/thin_sheets.h"
#include "interfaces/reconstruction/walls.h"

namespace adamas::interfaces {

namespace {

/// The least values of smoothed labels, in voxels: too small for the eye, and far above round-off.
constexpr double kLeastOfLabels = 0.02;
/// The greatest width of a step that an entry can have, in distances of sites.
constexpr double kWidestCoded = 64;
/// Values of blurred steps are known no farther from the interface than this, in widths.
constexpr double kFarthest = 4;

/// The part of a sheet's thickness that no correction of volumes takes away, and sheets, in cells, that are
/// so thin that they may tear.
constexpr double kLeastKept = 0.05, kLeastHeld = 0.1;

}  // namespace

SiteValues::SiteValues(const MultiMaterialData& data, bool smooth, const FractionOptions& options,
                       Progress& progress) {
  set_lengths(data.grid);
  {
    const LoopProgress stage(progress, "finding materials of cells");
    find_entries(data);
  }
  findings_.mixed_cells = mixed_.size();
  if (!smooth) {
    set_values_of_fractions(data, options, progress);
    return;
  }
  volumes_ = data.volumes();
  if (data.labels.empty()) fail("{}: expected labels to smooth, found volume fractions", data.source);
  least_ = kLeastOfLabels * data.grid.least_spacing();
  const LoopProgress stage(progress, "smoothing labels");
  smooth_label_values(data, *this);
}

void SiteValues::set_values_of_fractions(const MultiMaterialData& data, const FractionOptions& options,
                                         Progress& progress) {
  std::optional<LoopProgress> stage(std::in_place, progress, "finding widths and thin sheets");
  find_widths(data, options.known_blur(), *this);
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
  for (Entry& entry : values.entries_)
    entry.value = (static_cast<double>(entry.fraction) - 0.5) * data.grid.least_spacing();
  return values;
}

void SiteValues::set_lengths(const RectilinearGrid& grid) {
  double widest = 0;
  for (const auto& x : grid.nodes) {
    for (std::size_t i = 1; i < x.size(); ++i) widest = std::max(widest, x[i] - x[i - 1]);
  }
  far_ = -32 * widest;
  width_unit_ = kWidestCoded * grid.least_spacing() / 65535;
}

bool SiteValues::has_blurred() const {
  return std::ranges::any_of(entries_, [](const Entry& entry) { return entry.width > 0; });
}

/// Makes sharp cells blurred where fractions have errors, with the width of the cell itself, so that they are
/// fitted without reproducing the errors.
void SiteValues::fit_sharp_loosely(const RectilinearGrid& grid) {
  const GridSites sites(grid);
  for (const std::uint32_t site : mixed_) {
    const double width = kUniformDeviation * sites.least_side(site);
    for (Entry& entry : at(site)) {
      if (!entry.settled() && entry.width == 0) entry.width = coded_width(width);
    }
  }
}

/// The volumes of entries' fractions, and of sites that one material fills.
void SiteValues::find_volumes(const MultiMaterialData& data) {
  volumes_ = data.volumes();
  if (std::ranges::all_of(findings_.dispersed, [](double volume) { return volume == 0; })) return;
  // What is dispersed of a material goes to the others in its cells.
  const GridSites sites(data.grid);
  for (const std::uint32_t site : mixed_) {
    const double volume = sites.cell(site).volume();
    for (const Entry& entry : at(site)) {
      const MaterialId m = material(entry.material);
      volumes_[m] +=
          volume * (static_cast<double>(entry.fraction) - static_cast<double>(data.fraction(m, site)));
    }
  }
}

/// Distances from the planes that cut off each mixed cell's fractions.
void SiteValues::set_distances(const MultiMaterialData& data) {
  const GridSites sites(data.grid);
  const std::vector<InterfacePlane> planes = interface_planes(data, *this);
  parallel_for(mixed_.size(), 1024, [&](std::size_t n) {
    const Vec3 size = sites.cell(mixed_[n]).size();
    for (std::size_t e = first_[mixed_[n]]; e < first_[mixed_[n] + 1]; ++e) {
      if (entries_[e].settled()) continue;
      if (entries_[e].width > 0) {
        const double steps = normal_quantile(fraction_before_walls(*this, mixed_[n], entries_[e].fraction));
        entries_[e].value = std::clamp(width(entries_[e]) * std::clamp(steps, -kFarthest, kFarthest),
                                       -greatest_value(), greatest_value());
        continue;
      }
      entries_[e].value = planes[e].known() ? planes[e].distance
                                            : (static_cast<double>(entries_[e].fraction) - 0.5) *
                                                  std::min({size.x, size.y, size.z});
    }
  });
  // Sites beside mixed cells get the mean of what the planes round them say, on the right side of zero.
  parallel_for(data.grid.site_count(), 4096, [&](std::size_t site) {
    if (first_[site] == first_[site + 1]) return;
    const Vec3 centre = sites.position(site), size = sites.cell(site).size();
    const double half = 0.5 * std::min({size.x, size.y, size.z});
    const bool in_wall = std::ranges::any_of(
        at(site), [&](const Entry& entry) { return entry.fraction >= 1 && is_wall(entry); });
    for (std::size_t e = first_[site]; e < first_[site + 1]; ++e) {
      Entry& entry = entries_[e];
      if (!entry.settled()) continue;
      double sum = 0, weights = 0;
      sites.for_each_neighbour(site, [&](std::size_t other, int, int, int) {
        const Vec3 d = centre - sites.position(other);
        for (std::size_t o = first_[other]; o < first_[other + 1]; ++o) {
          if (entries_[o].material != entry.material) continue;
          const bool blurred = entries_[o].width > 0;
          if (!blurred && !planes[o].known()) continue;
          const double w = 1 / squared_norm(d);
          sum += w * (blurred ? entries_[o].value : planes[o].distance + dot(planes[o].towards, d));
          weights += w;
        }
      });
      const double side = entry.fraction > 0 ? 1 : -1;
      const double mean = weights > 0 ? sum / weights : 0;
      if (in_wall && weights > 0 && !is_wall(entry)) {
        // What lies before a wall runs on in it, until set_values_at_walls().
        entry.value = mean;
        continue;
      }
      entry.value = side * std::clamp(side * mean, half, greatest_value());
    }
  });
}

/// Numbers the materials by their names, and finds the sites that hold one alone.
void SiteValues::find_sole_materials(const MultiMaterialData& data) {
  const std::size_t count = data.grid.site_count(), materials = data.materials.size();
  for (MaterialId m(0); m.value < materials; ++m.value) by_name_.push_back(m);
  std::stable_sort(by_name_.begin(), by_name_.end(),
                   [&](MaterialId a, MaterialId b) { return data.materials[a] < data.materials[b]; });
  std::vector<std::uint16_t> numbers(materials);
  for (std::size_t n = 0; n < materials; ++n) numbers[by_name_[n].value] = static_cast<std::uint16_t>(n);
  sole_.resize(count);
  parallel_for(count, 1 << 14, [&](std::size_t site) {
    sole_[site] = static_cast<std::uint16_t>(materials);
    if (!data.labels.empty()) {
      sole_[site] = numbers[data.labels[site]];
      return;
    }
    for (std::size_t n = 0; n < materials; ++n) {
      if (data.fractions[by_name_[n]][site] >= 1) sole_[site] = static_cast<std::uint16_t>(n);
    }
  });
}

/// The numbers of the materials that have a value at a site, ascending: those that the site or a neighbour
/// holds, unless that is one material alone. Replaces `found`.
void SiteValues::find_materials_at(const MultiMaterialData& data, const GridSites& sites, std::size_t site,
                                   std::vector<std::uint16_t>& found) const {
  found.clear();
  const std::size_t materials = by_name_.size();
  if (sole_[site] < materials) {
    bool alone = true;
    sites.for_each_neighbour(
        site, [&](std::size_t other, int, int, int) { alone = alone && sole_[other] == sole_[site]; });
    if (alone) return;
  }
  const auto add = [&](std::size_t m) {
    const auto number = static_cast<std::uint16_t>(m);
    if (std::find(found.begin(), found.end(), number) == found.end()) found.push_back(number);
  };
  const auto add_site = [&](std::size_t s) {
    if (sole_[s] < materials) return add(sole_[s]);
    for (std::size_t n = 0; n < materials; ++n) {
      if (data.fractions[by_name_[n]][s] > 0) add(n);
    }
  };
  add_site(site);
  sites.for_each_neighbour(site, [&](std::size_t other, int, int, int) { add_site(other); });
  if (found.size() == 1 && sole_[site] < materials) found.clear();
  std::sort(found.begin(), found.end());
}

/// Makes an entry for each material that has a value at a site, and lists the mixed sites.
void SiteValues::find_entries(const MultiMaterialData& data) {
  find_sole_materials(data);
  const GridSites sites(data.grid);
  const std::size_t count = data.grid.site_count();
  first_.assign(count + 1, 0);
  parallel_for(count, 4096, [&](std::size_t site) {
    thread_local std::vector<std::uint16_t> found;
    find_materials_at(data, sites, site, found);
    first_[site + 1] = static_cast<std::uint32_t>(found.size());
  });
  std::uint64_t total = 0;
  for (std::size_t site = 0; site < count; ++site) {
    total += first_[site + 1];
    if (total > 0xffffffffu)
      fail("{}: expected at most {} materials beside sites, found more", data.source, 0xffffffffu);
    first_[site + 1] = static_cast<std::uint32_t>(total);
    if (sole_[site] == by_name_.size()) mixed_.push_back(static_cast<std::uint32_t>(site));
  }
  entries_.resize(total);
  parallel_for(count, 4096, [&](std::size_t site) {
    thread_local std::vector<std::uint16_t> found;
    if (first_[site] == first_[site + 1]) return;
    find_materials_at(data, sites, site, found);
    for (std::size_t n = 0; n < found.size(); ++n)
      entries_[first_[site] + n] = {0, data.fraction(by_name_[found[n]], site), found[n]};
  });
}

/// Steps of fractions at sheets are as wide as the layers fitted there say.
void SiteValues::set_widths_of_sheets(const MultiMaterialData& data, const ThinSheets& sheets) {
  const GridSites sites(data.grid);
  for (const SheetPlace& place : sheets.places) {
    const double length = length_along(place.slab.normal, sites.cell(place.site).size());
    for (Entry& entry : at(place.site)) {
      if (!entry.settled())
        entry.width = place.slab.width > 0 ? coded_width(place.slab.width * length) : std::uint16_t{0};
    }
  }
}

void SiteValues::split_at_sheets(const MultiMaterialData& data, const ThinSheets& sheets) {
  if (sheets.places.empty()) return;
  const SheetValues values(data, *this, sheets);
  if (values.too_many()) return;
  std::vector<std::vector<Entry>> changed(sheets.places.size());
  parallel_for(changed.size(), 256, [&](std::size_t p) { changed[p] = values.entries(sheets.places[p]); });

  std::vector<Entry> entries;
  entries.reserve(entries_.size() + 4 * changed.size());
  std::vector<char> is_wall;  // none in sheets
  std::vector<std::uint32_t> first(first_.size(), 0);
  auto place = sheets.places.begin();
  for (std::size_t site = 0; site + 1 < first_.size(); ++site) {
    if (place != sheets.places.end() && place->site == site) {
      const auto& own = changed[static_cast<std::size_t>(place - sheets.places.begin())];
      entries.insert(entries.end(), own.begin(), own.end());
      if (!is_wall_.empty()) is_wall.resize(entries.size(), 0);
      ++place;
    } else {
      entries.insert(entries.end(), entries_.begin() + first_[site], entries_.begin() + first_[site + 1]);
      if (!is_wall_.empty())
        is_wall.insert(is_wall.end(), is_wall_.begin() + first_[site], is_wall_.begin() + first_[site + 1]);
    }
    if (entries.size() > 0xffffffffu)
      fail("{}: expected fewer materials beside sites, found too many", data.source);
    first[site + 1] = static_cast<std::uint32_t>(entries.size());
  }
  const std::size_t materials = by_name_.size();
  for (std::size_t n = 0; n < materials; ++n) parents_.push_back(static_cast<std::uint16_t>(n));
  for (const SheetValues::Part& part : values.parts()) {
    parents_.push_back(part.material);
    by_name_.push_back(by_name_[part.material]);
  }
  entries_ = std::move(entries);
  is_wall_ = std::move(is_wall);
  first_ = std::move(first);
  find_layers(data, sheets, values);
}

void SiteValues::find_layers(const MultiMaterialData& data, const ThinSheets& sheets,
                             const SheetValues& values) {
  const GridSites sites(data.grid);
  const auto materials = static_cast<std::uint16_t>(data.materials.size());
  for (const SheetPlace& place : sheets.places) {
    if (sole_[place.site] != materials || place.slab.thickness < kLeastHeld) continue;
    // Where a sheet ends its value has to come down.
    bool inside = true;
    sites.for_each_neighbour(place.site, [&](std::size_t other, int, int, int) {
      const SheetPlace* beside = values.at(other);
      inside = inside && beside != nullptr && beside->material == place.material;
    });
    if (!inside) continue;
    Layer layer;
    for (std::uint32_t e = first_[place.site]; e < first_[place.site + 1]; ++e) {
      const Entry& entry = entries_[e];
      if (entry.material == place.material) {
        if (entry.fraction > 0) layer.sheet = e;
      } else if (entry.material >= materials) {
        const SheetValues::Part& part = values.parts()[entry.material - std::size_t{materials}];
        for (std::size_t side = 0; side < 2; ++side) {
          if (part.region == place.regions[side]) layer.sides[side].push_back(e);
        }
      }
    }
    if (layer.sheet == Layer::kNone || layer.sides[0].empty() || layer.sides[1].empty()) continue;
    layer.least = kLeastKept * above(layer);
    if (layer.least > 0) layers_.push_back(std::move(layer));
  }
}

double SiteValues::above(const Layer& layer) const {
  double sides = 0;
  for (const auto& side : layer.sides) {
    double most = entries_[side.front()].value;
    for (const std::uint32_t e : side) most = std::max(most, entries_[e].value);
    sides += most;
  }
  return entries_[layer.sheet].value - 0.5 * sides;
}

void SiteValues::hold_layers() {
  for (const Layer& layer : layers_) {
    const double missing = layer.least - above(layer);
    if (missing <= 0) continue;
    entries_[layer.sheet].value += 0.5 * missing;
    for (const auto& side : layer.sides) {
      for (const std::uint32_t e : side) entries_[e].value -= 0.5 * missing;
    }
  }
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
