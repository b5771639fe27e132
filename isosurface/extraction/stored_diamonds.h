#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/lattice/diamond.h"
#include "core/lattice/domain.h"
#include "isosurface/storage/stored_pages.h"
#include "isosurface/volume/error_scale.h"
#include "isosurface/volume/samples.h"

namespace adamas {

/// A page that is needed cannot be had, since a page is damaged: it itself or one that it is predicted from.
struct PageLost {
  PageId page, damaged;
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
  /// The spacing of samples in space.
  [[nodiscard]] Vec3 spacing() const { return std::ldexp(1.0, -grid_.depth()) * domain_.box().size(); }
  /// The lattice point of the last sample.
  [[nodiscard]] LatticePoint last_sample() const { return (1 << shift_) * grid_.last(); }
  /// Lods of samples; diamonds of LODs below this have errors.
  [[nodiscard]] int lods() const { return grid_.depth(); }
  /// The LOD of a lattice point in the store: coordinates in samples are multiples of 2^lod.
  [[nodiscard]] int lod(LatticePoint p) const { return trailing_zeros(p) - shift_; }
  /// How many lattice units there are between points of an LOD.
  [[nodiscard]] std::int32_t lattice_step(int lod) const { return std::int32_t{1} << (lod + shift_); }
  [[nodiscard]] LatticePoint in_samples(LatticePoint p) const {
    return {p.i >> shift_, p.j >> shift_, p.k >> shift_};
  }
  /// Whether pages know of the diamond: its point is no corner of the cube, and it reaches into the data.
  [[nodiscard]] bool is_stored(LatticePoint p) const {
    const int l = lod(p);
    if (l < 0 || l >= grid_.depth()) return false;
    // The coarsest page has points of its LOD whose diamonds lie wholly outside.
    const LatticePoint e = reaches_[static_cast<std::size_t>(l)], s = in_samples(p);
    return s.i <= e.i && s.j <= e.j && s.k <= e.k;
  }

  /// Of a page; valid until the next one is asked for. Throws PageLost.
  const PagePoints<Word>& samples(const PageId& id) {
    const PageSamples<Word>* found = pages_.samples(id);
    if (found == nullptr) throw PageLost{id, pages_.last_damaged()};
    return found->samples;
  }
  /// Null where the page is not in memory. Valid until the next one is asked for.
  const PageSamples<Word>* held_samples(const PageId& id) { return pages_.held(id); }

  /// The sample at a lattice point; beyond the data the nearest one. Throws PageLost.
  double sample(LatticePoint p) { return value(word(in_samples(p))); }
  /// The same at a point in samples.
  Word word(LatticePoint at) {
    // Points farther out than the virtual ones of their LOD have the values of those: no finer page than
    // theirs is needed.
    const int l = std::min(trailing_zeros(at), PageGrid::kMaxDepth + 1);
    const LatticePoint end = ends_[static_cast<std::size_t>(l)];
    for (int axis = 0; axis < 3; ++axis) at[axis] = std::min(at[axis], end[axis]);
    const PageId id = grid_.page(at);
    return samples(id)[PageGrid::place(at, id.lod)];
  }

  /// The samples, as words, at a lattice point and its 26 neighbours `step` lattice units away, i running
  /// fastest, as far as it is quick: false where they are not all on one page in memory.
  bool samples_round(LatticePoint p, std::int32_t step, std::array<Word, 27>& samples);

  /// Errors by rank: 0 is none, and each rank is an error 2^(1/4) times that of the one before.
  static constexpr int kRanks = ErrorScale::kCodes + 4 * PageGrid::kMaxDepth;
  /// Units of length.
  [[nodiscard]] double error(int rank) const { return errors_[static_cast<std::size_t>(rank)]; }
  /// The greatest rank whose error is not greater.
  [[nodiscard]] int rank_within(double error) const;

  /// Which contour what follows is for.
  void set_contour(double isovalue);
  /// Whether a sample is not below the isovalue.
  [[nodiscard]] bool is_above(Word word) const { return word >= least_above_; }
  /// Of a stored diamond: the rank of its error where the contour may cross it, 0 where it does not. Throws
  /// PageLost.
  int rank_if_crossed(LatticePoint p);
  /// No diamond of the page that the contour crosses has a greater rank; 0 where it crosses none. Not for the
  /// coarsest page, which has diamonds of several LODs. Throws PageLost.
  int greatest_rank(const PageId& id);
  /// Of a page's diamonds: the error codes of those that the contour crosses, 0 of the others.
  using Codes = PagePoints<std::uint8_t>;
  /// Throws PageLost.
  void find_crossed(const PageId& id, Codes& codes);
  /// The page, or all, will hardly be asked again for what diamonds are like.
  void drop_bounds(const PageId& id) { pages_.drop_bounds(id); }
  void drop_bounds() { pages_.drop_bounds(); }

  [[nodiscard]] static double value(Word word) { return from_ordered<Sample>(word); }

  /// The least and the greatest finite sample; the first greater where there is none. Throws PageLost.
  std::array<double, 2> range();

 private:
  const PageEntry& entry(const PageId& id);
  const PageBounds<Word>& values(const PageId& id) {
    const PageBounds<Word>* found = pages_.values(id);
    if (found == nullptr) throw PageLost{id, pages_.last_damaged()};
    return *found;
  }
  /// The contour crosses what has a range with low < least_above_ <= high, as ordered words.
  [[nodiscard]] bool crosses(std::uint32_t low, std::uint32_t high) const {
    return low <= high && low < least_above_ && least_above_ <= high;
  }

  /// The entry of an LOD that was asked for last.
  struct RecentEntry {
    PageId id{-1, {}};
    PageEntry entry;
  };

  StoredPages<Word>& pages_;
  PageGrid grid_;
  int shift_;
  Domain domain_;
  std::array<LatticePoint, PageGrid::kMaxDepth + 2> ends_{};  ///< by LOD: the last point, in samples
  /// The same of those whose diamonds reach into the data.
  std::array<LatticePoint, PageGrid::kMaxDepth + 2> reaches_{};
  std::vector<RecentEntry> recent_;  ///< by LOD
  std::uint64_t least_above_ = 0;    ///< the least ordered word of a value not below the isovalue
  std::array<double, kRanks> errors_{};
};

extern template class StoredDiamonds<std::uint8_t>;
extern template class StoredDiamonds<std::uint16_t>;
extern template class StoredDiamonds<std::int16_t>;
extern template class StoredDiamonds<float>;

}  // namespace adamas
