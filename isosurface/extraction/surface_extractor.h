#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/base/progress.h"
#include "core/lattice/lattice_map.h"
#include "isosurface/extraction/lost_regions.h"
#include "isosurface/extraction/stored_diamonds.h"
#include "isosurface/extraction/surface_request.h"

namespace adamas {

/// Isosurfaces of a store. The mesh they come from is that in which just those diamonds are split that the
/// surface crosses with an error that is too great: since no child has a greater error or range than a
/// parent, it is conforming, and a diamond at a time tells of it without a table of the mesh.
template <class Sample>
class SurfaceExtractor {
 public:
  /// The pages must outlive this.
  explicit SurfaceExtractor(StoredPages<OrderedWord<Sample>>& pages);

  [[nodiscard]] const Domain& domain() const { return diamonds_.domain(); }
  /// Least and greatest sample of the store.
  std::array<double, 2> range() { return diamonds_.range(); }

  /// Throws Error where the store is too damaged for any surface, or damaged at all and the request strict.
  ExtractedSurface extract(const SurfaceRequest& request, Progress& progress = SilentProgress::instance());

 private:
  using Points = std::vector<LatticePoint>;

  /// Which diamonds are split: those of greater rank, those of that rank and an earlier generation, and some
  /// of that generation.
  struct Cut {
    int rank = 0;
    int generation = 0;
    Points last;  ///< in ascending order
  };
  /// The values at the vertices of a diamond's tetrahedra in the domain, whose slots are `slots`.
  struct Vertices {
    unsigned slots = 0;
    double begin = 0, end = 0, middle = 0;
    std::array<double, 9> ring{};
    /// Which of them are above the isovalue, as bits in the order of the members.
    unsigned above = 0;
    bool finite = true;  ///< all of them

    [[nodiscard]] std::array<double, 4> tetrahedron(int slot) const {
      const auto s = static_cast<std::size_t>(slot);
      return {begin, end, ring[s], ring[s + 1]};
    }
    /// The same bits of one half of a tetrahedron, in the half's order.
    [[nodiscard]] unsigned above_of(int slot, const std::array<std::uint8_t, 4>& half) const {
      const unsigned bits = (above & 3) | (above >> (3 + slot) & 3) << 2 | (above & 4) << 2;
      return (bits >> half[0] & 1) | (bits >> half[1] & 1) << 1 | (bits >> half[2] & 1) << 2 |
             (bits >> half[3] & 1) << 3;
    }
  };

  ExtractedSurface extract_once(Progress& progress);
  Cut cut_by_error() const;
  Cut cut_by_triangles(std::uint64_t budget, Progress& progress);
  ExtractedSurface contour_of(const Cut& cut, Progress& progress);

  /// The least rank whose error is greater than the one wanted.
  [[nodiscard]] int least_rank() const { return diamonds_.rank_within(request_.error) + 1; }
  /// The rank of a diamond that may be split, 0 of others.
  int rank(LatticePoint p);
  /// Whether the cut splits the diamond, whose rank is `rank`.
  [[nodiscard]] bool is_split(LatticePoint p, int rank, const Cut& cut) const;
  /// Whether pages that cannot be had keep the diamond from being split.
  [[nodiscard]] bool is_lost(LatticePoint p) const;
  [[nodiscard]] bool reaches_region(LatticePoint p, int level, int phase) const;
  /// Whether `parent` is that of its parents through which `child` is come to.
  [[nodiscard]] bool leads_to(LatticePoint parent, LatticePoint child) const;
  [[nodiscard]] int generation(LatticePoint p) const;
  /// Brings diamonds of one generation into the order of their pages in the file: each page is looked at
  /// once.
  void sort_by_page(Points& points) const;
  Vertices vertices(const Diamond& diamond, bool with_middle);

  /// Calls fn(tetrahedron) for those of the fine tetrahedra of a tetrahedron that the contour crosses.
  template <class Fn>
  void for_each_crossed(LatticePoint diamond, int slot, const std::array<double, 4>& values, int bisections,
                        Fn&& fn);
  /// Whether a fine diamond, at which the bisections of some tetrahedron of the mesh end, is split since
  /// those of neighbouring ones go further: where it, or a diamond that cannot be split without it, follows a
  /// split.
  bool is_split_finely(LatticePoint p, int more = kMostFurther);
  /// By how many generations neighbours along an edge may differ.
  static constexpr int kMostFurther = 2;
  /// Whether a diamond is split from which this one comes by as many bisections as tetrahedra stand for.
  bool follows_split(LatticePoint p);
  std::int64_t count_triangles(LatticePoint diamond, int slot, const std::array<double, 4>& values);
  /// How many triangles a tetrahedron has when the surface is clipped.
  std::int64_t count_clipped(const CrossedTetrahedron& tetrahedron) const;
  /// Whether the surface in a diamond is not clipped.
  [[nodiscard]] bool is_inside(const Diamond& diamond) const;
  /// How many more triangles there are once a diamond is split.
  std::int64_t added_triangles(LatticePoint p);

  StoredDiamonds<Sample> diamonds_;
  int subtree_bisections_;
  LatticePoint root_;
  LostRegions lost_;
  const Cut* cut_ = nullptr;            ///< of the mesh with subtrees that is gone through
  LatticeMap<std::uint8_t> following_;  ///< what follows_split has found
  SurfaceRequest request_;
  std::optional<std::array<Vec3, 2>> region_;  ///< in samples
};

extern template class SurfaceExtractor<std::uint8_t>;
extern template class SurfaceExtractor<std::uint16_t>;
extern template class SurfaceExtractor<std::int16_t>;
extern template class SurfaceExtractor<float>;

}  // namespace adamas
