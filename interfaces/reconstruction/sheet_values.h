#pragma once

#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "core/data/multi_material_data.h"
#include "interfaces/reconstruction/grid_sites.h"
#include "interfaces/reconstruction/site_values.h"
#include "interfaces/reconstruction/thin_sheets.h"

namespace adamas::interfaces {

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

}  // namespace adamas::interfaces
