#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/base/assert.h"
#include "core/lattice/lattice_map.h"
#include "core/lattice/lattice_point.h"

namespace adamas::test {

/// Lattice points in buckets (D 4.8): the time of each operation does not depend on the number of points,
/// except for a step over empty buckets.
class BucketQueue {
 public:
  explicit BucketQueue(std::size_t buckets) : buckets_(buckets) {}

  [[nodiscard]] bool empty() const { return places_.size() == 0; }
  [[nodiscard]] std::size_t size() const { return places_.size(); }
  [[nodiscard]] bool has(LatticePoint p) const { return places_.find(p) != nullptr; }

  /// Puts a point into a bucket; a point that is in the queue already is moved.
  void put(LatticePoint p, std::size_t bucket) {
    ADAMAS_ASSERT(bucket < buckets_.size());
    erase(p);
    *places_.insert(p).first = {bucket, buckets_[bucket].size()};
    buckets_[bucket].push_back(p);
    least_ = size() == 1 || bucket < least_ ? bucket : least_;
    greatest_ = size() == 1 || bucket > greatest_ ? bucket : greatest_;
  }
  /// Removes a point; does nothing for one that is not in the queue.
  void erase(LatticePoint p) {
    const Place* const found = places_.find(p);
    if (found == nullptr) return;
    const Place place = *found;
    places_.erase(p);
    std::vector<LatticePoint>& bucket = buckets_[place.bucket];
    // The bucket's last point takes its place.
    if (place.at + 1 < bucket.size()) {
      bucket[place.at] = bucket.back();
      places_.find(bucket.back())->at = place.at;
    }
    bucket.pop_back();
  }
  void clear() {
    for (std::vector<LatticePoint>& bucket : buckets_) bucket.clear();
    places_.clear();
  }

  /// Returns the least, or the greatest, bucket that has points. The queue must not be empty.
  [[nodiscard]] std::size_t least() {
    while (buckets_[least_].empty()) ++least_;
    return least_;
  }
  [[nodiscard]] std::size_t greatest() {
    while (buckets_[greatest_].empty()) --greatest_;
    return greatest_;
  }
  /// Returns the points of a bucket, in an order that depends on history.
  [[nodiscard]] const std::vector<LatticePoint>& bucket(std::size_t n) const { return buckets_[n]; }

 private:
  struct Place {
    std::size_t bucket, at;
  };

  std::vector<std::vector<LatticePoint>> buckets_;
  LatticeMap<Place> places_;
  std::size_t least_ = 0, greatest_ = 0;  ///< no bucket before least_ or behind greatest_ has points
};

}  // namespace adamas::test
