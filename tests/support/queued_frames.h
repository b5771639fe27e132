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

/// Frames after D 4.8: the mesh is a table of diamonds, those that may be split and those that may be merged
/// lie in two queues by their errors in the view, and each frame goes on from the mesh of the last one. It
/// looks at all diamonds of the mesh for each frame. It ignores FrameRequest::resident_only, and counts no
/// depth tests.
template <class Sample>
class QueuedFrames {
 public:
  /// The pages must outlive this.
  explicit QueuedFrames(StoredPages<OrderedWord<Sample>>& pages);

  /// Brings the mesh to what is wanted, by splits and merges from where it stands; from the mesh in which
  /// nothing is split where another isovalue or limit has the present one at too many triangles. Throws
  /// PageLost, after which the mesh is whole.
  FrameFigures refine(const FrameRequest& request);

  [[nodiscard]] const IndexedHierarchy& mesh() const { return mesh_; }
  [[nodiscard]] ViewedDiamonds<Sample>& diamonds() { return diamonds_; }

 private:
  /// Buckets are in the order of classes, and in a class from the finest generation to the coarsest, so that
  /// what is split first has split parents, and what is merged first has merged children. The classes of
  /// errors that need no split count as 0.
  [[nodiscard]] std::size_t bucket(LatticePoint p);
  [[nodiscard]] std::size_t class_of_bucket(std::size_t bucket) const { return bucket / generations(); }
  [[nodiscard]] std::size_t generations() const { return 3 * static_cast<std::size_t>(diamonds_.lods()); }
  void set_contour(double isovalue);
  void forget_splits();
  void fill_queues();
  /// Does the next split or merge. Returns whether there was one to be done.
  bool step(FrameFigures& figures);
  struct Split {
    LatticePoint point;
    std::int64_t added;  ///< triangles
  };
  std::optional<Split> next_split();
  [[nodiscard]] bool waits_for_parents(LatticePoint p) const;
  std::optional<LatticePoint> next_merge(std::size_t greatest_class);
  void split(LatticePoint p, std::int64_t added);
  void merge(LatticePoint p);
  /// Puts a diamond into the queue or takes it out, as the mesh and the view have it.
  void queue_split(LatticePoint p);
  void queue_merge(LatticePoint p);
  double largest_error();

  ViewedDiamonds<Sample> diamonds_;
  SurfaceRequest counted_;  ///< the contour whose triangles are counted
  TriangleCounter<Sample> counter_;
  IndexedHierarchy mesh_;
  LatticeMap<std::int64_t> split_;  ///< split diamonds, and how many triangles that added
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
