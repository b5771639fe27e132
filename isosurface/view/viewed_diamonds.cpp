#include "isosurface/view/viewed_diamonds.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "isosurface/view/page_view.h"
#include "isosurface/volume/samples.h"

namespace adamas::isosurface {

template <class Sample>
int ViewedDiamonds<Sample>::view_class(double pixels) const {
  if (!(pixels > 0)) return 0;
  // The exponent tells the octave, and the rest which quarter of it.
  int octave = 0;
  const double part = 2 * std::frexp(std::min(pixels, std::numeric_limits<double>::max()), &octave);
  const int quarter = (part >= 0x1.306fe0a31b715p+0 ? 1 : 0) + (part >= 0x1.6a09e667f3bcdp+0 ? 1 : 0) +
                      (part >= 0x1.ae89f995ad3adp+0 ? 1 : 0);
  return std::clamp(class_of_one() + 4 * (octave - 1) + quarter, 4 * (this->lods() - 1) + 1, kMostCode);
}

template <class Sample>
double ViewedDiamonds<Sample>::most_pixels(int view_class) const {
  return view_class == 0 ? 0 : std::exp2(0.25 * (view_class + 1 - class_of_one()));
}

template <class Sample>
double ViewedDiamonds<Sample>::pixels(LatticePoint p) {
  if (!this->is_stored(p)) return 0;
  const Diamond diamond(p);
  const CentredBox box{this->domain().position(p),
                       nested_half(this->domain(), diamond.scale(), diamond.phase())};
  if (!view_.is_visible(box)) return 0;
  const int error_class = StoredDiamonds<Sample>::class_if_crossed(p);
  return error_class == 0 ? 0 : view_.pixels(this->error(error_class), box);
}

template <class Sample>
double ViewedDiamonds<Sample>::farthest(double error, int least_class) const {
  constexpr double kAll = std::numeric_limits<double>::infinity(), kNone = -1;
  if (!(error > 0)) return kNone;
  const auto holds = [&](double depth) { return view_class(view_.pixels_at(error, depth)) >= least_class; };
  if (least_class > kMostCode) return kNone;
  if (view_.viewpoint().height > 0) return holds(1) ? kAll : kNone;
  // Errors have the least class even where they take next to no pixels.
  if (holds(std::numeric_limits<double>::max())) return kAll;
  double depth = view_.pixels_at(error, 1) / most_pixels(least_class - 1);
  while (!holds(depth)) depth = std::nextafter(depth, 0.0);
  for (double next = depth; holds(next); next = std::nextafter(next, kAll)) depth = next;
  return depth;
}

ADAMAS_INSTANTIATE_FOR_SAMPLES(ViewedDiamonds);

}  // namespace adamas::isosurface
