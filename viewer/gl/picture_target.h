#pragma once

#include <cstdint>
#include <vector>

#include "core/picture/raster.h"
#include "isosurface/view/viewpoint.h"

namespace adamas::viewer {

/// A picture in the memory of a graphics device, with several samples per pixel. All members use the current
/// OpenGL context.
class PictureTarget {
 public:
  /// Throws Error if the context cannot make pictures of this size.
  PictureTarget(int width, int height);
  ~PictureTarget();
  PictureTarget(const PictureTarget&) = delete;
  PictureTarget& operator=(const PictureTarget&) = delete;

  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }
  /// The framebuffer into which the picture is drawn.
  [[nodiscard]] std::uint32_t framebuffer() const { return drawn_; }
  /// Reads the picture back. Throws Error if drawing failed.
  [[nodiscard]] picture::Raster read() const;
  /// The depth of each pixel, from the upper row to the lower one: the distance along the line of sight,
  /// infinite where nothing was drawn. `far`: as in DrawFigures.
  [[nodiscard]] std::vector<float> depths(const isosurface::Viewpoint& viewpoint, double far) const;
  /// Copies the picture into the window's framebuffer, which has the same size.
  void show() const;

 private:
  void make();
  void free();

  int width_, height_;
  std::uint32_t drawn_ = 0, colour_ = 0, depth_ = 0;  ///< the framebuffer with several samples per pixel
  std::uint32_t resolved_ = 0, resolved_colour_ = 0,
                resolved_depth_ = 0;  ///< the framebuffer with one sample per pixel
};

}  // namespace adamas::viewer
