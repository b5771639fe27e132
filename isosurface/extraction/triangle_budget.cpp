#include "isosurface/extraction/triangle_budget.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/geometry/tetrahedron_contour.h"
#include "isosurface/contour/contour_clip.h"
#include "isosurface/extraction/diamond_stencil.h"
#include "isosurface/volume/z_order.h"

namespace adamas::isosurface {

namespace {

/// How many more error classes may be split in one go: with each class a surface mostly has 2^(1/4) times as
/// many triangles.
int classes_further(std::int64_t triangles, std::int64_t most) {
  constexpr double kMost = 8;
  const double ratio = static_cast<double>(most) / static_cast<double>(std::max<std::int64_t>(triangles, 1));
  return static_cast<int>(std::clamp(4 * std::log2(ratio), 1.0, kMost));
}

/// The samples at the vertices of a diamond's tetrahedra.
struct DiamondVertices {
  unsigned slots = 0;  ///< of the tetrahedra in the domain, as bits
  double begin = 0, end = 0, middle = 0;
  std::array<double, 9> ring{};  ///< the first again behind the last

  /// Without the middle its value is 0. Throws PageLost.
  template <class Sample>
  DiamondVertices(const Diamond& diamond, LatticeSamples<Sample>& samples, bool with_middle);

  [[nodiscard]] std::array<double, 4> tetrahedron(int slot) const {
    const auto s = static_cast<std::size_t>(slot);
    return {begin, end, ring[s], ring[s + 1]};
  }
  /// The samples of one half of a tetrahedron: see TetrahedronHalf::vertices.
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
    // Of a diamond at the border of the data few tetrahedra reach over it.
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
      const TetrahedronHalf& half = DiamondHalves::of(diamond.type_index(), slot, end);
      added += count(Diamond(diamond.child(half.child)), half.slot, v.half(slot, half.vertices));
    }
  }
  return added;
}

template <class Sample>
TriangleBudget<Sample>::TriangleBudget(StoredDiamonds<Sample>& diamonds, SplitPages<Sample>& pages,
                                       const SurfaceRequest& request)
    : split_pages_(pages), request_(request), counter_(diamonds, request), page_(diamonds) {}

template <class Sample>
PageMask TriangleBudget<Sample>::of_classes(int lod, const PageOfLod& page, int low, int high) {
  PageMask found = *page.split;
  const unsigned least = CutOfPage::code(low, lod), end = CutOfPage::code(high, lod);
  if (page.cut.least() >= end) return {};
  const auto& codes = split_pages_.codes(lod, page.block);
  for (std::size_t row = 0; row < found.rows.size(); ++row) {
    if (found.rows[row] == 0) continue;
    const std::uint8_t* of_row = codes.data() + PageGrid::kSide * row;
    const unsigned wanted = row_not_less(of_row, least) & ~row_not_less(of_row, end);
    found.rows[row] = static_cast<std::uint16_t>(found.rows[row] & wanted);
  }
  return found;
}

template <class Sample>
template <class Visit>
void TriangleBudget<Sample>::visit_page(int lod, const PageOfLod& page, int low, int high, Visit&& visit) {
  const PageMask wanted = of_classes(lod, page, low, high);
  if (!wanted.any()) return;
  page_.load(lod, page.block, wanted);
  const auto& codes = split_pages_.codes(lod, page.block);
  const bool simple = page_.all_finite();
  wanted.for_each([&](LatticePoint q) {
    const DiamondStencil& stencil = DiamondStencil::at(q);
    // Tables tell how many triangles a split adds where nothing is clipped.
    const bool whole =
        simple && ((page_.is_inside() && !request_.region) || counter_.is_inside(page_.diamond(q)));
    const std::int64_t more =
        whole ? page_.triangles_added(stencil, q) : counter_.added_by_split(page_.diamond(q));
    visit(q, error_class(codes[PageGrid::place(q, 0)], lod),
          3 * (split_pages_.lods() - 1 - lod) + stencil.phase, more);
  });
}

