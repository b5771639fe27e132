#pragma once

#include <array>
#include <filesystem>
#include <optional>

#include "adamas/export.h"
#include "adamas/meshes.h"

namespace adamas ADAMAS_API {

/// Options that say how pictures are drawn. Sizes are in pixels, and in half points for `.svg` and `.pdf`.
struct DrawingOptions {
  double width = 1600;
  double height = 1200;  ///< of slices the greatest
  /// Values at the ends of the colour map; none: the least and the greatest.
  std::optional<std::array<double, 2>> range{};
  bool cells = false;                  ///< of slices: lines between cells
  Vec3 direction{-0.62, 0.72, -0.42};  ///< of surfaces: the way the camera looks
};

// Each writes a .png, .svg or .pdf file. They throw Error for sizes and points that cannot be drawn, another
// extension, and where the file cannot be written.

/// Values by colour where the slice has them, else materials; interfaces as lines.
void write_picture(const std::filesystem::path& path, const Slice& slice, const DrawingOptions& options = {});
/// A shaded surface.
void write_picture(const std::filesystem::path& path, const TriangleSurface& surface,
                   const DrawingOptions& options = {});
/// Shaded interfaces; each side has the colour of the material behind it.
void write_picture(const std::filesystem::path& path, const InterfaceTriangles& interfaces,
                   const DrawingOptions& options = {});

}  // namespace adamas
