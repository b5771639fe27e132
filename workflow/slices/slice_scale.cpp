#include "workflow/slices/slice_scale.h"

#include <algorithm>
#include <cmath>

#include "adamas/steps.h"

namespace adamas::workflow {

using namespace picture;

void SliceScale::add(const SlicePicture& picture) {
  for (const SlicePanel& panel : picture.panels) {
    for (const FieldPolygon& polygon : panel.polygons) {
      for (const double value : polygon.values) {
        if (!std::isfinite(value)) continue;
        if (!range_) range_ = ValueRange{value, value};
        range_->low = std::min(range_->low, value);
        range_->high = std::max(range_->high, value);
      }
    }
  }
  for (const LegendEntry& entry : picture.materials) {
    const auto same = [&entry](const LegendEntry& other) { return other.name == entry.name; };
    if (std::none_of(materials_.begin(), materials_.end(), same)) materials_.push_back(entry);
  }
}

void SliceScale::apply(std::size_t step, double time, SlicePicture& picture) const {
  picture.title = title_;
  if (!picture.range && range_ && range_->low < range_->high) picture.range = range_;
  if (!picture.materials.empty()) picture.materials = materials_;
  add_step_title(time, step, picture);
}

void add_step_title(double time, std::size_t step, SlicePicture& picture) {
  std::string& title = picture.panels.front().title;
  title = step_title(time, step) + (title.empty() ? "" : ": ") + title;
}

}  // namespace adamas::workflow
