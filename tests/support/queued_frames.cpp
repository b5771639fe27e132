#include "tests/support/queued_frames.h"

#include <algorithm>
#include <limits>
#include <vector>

#include "core/base/assert.h"

namespace adamas::test {

template <class Sample>
QueuedFrames<Sample>::QueuedFrames(StoredPages<OrderedWord<Sample>>& pages)
    : diamonds_(pages),
      counter_(diamonds_, counted_),
      mesh_(diamonds_.domain(), diamonds_.lods()),
      splits_(ViewedDiamonds<Sample>::kClasses * generations()),
      merges_(ViewedDiamonds<Sample>::kClasses * generations()) {}

template <class Sample>
std::size_t QueuedFrames<Sample>::bucket(LatticePoint p) {
  const double pixels = diamonds_.pixels(p);
  const auto error_class =
      pixels > pixels_ ? static_cast<std::size_t>(diamonds_.view_class(pixels)) : std::size_t{0};
  const Diamond diamond(p);
  const auto generation = static_cast<std::size_t>(3 * diamond.level() + diamond.phase());
  return error_class * generations() + generations() - 1 - generation;
}

template <class Sample>
FrameFigures QueuedFrames<Sample>::refine(const FrameRequest& request) {
  diamonds_.set_view(View(request.viewpoint, request.depths));
  pixels_ = request.pixels;
  constexpr auto kMost = std::numeric_limits<std::int64_t>::max();
  max_triangles_ =
      static_cast<std::int64_t>(std::min<std::uint64_t>(request.max_triangles.value_or(kMost), kMost));
  if (isovalue_ != request.isovalue) set_contour(request.isovalue);
  if (triangles_ > max_triangles_) forget_splits();
  fill_queues();
  FrameFigures figures;
  do {
    figures.stopped = request.stop && request.stop();
  } while (!figures.stopped && step(figures));
  figures.triangles = static_cast<std::uint64_t>(triangles_);
  figures.largest_error = largest_error();
  return figures;
}

template <class Sample>
void QueuedFrames<Sample>::set_contour(double isovalue) {
  // The isovalue is unset until the end, so that this is done again where a page is lost meanwhile.
  isovalue_.reset();
  diamonds_.set_contour(isovalue);
  counted_.isovalue = isovalue;
  triangles_ = counter_.triangles(diamonds_.root());
  std::vector<LatticePoint> points;
  split_.for_each([&](LatticePoint p, std::int64_t) { points.push_back(p); });
  for (const LatticePoint p : points) {
    const std::int64_t added = counter_.added_by_split(Diamond(p));
    *split_.find(p) = added;
    triangles_ += added;
  }
  isovalue_ = isovalue;
}

template <class Sample>
void QueuedFrames<Sample>::forget_splits() {
  mesh_ = IndexedHierarchy(diamonds_.domain(), diamonds_.lods());
  split_.clear();
  triangles_ = counter_.triangles(diamonds_.root());
}

template <class Sample>
void QueuedFrames<Sample>::fill_queues() {
  splits_.clear();
  merges_.clear();
  mesh_.for_each_diamond([this](const Diamond& diamond, std::uint8_t) { queue_split(diamond.point()); });
  split_.for_each([this](LatticePoint p, std::int64_t) { queue_merge(p); });
}

template <class Sample>
void QueuedFrames<Sample>::queue_split(LatticePoint p) {
  if (mesh_.tetrahedra(p) == 0 || !mesh_.can_split(p)) {
    splits_.erase(p);
    return;
  }
  const std::size_t at = bucket(p);
  if (class_of_bucket(at) > 0) splits_.put(p, at);
}

template <class Sample>
void QueuedFrames<Sample>::queue_merge(LatticePoint p) {
  if (mesh_.can_merge(p)) {
    merges_.put(p, bucket(p));
  } else {
    merges_.erase(p);
  }
}

template <class Sample>
bool QueuedFrames<Sample>::step(FrameFigures& figures) {
  // Diamonds that need no split are merged first. Then the one with the greatest error is split; where there
  // is no room for it, one with a lesser error is merged.
  std::optional<LatticePoint> merged = next_merge(0);
  if (!merged && !splits_.empty()) {
    if (const std::optional<Split> found = next_split()) {
      split(found->point, found->added);
      ++figures.splits;
      return true;
    }
    merged = next_merge(class_of_bucket(splits_.greatest()) - 1);
  }
  if (!merged) return false;
  merge(*merged);
  ++figures.merges;
  return true;
}

/// Returns one of the diamonds with the greatest class of errors whose triangles there is room for; only a
/// limited number of them is tried.
template <class Sample>
std::optional<typename QueuedFrames<Sample>::Split> QueuedFrames<Sample>::next_split() {
  int looks = 64;
  const std::size_t greatest = splits_.greatest();
  for (std::size_t n = greatest + 1; n-- > class_of_bucket(greatest) * generations();) {
    const std::vector<LatticePoint>& bucket = splits_.bucket(n);
    for (auto p = bucket.rbegin(); p != bucket.rend() && looks > 0; ++p, --looks) {
      if (waits_for_parents(*p)) continue;
      const std::int64_t added = counter_.added_by_split(Diamond(*p));
      if (triangles_ + added <= max_triangles_) return Split{*p, added};
    }
  }
  return {};
}

/// Returns whether a parent that is not wholly outside the data has to be split before.
template <class Sample>
bool QueuedFrames<Sample>::waits_for_parents(LatticePoint p) const {
  const auto parents = Diamond(p).parents(mesh_.domain());
  return std::any_of(parents.begin(), parents.end(), [this](LatticePoint parent) {
    return diamonds_.is_stored(parent) && !mesh_.is_split(parent);
  });
}

/// Returns one of the diamonds with the least errors, up to a class, that may be merged. A merge adds
/// triangles where the contour runs through the coarse tetrahedra alone.
template <class Sample>
std::optional<LatticePoint> QueuedFrames<Sample>::next_merge(std::size_t greatest_class) {
  if (merges_.empty()) return {};
  for (std::size_t n = merges_.least(); n < (greatest_class + 1) * generations(); ++n) {
    const std::vector<LatticePoint>& bucket = merges_.bucket(n);
    for (auto p = bucket.rbegin(); p != bucket.rend(); ++p) {
      if (triangles_ - *split_.find(*p) <= max_triangles_) return *p;
    }
  }
  return {};
}

template <class Sample>
void QueuedFrames<Sample>::split(LatticePoint p, std::int64_t added) {
  std::vector<LatticePoint> done;
  mesh_.split(p, done);
  triangles_ += added;
  for (const LatticePoint q : done) {
    // Parents come before their children in the queue, but for those outside the data, which have no
    // triangles.
    ADAMAS_ASSERT(q == p || !diamonds_.is_stored(q));
    *split_.insert(q).first = q == p ? added : 0;
    splits_.erase(q);
    queue_merge(q);
    for (const LatticePoint parent : Diamond(q).parents(mesh_.domain())) merges_.erase(parent);
    for (const LatticePoint child : Diamond(q).children(mesh_.domain())) queue_split(child);
  }
}

template <class Sample>
void QueuedFrames<Sample>::merge(LatticePoint p) {
  triangles_ -= *split_.find(p);
  split_.erase(p);
  mesh_.merge(p);
  merges_.erase(p);
  for (const LatticePoint child : Diamond(p).children(mesh_.domain())) queue_split(child);
  queue_split(p);
  for (const LatticePoint parent : Diamond(p).parents(mesh_.domain())) queue_merge(parent);
}

template <class Sample>
double QueuedFrames<Sample>::largest_error() {
  double largest = 0;
  mesh_.for_each_diamond([&](const Diamond& diamond, std::uint8_t) {
    largest = std::max(largest, diamonds_.pixels(diamond.point()));
  });
  return largest;
}

template class QueuedFrames<std::uint8_t>;
template class QueuedFrames<std::uint16_t>;
template class QueuedFrames<std::int16_t>;
template class QueuedFrames<float>;

}  // namespace adamas::test
