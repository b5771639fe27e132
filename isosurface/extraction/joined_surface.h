#pragma once

#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "core/lattice/lattice_map.h"
#include "core/lattice/lattice_point.h"
#include "isosurface/contour/cell_contour.h"
#include "isosurface/contour/contour.h"
#include "isosurface/contour/joined_point.h"

namespace adamas {

/// Numbers of edge points are those from 0 on, and numbers of patches, each of which is points that are joined
/// to one, those from here on.
inline constexpr std::uint32_t kFirstPatch = 1u << 31;

/// A name that all edge points have: twice the middle of the edge between a vertex and a neighbour, in
/// samples. A patch has that of its first point.
inline LatticePoint point_key(LatticePoint vertex, int neighbour) {
  return 2 * vertex + VertexLink::step(neighbour);
}

/// Cells between two planes of samples that follow along k, and the joined contour in them.
struct SurfaceSlab {
  struct Patch {
    LatticePoint vertex;     ///< in samples
    VertexLink::Set points;  ///< the neighbours of the vertex at the other ends of the points' edges
    JoinedPoint joined;
  };

  std::int32_t first = 0, last = 0;  ///< planes
  std::vector<EdgePoint> edge_points;
  std::vector<Vec3> edge_positions;
  std::vector<Patch> patches;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  /// The numbers of points that other pages may have too, by key.
  LatticeMap<std::uint32_t> shared;
  std::uint64_t crossed_cells = 0;
  /// The patches, less kFirstPatch, that have to be taken apart, as far as this slab tells: what is next to its
  /// planes has triangles in others.
  std::vector<std::uint32_t> coinciding;

  void clear(std::int32_t first_plane, std::int32_t last_plane);
  /// `sample`: the spacing of samples in lattice units.
  void find_coinciding(std::int32_t sample);
};

/// The joined contour of the lattice of all samples, slab after slab.
class JoinedSurface {
 public:
  struct Patch {
    Vec3 position;
    LatticePoint vertex;     ///< in samples
    VertexLink::Set points;  ///< see SurfaceSlab; none where they are points of the surface themselves again
  };

  /// `sample`: the spacing of samples in lattice units; `box`: the data's, which no point leaves.
  JoinedSurface(std::int32_t sample, const Box3& box) : sample_(sample), box_(box) {}

  /// Appends a slab that lies behind those before, whose points on its first plane it shares. `part`: how much
  /// of the whole surface there will be then, about.
  void append(const SurfaceSlab& slab, double part);

  [[nodiscard]] std::uint64_t crossed_cells() const { return crossed_cells_; }
  [[nodiscard]] const std::vector<EdgePoint>& edge_points() const { return edge_points_; }

  /// Takes apart the patches that coincide with something else, as far as that is possible without samples:
  /// removes their triangles. The first time it looks at all points, and then at those that came since.
  std::vector<Patch> take_apart();
  /// The numbers of points next to some vertices, by key.
  [[nodiscard]] LatticeMap<std::uint32_t> numbers_near(const LatticeMap<bool>& vertices) const;
  /// Adds what a slab has more than these: edge points, whose numbers begin behind those that there are, and
  /// triangles.
  void add(const SurfaceSlab& more);

  /// The contour; this is not to be used any more.
  [[nodiscard]] Contour finish();

 private:
  using Triangle = std::array<std::uint32_t, 3>;

  [[nodiscard]] std::uint32_t count() const {
    return static_cast<std::uint32_t>(edge_points_.size() + patches_.size());
  }
  /// Places of edge points, and of patches behind them.
  [[nodiscard]] std::uint32_t place(std::uint32_t number) const {
    return number < kFirstPatch ? number
                                : number - kFirstPatch + static_cast<std::uint32_t>(edge_points_.size());
  }
  [[nodiscard]] std::int32_t vertex_plane(const EdgePoint& p) const { return p.nearer_end().k / sample_; }

  [[nodiscard]] Vec3 position(const JoinedPoint& joined) const;

  std::int32_t sample_;
  Box3 box_;
  std::vector<EdgePoint> edge_points_;
  std::vector<Vec3> edge_positions_;
  std::vector<Patch> patches_;
  std::vector<Triangle> triangles_;
  std::uint64_t crossed_cells_ = 0;
  LatticeMap<std::uint32_t> shared_;                         ///< with the next slab
  std::unordered_map<std::uint32_t, JoinedPoint> on_plane_;  ///< the patches among these, by number
  std::vector<std::uint32_t> coinciding_;                    ///< patches, less kFirstPatch
  std::vector<std::uint32_t> suspects_;                      ///< points that were not looked at yet
};

}  // namespace adamas
