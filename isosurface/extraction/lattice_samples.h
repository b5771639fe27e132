#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "core/lattice/diamond.h"
#include "core/lattice/domain.h"
#include "isosurface/contour/contour.h"
#include "isosurface/storage/stored_pages.h"
#include "isosurface/volume/samples.h"

namespace adamas::isosurface {

/// The samples of a store as values at the points of the lattice whose diamonds make the meshes of surfaces.
/// The lattice's domain is the least cube of 2^n samples per side that contains the data; it may extend
/// beyond them.
template <class Sample>
class LatticeSamples {
 public:
  using Word = OrderedWord<Sample>;

  /// Makes the lattice of these pages, which must outlive this.
  explicit LatticeSamples(StoredPages<Word>& pages);

  [[nodiscard]] StoredPages<Word>& pages() const { return *pages_; }
  /// Changes to the pages of another step of the same store.
  void set_pages(StoredPages<Word>& pages) { pages_ = &pages; }
  [[nodiscard]] const PageGrid& grid() const { return grid_; }
  [[nodiscard]] const Domain& domain() const { return domain_; }
  /// Returns the diamond of the mesh in which nothing is split.
  [[nodiscard]] static Diamond root() {
    const std::int32_t middle = std::int32_t{1} << (kRootBits - 1);
    return Diamond({middle, middle, middle});
  }
  /// Returns the box from the first sample to the last, in the frame.
  [[nodiscard]] Box3 data_box() const { return {domain_.box().min, domain_.position(last_sample())}; }
  /// Returns the spacing of samples in space.
  [[nodiscard]] Vec3 spacing() const { return std::ldexp(1.0, -grid_.depth()) * domain_.box().size(); }
  [[nodiscard]] LatticePoint last_sample() const { return (1 << shift_) * grid_.last(); }
  /// Returns the number of LODs whose points are points of diamonds; those of coarser LODs are corners of the
  /// domain.
  [[nodiscard]] int lods() const { return grid_.depth(); }
  /// Returns the LOD of a lattice point: its coordinates in samples are multiples of 2^lod. Negative between
  /// samples.
  [[nodiscard]] int lod(LatticePoint p) const { return trailing_zeros(p) - shift_; }
  /// Returns whether the diamond of a lattice point is one of the domain and extends into the data.
  [[nodiscard]] bool reaches_data(LatticePoint p) const {
    return domain_.contains(p) && !is_beyond(Diamond(p), last_sample());
  }
  /// Returns the generation of an LOD's diamonds of phase 0, see SurfaceCut; those of the other phases
  /// follow.
  [[nodiscard]] int generation(int lod) const { return 3 * (lods() - 1 - lod); }
  /// Returns the page of an LOD's points; for LODs that are coarser than the coarsest page's own, that page.
  [[nodiscard]] PageId page_id(int lod, LatticePoint block) const {
    return {std::min(lod, grid_.top()), block};
  }
  /// The page of a point, which must not lie between samples, and its place there.
  struct Place {
    int lod;
    LatticePoint block;    ///< the block of the page of this LOD
    LatticePoint on_page;  ///< in units of the LOD, counted from the page's first point
  };
  [[nodiscard]] Place place(LatticePoint p) const {
    constexpr std::int32_t kSide = PageGrid::kSide;
    const int l = lod(p);
    const LatticePoint s = in_samples(p), u{s.i >> l, s.j >> l, s.k >> l};
    return {l, {u.i / kSide, u.j / kSide, u.k / kSide}, {u.i % kSide, u.j % kSide, u.k % kSide}};
  }
  /// Returns the number of lattice units between points of an LOD.
  [[nodiscard]] std::int32_t lattice_step(int lod) const { return std::int32_t{1} << (lod + shift_); }
  [[nodiscard]] LatticePoint in_samples(LatticePoint p) const {
    return {p.i >> shift_, p.j >> shift_, p.k >> shift_};
  }

  /// Returns the sample at a lattice point; beyond the data that of the nearest one. Throws PageLost.
  double sample(LatticePoint p) { return value(word(in_samples(p))); }
  /// Returns the word of the sample at a point in units of samples. Throws PageLost.
  Word word(LatticePoint at) {
    // Points beyond the virtual ones of their LOD have the samples of these, so no finer page is needed.
    const int l = std::min(trailing_zeros(at), PageGrid::kMaxDepth + 1);
    const LatticePoint end = ends_[static_cast<std::size_t>(l)];
    for (int axis = 0; axis < 3; ++axis) at[axis] = std::min(at[axis], end[axis]);
    const PageId id = grid_.page(at);
    if (!pages_->loads()) return word_in_memory(at, id);
    return pages_->needed_samples(id).samples[PageGrid::place(at, id.lod)];
  }
  /// The words of a sample and of its 26 neighbours, i running fastest.
  using Block = std::array<Word, 27>;
  /// Copies the samples at a lattice point and at its 26 neighbours `step` lattice units away. Returns false
  /// where pages of one LOD that are in memory do not have them all.
  bool samples_round(LatticePoint p, std::int32_t step, Block& samples);

  [[nodiscard]] static double value(Word word) { return from_ordered<Sample>(word); }

 private:
  /// Returns the word at a point where nothing is loaded, from any page in memory that has the point. Throws
  /// PageLost for the point's own page where there is no such page.
  Word word_in_memory(LatticePoint at, const PageId& own);
  bool block_of_page(const PageId& id, LatticePoint first, Block& samples);
  bool block_of_pages(const PageId& id, LatticePoint first, Block& samples);

  StoredPages<Word>* pages_;
  PageGrid grid_;
  int shift_;  ///< 2^shift lattice units are the spacing of samples
  Domain domain_;
  std::array<LatticePoint, PageGrid::kMaxDepth + 2> ends_{};  ///< the last point of each LOD, in samples
};

}  // namespace adamas::isosurface
