#pragma once

#include <cstdint>

#include "isosurface/extraction/stored_diamonds.h"
#include "isosurface/view/viewpoint.h"

namespace adamas::isosurface {

/// A store's diamonds as a camera sees them, with their errors in pixels and the classes of these. The class
/// of a child is never greater than those of its parents, so that a SurfaceCut by these classes is a
/// conforming mesh.
template <class Sample>
class ViewedDiamonds final : public StoredDiamonds<Sample> {
 public:
  using Word = typename StoredDiamonds<Sample>::Word;

  /// The pages must outlive this.
  explicit ViewedDiamonds(StoredPages<Word>& pages) : StoredDiamonds<Sample>(pages) {}

  void set_view(const View& view) { view_ = view; }
  [[nodiscard]] const View& view() const { return view_; }

  /// The isosurface error of a diamond in pixels, where it is in sight and the contour crosses it; otherwise
  /// 0. Its depth is the least of the diamond and its descendants. Throws PageLost.
  double pixels(LatticePoint p);

  /// The class of an error in pixels, four to an octave.
  static constexpr int kClasses = 128;
  [[nodiscard]] int view_class(double pixels) const;
  /// An upper bound of the errors of a class, in pixels, except for the last class.
  [[nodiscard]] double most_pixels(int view_class) const;

  /// The greatest depth, as in View::depth, at which an error has at least a class; less than all depths
  /// where there is none.
  [[nodiscard]] double farthest(double error, int view_class) const;

 private:
  /// The class of the errors of one pixel.
  [[nodiscard]] int class_of_one() const { return 4 * (this->lods() - 1) + 1 + 4 * kOctavesBelowOne; }

  static constexpr int kOctavesBelowOne = 8, kMostCode = kClasses - 1;

  View view_{Viewpoint{}};
};

}  // namespace adamas::isosurface
