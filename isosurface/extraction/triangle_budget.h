#pragma once

#include <cstdint>
#include <vector>

#include "core/base/progress.h"
#include "isosurface/extraction/page_diamonds.h"
#include "isosurface/extraction/surface_cut.h"
#include "isosurface/extraction/triangle_counter.h"

namespace adamas {

/// Finds the cut that gives a surface as many triangles as are allowed: diamonds are split in the cut's order
/// for as long as there is room.
template <class Sample>
class TriangleBudget {
 public:
  /// `bisections`: see TriangleCounter. All must outlive this.
  TriangleBudget(StoredDiamonds<Sample>& diamonds, SplitPages<Sample>& pages, const SurfaceRequest& request,
                 int bisections);

  /// The cut with at most this many triangles that splits no diamond of less than `least_rank`. `root`: of
  /// the mesh, with nothing split. Throws PageLost.
  SurfaceCut find(std::uint64_t triangles, int least_rank, const Diamond& root, Progress& progress);

 private:
  using PageOfLod = typename SplitPages<Sample>::PageOfLod;
  using Counts = std::vector<std::int64_t>;

  [[nodiscard]] int generations() const { return 3 * pages_.lods(); }
  [[nodiscard]] std::int64_t& added(int rank, int generation) {
    return added_[static_cast<std::size_t>(rank * generations() + generation)];
  }
  /// Counts what the diamonds of ranks from low to high - 1 add, as far as there is room: the cut is that of
  /// all of them, or up to the first rank and generation for which there is no room.
  SurfaceCut count(int low, int high, std::int64_t room, Progress& progress);
  /// Brings the cut to the first rank and generation for which there is no room.
  void tighten(int high, std::int64_t room, SurfaceCut& cut);
  /// What is added before the last generation of a cut, or in all of it where it has no last one.
  std::int64_t added_before_last(int high, const SurfaceCut& cut);
  /// Where in its generation the room of a cut ends.
  SurfaceCut find_place(SurfaceCut cut, std::int64_t room);
  /// The split diamonds of a page of ranks from low to high - 1.
  PageMask of_ranks(int lod, const PageOfLod& page, int low, int high);
  /// Calls visit(q, rank, generation, added) for each of them.
  template <class Visit>
  void visit_page(int lod, const PageOfLod& page, int low, int high, Visit&& visit);

  SplitPages<Sample>& pages_;
  const SurfaceRequest& request_;
  int bisections_;
  TriangleCounter<Sample> counter_;
  PageDiamonds<Sample> page_;
  Counts added_;  ///< by rank and generation
};

extern template class TriangleBudget<std::uint8_t>;
extern template class TriangleBudget<std::uint16_t>;
extern template class TriangleBudget<std::int16_t>;
extern template class TriangleBudget<float>;

}  // namespace adamas
