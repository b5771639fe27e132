#include "isosurface/view/viewed_diamonds.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "isosurface/extraction/split_limits.h"

namespace adamas {

template <class Sample>
void ViewedDiamonds<Sample>::set_contour_in_view(double isovalue) {
  this->set_contour(isovalue);
  known_.assign(lod_count(), {});
  pages_.clear();
}

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
CentredBox ViewedDiamonds<Sample>::nested_box(LatticePoint p, std::int32_t scale, int phase) const {
  // A little larger, so that rounding leaves the boxes of children within those of their parents.
  constexpr double kLarger = 1 + 0x1p-30;
  const double reach = kLarger * static_cast<double>(nested_reach(phase)) * scale;
  return {this->domain().position(p), reach * this->domain().spacing()};
}

template <class Sample>
double ViewedDiamonds<Sample>::pixels(LatticePoint p) {
  if (!this->is_stored(p)) return 0;
  const Diamond diamond(p);
  const CentredBox box = nested_box(p, diamond.scale(), diamond.phase());
  if (!view_.is_visible(box)) return 0;
  const int error_class = StoredDiamonds<Sample>::class_if_crossed(p);
  return error_class == 0 ? 0 : view_.pixels(this->error(error_class), box);
}

template <class Sample>
CentredBox ViewedDiamonds<Sample>::box_of_page(const PageId& id) const {
  const std::int32_t step = this->lattice_step(id.lod);
  const LatticePoint first = step * (PageGrid::kSide * id.block);
  const double middle = 0.5 * (PageGrid::kSide - 1), reach = 1 + middle + nested_reach(0);
  const Vec3 spacing = static_cast<double>(step) * this->domain().spacing();
  return {this->domain().position(first) + middle * spacing, reach * spacing};
}

template <class Sample>
int ViewedDiamonds<Sample>::greatest_class(const PageId& id) {
  const int error_class = StoredDiamonds<Sample>::greatest_class(id);
  if (error_class == 0) return 0;
  const CentredBox box = box_of_page(id);
  if (!view_.is_visible(box)) return 0;
  return view_class(view_.pixels(this->error(error_class), box));
}

template <class Sample>
const typename ViewedDiamonds<Sample>::Crossed& ViewedDiamonds<Sample>::crossed(const PageId& id) {
  LatticeMap<std::uint32_t>& of_lod = known_[static_cast<std::size_t>(id.lod)];
  if (const std::uint32_t* const known = of_lod.find(id.block)) return pages_[*known];
  Codes codes;
  StoredDiamonds<Sample>::find_crossed(id, codes);
  Crossed found;
  for (std::size_t n = 0; n < codes.size(); ++n) {
    if (codes[n] == 0) continue;
    found.places.push_back(static_cast<std::uint16_t>(n));
    found.codes.push_back(codes[n]);
  }
  *of_lod.insert(id.block).first = static_cast<std::uint32_t>(pages_.size());
  pages_.push_back(std::move(found));
  return pages_.back();
}

template <class Sample>
void ViewedDiamonds<Sample>::find_crossed(const PageId& id, Codes& codes) {
  codes.fill(0);
  const Crossed& found = crossed(id);
  const bool is_coarsest = id.lod == this->grid().top();
  const bool all_visible = !is_coarsest && view_.shows_all_of(box_of_page(id));
  for (std::size_t n = 0; n < found.places.size(); ++n) {
    const std::int32_t place = found.places[n];
    const LatticePoint q{place % PageGrid::kSide, place / PageGrid::kSide % PageGrid::kSide,
                         place / (PageGrid::kSide * PageGrid::kSide)};
    const LatticePoint p = this->lattice_step(id.lod) * (PageGrid::kSide * id.block + q);
    if (!this->is_stored(p)) continue;
    // The coarsest page has points of all coarser LODs.
    const int lod = is_coarsest ? this->lod(p) : id.lod;
    const int shift = lod - id.lod;
    const int phase = 3 - (q.i >> shift & 1) - (q.j >> shift & 1) - (q.k >> shift & 1);
    // Others than the coarsest page do not know of the points of coarser LODs.
    if (phase == 3) continue;
    const CentredBox box = nested_box(p, this->lattice_step(lod), phase);
    if (!all_visible && !view_.is_visible(box)) continue;
    const double error = this->error(error_class(found.codes[n], lod));
    const int in_view = view_class(view_.pixels(error, box));
    codes[static_cast<std::size_t>(place)] = static_cast<std::uint8_t>(in_view == 0 ? 0 : in_view - 4 * lod);
  }
}

template class ViewedDiamonds<std::uint8_t>;
template class ViewedDiamonds<std::uint16_t>;
template class ViewedDiamonds<std::int16_t>;
template class ViewedDiamonds<float>;

}  // namespace adamas
