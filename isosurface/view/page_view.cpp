#include "isosurface/view/page_view.h"

#include <cmath>

namespace adamas::isosurface {

LodPlaces::LodPlaces(const Domain& domain, std::int32_t step, LatticePoint last) : last_(last) {
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double>& of_axis = places_[static_cast<std::size_t>(axis)];
    of_axis.reserve(static_cast<std::size_t>(last[axis]) + 1);
    LatticePoint p{};
    for (std::int32_t n = 0; n <= last[axis]; ++n) {
      p[axis] = step * n;
      of_axis.push_back(domain.position(p)[axis]);
    }
  }
  for (int phase = 0; phase < 3; ++phase)
    halves_[static_cast<std::size_t>(phase)] = nested_half(domain, step, phase);
}

PageView::Heights::Heights(const View::Side& side, const LodPlaces& lod, LatticePoint block)
    : offset(side.offset) {
  std::array<double, 3> low, high;
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    const std::size_t begin = kSide * static_cast<std::size_t>(block[axis]),
                      count = std::min(kSide, lod.places(axis).size() - begin);
    for (std::size_t n = 0; n < count; ++n) parts[a][n] = side.normal[axis] * lod.places(axis)[begin + n];
    low[a] = std::min(parts[a][0], parts[a][count - 1]);
    high[a] = std::max(parts[a][0], parts[a][count - 1]);
  }
  // Rounding is monotone: no height of a point is beyond these.
  least = low[0] + low[1] + low[2];
  greatest = high[0] + high[1] + high[2];
  for (std::size_t phase = 0; phase < 3; ++phase)
    reach[phase] = View::reach({{}, lod.half(static_cast<int>(phase))}, side.normal);
}

PageView::PageView(const View& view, const LodPlaces& lod, LatticePoint block)
    : lod_(lod),
      block_(block),
      depths_(view.depths().get()),
      near_distance_(view.viewpoint().near),
      near_(view.sides()[View::kNear], lod, block) {
  const auto note = [&](const Heights& heights) {
    // Diamonds of phase 0 reach farthest.
    if (!(heights.greatest - heights.offset >= -heights.reach[0])) hidden_ = true;
    if (!(heights.least - heights.offset >= -heights.reach[2])) cut_[cut_count_++] = heights;
  };
  note(near_);
  for (std::size_t n = 0; n < View::kNear && !hidden_; ++n) note(Heights(view.sides()[n], lod, block));
  occluded_ = !hidden_ && depths_ != nullptr && depths_->hides(box_of_page());
}

CentredBox PageView::box_of_page() const {
  // The box is a little larger, so that rounding leaves the boxes of diamonds within it.
  constexpr double kLarger = 1 + 0x1p-30;
  CentredBox box;
  for (int axis = 0; axis < 3; ++axis) {
    const std::vector<double>& places = lod_.places(axis);
    const std::size_t begin = kSide * static_cast<std::size_t>(block_[axis]),
                      last = std::min(begin + kSide, places.size()) - 1;
    box.centre[axis] = 0.5 * (places[begin] + places[last]);
    box.half[axis] = kLarger * (0.5 * (places[last] - places[begin]) + lod_.half(0)[axis]);
  }
  return box;
}

}  // namespace adamas::isosurface
