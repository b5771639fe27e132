#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "core/data/multi_material_data.h"
#include "interfaces/reconstruction/grid_sites.h"
#include "interfaces/reconstruction/site_values.h"
#include "interfaces/reconstruction/thin_sheets.h"

namespace adamas::interfaces {

/// Values at places in thin sheets: those of the layers fitted there, and one on each side for all materials
/// but the sheet's. A sheet's own value is the distance into it, negative outside, and what there is most of
/// on a side differs from it by twice the distance from the sheet's face there: linear across the sheet, so
/// that even layers come out as they are.
class SheetValues {
 public:
  SheetValues(const MultiMaterialData& data, const SiteValues& values, const ThinSheets& sheets);

  /// What a number above those of materials stands for.
  struct Part {
    std::uint32_t region;
    std::uint16_t material;
  };
  [[nodiscard]] const std::vector<Part>& parts() const { return parts_; }
  /// The entries of a place, in the order of their numbers.
  [[nodiscard]] std::vector<SiteValues::Entry> entries(const SheetPlace& place) const;
  /// The place at a site; null where there is none.
  [[nodiscard]] const SheetPlace* at(std::size_t site) const {
    return place_of_[site] == kNone ? nullptr : &sheets_.places[place_of_[site]];
  }
  [[nodiscard]] bool too_many() const { return materials_ + parts_.size() > 0xfffeu; }

 private:
  using Entry = SiteValues::Entry;
  static constexpr std::uint32_t kNone = 0xffffffffu;

  /// A side of a sheet, as the place that says most of it at a site has it.
  struct Side {
    std::uint32_t region;
    std::uint16_t most;  ///< the material there is most of
    double value;        ///< of that
    double squared;      ///< distance of the place
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

}  // namespace adamas::interfaces
