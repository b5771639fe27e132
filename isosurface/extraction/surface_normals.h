#pragma once

#include <array>
#include <memory>
#include <vector>

#include "adamas/geometry.h"
#include "adamas/progress.h"
#include "core/base/error.h"
#include "isosurface/contour/contour.h"
#include "isosurface/extraction/lattice_samples.h"
#include "isosurface/volume/samples.h"

namespace adamas::isosurface {

/// The normals of a surface's points.
struct SurfaceNormals {
  std::vector<Vec3> normals;
  /// The damaged pages that some normals were computed without, in the order in which they were found.
  std::vector<PageId> lost;
};

/// Computes a unit vector for each point of a surface, which points to values below the isovalue, as the
/// triangles' normals do; zero where the gradient is zero. Normals are gradients at the ends of the mesh's
/// edges, interpolated along the edge. The gradients are the stored directions, or else the least-squares fit
/// to the 26 neighbours at the distance of the mesh's spacing there. Lost samples do not count; if stored
/// directions are lost, gradients are computed from samples.
template <class Sample>
SurfaceNormals surface_normals(StoredPages<OrderedWord<Sample>>& pages, const Contour& contour,
                               Progress& progress = SilentProgress::instance());

/// A page without which normals were computed, as it is not in memory and pages are not loaded
/// (PageCache::set_loading).
struct MissingNormals {
  PageId page;
  bool is_of_gradients = false;  ///< whether it is a page of stored gradients, not of samples
  bool operator==(const MissingNormals&) const = default;
};

/// Computes normals as surface_normals does, to the last bit, but one point at a time and in any order.
template <class Sample>
class PointNormals {
 public:
  /// Makes the object. The pages must outlive it. `lent`: the stored directions of another PointNormals,
  /// which changes to other pages before this one does; null: this one opens them, if there are any.
  explicit PointNormals(StoredPages<OrderedWord<Sample>>& pages, StoredGradients* lent = nullptr);
  ~PointNormals();
  PointNormals(PointNormals&&) noexcept;

  /// Changes to the pages of another step of the same store. `lent`: the directions at that step, or null as
  /// for the constructor.
  void set_pages(StoredPages<OrderedWord<Sample>>& pages, StoredGradients* lent = nullptr);

  Vec3 normal(const EdgePoint& point);
  /// Returns the gradients at the ends of a point's edge, from which its normal is interpolated.
  std::array<Vec3, 2> at_ends(const EdgePoint& point);
  Vec3 normal(const MeanPoint& point);

  /// Returns, once each, the pages that the normals since the last call were computed without.
  std::vector<MissingNormals> take_missing();
  /// Returns the directions that the store keeps; null where it has none.
  [[nodiscard]] StoredGradients* stored();

 private:
  class Gradients;
  std::unique_ptr<Gradients> gradients_;
};

}  // namespace adamas::isosurface
