#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "adamas/progress.h"
#include "core/data/multi_material_data.h"
#include "interfaces/reconstruction/site_box.h"
#include "interfaces/reconstruction/site_cell.h"
#include "interfaces/reconstruction/site_values.h"

namespace adamas::interfaces {

/// One flag for each side of a grid: least x, greatest x, then the same for y and z.
using GridSides = std::array<bool, 6>;

/// Finds the sides beyond which blurred fractions continue, as where data are cut out of larger ones. At the
/// other sides fractions are mirrored, as at a solver's walls: their slope across the side falls towards it.
GridSides continued_sides(const MultiMaterialData& data, const SiteValues& values);

/// A box of sites that is extended by sites beyond the sides at which fractions continue. These have the
/// spacing of the two sites nearest to the side.
class ContinuedBox {
 public:
  /// `reach`: the length by which the box is extended beyond each such side. `box` must outlive this object.
  ContinuedBox(const RectilinearGrid& grid, const SiteBox& box, const GridSides& sides, double reach);
  /// The part of another extended box that holds `part`, a part of its box from near_sides(), and the same
  /// sites beyond it.
  ContinuedBox(const RectilinearGrid& grid, const SiteBox& part, const GridSides& sides, double reach,
               const ContinuedBox& whole)
      : ContinuedBox(grid, part, sides, reach) {
    own_width_ = whole.own_width_;
  }
  ContinuedBox(const ContinuedBox&) = delete;
  ContinuedBox& operator=(const ContinuedBox&) = delete;

  /// Returns whether there are sites beyond the sides.
  [[nodiscard]] bool reaches_beyond() const { return box_.size() > inner_.size(); }
  /// Returns the extended box.
  [[nodiscard]] const SiteBox& box() const { return box_; }
  /// Converts a place in the box to the place in the extended box.
  [[nodiscard]] std::size_t place(std::size_t inner) const;

  /// Returns the part of the box that ends `depth` sites from the side at which it is extended; the whole box
  /// if there are several such sides.
  [[nodiscard]] SiteBox near_sides(std::size_t depth) const;

  /// Returns the distance, in sites along the axes, from a place in the box to the nearest site beyond a
  /// side.
  [[nodiscard]] std::size_t sites_to_beyond(std::size_t inner) const;
  /// Calls visit(place, site) for the places in the box that are as near to such a side as sites beyond it
  /// are, or beside it: only these count in beyond_mirrored().
  template <class Visit>
  void for_each_near_side(const Visit& visit) const;

  /// Returns the fraction of a material in each cell beyond the sides minus that of the mirror image; 0 in
  /// the other cells. `volumes`: the fractions in the cells of `box`. `distances`: their distances into the
  /// material, which are continued linearly.
  [[nodiscard]] std::vector<float> beyond_mirrored(const std::vector<float>& volumes,
                                                   const std::vector<float>& distances) const;

 private:
  static RectilinearGrid extended(const RectilinearGrid& grid, const SiteBox& box,
                                  std::array<std::array<std::size_t, 2>, 3>& cells, const GridSides& sides,
                                  double reach);
  /// Continues an array beyond the sides, axis by axis: next(axis, end, line, k) returns the value k cells
  /// beyond an end of the axis; line(i) is the value i cells inwards from the cell at that end.
  template <class Next>
  void continue_beyond(std::vector<float>& values, const Next& next) const;

  const SiteBox& inner_;
  std::array<std::array<std::size_t, 2>, 3> cells_{};  // the numbers of cells beyond the sides
  RectilinearGrid grid_;
  SiteBox box_;
  double own_width_;  // of the step of a sharp interface's fractions
};

/// Predicts the fractions of sharp interfaces that are blurred like the data's: the exact volumes of
/// materials in cells, spread by a normal distribution with each entry's own width, less the width of the
/// cell itself.
class BlurredFractions {
 public:
  BlurredFractions(const MultiMaterialData& data, const SiteValues& values, const SiteCells& cells);

  /// Computes the fractions for the present values.
  void predict();
  /// Returns the predicted fraction of a blurred entry, or the volume of another one, relative to the cell.
  [[nodiscard]] float at(std::size_t entry) const { return predicted_[entry]; }
  /// Returns whether a considerable part of a wall is spread to the site of an entry, which must be a
  /// material's first one there.
  [[nodiscard]] bool is_near_wall(std::size_t entry) const { return near_wall_[entry] != 0; }

 private:
  /// The blurred entries of a material, in a box round them.
  struct Part {
    std::uint16_t number;
    SiteBox box;
    double step;    ///< the variance of a step of diffusion
    double widest;  ///< the greatest width
    /// An entry with its place in the box and the part of one more step that it needs.
    struct Target {
      std::uint32_t entry, place;
      float rest;
    };
    using Targets = std::vector<std::vector<Target>>;
    Targets targets;                      ///< by the number of whole steps that they need
    std::optional<DiffusionNeeds> needs;  ///< in the box; without a value if the steps are too many
    /// A wall before which the material lies, with marks at the places of the box where it counts as a wall.
    struct Wall {
      std::uint16_t number;
      std::vector<std::uint8_t> marks;
    };
    std::vector<Wall> walls;
  };
  void add_part(std::uint16_t number, const std::vector<std::uint32_t>& sites);
  void measure();
  static void find_needs(Part& part);
  void mark_walls(Part& part, std::size_t reach) const;
  /// Returns the volume of a material in a site's cell.
  [[nodiscard]] float volume_at(std::size_t site, std::uint16_t number) const;
  /// Return the volumes of a material in the cells of a box, and those of a part's walls in the cells of its
  /// box.
  [[nodiscard]] std::vector<float> volumes(const SiteBox& box, std::uint16_t number) const;
  [[nodiscard]] std::vector<float> wall_volumes(const Part& part) const;
  /// Diffuses the volumes `now` in a box, by the variance `by` in a step, and calls set(target, fraction) for
  /// the targets in it with the result. `needs`: null if all values of the box are needed.
  template <class Set>
  static void spread(const SiteBox& box, double by, const Part::Targets& targets, const DiffusionNeeds* needs,
                     std::vector<float> now, const Set& set);
  /// Finds the contributions of cells beyond the sides at which fractions continue.
  void find_beyond();
  void find_beyond(const Part& part, const GridSides& sides);

  const MultiMaterialData& data_;
  const SiteValues& values_;
  const SiteCells& cells_;
  std::vector<Part> parts_;
  // The contributions of cells beyond the sides, by entry; empty until they are computed, which is done once.
  std::vector<float> beyond_;
  // Volumes by entry; a material's first entry at a site has that of all its regions.
  std::vector<float> owned_;
  std::vector<float> predicted_;  // by entry
  std::vector<char> near_wall_;   // by entry
};

/// Moves the values of blurred entries until the predicted fractions are those of the data: in each of a few
/// rounds, by the difference of the fractions times a length.
void fit_blurred(const MultiMaterialData& data, SiteValues& values, const SiteCells& cells,
                 Progress& progress);

}  // namespace adamas::interfaces
