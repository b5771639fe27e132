#pragma once

#include <array>
#include <cstddef>
#include <limits>

#include "core/base/typed_id.h"
#include "core/geometry/vec3.h"

namespace adamas::interfaces {

/// For each body at a point of its boundary the sum of the weighted normals towards it. With angles as
/// weights the body with the greatest product holds the point (docs/method.md, Signed distances at vertices).
class Pseudonormals {
 public:
  struct Greatest {
    BodyId body;
    bool clear = false;  ///< positive, and greater than all others
  };
  void add(BodyId body, const Vec3& normal) {
    std::size_t i = 0;
    while (i < count_ && entries_[i].body != body) ++i;
    if (i == entries_.size()) {
      overflow_ = true;
      return;
    }
    if (i == count_) entries_[count_++] = {body, {}};
    entries_[i].normal += normal;
  }
  [[nodiscard]] Greatest greatest(const Vec3& offset) const {
    Greatest best;
    double first = -std::numeric_limits<double>::infinity(), second = first;
    for (std::size_t i = 0; i < count_; ++i) {
      const double value = dot(offset, entries_[i].normal);
      const bool better = value > first || (value == first && entries_[i].body < best.body);
      second = std::max(second, better ? first : value);
      if (better) first = value, best.body = entries_[i].body;
    }
    const double margin = kAmbiguous * norm(offset);
    best.clear = !overflow_ && first > margin && first - second > margin;
    return best;
  }

 private:
  /// Products closer to each other than this, relative to the distance, decide nothing.
  static constexpr double kAmbiguous = 1e-7;
  struct Entry {
    BodyId body;
    Vec3 normal;
  };
  std::array<Entry, 16> entries_;
  std::size_t count_ = 0;
  bool overflow_ = false;
};

}  // namespace adamas::interfaces
