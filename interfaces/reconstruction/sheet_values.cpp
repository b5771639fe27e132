#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/data/multi_material_data.h"
#include "interfaces/reconstruction/grid_sites.h"
#include "interfaces/reconstruction/normal_distribution.h"
#include "interfaces/reconstruction/site_values.h"
#include "interfaces/reconstruction/thin_sheets.h"

namespace adamas::interfaces {

namespace {

/// The least absolute value, in cells, if its sign is known; the value of a material on the other side of a
/// sheet is also below the main material's by at least this.
constexpr double kLeastValue = 0.25;
/// Values of materials that a side does not hold are lower by this many times kLeastValue.
constexpr double kFarBelow = 6;
/// The least sum of a material's fractions in the cells on a side, if the material is present there.
constexpr double kLeastPresent = 1e-3, kLeastPresentBlurred = 0.25;
/// The fraction of a material that appears across a blurred sheet may be this many times the one predicted
/// from the width.
constexpr double kAcross = 1.3;
/// The part of a sheet's excess value that the correction of volumes must leave, and the thickness, in cells,
/// below which sheets may tear.
constexpr double kLeastKept = 0.05, kLeastHeld = 0.1;

/// Returns the value of the main material on a side of a sheet minus the sheet's own value, at a point `d`
/// cells away from a place.
double above_sheet(const SheetPlace& place, std::size_t side, const Vec3& d, const Vec3& size) {
  const double height = place.slab.height(d);
  return 2 * ((side == 0 ? height : -height) - 0.5 * place.slab.thickness) *
         length_along(place.slab.normal, size);
}

/// Returns the value, or `least` with the given sign if the value is not beyond that.
double signed_value(double value, bool positive, double least) {
  return positive ? std::max(value, least) : std::min(value, -least);
}

}  // namespace

/// Computes the values at places in thin sheets from the layers fitted there. Each side of a sheet has values
/// of its own for all materials except the sheet's. The sheet's value is the distance into it, negative
/// outside; the value of the main material of a side differs from it by twice the distance from the sheet's
/// face on that side. Values are linear across the sheet, so that layers of even thickness are reproduced
/// exactly.
class SheetValues {
 public:
  SheetValues(const MultiMaterialData& data, const SiteValues& values, const ThinSheets& sheets);

  /// The region and the material that a number above those of materials stands for.
  struct Part {
    std::uint32_t region;
    std::uint16_t material;
  };
  [[nodiscard]] const std::vector<Part>& parts() const { return parts_; }
  /// Returns the entries of a place, in the order of their numbers.
  [[nodiscard]] std::vector<SiteValues::Entry> entries(const SheetPlace& place) const;
  /// Returns the place at a site; null if there is none.
  [[nodiscard]] const SheetPlace* at(std::size_t site) const {
    return place_of_[site] == kNone ? nullptr : &sheets_.places[place_of_[site]];
  }
  [[nodiscard]] bool too_many() const { return materials_ + parts_.size() > 0xfffeu; }

 private:
  using Entry = SiteValues::Entry;
  static constexpr std::uint32_t kNone = 0xffffffffu;

  /// A side of a sheet at a site, as the nearest place has it.
  struct Side {
    std::uint32_t region;
    std::uint16_t most;  ///< the main material
    double value;        ///< the value of the main material
    double squared;      ///< squared distance of the place
  };
  [[nodiscard]] std::vector<Side> sides(const SheetPlace& place, double own, const Vec3& size) const;
  [[nodiscard]] std::vector<Entry> plain_entries(const SheetPlace& place,
                                                 const std::vector<Side>& sides) const;
  [[nodiscard]] bool is_on_side(const SheetPlace& place, std::uint32_t region, std::uint16_t material) const;
  [[nodiscard]] std::uint16_t number(std::uint32_t region, std::uint16_t material) const {
    return numbers_.at({region, material});
  }

