#include "interfaces/reconstruction/sheet_values.h"

#include <algorithm>
#include <cmath>

#include "interfaces/reconstruction/normal_distribution.h"

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
    entry.value = entry.settled() ? signed_value(own, entry.fraction > 0, least) : own;
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
      entry.value = entry.settled() && !absent ? signed_value(value, entry.fraction > 0, least) : value;
      entry.material = number(side.region, entry.material);
      entries.push_back(entry);
    }
  }
  std::sort(entries.begin(), entries.end(),
            [](const Entry& a, const Entry& b) { return a.material < b.material; });
  return entries;
}

}  // namespace adamas::interfaces
