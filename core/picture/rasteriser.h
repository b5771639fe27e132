#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "adamas/geometry.h"
#include "core/picture/camera.h"
#include "core/picture/raster.h"

namespace adamas::picture {

/// A triangle in space; either side may face the camera.
struct PictureTriangle {
  std::array<Vec3, 3> points;
  Colour colour;                 ///< the colour of its front, to which its right-hand normal points
  std::optional<Colour> back{};  ///< the colour of its back; default: the one of the front
};

/// Unit normals at a triangle's corners, on the side that its own normal points to.
using CornerNormals = std::array<Vec3, 3>;

/// The lines that are drawn besides the shaded triangles.
struct RasteriserStyle {
  bool triangle_edges = false;
  bool outlines = true;      ///< silhouettes, borders between colours, creases
  double crease_angle = 40;  ///< angle between normals, in degrees, from which an edge is a crease
  double edge_width = 1;     ///< width of triangle edges, in pixels of the grid
  double depth_jump = 0;     ///< a step in depth by more than this distance along the view is a silhouette
};

/// A z-buffer: draws triangles and depth-tested lines as a camera sees them, with one sample per pixel
/// centre.
class Rasteriser {
 public:
  static constexpr std::uint32_t kNone = 0xFFFFFFFFu;

  /// The camera must have been made for this width and height. Throws Error for sides outside 1..32767.
  Rasteriser(const Camera& camera, int width, int height);

  /// Draws triangles, which must outlive the rasteriser; of equally deep ones the first is visible. With
  /// `normals`, one entry per triangle, which must outlive it too, they are shaded as a smooth surface;
  /// otherwise each is flat. Throws Error for points that are not finite.
  void draw(std::span<const PictureTriangle> triangles, std::span<const CornerNormals> normals = {});
  /// The index of the nearest triangle at a pixel, kNone if there is none.
  [[nodiscard]] std::uint32_t triangle_at(int x, int y) const { return triangle_[index(x, y)]; }
  /// The colour of a triangle's side that faces the camera.
  [[nodiscard]] const Colour& facing_colour(std::uint32_t triangle) const;
  /// The projected depth at a pixel, infinite if there is no triangle.
  [[nodiscard]] double depth_at(int x, int y) const { return depth_[index(x, y)]; }

  /// The shaded picture; pixels without a triangle stay transparent.
  [[nodiscard]] Raster shade(const RasteriserStyle& style) const;
  /// Draws a straight line over a shaded picture wherever no triangle lies in front of it.
  void draw_line(Raster& raster, const Vec3& from, const Vec3& to, double width, const Colour& colour) const;

 private:
  /// The normal of a smooth surface over the picture of a triangle.
  class SmoothNormal {
   public:
    SmoothNormal(const Rasteriser& rasteriser, std::uint32_t number);
    /// The normal, of unit length, on the side of the triangle that faces the camera.
    [[nodiscard]] Vec3 at(const Vec2& pixel) const;

   private:
    CornerNormals normals_{};
    std::array<Vec2, 3> corners_{};
    double area_ = 0;  ///< twice the area of the triangle; 0: the normal is the first one everywhere
  };

  // The depth as an affine function of the pixel position.
  struct DepthPlane {
    Vec2 origin, gradient;
    double depth = 0;
    [[nodiscard]] double at(double x, double y) const { return depth + dot(gradient, Vec2{x, y} - origin); }
  };

  [[nodiscard]] std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
  }
  void draw_triangle(std::uint32_t number);
  [[nodiscard]] Colour shaded_colour(std::uint32_t number, const Vec3& normal) const;
  void draw_edges(Raster& raster, const RasteriserStyle& style) const;
  void draw_outlines(Raster& raster, const RasteriserStyle& style) const;
  [[nodiscard]] bool outline_between(int x, int y, int u, int v, const RasteriserStyle& style,
                                     double least_cosine) const;

  Camera camera_;
  int width_, height_;
  std::span<const PictureTriangle> triangles_;
  std::span<const CornerNormals> corner_normals_;
  std::vector<DepthPlane> planes_;
  std::vector<Vec3> normals_;  // they point towards the camera
  std::vector<char> turned_;   // whether the back of each triangle faces the camera
  std::vector<std::uint32_t> triangle_;
  std::vector<double> depth_;
};

}  // namespace adamas::picture
