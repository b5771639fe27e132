#pragma once

#include <cstdint>
#include <optional>

#include "core/refinement/bucket_queue.h"
#include "isosurface/extraction/stored_diamonds.h"
#include "isosurface/extraction/triangle_budget.h"
#include "isosurface/hierarchy/indexed_hierarchy.h"
#include "isosurface/view/frame_refinement.h"

namespace adamas {

/// The errors of a store's diamonds as a camera sees them. A child never has a greater one than its parents.
template <class Sample>
class ViewErrors {
 public:
  /// Of the contour that is set in the diamonds, which must outlive this.
  explicit ViewErrors(StoredDiamonds<Sample>& diamonds) : diamonds_(diamonds) {}

  /// The diamond's isosurface error in pixels, where it is in sight and the contour crosses it; otherwise 0.
  /// It is seen where that diamond, or one that comes from splitting it, is nearest to the eye. Throws
  /// PageLost.
  [[nodiscard]] double pixels(const View& view, LatticePoint p) const;

  /// Errors of the same class differ by less than a quarter of an octave; 0: none.
  static constexpr int kClasses = 256;
  static int class_of(double pixels);

 private:
  StoredDiamonds<Sample>& diamonds_;
};

/// Frames after D 4.8: the mesh is a table of diamonds, those that may be split and those that may be merged
/// lie in two queues by their errors in the view, and each frame goes on from the mesh of the last one. It
/// looks at all diamonds of the mesh for each frame.
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
  [[nodiscard]] StoredDiamonds<Sample>& diamonds() { return diamonds_; }

 private:
  /// Buckets are in the order of classes, and in a class from the finest generation to the coarsest, so that
  /// what is split first has split parents, and what is merged first has merged children. The classes of
  /// errors that need no split count as 0.
  [[nodiscard]] std::size_t bucket(LatticePoint p) const;
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
  [[nodiscard]] double largest_error() const;

  StoredDiamonds<Sample> diamonds_;
  SurfaceRequest counted_;  ///< the contour whose triangles are counted
  TriangleCounter<Sample> counter_;
  ViewErrors<Sample> errors_;
  IndexedHierarchy mesh_;
  LatticeMap<std::int64_t> split_;  ///< split diamonds, and how many triangles that added
  std::int64_t triangles_ = 0;
  std::optional<double> isovalue_;  ///< none before the first frame
  View view_{Viewpoint{}};
  double pixels_ = 0;
  std::int64_t max_triangles_ = 0;
  BucketQueue splits_, merges_;
};

extern template class ViewErrors<std::uint8_t>;
extern template class ViewErrors<std::uint16_t>;
extern template class ViewErrors<std::int16_t>;
extern template class ViewErrors<float>;
extern template class QueuedFrames<std::uint8_t>;
extern template class QueuedFrames<std::uint16_t>;
extern template class QueuedFrames<std::int16_t>;
extern template class QueuedFrames<float>;

}  // namespace adamas
