#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/geometry/vec3.h"
#include "core/lattice/lattice_point.h"
#include "isosurface/contour/contour.h"

namespace adamas {

/// What chunks of a surface are made of.
enum class SurfaceForm : std::uint8_t {
  kPoints,   ///< points with normals, interpolated along the edges of the mesh
  kEdgeEnds  ///< what is at the ends of these edges, for who interpolates later (D 5.6)
};

/// The ends of an edge of the mesh that a surface crosses, in 24 bytes.
struct EdgeEnds {
  /// Both points, five bits for each coordinate, that of i of the first one lowest: from 0 to 17 steps of the
  /// page from the chunk's corner.
  std::uint32_t points = 0;
  std::array<float, 2> values{};  ///< the samples
  /// Vectors to lesser values, first that of the first point: gradients in units of which the greatest
  /// component of both has kUnits. Zero: no normal.
  std::array<std::int16_t, 6> descents{};

  static constexpr int kBits = 5;
  static constexpr double kUnits = 32767;

  EdgeEnds() = default;
  bool operator==(const EdgeEnds&) const = default;
  EdgeEnds(const std::array<LatticePoint, 2>& at, const std::array<float, 2>& samples,
           const std::array<Vec3, 2>& gradients)
      : values(samples) {
    int shift = 0;
    for (const LatticePoint& p : at) {
      for (int axis = 0; axis < 3; ++axis, shift += kBits)
        points |= static_cast<std::uint32_t>(p[axis]) << shift;
    }
    double most = 0;
    for (const Vec3& g : gradients) most = std::max({most, std::abs(g.x), std::abs(g.y), std::abs(g.z)});
    if (!(most > 0) || !std::isfinite(most)) return;
    for (std::size_t n = 0; n < 6; ++n) {
      const double part = -kUnits / most * gradients[n / 3][static_cast<int>(n % 3)];
      descents[n] = static_cast<std::int16_t>(part + std::copysign(0.5, part));
    }
  }

  /// Where the points lie, in steps from the chunk's corner.
  [[nodiscard]] std::array<LatticePoint, 2> places() const {
    std::array<LatticePoint, 2> at;
    int shift = 0;
    for (LatticePoint& p : at) {
      for (int axis = 0; axis < 3; ++axis, shift += kBits)
        p[axis] = static_cast<std::int32_t>(points >> shift & 31u);
    }
    return at;
  }
  /// Where the surface crosses the edge: 0 at the first point, 1 at the second. See ContourOptions.
  [[nodiscard]] double parameter(double isovalue, double least_parameter) const {
    return std::clamp(edge_parameter(values[0], values[1], isovalue), least_parameter, 1 - least_parameter);
  }
};

/// A part of the surface of a frame: the triangles that come from splitting the diamonds of one page of one
/// LOD, or those of the mesh in which nothing is split. All chunks of a frame together are its surface.
/// Neighbouring chunks have the points that they share each for itself, with the same place and the same
/// normal to the last bit.
struct SurfaceChunk {
  std::uint64_t id = 0;        ///< always that of the same page
  std::uint64_t revision = 0;  ///< greater each time the chunk is made anew
  std::vector<Vec3> points;    ///< in the frame of the grid
  std::vector<Vec3> normals;   ///< of each point: a unit vector to values below the isovalue, or zero
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< normals point to values below the isovalue
  /// In place of points and normals: these lie on edges, whose ends count steps from a corner, both in the
  /// frame of the grid.
  std::vector<EdgeEnds> ends;
  Vec3 corner, step;

  /// Where the surface crosses an edge.
  [[nodiscard]] Vec3 place(const EdgeEnds& edge, double parameter) const {
    const auto [first, second] = edge.places();
    const auto along = [&](int axis) {
      return corner[axis] + step[axis] * ((1 - parameter) * first[axis] + parameter * second[axis]);
    };
    return {along(0), along(1), along(2)};
  }
};

/// Which chunks are not as they were before the last frame was asked for, by their ids, in ascending order.
struct ChunkChanges {
  std::vector<std::uint64_t> added, changed, removed;
};

}  // namespace adamas
