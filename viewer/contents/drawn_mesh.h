#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include "adamas/geometry.h"
#include "core/picture/material_colours.h"
#include "isosurface/view/edge_ends.h"

namespace adamas::viewer {

/// Triangles or lines for the renderer. A mesh never changes once it has been passed on; the renderer
/// recognises it by its address.
struct DrawnMesh {
  struct Vertex {
    std::array<float, 3> place;   ///< relative to `origin`, so that single precision suffices
    std::array<float, 3> normal;  ///< unit normal on the front side; zero: that of the triangle
    /// The values for the colour map on the front and on the back side; NaN if the side has its plain colour.
    float front_value = std::numeric_limits<float>::quiet_NaN();
    float back_value = std::numeric_limits<float>::quiet_NaN();
  };

  Vec3 origin;
  std::vector<Vertex> vertices;
  /// The ends of edges along which the vertex shader interpolates; they replace vertices. Their points are
  /// multiples of `step` away from `origin`.
  std::vector<isosurface::EdgeEnds> ends;
  Vec3 step;
  double least_parameter = 0;  ///< see ContourOptions
  /// Three indices per triangle, counterclockwise seen from the front; two per line.
  std::vector<std::uint32_t> indices;
  bool is_lines = false;
  Box3 box;  ///< the box of all vertices, or of both ends of all edges, in the frame of the data

  /// The place of a vertex relative to `origin`; for ends of edges, the point where the surface of an
  /// isovalue crosses the edge.
  [[nodiscard]] Vec3 place(std::uint32_t vertex, double isovalue) const {
    if (ends.empty()) {
      const auto& at = vertices[vertex].place;
      return {at[0], at[1], at[2]};
    }
    const Vec3 at = ends[vertex].at(ends[vertex].parameter(isovalue, least_parameter));
    return {step.x * at.x, step.y * at.y, step.z * at.z};
  }
};

/// A vector in single precision, the form used for vertices.
inline std::array<float, 3> in_single(const Vec3& v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

using SharedMesh = std::shared_ptr<const DrawnMesh>;

/// The style in which a mesh is drawn.
struct PartStyle {
  picture::Colour front = picture::kSurfaceColour, back{0.62, 0.45, 0.40};
  double opacity = 1;  ///< 0 to 1
  bool is_coloured_by_value = false;
  double low = 0, high = 1;  ///< the values at the ends of the colour map
  bool is_flat = false;      ///< whether it is drawn without shading, like cross sections and lines
  bool is_clipped = false;   ///< whether the picture's plane clips what lies in front of it
  bool has_edges = false;    ///< whether the edges of its triangles are drawn

  bool operator==(const PartStyle&) const = default;
};

/// A mesh in a picture, and its style.
struct DrawnPart {
  SharedMesh mesh;
  PartStyle style;
  std::size_t surface = 0;  ///< the number of the store's shown surface that it belongs to
  /// The sample at which the surface crosses the edges of a mesh that has ends of edges.
  double isovalue = 0;
};

}  // namespace adamas::viewer
