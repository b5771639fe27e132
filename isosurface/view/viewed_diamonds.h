#pragma once

#include <cstdint>
#include <vector>

#include "core/lattice/lattice_map.h"
#include "isosurface/extraction/stored_diamonds.h"
#include "isosurface/view/viewpoint.h"

namespace adamas {

/// A store's diamonds as a camera sees them: their classes are of errors in pixels, and 0 also for what is
/// out of sight. A child never has a greater class than its parents, so that all that works with classes of
/// errors works with these: cuts, limits of triangles, contours.
template <class Sample>
class ViewedDiamonds final : public StoredDiamonds<Sample> {
 public:
  using Word = typename StoredDiamonds<Sample>::Word;
  using Codes = typename StoredDiamonds<Sample>::Codes;

  /// The pages must outlive this.
  explicit ViewedDiamonds(StoredPages<Word>& pages) : StoredDiamonds<Sample>(pages), known_(lod_count()) {}

  void set_view(const View& view) { view_ = view; }
  /// Sets the contour, as StoredDiamonds does, and forgets what is known of another one.
  void set_contour_in_view(double isovalue);

  /// The isosurface error of a diamond in pixels, where it is in sight and the contour crosses it; otherwise
  /// 0. It is seen where that diamond, or one that comes from splitting it, is nearest to the eye. Throws
  /// PageLost.
  double pixels(LatticePoint p);

  /// The class of an error in pixels, four to an octave.
  static constexpr int kClasses = 128;
  [[nodiscard]] int view_class(double pixels) const;
  /// No error of the class takes more pixels, but for the last class.
  [[nodiscard]] double most_pixels(int view_class) const;

  int class_if_crossed(LatticePoint p) override { return view_class(pixels(p)); }
  int greatest_class(const PageId& id) override;
  void find_crossed(const PageId& id, Codes& codes) override;

 private:
  /// The crossed diamonds of a page, by their places, and their error codes.
  struct Crossed {
    std::vector<std::uint16_t> places;
    std::vector<std::uint8_t> codes;
  };

  [[nodiscard]] std::size_t lod_count() const { return static_cast<std::size_t>(this->grid().top()) + 1; }
  /// The class of the errors of one pixel.
  [[nodiscard]] int class_of_one() const { return 4 * (this->lods() - 1) + 1 + 4 * kOctavesBelowOne; }
  /// How far a diamond and what comes from splitting it may reach, in space.
  [[nodiscard]] CentredBox nested_box(LatticePoint p, std::int32_t scale, int phase) const;
  /// A box that contains those of all diamonds of a page, other than the coarsest.
  [[nodiscard]] CentredBox box_of_page(const PageId& id) const;
  const Crossed& crossed(const PageId& id);

  static constexpr int kOctavesBelowOne = 8, kMostCode = kClasses - 1;

  View view_{Viewpoint{}};
  std::vector<LatticeMap<std::uint32_t>> known_;  ///< by LOD: places in pages_, by block
  std::vector<Crossed> pages_;
};

extern template class ViewedDiamonds<std::uint8_t>;
extern template class ViewedDiamonds<std::uint16_t>;
extern template class ViewedDiamonds<std::int16_t>;
extern template class ViewedDiamonds<float>;

}  // namespace adamas
