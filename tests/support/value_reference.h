#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/geometry/vec3.h"
#include "isosurface/storage/page.h"

namespace adamas::test {

/// Samples, errors and ranges of all diamonds of a small volume, by their definitions alone.
template <class Sample>
class ValueReference {
 public:
  using Word = OrderedWord<Sample>;

  /// `samples`: i running fastest. Levels below `depth` have no values, as with subtrees.
  ValueReference(const std::array<std::uint64_t, 3>& dimensions, std::vector<Sample> samples,
                 Vec3 spacing = {1, 1, 1}, int depth = 0);

  [[nodiscard]] const PageGrid& grid() const { return grid_; }
  [[nodiscard]] PageShape shape(const PageId& id) const {
    return {grid_.count(id), grid_.is_complete(id), id.level};
  }
  [[nodiscard]] Page<Word> page(const PageId& id) const;
  /// Of a page that is not complete.
  [[nodiscard]] Surroundings<Word> around(const PageId& id) const;

 private:
  struct Value {
    Word sample = 0, low = static_cast<Word>(~Word{0}), high = 0;
    std::uint8_t error = 0;
  };

  [[nodiscard]] std::size_t index(LatticePoint p) const {
    return static_cast<std::size_t>(p.i) +
           size_[0] * (static_cast<std::size_t>(p.j) + size_[1] * static_cast<std::size_t>(p.k));
  }
  [[nodiscard]] Sample sample(LatticePoint p) const;
  [[nodiscard]] bool is_point(LatticePoint p) const;
  void work_out(LatticePoint p, int bits, int phase);
  void measure(LatticePoint p, int bits, int phase, double& error, Value& value) const;
  [[nodiscard]] double greatest_diameter(int bits) const;

  PageGrid grid_;
  std::array<std::uint64_t, 3> dimensions_;
  std::vector<Sample> samples_;
  Vec3 spacing_;
  int depth_;
  std::array<std::size_t, 3> size_{};
  std::vector<Value> values_;
};

}  // namespace adamas::test
