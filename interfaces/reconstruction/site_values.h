#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "adamas/fractions.h"
#include "adamas/progress.h"
#include "core/data/multi_material_data.h"

namespace adamas::interfaces {

class GridSites;
class SheetValues;
struct ThinSheets;

/// One value for each site and each material near it. It is a length, roughly the signed distance from the
/// material's boundary. The material with the greatest value owns a point (docs/method.md, Interfaces from
/// volume fractions). A site has no values if one material fills it and all its neighbours.
class SiteValues {
 public:
  struct Entry {
    double value;
    float fraction;
    std::uint16_t material;   ///< the number of the material in the order of names, or of one of its regions
    std::uint16_t width = 0;  ///< the width of the step of its fractions, coded (see width()); 0 for a sharp
                              ///< step

    /// Returns whether the material fills the cell or is absent from it.
    [[nodiscard]] bool is_pure() const { return fraction <= 0 || fraction >= 1; }
  };

  /// If the standard deviation of the fractions' errors is below this, the fractions count as exact.
  static constexpr double kLeastError = 6e-3;

  /// Computes values from the planes that cut off each mixed cell's fractions, and from the widths of blurred
  /// steps; with `smooth`, for labels, by smooth_label_values(). Throws Cancelled where `progress` asks for
  /// it.
  explicit SiteValues(const MultiMaterialData& data, bool smooth = false, const FractionOptions& options = {},
                      Progress& progress = SilentProgress::instance());

  /// Returns values that are the fractions, less 0.5, times a length.
  static SiteValues fractions(const MultiMaterialData& data);

  [[nodiscard]] std::span<const Entry> at(std::size_t site) const {
    return {entries_.data() + first_entries_[site], entries_.data() + first_entries_[site + 1]};
  }
  [[nodiscard]] std::span<Entry> at(std::size_t site) {
    return {entries_.data() + first_entries_[site], entries_.data() + first_entries_[site + 1]};
  }
  [[nodiscard]] std::vector<Entry>& entries() { return entries_; }
  [[nodiscard]] const std::vector<Entry>& entries() const { return entries_; }
  /// Returns the index of an entry in entries().
  [[nodiscard]] std::size_t index(const Entry& entry) const {
    return static_cast<std::size_t>(&entry - entries_.data());
  }
  /// Returns the material with a number. Materials are numbered in the order of names, so that the result
  /// does not depend on the order of the data's materials. Greater numbers belong to regions of materials, as
  /// on the two sides of a thin sheet. The value of the material itself at a site holds for all its regions.
  [[nodiscard]] MaterialId material(std::uint16_t number) const { return by_name_[number]; }
  /// Returns the number of the material to which a number, of a material or a region, belongs.
  [[nodiscard]] std::uint16_t material_number(std::uint16_t number) const {
    return parents_.empty() ? number : parents_[number];
  }
  [[nodiscard]] bool has_regions() const { return !parents_.empty(); }
  /// Returns the count of numbers of materials and regions.
  [[nodiscard]] std::size_t number_count() const { return by_name_.size(); }
  /// Returns the number of the only material of a site that has no values.
  [[nodiscard]] std::uint16_t sole_material(std::size_t site) const { return sole_materials_[site]; }
  /// Return the width of an entry's step, and the code of a width: the standard deviation of the normal
  /// distribution whose step is most like that of the fractions, in the unit of length; 0 for a sharp step.
  [[nodiscard]] double width(const Entry& entry) const { return entry.width * width_unit_; }
  [[nodiscard]] std::uint16_t coded_width(double width) const {
    return static_cast<std::uint16_t>(std::clamp(width / width_unit_, 1.0, 65535.0));
  }
  /// Returns whether a step of a site's fractions is blurred.
  [[nodiscard]] bool is_blurred(std::size_t site) const {
    return std::ranges::any_of(at(site), [](const Entry& entry) { return entry.width > 0; });
  }
  /// Returns the value that stands for a material without a value at a site; it is less than all values of
  /// entries.
  [[nodiscard]] double far_value() const { return far_value_; }
  /// Returns the bound of the absolute values of all entries.
  [[nodiscard]] double greatest_value() const { return -far_value_ / 8; }
  /// Returns the least absolute value for smoothed labels, with which sites keep their labels; 0 for other
  /// data.
  [[nodiscard]] double least_label_value() const { return least_label_value_; }
  /// The entries of a mixed site in a thin sheet. The sheet is closed there as long as its value is above the
  /// mean of the greatest values on its two sides.
  struct Layer {
    static constexpr std::uint32_t kNone = 0xffffffffu;
    std::uint32_t sheet = kNone;
    std::array<std::vector<std::uint32_t>, 2> sides;
    double least = 0;  ///< the least excess of the sheet's value over that mean
  };
  [[nodiscard]] const std::vector<Layer>& layers() const { return layers_; }
  /// Raises the values of sheets that have come too close to the values on their sides.
  void hold_layers();
  /// Returns the findings about the fractions, without the counts of cells that are off and the areas.
  [[nodiscard]] const FractionFindings& findings() const { return findings_; }
  /// Returns the volumes that interfaces are to enclose: those of the fractions without dispersed parts.
  [[nodiscard]] const IdVector<MaterialId, double>& volumes() const { return volumes_; }
  /// Returns whether an entry belongs to a wall (walls.h).
  [[nodiscard]] bool is_wall(const Entry& entry) const {
    return !is_wall_.empty() && is_wall_[index(entry)] != 0;
  }
  [[nodiscard]] const std::vector<std::uint32_t>& wall_sites() const { return wall_sites_; }
  void set_walls(std::vector<char> is_wall, std::vector<std::uint32_t> sites) {
    is_wall_ = std::move(is_wall), wall_sites_ = std::move(sites);
  }
  /// Forgets all values but those at the sites for which `kept` is not 0, and all that is known of sites
  /// besides: only at() and what tells of numbers can be used afterwards.
  void keep_values_at(const std::vector<std::uint8_t>& kept);
  /// Returns the sites where at least two materials have a fraction, in order.
  [[nodiscard]] const std::vector<std::uint32_t>& mixed_sites() const { return mixed_sites_; }

