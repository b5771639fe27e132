#pragma once

#include <cstdint>
#include <vector>

#include "core/data/multi_material_data.h"
#include "interfaces/reconstruction/site_box.h"
#include "interfaces/reconstruction/site_cell.h"
#include "interfaces/reconstruction/site_values.h"

namespace adamas::interfaces {

/// What fractions sharp interfaces would have if they were blurred as the data's are: the exact volumes of
/// materials in cells, spread by a normal distribution of each entry's own width beyond that of the cell.
class BlurredFractions {
 public:
  BlurredFractions(const MultiMaterialData& data, const SiteValues& values, const SiteCells& cells);

  /// Works them out for the present values.
  void predict();
  /// What a blurred entry's fraction should be; of entries that are not blurred the volume itself.
  [[nodiscard]] float at(std::size_t entry) const { return predicted_[entry]; }
  /// Whether more than a little of a wall is spread to where a material's first entry at a site is.
  [[nodiscard]] bool is_near_wall(std::size_t entry) const { return near_wall_[entry] != 0; }

 private:
  /// The entries of a material that are blurred, in a box round them.
  struct Part {
    std::uint16_t number;
    SiteBox box;
    double step;    ///< variance of a step of diffusion
    double widest;  ///< greatest width
    /// Entries with their place in the box, by the steps that they need; and the rest of a step, as a part.
    struct Target {
      std::uint32_t entry, place;
      float rest;
    };
    std::vector<std::vector<Target>> targets;
    /// A wall before which the material lies, and where in the box it counts as one.
    struct Wall {
      std::uint16_t number;
      std::vector<std::uint8_t> marks;
    };
    std::vector<Wall> walls;
  };
  void add_part(std::uint16_t number, const std::vector<std::uint32_t>& sites);
  void measure();
  void mark_walls(Part& part, std::size_t reach) const;
  /// The volumes of a material in the cells of a box; and of a part's walls in those of its own.
  [[nodiscard]] std::vector<float> volumes(const SiteBox& box, std::uint16_t number) const;
  [[nodiscard]] std::vector<float> wall_volumes(const Part& part) const;
  /// Calls set(target, fraction) for the targets of a part, with what diffusion makes of volumes in a box;
  /// place(p) is where a place of the part's box is in it.
  template <class Place, class Set>
  void spread(const Part& part, const SiteBox& box, std::vector<float> now, const Place& place,
              const Set& set) const;
  /// What lies beyond the sides on which fractions run on.
  void look_beyond();

  const MultiMaterialData& data_;
  const SiteValues& values_;
  const SiteCells& cells_;
  std::vector<Part> parts_;
  // By entry: what is to be added for cells beyond the sides, as they are at first; empty before.
  std::vector<float> beyond_;
  std::vector<float> owned_;      // by entry: a material's first at a site has the volume of all its regions
  std::vector<float> predicted_;  // by entry
  std::vector<char> near_wall_;   // by entry
};

}  // namespace adamas::interfaces
