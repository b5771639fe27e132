#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/geometry/vec3.h"
#include "isosurface/view/viewpoint.h"
#include "viewer/document/drawn_mesh.h"
#include "viewer/document/view_state.h"

namespace adamas::viewer {

/// All that is to be seen in a picture.
struct PictureContents {
  isosurface::Viewpoint viewpoint;
  std::vector<DrawnPart> parts;
  Shading shading = Shading::kLit;
  std::string colour_map = "sequential";
  /// What lies where its normal points to is cut away from parts that are clipped.
  std::optional<Plane> clip;
  picture::Colour background{1, 1, 1};
};

/// What drawing a picture came to.
struct DrawFigures {
  std::uint64_t triangles = 0, draw_calls = 0, copied_bytes = 0;
  double far = 0;  ///< the distance of the far plane
};

/// Draws parts by the OpenGL context that is current when it is made. Opaque parts of one block of memory are
/// one command for the device; transparent triangles are drawn one after the other, from far to near.
class Renderer {
 public:
  /// Throws Error where the shaders are refused.
  Renderer();
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  /// Draws into a framebuffer (0: the window's) of this size, whatever the viewpoint says of sizes. Throws
  /// Error where the context was lost or its memory is full.
  DrawFigures draw(const PictureContents& contents, std::uint32_t framebuffer, int width, int height);

 private:
  struct Objects;

  std::unique_ptr<Objects> objects_;
};

}  // namespace adamas::viewer
