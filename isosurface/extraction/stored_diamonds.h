#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/lattice/diamond.h"
#include "core/lattice/domain.h"
#include "isosurface/compression/split_edge_prediction.h"
#include "isosurface/preprocessing/error_scale.h"
#include "isosurface/storage/stored_pages.h"

namespace adamas {

/// A page that is needed cannot be had.
struct PageLost {
  PageId page;
};

/// What a store knows of diamonds and their points, by points of the lattice that its domain spans.
template <class Sample>
class StoredDiamonds {
 public:
  using Word = OrderedWord<Sample>;

  explicit StoredDiamonds(StoredPages<Word>& pages);

  [[nodiscard]] const PageGrid& grid() const { return grid_; }
  /// The lattice's cube in space; it may reach beyond the data.
  [[nodiscard]] const Domain& domain() const { return domain_; }
  /// The lattice point of the last sample.
  [[nodiscard]] LatticePoint last_sample() const { return (1 << shift_) * grid_.last(); }
  /// Levels of samples; diamonds of levels below this have errors.
  [[nodiscard]] int levels() const { return grid_.depth(); }
  /// The level of a lattice point in the store: coordinates in samples are multiples of 2^level.
  [[nodiscard]] int level(LatticePoint p) const { return trailing_zeros(p) - shift_; }
  [[nodiscard]] LatticePoint in_samples(LatticePoint p) const {
    return {p.i >> shift_, p.j >> shift_, p.k >> shift_};
  }
  /// Whether something is known of the diamond: its point is no corner of the cube, and it reaches into the
  /// data.
  [[nodiscard]] bool is_stored(LatticePoint p) const {
    const int l = level(p);
    if (l < 0 || l >= grid_.depth()) return false;
    const LatticePoint e = grid_.extent(l), s = in_samples(p);
    return s.i >> l <= e.i && s.j >> l <= e.j && s.k >> l <= e.k;
  }

  /// The sample at a point of the lattice of samples; beyond the data the nearest one. Throws PageLost.
  double sample(LatticePoint p);

  /// Errors by rank: 0 is none, and each rank is an error 2^(1/4) times that of the one before.
  static constexpr int kRanks = ErrorScale::kCodes + 4 * PageGrid::kMaxDepth;
  /// Units of length.
  [[nodiscard]] double error(int rank) const { return errors_[static_cast<std::size_t>(rank)]; }
  /// The greatest rank whose error is not greater.
  [[nodiscard]] int rank_within(double error) const;

  /// Of a stored diamond: the rank of its error where the contour may cross it, 0 where it does not. Throws
  /// PageLost.
  int rank_if_crossed(LatticePoint p, double isovalue);

  /// Bounds of all samples. Throws PageLost.
  std::array<double, 2> range();

 private:
  /// Whether the pages of the level have a place for the point. The few points that have none are those of
  /// diamonds that are much larger than the data along some axis.
  [[nodiscard]] bool has_place(LatticePoint in_samples, int page_level) const {
    const LatticePoint e = grid_.extent(page_level);
    return in_samples.i >> page_level <= e.i && in_samples.j >> page_level <= e.j &&
           in_samples.k >> page_level <= e.k;
  }
  /// Of a diamond whose point has no place in pages: an upper bound by what its parents have, which cover it.
  int rank_by_parents(LatticePoint p, double isovalue);

  const Page<Word>& page(const PageId& id);
  const PageEntry& entry(const PageId& id);
  [[nodiscard]] static double value(Word word) { return from_ordered<Sample>(word); }
  [[nodiscard]] static bool crosses(std::uint32_t low, std::uint32_t high, double isovalue) {
    return low <= high && value(static_cast<Word>(low)) < isovalue &&
           isovalue <= value(static_cast<Word>(high));
  }

  /// The page of a level that was asked for last.
  struct Recent {
    PageId id{-1, {}};
    const Page<Word>* page = nullptr;
    PageId entry_id{-1, {}};
    PageEntry entry;
  };

  StoredPages<Word>& pages_;
  PageGrid grid_;
  int shift_;
  Domain domain_;
  std::vector<Recent> recent_;  ///< by level
  std::uint64_t generation_ = 0;
  std::array<double, kRanks> errors_{};
};

extern template class StoredDiamonds<std::uint8_t>;
extern template class StoredDiamonds<std::uint16_t>;
extern template class StoredDiamonds<std::int16_t>;
extern template class StoredDiamonds<float>;

}  // namespace adamas
