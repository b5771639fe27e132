#pragma once

#include <array>
#include <cstdint>

#include "isosurface/extraction/diamond_vertices.h"
#include "isosurface/extraction/stored_diamonds.h"
#include "isosurface/extraction/surface_request.h"

namespace adamas {

/// How many triangles a surface has, before there is one. What a split adds does not depend on other splits,
/// but for subtrees: there a split adds some to its neighbours too, which is left out.
template <class Sample>
class TriangleCounter {
 public:
  /// `bisections`: so many further tetrahedra of the mesh are contoured. Both objects must outlive this.
  TriangleCounter(StoredDiamonds<Sample>& diamonds, const SurfaceRequest& request, int bisections)
      : diamonds_(diamonds), request_(request), bisections_(bisections) {}

  /// Triangles in the tetrahedra of a diamond.
  std::int64_t triangles(const Diamond& diamond);
  /// How many more there are once a diamond is split. Throws PageLost.
  std::int64_t added_by_split(const Diamond& diamond);
  /// Whether the surface in a diamond is not clipped.
  [[nodiscard]] bool is_inside(const Diamond& diamond) const;

 private:
  DiamondVertices vertices(const Diamond& diamond, bool with_middle);
  std::int64_t count(const Diamond& diamond, int slot, const std::array<double, 4>& values, int bisections);
  std::int64_t count_clipped(const Diamond& diamond, int slot);

  StoredDiamonds<Sample>& diamonds_;
  const SurfaceRequest& request_;
  int bisections_;
};

extern template class TriangleCounter<std::uint8_t>;
extern template class TriangleCounter<std::uint16_t>;
extern template class TriangleCounter<std::int16_t>;
extern template class TriangleCounter<float>;

}  // namespace adamas
