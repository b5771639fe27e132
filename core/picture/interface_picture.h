#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/picture/camera.h"
#include "core/picture/legend.h"
#include "core/picture/rasteriser.h"

namespace adamas::picture {

/// Materials and fields at points of a grid. A picture that can be turned shows them on its cutting plane.
struct PictureBlock {
  std::array<std::size_t, 3>
      counts{};  ///< points along x, y and z, from the lower end of the box to the upper
  Box3 box;
  std::vector<LegendEntry> materials;
  static constexpr std::uint8_t kNothing = 255;
  std::vector<std::uint8_t> numbers;  ///< number of the material at each point, x fastest, or kNothing
  struct Field {
    std::string name;
    double low = 0, high = 0;
    std::vector<std::uint8_t> parts;  ///< 0 to 254 between low and high at each point, or kNothing
  };
  std::vector<Field> fields;
};

/// A picture of surfaces in space: shaded triangles in a wireframe box on white.
struct InterfacePicture {
  std::string title{};
  std::vector<PictureTriangle> triangles{};
  std::vector<CornerNormals>
      normals{};          ///< normals of each triangle, for shading as a smooth surface; empty: flat
  std::string message{};  ///< a text in the middle, for example if there is no triangle
  Box3 domain{};          ///< drawn as a wireframe and framed; empty: the box of the triangles, not drawn
  std::optional<Box3> focus{};           ///< the box that is framed instead of the domain
  std::vector<LegendEntry> materials{};  ///< the legend; colours that are not visible are left out of it
  std::optional<PictureBlock> block{};   ///< the inside, for pictures that can be turned
  Vec3 direction{-0.62, 0.72, -0.42};    ///< the viewing direction
  Projection projection = Projection::kPerspective;
};

struct InterfacePictureOptions {
  double width = 1600;   ///< pixels
  double height = 1200;  ///< pixels
  double font_size = 0;  ///< 0: derived from the width
  int samples = 3;       ///< number of samples per pixel along each axis, 1 to 4
  bool triangle_edges = false;
  bool outlines = true;       ///< silhouettes and borders between colours
  double crease_angle = 180;  ///< angle between normals, in degrees, from which edges are drawn as lines: 180
                              ///< for none, since the steps of a reconstructed surface are no creases
  bool axes = true;           ///< a small cross of the axes in the lower left corner
};

/// Draws the picture and returns the file's bytes. Throws Error for points that are not finite, a box or
/// direction that cannot be framed, or options out of range.
std::string draw_interfaces(const InterfacePicture& picture, PictureFormat format,
                            const InterfacePictureOptions& options = {});

/// Writes a .png file, .svg or .pdf with the picture embedded, or .html as turning_page makes it. It also
/// throws Error if the file cannot be written.
void write_interfaces(const InterfacePicture& picture, const std::filesystem::path& path,
                      const InterfacePictureOptions& options = {});

}  // namespace adamas::picture
