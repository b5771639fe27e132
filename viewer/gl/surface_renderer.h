#pragma once

#include <memory>

#include "adamas/meshes.h"
#include "core/picture/raster.h"
#include "isosurface/view/viewpoint.h"

namespace adamas {

/// How surfaces are shaded.
enum class Shading {
  kLit,     ///< by a light beside the eye
  kSphere,  ///< after D: by where the normal points in the view, with dark silhouettes
};

/// Draws triangles with normals into memory, with the OpenGL context that is current when it is made.
class SurfaceRenderer {
 public:
  /// Throws Error where the context cannot draw pictures of this size.
  SurfaceRenderer(int width, int height);
  ~SurfaceRenderer();
  SurfaceRenderer(const SurfaceRenderer&) = delete;
  SurfaceRenderer& operator=(const SurfaceRenderer&) = delete;

  /// Triangles for the following pictures. Points without a normal have that of their triangle.
  void set_surface(const TriangleSurface& surface);
  /// The picture has the renderer's size, whatever the viewpoint says. Throws Error where the context was
  /// lost.
  Raster draw(const Viewpoint& viewpoint, Shading shading);

 private:
  struct Objects;

  std::unique_ptr<Objects> objects_;
};

}  // namespace adamas
