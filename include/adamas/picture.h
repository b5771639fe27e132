#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "adamas/export.h"
#include "adamas/geometry.h"
#include "adamas/meshes.h"

namespace adamas ADAMAS_API {

/// The projection of pictures of surfaces.
enum class Projection : std::uint8_t { kOrthographic, kPerspective };

/// Names interfaces that a picture shows: those between two materials, or all of one material.
struct ShownInterface {
  std::string material;
  std::string other{};  ///< the material on the other side; empty: any
  bool operator==(const ShownInterface&) const = default;
};

/// Options that say how pictures are drawn. Sizes are in pixels, and in half points for `.svg` and `.pdf`.
struct DrawingOptions {
  double width = 1600;
  double height = 1200;  ///< height; for slices the greatest height
  /// Values at the ends of the colour map; none: the least and the greatest.
  std::optional<std::array<double, 2>> range{};
  bool cells = false;  ///< draw lines between the cells of slices

  // The options below apply to surfaces alone.
  Vec3 direction{-0.62, 0.72, -0.42};  ///< direction of view; z is up on the picture
  Projection projection = Projection::kPerspective;
  std::optional<Box3> domain{};  ///< the box of the data, drawn as a wireframe; none: no box is drawn
  std::optional<Box3> focus{};   ///< the box that is shown as large as possible; none: that of the data
  bool triangle_edges = false;   ///< draw the edges of triangles
  std::vector<ShownInterface> shown{};  ///< the interfaces that are shown; empty: all

  /// Colours of materials by name: red, green and blue from 0 to 1. Others get one by their number.
  std::map<std::string, std::array<double, 3>> colours{};
};

/// The isosurfaces that a surface consists of, one behind the other in its triangles.
struct IsosurfaceParts {
  std::string title;              ///< the heading of the picture, without isovalues
  std::vector<double> isovalues;  ///< several isosurfaces get colours and a legend
  /// The number of triangles up to the end of each isosurface: isosurface n has the triangles from ends[n -
  /// 1] to ends[n] - 1.
  std::vector<std::size_t> ends;
};

// Each function below writes a .png, .svg or .pdf file; surfaces are also written as .html, a page with a
// view that the user turns in a browser. The functions throw Error for sizes and points that cannot be drawn,
// another extension, and where the file cannot be written.

/// Draws a slice: values by colour where it has them, else materials; interfaces as lines.
void write_picture(const std::filesystem::path& path, const Slice& slice, const DrawingOptions& options = {});
/// Draws a shaded surface.
void write_picture(const std::filesystem::path& path, const TriangleSurface& surface,
                   const DrawingOptions& options = {});
/// Draws isosurfaces, with smooth shading where they have normals; a picture without triangles says so.
/// Throws Error too where `ends` are not ascending numbers of triangles, one for each isovalue.
void write_picture(const std::filesystem::path& path, const TriangleSurface& surface,
                   const IsosurfaceParts& parts, const DrawingOptions& options = {});
/// Draws shaded interfaces; each side has the colour of the material behind it, so that colours depend on
/// materials alone. Throws Error too for shown materials that are not among those of the interfaces.
void write_picture(const std::filesystem::path& path, const InterfaceTriangles& interfaces,
                   const DrawingOptions& options = {});

/// Checks options. Throws Error (kUsage) for a direction without a length, sides that are not from 200 to
/// 8000, and an interface that is shown between a material and itself.
void check_surface_drawing(const DrawingOptions& options);
/// Checks shown materials. Throws Error, which begins with `source`, for those that are not among
/// `materials`.
void check_shown_interfaces(const std::vector<ShownInterface>& shown,
                            const std::vector<std::string>& materials, const std::string& source);

/// Returns the names of the colour maps.
std::vector<std::string> colour_map_names();

}  // namespace adamas
