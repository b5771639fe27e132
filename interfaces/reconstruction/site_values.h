#pragma once

#include <algorithm>
#include <array>
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

/// A value per site and material near it, whose greatest says who owns a point (docs/method.md, Interfaces
/// from volume fractions): lengths, about the signed distance from the material's boundary. Sites all of
/// whose neighbours hold what they hold alone have no values.
class SiteValues {
 public:
  struct Entry {
    double value;
    float fraction;
    std::uint16_t material;   ///< its number in the order of names, or that of a region of it
    std::uint16_t width = 0;  ///< of the step of its fractions, coded (width()); 0: it is sharp

    /// Whether the material fills the cell or is absent from it.
    [[nodiscard]] bool settled() const { return fraction <= 0 || fraction >= 1; }
  };

  /// Errors of fractions with a lesser standard deviation are none.
  static constexpr double kLeastError = 6e-3;

  /// Values from the planes that cut off each mixed cell's fractions, and from the widths of blurred ones; of
  /// labels, with `smooth`, those of smooth_label_values(). Throws Cancelled where `progress` says so.
  explicit SiteValues(const MultiMaterialData& data, bool smooth = false, const FractionOptions& options = {},
                      Progress& progress = SilentProgress::instance());

  /// Values that are the fractions themselves, times a length.
  static SiteValues fractions(const MultiMaterialData& data);

  [[nodiscard]] std::span<const Entry> at(std::size_t site) const {
    return {entries_.data() + first_[site], entries_.data() + first_[site + 1]};
  }
  [[nodiscard]] std::span<Entry> at(std::size_t site) {
    return {entries_.data() + first_[site], entries_.data() + first_[site + 1]};
  }
  [[nodiscard]] std::vector<Entry>& entries() { return entries_; }
  [[nodiscard]] const std::vector<Entry>& entries() const { return entries_; }
  /// The place of an entry among all.
  [[nodiscard]] std::size_t index(const Entry& entry) const {
    return static_cast<std::size_t>(&entry - entries_.data());
  }
  /// The material with a number in the order of names, on which nothing else may depend. Above these are
  /// regions of materials, which may lie on the two sides of a thin sheet. Where a site has a value of the
  /// material itself it is that of all its regions.
  [[nodiscard]] MaterialId material(std::uint16_t number) const { return by_name_[number]; }
  /// The number of the material itself.
  [[nodiscard]] std::uint16_t whole(std::uint16_t number) const {
    return parents_.empty() ? number : parents_[number];
  }
  [[nodiscard]] bool has_regions() const { return !parents_.empty(); }
  /// How many numbers there are, those of regions included.
  [[nodiscard]] std::size_t number_count() const { return by_name_.size(); }
  /// The number of the one material of a site that has no values.
  [[nodiscard]] std::uint16_t sole_material(std::size_t site) const { return sole_[site]; }
  /// The standard deviation of the normal distribution that the step of an entry's fractions looks like, in
  /// the unit of length; 0 where it is sharp. And how an entry has it.
  [[nodiscard]] double width(const Entry& entry) const { return entry.width * width_unit_; }
  [[nodiscard]] std::uint16_t coded_width(double width) const {
    return static_cast<std::uint16_t>(std::clamp(width / width_unit_, 1.0, 65535.0));
  }
  /// Whether a step of a site's fractions is blurred.
  [[nodiscard]] bool is_blurred(std::size_t site) const {
    return std::ranges::any_of(at(site), [](const Entry& entry) { return entry.width > 0; });
  }
  /// The value of a material that has none near a site: less than any that counts.
  [[nodiscard]] double far() const { return far_; }
  /// No value is greater than this.
  [[nodiscard]] double greatest() const { return -far_ / 8; }
  /// No value of smoothed labels is nearer to zero than this, so that sites keep their labels; 0 for other
  /// data.
  [[nodiscard]] double least() const { return least_; }
  /// A place in a thin sheet of a mixed site, by its entries: it holds together as long as the sheet's value
  /// is above the mean of the greatest on either side.
  struct Layer {
    static constexpr std::uint32_t kNone = 0xffffffffu;
    std::uint32_t sheet = kNone;
    std::array<std::vector<std::uint32_t>, 2> sides;
    double least = 0;  ///< how much it is to be above
  };
  [[nodiscard]] const std::vector<Layer>& layers() const { return layers_; }
  /// Lifts the values of sheets above what is on their sides where they have come below.
  void hold_layers();
  /// What was found of the fractions, but for cells that are off and areas.
  [[nodiscard]] const FractionFindings& findings() const { return findings_; }
  /// The volumes that interfaces are to enclose: those of the fractions, without what is dispersed.
  [[nodiscard]] const IdVector<MaterialId, double>& volumes() const { return volumes_; }
  /// Whether an entry is that of a wall (walls.h); the sites that have such entries, in order; and where both
  /// are set.
  [[nodiscard]] bool is_wall(const Entry& entry) const {
    return !is_wall_.empty() && is_wall_[index(entry)] != 0;
  }
  [[nodiscard]] const std::vector<std::uint32_t>& at_walls() const { return at_walls_; }
  void set_walls(std::vector<char> is_wall, std::vector<std::uint32_t> sites) {
    is_wall_ = std::move(is_wall), at_walls_ = std::move(sites);
  }
  /// Sites where two materials or more have a fraction, in order.
  [[nodiscard]] const std::vector<std::uint32_t>& mixed() const { return mixed_; }

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
  void find_entries(const MultiMaterialData& data);
  [[nodiscard]] bool has_blurred() const;
  void fit_sharp_loosely(const RectilinearGrid& grid);
  void set_widths_of_sheets(const MultiMaterialData& data, const ThinSheets& sheets);
  void split_at_sheets(const MultiMaterialData& data, const ThinSheets& sheets);
  void find_layers(const MultiMaterialData& data, const ThinSheets& sheets, const SheetValues& values);
  [[nodiscard]] double above(const Layer& layer) const;

  std::vector<MaterialId> by_name_;
  std::vector<std::uint16_t> parents_;  // by number; empty where there are no regions
  std::vector<std::uint16_t> sole_;     // by site; the number of materials where there are several
  std::vector<std::uint32_t> first_;
  std::vector<Entry> entries_;
  std::vector<std::uint32_t> mixed_, at_walls_;
  std::vector<char> is_wall_;  // by entry; empty where there are no walls
  std::vector<Layer> layers_;
  FractionFindings findings_;
  IdVector<MaterialId, double> volumes_;
  double far_ = 0, least_ = 0, width_unit_ = 1;
};

/// The value at a lattice point on the border, beyond the sites, `step` times as far from the nearest as that
/// is from the next one: continued linearly, or that of the nearest where the other is far. No interface gets
/// into a cell that a material fills or is absent from: there the value keeps its sign (`settled`).
inline double continued(double nearest, double next, double step, double far, bool settled) {
  constexpr double kLeastPart = 0.05;
  if (nearest == far || next == far) return nearest;
  const double value = nearest + step * (nearest - next);
  if (!settled) return value;
  const double least = kLeastPart * nearest;
  return nearest > 0 ? std::max(value, least) : std::min(value, least);
}

}  // namespace adamas::interfaces