template <class Sample>
void TriangleBudget<Sample>::tighten(int high, std::int64_t room, SurfaceCut& cut) {
  std::int64_t sum = 0;
  for (int error_class = high - 1; error_class >= cut.error_class; --error_class) {
    for (int generation = 0; generation < generations(); ++generation) {
      sum += added(error_class, generation);
      if (sum <= room) continue;
      cut = {.error_class = error_class, .generation = generation + 1};
      return;
    }
  }
}

template <class Sample>
std::int64_t TriangleBudget<Sample>::added_before_last(int high, const SurfaceCut& cut) {
  std::int64_t sum = 0;
  for (int error_class = cut.error_class; error_class < high; ++error_class) {
    const int end =
        error_class > cut.error_class ? generations() : std::min(cut.generation - 1, generations());
    for (int generation = 0; generation < end; ++generation) sum += added(error_class, generation);
  }
  return sum;
}

template <class Sample>
SurfaceCut TriangleBudget<Sample>::count(int low, int high, std::int64_t room, Progress& progress) {
  added_.assign(static_cast<std::size_t>(StoredDiamonds<Sample>::kErrorClasses * generations()), 0);
  SurfaceCut cut{.error_class = low};
  std::int64_t sum = 0;
  split_pages_.find(cut, [&](int lod, const PageOfLod& page) {
    progress.step("choosing", 1 - (lod + 1.0) / split_pages_.lods());
    visit_page(lod, page, low, high, [&](LatticePoint, int error_class, int generation, std::int64_t more) {
      added(error_class, generation) += more;
      sum += more;
    });
    // Diamonds that come after the first for which there is no room do not matter.
    if (sum > room) tighten(high, room, cut);
  });
  return cut;
}

template <class Sample>
SurfaceCut TriangleBudget<Sample>::find_place(SurfaceCut cut, std::int64_t room) {
  struct Added {
    std::uint64_t page;
    std::size_t place;
    std::int64_t triangles;
  };
  const int generation = cut.generation - 1;
  std::vector<Added> all;
  split_pages_.find(cut, [&](int lod, const PageOfLod& page) {
    if (lod != split_pages_.lods() - 1 - generation / 3) return;
    visit_page(lod, page, cut.error_class, cut.error_class + 1,
               [&](LatticePoint q, int, int of_generation, std::int64_t more) {
                 if (of_generation == generation)
                   all.push_back({ZOrder::interleave(page.block), PageGrid::place(q, 0), more});
               });
  });
  cut.generation = generation;
  for (const Added& next : all) {
    cut.page = next.page;
    cut.place = next.place;
    room -= next.triangles;
    if (room < 0) break;
  }
  return cut;
}

template <class Sample>
SurfaceCut TriangleBudget<Sample>::find(std::uint64_t triangles, int least_class, const Diamond& root,
                                        Progress& progress) {
  const auto most =
      static_cast<std::int64_t>(std::min<std::uint64_t>(triangles, std::numeric_limits<std::int64_t>::max()));
  std::int64_t total = counter_.triangles(root);
  int high = std::max(split_pages_.class_if_allowed(root.point()) + 1, least_class);
  while (high > least_class) {
    const int low = std::max(least_class, high - classes_further(total, most));
    const SurfaceCut cut = count(low, high, most - total, progress);
    total += added_before_last(high, cut);
    if (cut.generation != SurfaceCut::kAll) return find_place(cut, most - total);
    high = low;
  }
  return {.error_class = least_class};
}

template class TriangleCounter<std::uint8_t>;
template class TriangleCounter<std::uint16_t>;
template class TriangleCounter<std::int16_t>;
template class TriangleCounter<float>;
template class TriangleBudget<std::uint8_t>;
template class TriangleBudget<std::uint16_t>;
template class TriangleBudget<std::int16_t>;
template class TriangleBudget<float>;

}  // namespace adamas::isosurface
