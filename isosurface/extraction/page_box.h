#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/lattice/lattice_point.h"
#include "isosurface/extraction/stored_diamonds.h"

namespace adamas::isosurface {

/// The samples of a page of the finest LOD and of the points round it, from one before the page to two behind
/// it: coordinates from -1 to 17. So all corners of the page's cells have all their neighbours.
template <class Sample>
class PageBox {
 public:
  using Word = OrderedWord<Sample>;
  static constexpr std::int32_t kFirst = -1, kLast = 17;

  /// Makes an empty box. The diamonds must outlive it.
  explicit PageBox(StoredDiamonds<Sample>& diamonds) : diamonds_(diamonds) {}

  /// Copies the samples of a page, and finds the side of the contour on which each lies. Throws PageLost.
  void load(LatticePoint block);

  /// Returns the sample at a corner of a crossed cell of the page, or at the other end of a crossed edge from
  /// such a corner. Other samples may not have been loaded.
  [[nodiscard]] double value(LatticePoint q) const { return from_ordered<Sample>(words_[place(q)]); }
  /// Returns which samples of a row along i are not below the isovalue: bit i + 1 is the sample at i.
  [[nodiscard]] std::uint32_t above(std::int32_t j, std::int32_t k) const { return above_[row(j, k)]; }
  /// Returns the cells of the page in a row that the contour crosses: bit i is the cell whose first corner is
  /// at i.
  [[nodiscard]] std::uint32_t crossed_cells(std::int32_t j, std::int32_t k) const;
  /// Returns whether the samples of the page and round it are all finite.
  [[nodiscard]] bool is_finite() const { return is_finite_; }
  /// Returns the number of cells of the page along each axis.
  [[nodiscard]] LatticePoint cells() const { return cells_; }

 private:
  static constexpr std::int32_t kSide = kLast - kFirst + 1;

  static std::size_t row(std::int32_t j, std::int32_t k) {
    return static_cast<std::size_t>(j - kFirst + kSide * (k - kFirst));
  }
  static std::size_t place(LatticePoint q) {
    return static_cast<std::size_t>(q.i - kFirst) + static_cast<std::size_t>(kSide) * row(q.j, q.k);
  }
  /// The part of the box that lies on a page at a step along an axis: the first coordinate and the number of
  /// points.
  struct Run {
    std::int32_t first, count;
    explicit Run(std::int32_t step)
        : first(step < 0 ? -1 : 16 * step),
          count(step < 0   ? 1
                : step > 0 ? 2
                           : 16) {}
  };

  void copy(LatticePoint step);
  void fill(LatticePoint step, Word word);
  void find_above();
  void find_finite();
  [[nodiscard]] bool has_crossed_cells_at(LatticePoint step) const;

  StoredDiamonds<Sample>& diamonds_;
  LatticePoint block_{}, cells_{};
  std::array<Word, static_cast<std::size_t>(kSide) * kSide * kSide> words_{};
  std::array<std::uint32_t, static_cast<std::size_t>(kSide) * kSide> above_{};
  bool is_finite_ = true;
};

extern template class PageBox<std::uint8_t>;
extern template class PageBox<std::uint16_t>;
extern template class PageBox<std::int16_t>;
extern template class PageBox<float>;

}  // namespace adamas::isosurface
