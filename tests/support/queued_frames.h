#pragma once

#include <cstdint>
#include <optional>

#include "isosurface/extraction/triangle_counter.h"
#include "isosurface/view/frame_request.h"
#include "isosurface/view/viewed_diamonds.h"
#include "tests/support/bucket_queue.h"
#include "tests/support/indexed_hierarchy.h"

namespace adamas::test {

using namespace isosurface;

/// Frames after D 4.8: the mesh is a table of diamonds. Those that may be split and those that may be merged
/// lie in two queues ordered by their errors in the view, and each frame continues from the mesh of the last
/// one. Each frame looks at all diamonds of the mesh. FrameRequest::resident_only is ignored, and depth tests
/// are not counted.
template <class Sample>
class QueuedFrames {
 public:
  /// The pages must outlive the object.
  explicit QueuedFrames(StoredPages<OrderedWord<Sample>>& pages);

  /// Brings the mesh to the one wanted, by splits and merges from its present state. It starts from the mesh
  /// in which nothing is split where, with another isovalue or limit, the present mesh has too many
  /// triangles. Throws PageLost, after which the mesh is whole.
  FrameFigures refine(const FrameRequest& request);

  [[nodiscard]] const IndexedHierarchy& mesh() const { return mesh_; }
  [[nodiscard]] ViewedDiamonds<Sample>& diamonds() { return diamonds_; }

 private:
  /// Returns the bucket of a diamond. Buckets are in the order of classes, and within a class from the finest
  /// generation to the coarsest; so a diamond that is split first has split parents, and one that is merged
  /// first has merged children. The classes of errors that need no split count as 0.
  [[nodiscard]] std::size_t bucket(LatticePoint p);
  [[nodiscard]] std::size_t class_of_bucket(std::size_t bucket) const { return bucket / generations(); }
  [[nodiscard]] std::size_t generations() const { return 3 * static_cast<std::size_t>(diamonds_.lods()); }
  void set_contour(double isovalue);
  void forget_splits();
  void fill_queues();
  /// Does the next split or merge. Returns whether there was one.
  bool step(FrameFigures& figures);
  struct Split {
    LatticePoint point;
    std::int64_t added;  ///< number of triangles
  };
  std::optional<Split> next_split();
  [[nodiscard]] bool waits_for_parents(LatticePoint p) const;
  std::optional<LatticePoint> next_merge(std::size_t greatest_class);
  void split(LatticePoint p, std::int64_t added);
  void merge(LatticePoint p);
  /// Puts a diamond into the queue of splits, or takes it out, according to the mesh and the view.
  void queue_split(LatticePoint p);
  void queue_merge(LatticePoint p);
  double largest_error();

  ViewedDiamonds<Sample> diamonds_;
  SurfaceRequest counted_;  ///< the contour whose triangles are counted
  TriangleCounter<Sample> counter_;
  IndexedHierarchy mesh_;
  LatticeMap<std::int64_t> split_;  ///< split diamonds, and the number of triangles that each split added
  std::int64_t triangles_ = 0;
  std::optional<double> isovalue_;  ///< none before the first frame
  double pixels_ = 0;
  std::int64_t max_triangles_ = 0;
  BucketQueue splits_, merges_;
};

extern template class QueuedFrames<std::uint8_t>;
extern template class QueuedFrames<std::uint16_t>;
extern template class QueuedFrames<std::int16_t>;
extern template class QueuedFrames<float>;

}  // namespace adamas::test