  const MultiMaterialData& data_;
  const SiteValues& values_;
  const ThinSheets& sheets_;
  GridSites sites_;
  std::size_t materials_;
  std::vector<std::uint32_t> place_of_;  // by site
  std::vector<Part> parts_;
  std::map<std::pair<std::uint32_t, std::uint16_t>, std::uint16_t> numbers_;
};

SheetValues::SheetValues(const MultiMaterialData& data, const SiteValues& values, const ThinSheets& sheets)
    : data_(data),
      values_(values),
      sheets_(sheets),
      sites_(data.grid),
      materials_(data.materials.size()),
      place_of_(data.grid.site_count(), kNone) {
  for (std::size_t p = 0; p < sheets.places.size(); ++p)
    place_of_[sheets.places[p].site] = static_cast<std::uint32_t>(p);
  const auto add = [&](std::uint32_t region, std::uint16_t material) {
    const auto [at, fresh] =
        numbers_.try_emplace({region, material}, static_cast<std::uint16_t>(materials_ + parts_.size()));
    if (fresh) parts_.push_back({region, material});
  };
  for (const SheetPlace& place : sheets.places) {
    const std::vector<Side> round = sides(place, 0, {1, 1, 1});
    const std::vector<Entry> plain = plain_entries(place, round);
    for (const Side& side : round) {
      for (const Entry& entry : plain) {
        if (entry.material != place.material) add(side.region, entry.material);
      }
    }
  }
}

/// Returns the entries of a site and those of the main materials on the sides of sheets there.
std::vector<SiteValues::Entry> SheetValues::plain_entries(const SheetPlace& place,
                                                          const std::vector<Side>& sides) const {
  const std::span<const Entry> own = values_.at(place.site);
  std::vector<Entry> entries(own.begin(), own.end());
  for (const Side& side : sides) {
    if (std::none_of(entries.begin(), entries.end(), [&](const Entry& e) { return e.material == side.most; }))
      entries.push_back({-values_.greatest_value(), 0, side.most});
  }
  return entries;
}

std::vector<SheetValues::Side> SheetValues::sides(const SheetPlace& place, double own,
                                                  const Vec3& size) const {
  std::vector<Side> sides;
  const auto add = [&](const SheetPlace& other, const Vec3& d) {
    for (std::size_t s = 0; s < 2; ++s) {
      const Side side{other.regions[s], other.sides[s], own + above_sheet(other, s, d, size),
                      squared_norm(d)};
      const auto known =
          std::find_if(sides.begin(), sides.end(), [&](const Side& k) { return k.region == side.region; });
      if (known == sides.end()) {
        sides.push_back(side);
      } else if (side.squared < known->squared) {
        *known = side;
      }
    }
  };
  add(place, {});
  sites_.for_each_neighbour(place.site, [&](std::size_t site, int di, int dj, int dk) {
    if (const SheetPlace* other = at(site); other != nullptr && other->material == place.material)
      add(*other, {-static_cast<double>(di), -static_cast<double>(dj), -static_cast<double>(dk)});
  });
  return sides;
}

/// Returns whether cells beside the sheet, round a place, hold a material on one of its sides.
bool SheetValues::is_on_side(const SheetPlace& place, std::uint32_t region, std::uint16_t material) const {
  if (region != place.regions[0] && region != place.regions[1]) return false;
  const double side = region == place.regions[0] ? 1 : -1;
  const SiteArray<float>& fractions = data_.fractions[values_.material(material)];
  const SiteArray<float>& sheet = data_.fractions[values_.material(place.material)];
  const bool blurred = place.slab.width > 0, is_across = material == place.sides[side > 0 ? 1 : 0];
  double sum = 0;
  const auto add = [&](std::size_t site, int di, int dj, int dk) {
    const Vec3 away{static_cast<double>(di), static_cast<double>(dj), static_cast<double>(dk)};
    const double beyond = side * place.slab.height(away) - 0.5 * place.slab.thickness;
    if (beyond <= 0 || !place.is_beside(away, sheet[site])) return;
    auto held = static_cast<double>(fractions[site]);
    // The material across a blurred sheet has some fraction on this side too.
    if (blurred && is_across)
      held -= kAcross * normal_probability(-(beyond + place.slab.thickness) / place.slab.width);
    sum += std::max(0.0, held);
  };
  add(place.site, 0, 0, 0);
  sites_.for_each_neighbour(place.site, add);
  return sum > (blurred ? kLeastPresentBlurred : kLeastPresent);
}

std::vector<SiteValues::Entry> SheetValues::entries(const SheetPlace& place) const {
  std::vector<Entry> entries;
  const Vec3 size = sites_.cell(place.site).size();
  const double least = kLeastValue * std::min({size.x, size.y, size.z});
  const double own =
      (0.5 * place.slab.thickness - std::abs(place.slab.offset)) * length_along(place.slab.normal, size);
  const std::vector<Side> round = sides(place, own, size);
  const std::vector<Entry> plain = plain_entries(place, round);
  const auto value_of = [&](std::uint16_t material) {
    return std::find_if(plain.begin(), plain.end(), [&](const Entry& e) { return e.material == material; })
        ->value;
  };
  bool beside = true;
  for (Entry entry : plain) {
    if (entry.material != place.material) continue;
    beside = place.is_beside({}, entry.fraction);
    entry.value = entry.is_pure() ? signed_value(own, entry.fraction > 0, least) : own;
    entries.push_back(entry);
  }
  const std::uint32_t home = place.regions[place.slab.offset > 0 ? 1 : 0];
  for (const Side& side : round) {
    for (Entry entry : plain) {
      if (entry.material == place.material) continue;
      double value = side.value;
      const bool here = beside && side.region == home;
      if (entry.material != side.most) {
        const double less = entry.value - value_of(side.most);
        value += here ? less : std::min(less, -least);
      }
      if (entry.fraction >= 1 && value <= 0) entry.fraction = 0;
      // Values of materials that a side does not hold are far below the others and are not given a sign.
      const bool absent = entry.material != side.most && !is_on_side(place, side.region, entry.material);
      if (absent) entry.fraction = 0, value = std::min(value, side.value - kFarBelow * least);
      entry.value = entry.is_pure() && !absent ? signed_value(value, entry.fraction > 0, least) : value;
      entry.material = number(side.region, entry.material);
      entries.push_back(entry);
    }
  }
  std::sort(entries.begin(), entries.end(),
            [](const Entry& a, const Entry& b) { return a.material < b.material; });
  return entries;
}

void SiteValues::split_at_sheets(const MultiMaterialData& data, const ThinSheets& sheets) {
  if (sheets.places.empty()) return;
  const SheetValues values(data, *this, sheets);
  if (values.too_many()) return;
  std::vector<std::vector<Entry>> changed(sheets.places.size());
  parallel_for(changed.size(), 256, [&](std::size_t p) { changed[p] = values.entries(sheets.places[p]); });

  std::vector<Entry> entries;
  entries.reserve(entries_.size() + 4 * changed.size());
  std::vector<char> is_wall;  // there are no walls in sheets
  std::vector<std::uint32_t> first(first_entries_.size(), 0);
  auto place = sheets.places.begin();
  for (std::size_t site = 0; site + 1 < first_entries_.size(); ++site) {
    if (place != sheets.places.end() && place->site == site) {
      const auto& own = changed[static_cast<std::size_t>(place - sheets.places.begin())];
      entries.insert(entries.end(), own.begin(), own.end());
      if (!is_wall_.empty()) is_wall.resize(entries.size(), 0);
      ++place;
    } else {
      entries.insert(entries.end(), entries_.begin() + first_entries_[site],
                     entries_.begin() + first_entries_[site + 1]);
      if (!is_wall_.empty())
        is_wall.insert(is_wall.end(), is_wall_.begin() + first_entries_[site],
                       is_wall_.begin() + first_entries_[site + 1]);
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
  first_entries_ = std::move(first);
  find_layers(data, sheets, values);
}

void SiteValues::find_layers(const MultiMaterialData& data, const ThinSheets& sheets,
                             const SheetValues& values) {
  const GridSites sites(data.grid);
  const auto materials = static_cast<std::uint16_t>(data.materials.size());
  for (const SheetPlace& place : sheets.places) {
    if (sole_materials_[place.site] != materials || place.slab.thickness < kLeastHeld) continue;
    // The value of a sheet has to fall where the sheet ends.
    const bool at_end = sites.any_neighbour(place.site, [&](std::size_t other) {
      const SheetPlace* beside = values.at(other);
      return beside == nullptr || beside->material != place.material;
    });
    if (at_end) continue;
    Layer layer;
    for (std::uint32_t e = first_entries_[place.site]; e < first_entries_[place.site + 1]; ++e) {
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
    layer.least = kLeastKept * excess(layer);
    if (layer.least > 0) layers_.push_back(std::move(layer));
  }
}

double SiteValues::excess(const Layer& layer) const {
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
    const double missing = layer.least - excess(layer);
    if (missing <= 0) continue;
    entries_[layer.sheet].value += 0.5 * missing;
    for (const auto& side : layer.sides) {
      for (const std::uint32_t e : side) entries_[e].value -= 0.5 * missing;
    }
  }
}

}  // namespace adamas::interfaces