 private:
  SiteValues() = default;
  void set_values_of_fractions(const MultiMaterialData& data, const FractionOptions& options,
                               Progress& progress);
  void set_lengths(const RectilinearGrid& grid);
  void set_distances(const MultiMaterialData& data);
  void find_volumes(const MultiMaterialData& data);
  void find_sole_materials(const MultiMaterialData& data);
  void find_materials_at(const MultiMaterialData& data, const GridSites& sites, std::size_t site,
                         std::vector<std::uint16_t>& found) const;
  template <class Visit>
  void for_each_site_with_values(const MultiMaterialData& data, const Visit& visit) const;
  void find_entries(const MultiMaterialData& data);
  [[nodiscard]] bool has_blurred() const;
  void fit_sharp_loosely(const RectilinearGrid& grid);
  void set_widths_of_sheets(const MultiMaterialData& data, const ThinSheets& sheets);
  void split_at_sheets(const MultiMaterialData& data, const ThinSheets& sheets);
  void find_layers(const MultiMaterialData& data, const ThinSheets& sheets, const SheetValues& values);
  [[nodiscard]] double excess(const Layer& layer) const;

  std::vector<MaterialId> by_name_;
  std::vector<std::uint16_t> parents_;         // by number; empty if there are no regions
  std::vector<std::uint16_t> sole_materials_;  // by site; the number of materials if the site has several
  std::vector<std::uint32_t> first_entries_;
  std::vector<Entry> entries_;
  std::vector<std::uint32_t> mixed_sites_, wall_sites_;
  std::vector<char> is_wall_;  // by entry; empty if there are no walls
  std::vector<Layer> layers_;
  FractionFindings findings_;
  IdVector<MaterialId, double> volumes_;
  double far_value_ = 0, least_label_value_ = 0, width_unit_ = 1;
};

/// Returns the materials in the order of their names, by which equal values are decided.
std::vector<MaterialId> materials_by_name(const IdVector<MaterialId, std::string>& names);

/// Returns the place of each material among `materials`.
std::vector<std::uint16_t> places_of(const std::vector<MaterialId>& materials);

/// Returns the value of a material that is far from a site, in the unit of length of the grid.
double far_value(const RectilinearGrid& grid);

/// Returns the value at a lattice point on the border, beyond the sites: it is continued linearly from the
/// values at the nearest site and the next one, or equal to `nearest` if one of these is `far`. `step`: the
/// distance from the point to the nearest site, relative to that between the two sites. With `is_pure` the
/// value keeps its sign, so that no interface enters a cell that a material fills or is absent from.
inline double continued(double nearest, double next, double step, double far, bool is_pure) {
  constexpr double kLeastPart = 0.05;
  if (nearest == far || next == far) return nearest;
  const double value = nearest + step * (nearest - next);
  if (!is_pure) return value;
  const double least = kLeastPart * nearest;
  return nearest > 0 ? std::max(value, least) : std::min(value, least);
}

/// Finds the entry with a number among those of a site; null if there is none.
template <class Entry>
Entry* find_entry(std::span<Entry> entries, std::uint16_t number) {
  const auto found = std::ranges::find_if(entries, [&](const Entry& e) { return e.material == number; });
  return found == entries.end() ? nullptr : &*found;
}

/// Returns the index, among all entries, of a site's first entry of a material or its regions. The site must
/// have one.
inline std::size_t first_entry(const SiteValues& values, std::size_t site, std::uint16_t material) {
  const std::span<const SiteValues::Entry> own = values.at(site);
  const auto found = std::ranges::find_if(
      own, [&](const auto& e) { return values.material_number(e.material) == material; });
  return values.index(*found);
}

/// Finds the fractions of a site's entries as the data have them, before errors are smoothed, without
/// dispersed fractions. `given[e]` becomes the fraction of the e-th entry's material; of several entries of
/// one material, the first has the fraction and the others 0. The sum is 1, or 0 if no entry has a fraction.
void find_given_fractions(const MultiMaterialData& data, const SiteValues& values, std::size_t site,
                          std::vector<double>& given);

}  // namespace adamas::interfaces
