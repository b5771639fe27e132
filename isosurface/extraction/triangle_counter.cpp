#include "isosurface/extraction/triangle_counter.h"

#include <algorithm>
#include <cmath>

#include "core/geometry/tetrahedron_contour.h"
#include "core/lattice/diamond_type.h"
#include "isosurface/contour/contour_clip.h"
#include "isosurface/extraction/diamond_stencil.h"

namespace adamas::isosurface {

namespace {

/// One of the two tetrahedra into which a split bisects a tetrahedron.
struct TetrahedronHalf {
  std::uint8_t child;  ///< the child diamond it belongs to
  std::uint8_t slot;   ///< its slot in that diamond
  /// Its vertices: 0 to 3 are those of the bisected tetrahedron, 4 is the split vertex.
  std::array<std::uint8_t, 4> vertices;
};

/// The content of DiamondType::child_tetrahedra, by the tetrahedron that is bisected.
class DiamondHalves {
 public:
  /// Returns the half of a tetrahedron, given the diamond's type, with the beginning of the split edge (`end`
  /// = 0) or with its end (1).
  static const TetrahedronHalf& half(int type, int slot, int end) {
    static const DiamondHalves kAll;
    return kAll.halves_[static_cast<std::size_t>(type)][static_cast<std::size_t>(slot)]
                       [static_cast<std::size_t>(end)];
  }

 private:
  DiamondHalves() {
    for (std::size_t t = 0; t < kDiamondTypes.size(); ++t) {
      const DiamondType& type = kDiamondTypes[t];
      for (std::uint8_t child = 0; child < type.child_count; ++child) {
        for (const DiamondType::ChildTetrahedron& half : type.child_tetrahedra[child])
          halves_[t][half.slot][half.end] = {child, half.child_slot, half.vertices};
      }
    }
  }

  std::array<std::array<std::array<TetrahedronHalf, 2>, 8>, kDiamondTypeCount> halves_{};
};

/// The samples at the vertices of a diamond's tetrahedra.
struct DiamondVertices {
  unsigned slots = 0;  ///< slots of the tetrahedra in the domain, as bits
  double begin = 0, end = 0, middle = 0;
  std::array<double, 9> ring{};  ///< values of the ring, the first again behind the last

  /// Reads the samples; the middle is 0 unless `with_middle` is set. Throws PageLost.
  template <class Sample>
  DiamondVertices(const Diamond& diamond, LatticeSamples<Sample>& samples, bool with_middle);

