// The part of SiteValues that is about thin sheets.

#include <algorithm>
#include <utility>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "interfaces/reconstruction/grid_sites.h"
#include "interfaces/reconstruction/sheet_values.h"
#include "interfaces/reconstruction/site_values.h"
#include "interfaces/reconstruction/thin_sheets.h"

namespace adamas::interfaces {

namespace {

/// The part of a sheet's thickness that no correction of volumes takes away, and sheets, in cells, that are
/// so thin that they may tear.
constexpr double kLeastKept = 0.05, kLeastHeld = 0.1;

}  // namespace

/// Steps of fractions at sheets are as wide as the layers fitted there say.
void SiteValues::set_widths_of_sheets(const MultiMaterialData& data, const ThinSheets& sheets) {
  const GridSites sites(data.grid);
  for (const SheetPlace& place : sheets.places) {
    const Vec3 size = sites.cell(place.site).size(), &n = place.slab.normal;
    const double length = 1 / norm(Vec3{n.x / size.x, n.y / size.y, n.z / size.z});
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

}  // namespace adamas::interfaces
