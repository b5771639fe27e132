#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/data/multi_material_data.h"
#include "interfaces/reconstruction/site_box.h"
#include "interfaces/reconstruction/site_values.h"

namespace adamas::interfaces {

/// The sides of a grid: of least and of greatest x, and so on.
using GridSides = std::array<bool, 6>;

/// The sides beyond which blurred fractions run on, as where data are cut out of larger ones. On the others
/// they are mirrored, as at a solver's walls: their slope across the side becomes less towards it.
GridSides sides_that_run_on(const MultiMaterialData& data, const SiteValues& values);

/// A box of sites with more of them beyond the sides on which fractions run on, as far from each other as the
/// two nearest to the side.
class ContinuedBox {
 public:
  /// `reach`: how far the box reaches beyond each such side, a length. `box` must outlive this.
  ContinuedBox(const RectilinearGrid& grid, const SiteBox& box, const GridSides& sides, double reach);
  ContinuedBox(const ContinuedBox&) = delete;
  ContinuedBox& operator=(const ContinuedBox&) = delete;

  /// Whether there are such cells.
  [[nodiscard]] bool reaches_beyond() const { return box_.size() > inner_.size(); }
  /// The box with these cells.
  [[nodiscard]] const SiteBox& box() const { return box_; }
  /// Where a place of the box is in the box with these cells.
  [[nodiscard]] std::size_t place(std::size_t inner) const;

  /// What cells beyond hold more of a material than the mirror image does; 0 in the cells within. `volumes`
  /// and `distances`, lengths, are what the cells of `box` hold and how far inside the material they are:
  /// distances run on linearly.
  [[nodiscard]] std::vector<float> beyond_mirrored(const std::vector<float>& volumes,
                                                   const std::vector<float>& distances) const;

 private:
  static RectilinearGrid extended(const RectilinearGrid& grid, const SiteBox& box,
                                  std::array<std::array<std::size_t, 2>, 3>& cells, const GridSides& sides,
                                  double reach);
  /// Continues an array beyond the sides, axis by axis: next(axis, end, line, k) is the value k cells beyond
  /// an end of the axis, where line(i) is that i cells within from the nearest one.
  template <class Next>
  void run_on(std::vector<float>& values, const Next& next) const;

  const SiteBox& inner_;
  std::array<std::array<std::size_t, 2>, 3> cells_{};  // beyond the sides
  RectilinearGrid grid_;
  SiteBox box_;
};

}  // namespace adamas::interfaces
