#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/lattice/domain.h"
#include "isosurface/extraction/split_limits.h"
#include "isosurface/view/depth_pyramid.h"
#include "isosurface/view/viewpoint.h"
#include "isosurface/volume/page_grid.h"

namespace adamas::isosurface {

/// Half the sides of the box in space round a diamond and all its descendants, by its phase and its scale in
/// lattice units.
inline Vec3 nested_half(const Domain& domain, std::int32_t scale, int phase) {
  // The box is a little larger, so that rounding leaves the boxes of children within those of their parents.
  constexpr double kLarger = 1 + 0x1p-30;
  return kLarger * static_cast<double>(nested_reach(phase)) * scale * domain.spacing();
}

/// The positions of an LOD's points in space, and how far its diamonds reach.
class LodPlaces {
 public:
  /// `step`: lattice units between points; `last`: the last point, in units of the LOD.
  LodPlaces(const Domain& domain, std::int32_t step, LatticePoint last);

  [[nodiscard]] LatticePoint last() const { return last_; }
  /// The coordinates of the points along an axis, from the first on.
  [[nodiscard]] const std::vector<double>& places(int axis) const {
    return places_[static_cast<std::size_t>(axis)];
  }
  [[nodiscard]] const Vec3& half(int phase) const { return halves_[static_cast<std::size_t>(phase)]; }

 private:
  LatticePoint last_;
  std::array<std::vector<double>, 3> places_;
  std::array<Vec3, 3> halves_;
};

/// The diamonds of one page as a camera sees them. The answers for one diamond are those of View for its
/// nested box, bit by bit.
class PageView {
 public:
  /// The view and the LOD must outlive this.
  PageView(const View& view, const LodPlaces& lod, LatticePoint block);

  /// Whether no diamond is visible.
  [[nodiscard]] bool is_hidden() const { return hidden_ || occluded_; }
  /// Whether all diamonds are visible.
  [[nodiscard]] bool is_whole() const { return cut_count_ == 0 && depths_ == nullptr; }
  /// Whether no diamond is visible since depths hide them.
  [[nodiscard]] bool is_occluded() const { return occluded_; }
  /// Whether there are depths.
  [[nodiscard]] bool has_depths() const { return depths_ != nullptr; }
  /// The View::depth of a diamond, by its place on the page.
  [[nodiscard]] double depth(std::uint16_t place, int phase) const {
    return as_depth(near_.at(place), phase);
  }
  /// The least and the greatest depth that diamonds of a phase have at any place of the page.
  [[nodiscard]] double least_depth(int phase) const { return as_depth(near_.least, phase); }
  [[nodiscard]] double greatest_depth(int phase) const { return as_depth(near_.greatest, phase); }
  [[nodiscard]] bool is_visible(std::uint16_t place, int phase) const {
    return is_in_picture(place, phase) && !is_occluded(place, phase);
  }
  [[nodiscard]] bool is_occluded(std::uint16_t place, int phase) const {
    return depths_ != nullptr && depths_->hides(box(place, phase));
  }
  [[nodiscard]] bool is_in_picture(std::uint16_t place, int phase) const {
    for (std::size_t n = 0; n < cut_count_; ++n) {
      if (!(cut_[n].at(place) - cut_[n].offset >= -cut_[n].reach[static_cast<std::size_t>(phase)]))
        return false;
    }
    return true;
  }

 private:
  static constexpr std::size_t kSide = PageGrid::kSide;

  /// The heights of a page's points above a side of the picture, before its offset: sums over the axes.
  struct Heights {
    std::array<std::array<double, kSide>, 3> parts;
    double least, greatest, offset;
    std::array<double, 3> reach;  ///< how far the boxes reach, by phase

    Heights() = default;
    Heights(const View::Side& side, const LodPlaces& lod, LatticePoint block);
    [[nodiscard]] double at(std::uint16_t place) const {
      return parts[0][place % kSide] + parts[1][place / kSide % kSide] + parts[2][place / (kSide * kSide)];
    }
  };

  [[nodiscard]] double as_depth(double height, int phase) const {
    return near_distance_ +
           std::max(0.0, height - near_.offset - near_.reach[static_cast<std::size_t>(phase)]);
  }

  [[nodiscard]] CentredBox box(std::uint16_t place, int phase) const {
    const auto along = [&](int axis, std::size_t n) {
      return lod_.places(axis)[kSide * static_cast<std::size_t>(block_[axis]) + n];
    };
    return {{along(0, place % kSide), along(1, place / kSide % kSide), along(2, place / (kSide * kSide))},
            lod_.half(phase)};
  }
  /// A box round the boxes of all diamonds.
  [[nodiscard]] CentredBox box_of_page() const;

  const LodPlaces& lod_;
  LatticePoint block_;
  const DepthPyramid* depths_;
  double near_distance_;
  Heights near_;
  bool hidden_ = false, occluded_ = false;
  std::array<Heights, 5> cut_;  ///< the heights above sides that some diamonds may lie outside
  std::size_t cut_count_ = 0;
};

}  // namespace adamas::isosurface
