#pragma once

#include <cstdint>
#include <vector>

#include "core/picture/raster.h"
#include "isosurface/view/viewpoint.h"

namespace adamas::viewer {

/// A picture in the memory of a graphics device, with several samples a pixel, for the OpenGL context that is
/// current.
class PictureTarget {
 public:
  /// Throws Error where the context has no pictures of this size.
  PictureTarget(int width, int height);
  ~PictureTarget();
  PictureTarget(const PictureTarget&) = delete;
  PictureTarget& operator=(const PictureTarget&) = delete;

  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }
  /// What is drawn into.
  [[nodiscard]] std::uint32_t framebuffer() const { return drawn_; }
  /// What was drawn. Throws Error where that failed.
  [[nodiscard]] picture::Raster read() const;
  /// How far one sees at each pixel, from the upper row to the lower one: distances along the line of sight,
  /// infinite where nothing was drawn. `far`: as DrawFigures tells.
  [[nodiscard]] std::vector<float> depths(const isosurface::Viewpoint& viewpoint, double far) const;
  /// Puts what was drawn into the window's framebuffer, which has the same size.
  void show() const;

 private:
  void make();
  void free();

  int width_, height_;
  std::uint32_t drawn_ = 0, colour_ = 0, depth_ = 0;                       ///< with several samples a pixel
  std::uint32_t resolved_ = 0, resolved_colour_ = 0, resolved_depth_ = 0;  ///< with one
};

}  // namespace adamas::viewer
