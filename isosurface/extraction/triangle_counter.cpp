#include "isosurface/extraction/triangle_counter.h"

#include <algorithm>
#include <cmath>

#include "core/geometry/tetrahedron_contour.h"
#include "isosurface/contour/contour_clip.h"
#include "isosurface/extraction/contour_options.h"

namespace adamas {

template <class Sample>
DiamondVertices TriangleCounter<Sample>::vertices(const Diamond& diamond, bool with_middle) {
  return {diamond, diamonds_.domain(), with_middle, [this](LatticePoint p) { return diamonds_.sample(p); }};
}

template <class Sample>
bool TriangleCounter<Sample>::is_inside(const Diamond& diamond) const {
  const LatticePoint p = diamond.point(), last = diamonds_.last_sample();
  const std::int32_t s = diamond.scale();
  if (p.i + s > last.i || p.j + s > last.j || p.k + s > last.k) return false;
  if (!request_.region) return true;
  const Domain& domain = diamonds_.domain();
  const Box3 box{domain.position(p - LatticePoint{s, s, s}), domain.position(p + LatticePoint{s, s, s})};
  if (!request_.region->contains(box.min) || !request_.region->contains(box.max)) return false;
  const std::array<Vec3, 8> corners = box.corners();
  return std::all_of(request_.sides.begin(), request_.sides.end(), [&](const Plane& side) {
    return std::all_of(corners.begin(), corners.end(),
                       [&](const Vec3& corner) { return dot(side.normal, corner - side.origin) < 0; });
  });
}

template <class Sample>
std::int64_t TriangleCounter<Sample>::count_clipped(const Diamond& diamond, int slot) {
  const ContourOptions options = contour_options(diamonds_, request_);
  ContourBuilder builder(diamonds_.domain(), request_.isovalue, options);
  DiamondContour(builder, request_.isovalue, diamonds_.last_sample())
      .add(diamond, 1u << slot, [this](LatticePoint p) { return diamonds_.sample(p); });
  Contour contour = builder.finish();
  if (request_.region) clip_contour(contour, *request_.region, options.spacing);
  if (!request_.sides.empty()) clip_contour(contour, request_.sides, options.spacing);
  return static_cast<std::int64_t>(contour.triangles.size());
}

template <class Sample>
std::int64_t TriangleCounter<Sample>::count(const Diamond& diamond, int slot,
                                            const std::array<double, 4>& values, int bisections) {
  if (bisections > 0) {
    std::int64_t total = 0;
    const double middle = diamonds_.sample(diamond.point());
    for (const int end : {0, 1}) {
      const TetrahedronHalf& half = DiamondHalves::of(diamond.type_index(), slot, end);
      std::array<double, 4> part;
      for (std::size_t v = 0; v < 4; ++v) part[v] = half.vertices[v] < 4 ? values[half.vertices[v]] : middle;
      total += count(Diamond(diamond.child(half.child)), half.slot, part, bisections - 1);
    }
    return total;
  }
  unsigned above = 0;
  for (std::size_t v = 0; v < 4; ++v) {
    if (!std::isfinite(values[v])) return 0;
    above |= unsigned{values[v] >= request_.isovalue} << v;
  }
  const std::int64_t triangles = kTetrahedronContours[above].triangle_count;
  if (triangles == 0 || is_inside(diamond)) return triangles;
  return count_clipped(diamond, slot);
}

template <class Sample>
std::int64_t TriangleCounter<Sample>::triangles(const Diamond& diamond) {
  const DiamondVertices v = vertices(diamond, false);
  std::int64_t total = 0;
  for (int slot = 0; slot < diamond.tetrahedron_count(); ++slot) {
    if ((v.slots >> slot & 1) != 0) total += count(diamond, slot, v.tetrahedron(slot), bisections_);
  }
  return total;
}

template <class Sample>
std::int64_t TriangleCounter<Sample>::added_by_split(const Diamond& diamond) {
  const DiamondVertices v = vertices(diamond, true);
  std::int64_t added = 0;
  for (int slot = 0; slot < diamond.tetrahedron_count(); ++slot) {
    if ((v.slots >> slot & 1) == 0) continue;
    added -= count(diamond, slot, v.tetrahedron(slot), bisections_);
    for (const int end : {0, 1}) {
      const TetrahedronHalf& half = DiamondHalves::of(diamond.type_index(), slot, end);
      added += count(Diamond(diamond.child(half.child)), half.slot, v.half(slot, half.vertices), bisections_);
    }
  }
  return added;
}

template class TriangleCounter<std::uint8_t>;
template class TriangleCounter<std::uint16_t>;
template class TriangleCounter<std::int16_t>;
template class TriangleCounter<float>;

}  // namespace adamas
