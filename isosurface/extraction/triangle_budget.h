#pragma once

#include <cstdint>
#include <vector>

#include "adamas/progress.h"
#include "isosurface/extraction/split_pages.h"
#include "isosurface/extraction/surface_cut.h"
#include "isosurface/extraction/surface_request.h"

namespace adamas::isosurface {

/// Finds the cut that gives a surface as many triangles as are allowed: diamonds are split in the order of
/// SurfaceCut for as long as there is room for the triangles that this adds.
template <class Sample>
class TriangleBudget {
 public:
  /// All arguments must outlive this.
  TriangleBudget(StoredDiamonds<Sample>& diamonds, SplitPages<Sample>& pages, const SurfaceRequest& request)
      : diamonds_(diamonds), request_(request), split_pages_(pages) {}

  /// Finds the cut with at most this many triangles that splits no diamond of a class below `least_class`.
  /// `root`: the diamond of the mesh in which nothing is split. Throws PageLost.
  SurfaceCut find(std::uint64_t triangles, int least_class, const Diamond& root, Progress& progress);

 private:
  [[nodiscard]] int generations() const { return 3 * split_pages_.lods(); }
  [[nodiscard]] std::int64_t& added(int error_class, int generation) {
    return added_[static_cast<std::size_t>(error_class * generations() + generation)];
  }
  /// Counts the triangles that diamonds of the classes from low to high - 1 add, as far as there is room.
  /// Returns the cut that splits all of them, or those up to the first class and generation for which there
  /// is no room.
  SurfaceCut count(int low, int high, std::int64_t room, Progress& progress);
  /// Brings the cut to the first class and generation for which there is no room.
  void tighten(int high, std::int64_t room, SurfaceCut& cut);
  /// How many triangles a cut adds before its last generation, or in all where it ends with no generation.
  std::int64_t added_before_last(int high, const SurfaceCut& cut);
  /// Returns the cut that ends at the diamond in the last generation of `cut` where the room ends.
  SurfaceCut find_place(SurfaceCut cut, std::int64_t room);
  StoredDiamonds<Sample>& diamonds_;
  const SurfaceRequest& request_;
  SplitPages<Sample>& split_pages_;
  std::vector<std::int64_t> added_;  ///< how many triangles splits add, by class and generation
};

}  // namespace adamas::isosurface
