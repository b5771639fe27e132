#pragma once

#include <array>
#include <cstdint>

#include "isosurface/extraction/page_diamonds.h"
#include "isosurface/extraction/surface_request.h"

namespace adamas::isosurface {

/// Counts the triangles of a surface without making it. The number that a split adds does not depend on other
/// splits.
template <class Sample>
class TriangleCounter {
 public:
  /// Makes the object. Both arguments must outlive it.
  TriangleCounter(LatticeSamples<Sample>& samples, const SurfaceRequest& request)
      : samples_(samples), request_(request) {}

  /// Returns the number of triangles in the tetrahedra of a diamond. Throws PageLost.
  std::int64_t triangles(const Diamond& diamond);
  /// Returns the number of triangles that the split of a diamond adds; it may be negative. Throws PageLost.
  std::int64_t added_by_split(const Diamond& diamond);
  /// Returns whether the surface in a diamond is not clipped.
  [[nodiscard]] bool is_inside(const Diamond& diamond) const;

 private:
  std::int64_t count(const Diamond& diamond, int slot, const std::array<double, 4>& values);
  std::int64_t count_clipped(const Diamond& diamond, int slot);

  LatticeSamples<Sample>& samples_;
  const SurfaceRequest& request_;
};

/// Counts the triangles that the splits of a page's diamonds add.
template <class Sample>
class PageTriangleCounter {
 public:
  /// Makes the object. Both arguments must outlive it.
  PageTriangleCounter(StoredDiamonds<Sample>& diamonds, const SurfaceRequest& request)
      : request_(request), counter_(diamonds, request), page_(diamonds) {}

  /// Goes to a page, and copies the samples of some of its diamonds. Throws PageLost.
  void load(int lod, LatticePoint block, const PageMask& wanted) { page_.load(lod, block, wanted); }
  /// Returns the number of triangles that the split of a diamond adds, whose samples were loaded. Throws
  /// PageLost.
  std::int64_t added_by_split(LatticePoint q);

 private:
  const SurfaceRequest& request_;
  TriangleCounter<Sample> counter_;
  PageDiamonds<Sample> page_;
};

}  // namespace adamas::isosurface
