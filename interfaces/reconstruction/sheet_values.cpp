#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "interfaces/reconstruction/grid_sites.h"
#include "interfaces/reconstruction/site_values.h"
#include "interfaces/reconstruction/thin_sheets.h"

namespace adamas {

namespace {

constexpr std::uint32_t kNone = 0xffffffffu;
/// What a value differs from zero by at least, in cells, where its sign is known.
constexpr double kLeastValue = 0.25;

/// The part of a sheet's thickness that no correction of volumes takes away.
constexpr double kLeastKept = 0.05, kLeastHeld = 0.1;

/// The length of a cell of some size along a direction that is given in cells.
double length_along(const Vec3& n, const Vec3& size) {
  return 1 / norm(Vec3{n.x / size.x, n.y / size.y, n.z / size.z});
}

/// How much greater the value of what lies on a side of a sheet is than the sheet's own, at a point `d` cells
/// away from a place.
double above_sheet(const SheetPlace& place, std::size_t side, const Vec3& d, const Vec3& size) {
  const double height = place.slab.height(d);
  return 2 * ((side == 0 ? height : -height) - 0.5 * place.slab.thickness) *
         length_along(place.slab.normal, size);
}

/// A value with a sign, not too near to zero.
double signed_value(double value, bool positive, double least) {
  return positive ? std::max(value, least) : std::min(value, -least);
}

}  // namespace

/// At thin sheets values are those of the layers fitted there, and what lies on both sides gets two values
/// instead of one. A sheet's own value is the distance into it, negative outside, and the others differ from
/// it by twice the distance from the sheet's face on their side: linear across the sheet, so that even layers
/// come out as they are.
void SiteValues::split_at_sheets(const MultiMaterialData& data) {
  const ThinSheets sheets = find_thin_sheets(data, *this);
  if (sheets.places.empty()) return;
  const std::size_t materials = by_name_.size();
  if (materials + sheets.region_materials.size() > 0xfffeu) return;
  parents_.resize(materials);
  for (std::size_t n = 0; n < materials; ++n) parents_[n] = static_cast<std::uint16_t>(n);
  for (const std::uint16_t m : sheets.region_materials) {
    parents_.push_back(m);
    by_name_.push_back(by_name_[m]);
  }
  const GridSites sites(data.grid);
  std::vector<std::uint32_t> place_of(data.grid.site_count(), kNone);
  for (std::size_t p = 0; p < sheets.places.size(); ++p)
    place_of[sheets.places[p].site] = static_cast<std::uint32_t>(p);

  /// A region at a site, by the place that says most of it there.
  struct Twin {
    std::uint16_t number;
    double value;
  };
  const auto find_twins = [&](const SheetPlace& place, std::vector<Twin>& twins) {
    const Vec3 size = sites.cell(place.site).size();
    const double own =
        (0.5 * place.slab.thickness - std::abs(place.slab.offset)) * length_along(place.slab.normal, size);
    std::vector<double> distances;
    const auto add = [&](const SheetPlace& other, const Vec3& d, double squared) {
      for (std::size_t side = 0; side < 2; ++side) {
        const auto number = static_cast<std::uint16_t>(materials + other.regions[side]);
        const double value = own + above_sheet(other, side, d, size);
        const auto known =
            std::find_if(twins.begin(), twins.end(), [&](const Twin& t) { return t.number == number; });
        const auto at = static_cast<std::size_t>(known - twins.begin());
        if (known == twins.end()) {
          twins.push_back({number, value});
          distances.push_back(squared);
        } else if (squared < distances[at]) {
          *known = {number, value}, distances[at] = squared;
        }
      }
    };
    twins.clear();
    add(place, {}, 0);
    sites.for_each_neighbour(place.site, [&](std::size_t s, int di, int dj, int dk) {
      if (place_of[s] == kNone) return;
      const SheetPlace& other = sheets.places[place_of[s]];
      if (other.has_twins() && other.sides == place.sides)
        add(other, {-static_cast<double>(di), -static_cast<double>(dj), -static_cast<double>(dk)},
            static_cast<double>(di * di + dj * dj + dk * dk));
    });
    std::sort(twins.begin(), twins.end(), [](const Twin& a, const Twin& b) { return a.number < b.number; });
  };

  std::vector<std::vector<Entry>> changed(sheets.places.size());
  parallel_for(changed.size(), 256, [&](std::size_t p) {
    thread_local std::vector<Twin> twins;
    const SheetPlace& place = sheets.places[p];
    const Vec3 size = sites.cell(place.site).size();
    const double least = kLeastValue * std::min({size.x, size.y, size.z});
    const double own =
        (0.5 * place.slab.thickness - std::abs(place.slab.offset)) * length_along(place.slab.normal, size);
    if (place.has_twins()) find_twins(place, twins);
    for (Entry entry : at(place.site)) {
      const bool settled = entry.settled();
      const auto set = [&](double value) {
        entry.value = settled ? signed_value(value, entry.fraction > 0, least) : value;
        changed[p].push_back(entry);
      };
      if (entry.material == place.material) {
        set(own);
      } else if (entry.material == place.sides[0] && place.has_twins()) {
        // Added behind the others.
      } else if (entry.material == place.sides[0] || entry.material == place.sides[1]) {
        set(own + above_sheet(place, entry.material == place.sides[0] ? 0 : 1, {}, size));
      } else {
        changed[p].push_back(entry);
      }
    }
    if (!place.has_twins()) return;
    const float fraction = data.fractions[by_name_[place.sides[0]]][place.site];
    for (const Twin& twin : twins) {
      Entry entry{twin.value, fraction, twin.number};
      if (fraction >= 1 && twin.value <= 0) entry.fraction = 0;
      if (entry.settled()) entry.value = signed_value(twin.value, entry.fraction > 0, least);
      changed[p].push_back(entry);
    }
  });

  std::vector<Entry> entries;
  entries.reserve(entries_.size() + 2 * changed.size());
  std::vector<std::uint32_t> first(first_.size(), 0);
  for (std::size_t site = 0; site + 1 < first_.size(); ++site) {
    if (place_of[site] != kNone) {
      const auto& own = changed[place_of[site]];
      entries.insert(entries.end(), own.begin(), own.end());
    } else {
      entries.insert(entries.end(), entries_.begin() + first_[site], entries_.begin() + first_[site + 1]);
    }
    if (entries.size() > 0xffffffffu)
      fail("{}: expected fewer materials beside sites, found too many", data.source);
    first[site + 1] = static_cast<std::uint32_t>(entries.size());
  }
  entries_ = std::move(entries);
  first_ = std::move(first);
  find_layers(data, sheets, materials);
}

void SiteValues::find_layers(const MultiMaterialData& data, const ThinSheets& sheets, std::size_t materials) {
  const GridSites sites(data.grid);
  std::vector<const SheetPlace*> place_at(data.grid.site_count(), nullptr);
  for (const SheetPlace& place : sheets.places) place_at[place.site] = &place;
  const auto is_alike = [](const SheetPlace& a, const SheetPlace& b) {
    return a.material == b.material &&
           std::minmax(a.sides[0], a.sides[1]) == std::minmax(b.sides[0], b.sides[1]);
  };
  constexpr std::uint32_t kNone = 0xffffffffu;
  for (const SheetPlace& place : sheets.places) {
    if (sole_[place.site] != materials) continue;
    if (place.slab.thickness < kLeastHeld) continue;
    // Where a sheet ends its value has to come down, and where something else begins beside it sides change.
    bool inside = true;
    sites.for_each_neighbour(place.site, [&](std::size_t other, int, int, int) {
      inside = inside && place_at[other] != nullptr && is_alike(place, *place_at[other]);
    });
    if (!inside) continue;
    const auto entry_of = [&](std::size_t number) {
      for (std::uint32_t e = first_[place.site]; e < first_[place.site + 1]; ++e) {
        if (entries_[e].material == number) return e;
      }
      return kNone;
    };
    Layer layer{entry_of(place.material), {}, 0};
    for (std::size_t side = 0; side < 2; ++side)
      layer.sides[side] = entry_of(place.has_twins() ? materials + place.regions[side] : place.sides[side]);
    if (layer.sheet == kNone || layer.sides[0] == kNone || layer.sides[1] == kNone) continue;
    if (!(entries_[layer.sheet].fraction > 0)) continue;
    const double above =
        entries_[layer.sheet].value - 0.5 * (entries_[layer.sides[0]].value + entries_[layer.sides[1]].value);
    layer.least = kLeastKept * above;
    if (layer.least > 0) layers_.push_back(layer);
  }
}

void SiteValues::hold_layers() {
  for (const Layer& layer : layers_) {
    Entry &sheet = entries_[layer.sheet], &front = entries_[layer.sides[0]], &back = entries_[layer.sides[1]];
    const double missing = layer.least - (sheet.value - 0.5 * (front.value + back.value));
    if (missing <= 0) continue;
    sheet.value += 0.5 * missing;
    front.value -= 0.5 * missing;
    back.value -= 0.5 * missing;
  }
}

}  // namespace adamas
