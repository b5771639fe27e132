#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include "core/geometry/vec3.h"
#include "core/picture/colour.h"
#include "isosurface/view/edge_ends.h"

namespace adamas::viewer {

/// Triangles, or lines, as a renderer takes them. One that was handed out never changes: what is to look
/// different is made anew, so that a renderer knows by the address what it has already.
struct DrawnMesh {
  struct Vertex {
    std::array<float, 3> place;   ///< relative to `origin`, so that single precision suffices
    std::array<float, 3> normal;  ///< of length 1 to the front side; zero: that of the triangle
    /// What a colour map shows on the front and on the back side; NaN: nothing, so that the side's colour is.
    float front_value = std::numeric_limits<float>::quiet_NaN();
    float back_value = std::numeric_limits<float>::quiet_NaN();
  };

  Vec3 origin;
  std::vector<Vertex> vertices;
  /// In place of vertices: the ends of edges, which the vertex shader interpolates along. Their points lie
  /// so many steps from `origin`.
  std::vector<isosurface::EdgeEnds> ends;
  Vec3 step;
  double least_parameter = 0;  ///< see ContourOptions
  std::vector<std::uint32_t>
      indices;  ///< three for a triangle, counterclockwise from the front; two for a line
  bool is_lines = false;
  Box3 box;  ///< of all vertices, in the frame of the data; that of both ends of edges

  /// Relative to `origin`; of ends of edges where the surface of an isovalue crosses them.
  [[nodiscard]] Vec3 place(std::uint32_t vertex, double isovalue) const {
    if (ends.empty()) {
      const auto& at = vertices[vertex].place;
      return {at[0], at[1], at[2]};
    }
    const Vec3 at = ends[vertex].at(ends[vertex].parameter(isovalue, least_parameter));
    return {step.x * at.x, step.y * at.y, step.z * at.z};
  }
};

/// As vertices have it.
inline std::array<float, 3> in_single(const Vec3& v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

using SharedMesh = std::shared_ptr<const DrawnMesh>;

/// How a mesh looks.
struct PartStyle {
  picture::Colour front{0.93, 0.85, 0.71}, back{0.62, 0.45, 0.40};
  double opacity = 1;  ///< 0 to 1
  bool is_coloured_by_value = false;
  double low = 0, high = 1;  ///< the values at the ends of the colour map
  bool is_flat = false;      ///< not shaded: cross sections and lines
  bool is_clipped = false;   ///< what lies in front of the picture's plane is cut away
  bool has_edges = false;    ///< with the edges of its triangles

  bool operator==(const PartStyle&) const = default;
};

/// One thing in a picture.
struct DrawnPart {
  SharedMesh mesh;
  PartStyle style;
  std::size_t surface = 0;  ///< of a store: to which of those that are shown it belongs
  double isovalue = 0;      ///< of samples: where it crosses the edges of the mesh, if that has them
};

}  // namespace adamas::viewer
