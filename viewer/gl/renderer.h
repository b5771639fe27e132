#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "adamas/geometry.h"
#include "isosurface/view/viewpoint.h"
#include "viewer/contents/drawn_mesh.h"
#include "viewer/contents/view_state.h"

namespace adamas::viewer {

/// The contents of a picture.
struct PictureContents {
  isosurface::Viewpoint viewpoint;
  std::vector<DrawnPart> parts;
  Shading shading = Shading::kLit;
  std::string colour_map = "sequential";
  /// The plane that clips parts: the side to which its normal points is cut away.
  std::optional<Plane> clip;
  picture::Colour background{1, 1, 1};
};

/// The figures of drawing a picture.
struct DrawFigures {
  std::uint64_t triangles = 0, draw_calls = 0, copied_bytes = 0;
  double far = 0;  ///< the distance of the far plane
};

/// Draws parts with the OpenGL context that is current when it is made. Opaque parts in one block of memory
/// are drawn by one command; transparent triangles are drawn one after the other, from far to near.
class Renderer {
 public:
  /// Throws Error if the shaders are refused.
  Renderer();
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  /// Draws into a framebuffer (0 for the window's) of this size, which overrides the size of the viewpoint.
  /// Throws Error if the context was lost or its memory is full.
  DrawFigures draw(const PictureContents& contents, std::uint32_t framebuffer, int width, int height);

 private:
  struct Objects;

  std::unique_ptr<Objects> objects_;
};

}  // namespace adamas::viewer
