#pragma once

#include <array>
#include <memory>
#include <vector>

#include "adamas/progress.h"
#include "core/base/error.h"
#include "core/geometry/vec3.h"
#include "isosurface/contour/contour.h"
#include "isosurface/extraction/lattice_samples.h"
#include "isosurface/volume/samples.h"

namespace adamas::isosurface {

/// The normals of a surface's points.
struct SurfaceNormals {
  std::vector<Vec3> normals;
  /// Damaged pages that some of them do without, in the order in which they were met.
  std::vector<PageId> lost;
};

/// A unit vector for each point of a surface, to values below the isovalue, as the triangles' normals point;
/// zero where nothing changes. They are gradients at the ends of the mesh's edges, interpolated along the
/// edge: the directions that the store keeps, or else by least squares from the 26 neighbours as far away as
/// the mesh is fine there. Samples that cannot be had do not count; stored directions that cannot be had are
/// worked out from samples.
template <class Sample>
SurfaceNormals surface_normals(StoredPages<OrderedWord<Sample>>& pages, const Contour& contour,
                               Progress& progress = SilentProgress::instance());

/// A page that normals were worked out without, since pages are not loaded (PageCache::set_loading) and it is
/// not in memory.
struct MissingNormals {
  PageId page;
  bool is_of_gradients = false;  ///< of those that the store keeps, not of samples
  bool operator==(const MissingNormals&) const = default;
};

/// The same, one point at a time and in any order, with the same result to the last bit.
template <class Sample>
class PointNormals {
 public:
  /// The pages must outlive this. `lent`: the directions that the store keeps, opened by another one that
  /// goes over to other pages before this one does; null: this one opens them, if there are any.
  explicit PointNormals(StoredPages<OrderedWord<Sample>>& pages, StoredGradients* lent = nullptr);
  ~PointNormals();
  PointNormals(PointNormals&&) noexcept;

  /// Goes over to the pages of another step of the same store. `lent`: the directions at that step, or null
  /// as for the constructor.
  void set_pages(StoredPages<OrderedWord<Sample>>& pages, StoredGradients* lent = nullptr);

  Vec3 of(const EdgePoint& point);
  /// The gradients that its normal is interpolated from.
  std::array<Vec3, 2> at_ends(const EdgePoint& point);
  Vec3 of(const MeanPoint& point);

  /// What the normals lack that were worked out since this was called last, each page once.
  std::vector<MissingNormals> take_missing();
  /// The directions that the store keeps; null where it has none.
  [[nodiscard]] StoredGradients* stored();

 private:
  class Gradients;
  std::unique_ptr<Gradients> gradients_;
};

extern template class PointNormals<std::uint8_t>;
extern template class PointNormals<std::uint16_t>;
extern template class PointNormals<std::int16_t>;
extern template class PointNormals<float>;

}  // namespace adamas::isosurface