  [[nodiscard]] std::array<double, 4> tetrahedron(int slot) const {
    const auto s = static_cast<std::size_t>(slot);
    return {begin, end, ring[s], ring[s + 1]};
  }
  /// Returns the samples of one half of a tetrahedron: see TetrahedronHalf::vertices.
  [[nodiscard]] std::array<double, 4> half(int slot, const std::array<std::uint8_t, 4>& vertices) const {
    const std::array<double, 4> whole = tetrahedron(slot);
    std::array<double, 4> result;
    for (std::size_t v = 0; v < 4; ++v) result[v] = vertices[v] < 4 ? whole[vertices[v]] : middle;
    return result;
  }
};

template <class Sample>
DiamondVertices::DiamondVertices(const Diamond& diamond, LatticeSamples<Sample>& samples, bool with_middle) {
  const Domain& domain = samples.domain();
  const int count = diamond.tetrahedron_count();
  if (domain.boundary_count(diamond.point()) == 0) {
    slots = (1u << count) - 1;
  } else {
    for (const int slot : diamond.tetrahedra(domain)) slots |= 1u << slot;
  }
  const auto [a, b] = diamond.split_edge();
  begin = samples.sample(a);
  end = samples.sample(b);
  if (with_middle) middle = samples.sample(diamond.point());
  // Tetrahedron `slot` has the vertices `slot` and `slot` + 1 of the ring.
  const unsigned used = slots | slots << 1 | slots >> (count - 1);
  for (int r = 0; r < count; ++r) {
    if ((used >> r & 1) != 0) ring[static_cast<std::size_t>(r)] = samples.sample(diamond.ring(r));
  }
  ring[static_cast<std::size_t>(count)] = ring[0];
}

}  // namespace

template <class Sample>
bool TriangleCounter<Sample>::is_inside(const Diamond& diamond) const {
  const LatticePoint p = diamond.point(), last = samples_.last_sample();
  const std::int32_t s = diamond.scale();
  if (p.i + s > last.i || p.j + s > last.j || p.k + s > last.k) return false;
  if (!request_.region) return true;
  const Domain& domain = samples_.domain();
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
  const ContourOptions options = request_.contour_options(samples_.last_sample(), samples_.spacing());
  ContourBuilder builder(samples_.domain(), request_.isovalue, options);
  DiamondContour(builder, request_.isovalue, samples_.last_sample())
      .add(diamond, 1u << slot, [this](LatticePoint p) { return samples_.sample(p); });
  Contour contour = builder.finish();
  if (request_.region) clip_contour(contour, *request_.region, options.spacing);
  if (!request_.sides.empty()) clip_contour(contour, request_.sides, options.spacing);
  return static_cast<std::int64_t>(contour.triangles.size());
}

template <class Sample>
std::int64_t TriangleCounter<Sample>::count(const Diamond& diamond, int slot,
                                            const std::array<double, 4>& values) {
  unsigned above = 0;
  for (std::size_t v = 0; v < 4; ++v) {
    if (!std::isfinite(values[v])) return 0;
    above |= unsigned{values[v] >= request_.isovalue} << v;
  }
  const std::int64_t triangles = kTetrahedronContours[above].triangle_count;
  if (triangles == 0 || is_inside(diamond)) return triangles;
  if (!request_.region) {
    // Few tetrahedra of a diamond at the border of the data extend beyond it.
    const std::array<LatticePoint, 4> vertices = diamond.tetrahedron(slot);
    const LatticePoint last = samples_.last_sample();
    if (is_beyond(vertices, last)) return 0;
    if (!reaches_beyond(vertices, last)) return triangles;
  }
  return count_clipped(diamond, slot);
}

template <class Sample>
std::int64_t TriangleCounter<Sample>::triangles(const Diamond& diamond) {
  const DiamondVertices v(diamond, samples_, false);
  std::int64_t total = 0;
  for (int slot = 0; slot < diamond.tetrahedron_count(); ++slot) {
    if ((v.slots >> slot & 1) != 0) total += count(diamond, slot, v.tetrahedron(slot));
  }
  return total;
}

template <class Sample>
std::int64_t TriangleCounter<Sample>::added_by_split(const Diamond& diamond) {
  const DiamondVertices v(diamond, samples_, true);
  std::int64_t added = 0;
  for (int slot = 0; slot < diamond.tetrahedron_count(); ++slot) {
    if ((v.slots >> slot & 1) == 0) continue;
    added -= count(diamond, slot, v.tetrahedron(slot));
    for (const int end : {0, 1}) {
      const TetrahedronHalf& half = DiamondHalves::half(diamond.type_index(), slot, end);
      added += count(Diamond(diamond.child(half.child)), half.slot, v.half(slot, half.vertices));
    }
  }
  return added;
}

template <class Sample>
std::int64_t PageTriangleCounter<Sample>::added_by_split(LatticePoint q) {
  // If nothing is clipped, a table has the number of triangles that a split adds.
  const bool is_whole =
      page_.all_finite() && ((page_.is_inside() && !request_.region) || counter_.is_inside(page_.diamond(q)));
  return is_whole ? page_.triangles_added(DiamondStencil::at(q), q)
                  : counter_.added_by_split(page_.diamond(q));
}

ADAMAS_INSTANTIATE_FOR_SAMPLES(TriangleCounter);
ADAMAS_INSTANTIATE_FOR_SAMPLES(PageTriangleCounter);

}  // namespace adamas::isosurface
