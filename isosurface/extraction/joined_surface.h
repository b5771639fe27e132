#pragma once

#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "core/lattice/lattice_map.h"
#include "core/lattice/lattice_point.h"
#include "isosurface/contour/cell_contour.h"
#include "isosurface/contour/coinciding_patches.h"
#include "isosurface/contour/contour.h"
#include "isosurface/contour/joined_point.h"

namespace adamas::isosurface {

/// The number of the first patch. Edge points are numbered from 0 on. A patch is a set of edge points that
/// are joined to one point.
inline constexpr std::uint32_t kFirstPatch = 1u << 31;

/// Returns the key of an edge point: twice the middle of the edge between a vertex and a neighbour, in
/// samples. The key of a patch is that of its first point.
inline LatticePoint point_key(LatticePoint vertex, int neighbour) {
  return 2 * vertex + VertexLink::step(neighbour);
}

/// Edge points next to one vertex, as the set of the neighbours at the other ends of their edges.
struct PointsOfVertex {
  LatticePoint vertex;  ///< the vertex in samples
  VertexLink::Set points;
};

/// The joined contour in the cells between two planes of samples along k.
struct SurfaceSlab {
  /// A patch. It has no points once it was separated: its edge points are points of the surface again.
  struct Patch {
    PointsOfVertex edge_points;
    JoinedPoint joined;
  };

  std::int32_t first = 0, last = 0;  ///< planes at the beginning and the end
  std::uint32_t first_edge = 0;      ///< the number of the first edge point
  std::vector<EdgePoint> edge_points;
  std::vector<Vec3> edge_positions;
  std::vector<Patch> patches;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  /// The numbers of points that other pages may have too, by key.
  LatticeMap<std::uint32_t> shared;
  std::uint64_t crossed_cells = 0;
  /// The edge points from this number on belong to patches that were separated.
  std::size_t first_separated = 0;
  /// The patches next to the planes that have to be separated, as numbers less kFirstPatch. They have
  /// triangles in other slabs too.
  std::vector<std::uint32_t> coinciding;

  void clear(std::int32_t first_plane, std::int32_t last_plane);
  /// Separates the coinciding patches inside the slab, and removes their triangles and points. `sample`: the
  /// spacing of samples in lattice units.
  std::vector<PointsOfVertex> separate(std::int32_t sample, CoincidingPatches& coincidences);
  /// Notes the points next to these vertices in `shared` too.
  void share(const LatticeMap<bool>& vertices, std::int32_t sample);

 private:
  [[nodiscard]] bool on_plane(std::int32_t k) const { return k == first || k == last; }
};

/// The joined contour of the lattice of all samples, slab after slab.
class JoinedSurface {
 public:
  /// Makes an empty surface. `sample`: the spacing of samples in lattice units; `box`: the box of the data,
  /// which no point leaves.
  JoinedSurface(std::int32_t sample, const Box3& box) : sample_(sample), box_(box) {}

  /// Appends the next slab along k, which shares the points on its first plane with the slabs before. `part`:
  /// the approximate part of the whole surface that there is then, for the reservation of memory.
  void append(const SurfaceSlab& slab, double part);

  [[nodiscard]] std::uint64_t crossed_cells() const { return crossed_cells_; }

  /// Returns whether there may be coinciding patches that were not checked yet.
  [[nodiscard]] bool has_suspects() const { return !suspects_.empty() || !separated_.empty(); }
  /// Separates patches that coincide with others, and removes their triangles and points. The first call
  /// checks patches next to planes between slabs, later calls those near separated patches.
  std::vector<PointsOfVertex> separate(CoincidingPatches& coincidences);
  /// Returns an empty slab that shares the points next to these vertices, for triangles and points of
  /// separated patches.
  [[nodiscard]] SurfaceSlab addition(const LatticeMap<bool>& vertices) const;
  void add(const SurfaceSlab& addition);

  /// Returns the contour. The object must not be used after this.
  [[nodiscard]] Contour finish();

 private:
  using Triangle = std::array<std::uint32_t, 3>;
  struct Patch {
    Vec3 position;
    PointsOfVertex edge_points;  ///< see SurfaceSlab::Patch
  };

  [[nodiscard]] std::uint32_t edge_count() const { return static_cast<std::uint32_t>(edge_points_.size()); }
  [[nodiscard]] bool is_apart(std::uint32_t number) const {
    return number >= kFirstPatch && patches_[number - kFirstPatch].edge_points.points == 0;
  }
  [[nodiscard]] Vec3 position(const JoinedPoint& joined) const;
  /// Finds coinciding patches among the triangles from `first_triangle` on.
  void find_coinciding(CoincidingPatches& coincidences, const std::vector<std::uint32_t>& suspects,
                       std::size_t first_triangle);

  std::int32_t sample_;
  Box3 box_;
  std::vector<EdgePoint> edge_points_;
  std::vector<Vec3> edge_positions_;
  std::vector<Patch> patches_;
  std::vector<Triangle> triangles_;  ///< triangles, also those of patches that are separated later
  std::uint64_t crossed_cells_ = 0;
  LatticeMap<std::uint32_t> shared_;                         ///< points that the next slab may share
  std::unordered_map<std::uint32_t, JoinedPoint> on_plane_;  ///< the patches among these, by number
  std::vector<std::uint32_t> coinciding_;  ///< coinciding patches, as numbers less kFirstPatch
  std::vector<std::uint32_t> suspects_;    ///< points to check, and
  std::vector<std::uint32_t> separated_;   ///< after those, the ones of patches that slabs took apart
  int rounds_ = 0;
  std::size_t first_added_ = 0;  ///< the first triangle that was added after the last round
};

}  // namespace adamas::isosurface
