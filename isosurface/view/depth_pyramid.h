#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "adamas/geometry.h"
#include "isosurface/view/viewpoint.h"

namespace adamas::isosurface {

/// The visible depths at each pixel of a picture, and the greatest in each square of 2^n pixels a side:
/// everything behind them is hidden (D 4.10, by hierarchical depths in place of queries).
class DepthPyramid {
 public:
  /// Makes the pyramid. `depths`: width_pixels x height_pixels distances from the eye along the line of sight
  /// in a picture of that viewpoint, from its upper row to its lower one; infinite for the background.
  DepthPyramid(const Viewpoint& viewpoint, std::span<const float> depths);

  [[nodiscard]] const Viewpoint& viewpoint() const { return viewpoint_; }
  /// Returns whether a picture of that viewpoint shows nothing of a box, since it lies behind visible parts
  /// or outside the picture. False for a box that the near plane cuts. A box inside a hidden box is hidden.
  [[nodiscard]] bool hides(const CentredBox& box) const;

 private:
  struct Level {
    std::int32_t width, height;
    std::vector<float> farthest;
  };

  [[nodiscard]] float farthest_in(std::int32_t left, std::int32_t top, std::int32_t right,
                                  std::int32_t bottom) const;

  Viewpoint viewpoint_;
  ViewAxes axes_;
  double scale_;  ///< pixels of a length at the distance 1, or in parallel projection
  std::vector<Level> levels_;
};

}  // namespace adamas::isosurface
