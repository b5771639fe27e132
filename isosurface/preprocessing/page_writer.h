#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <vector>

#include "isosurface/preprocessing/lod_values.h"
#include "isosurface/preprocessing/preprocess.h"
#include "isosurface/volume/samples.h"

namespace adamas::isosurface {

/// Makes pages of the LODs' values, as soon as these are final.
template <class Sample>
class PageWriter {
 public:
  using Word = OrderedWord<Sample>;
  using Lods = std::vector<LodValues<Word>>;

  PageWriter(const PageGrid& grid, Lods& lods, const CoarseSamples<Word>& coarse,
             const PageSink<Sample>& sink)
      : grid_(grid),
        lods_(lods),
        coarse_(coarse),
        sink_(sink),
        next_(lods.size(), 0),
        page_(std::make_unique<Page<Word>>()) {}

  /// Hands over the pages of an LOD whose planes are all among those up to `done`; not the coarsest page.
  void write(int lod, std::int32_t done) {
    if (lod >= grid_.top()) return;
    const LatticePoint blocks = grid_.blocks(lod);
    const std::int32_t last = grid_.extent(lod).k;
    std::int32_t& k = next_[static_cast<std::size_t>(lod)];
    for (; k < blocks.k && std::min(PageGrid::kSide * k + PageGrid::kSide - 1, last) <= done; ++k) {
      for (std::int32_t j = 0; j < blocks.j; ++j) {
        for (std::int32_t i = 0; i < blocks.i; ++i) {
          const PageId id{lod, {i, j, k}};
          if (grid_.contains(id)) write(id);
        }
      }
    }
  }

  /// Hands over the coarsest page, for which all values must be final.
  void write_coarsest() { write(PageId{grid_.top(), {0, 0, 0}}); }

 private:
  void write(const PageId& id) {
    const LatticePoint count = grid_.count(id);
    for (std::int32_t k = 0; k < count.k; ++k) {
      for (std::int32_t j = 0; j < count.j; ++j) {
        fill_samples(id, j, k, count.i);
        if (grid_.is_complete(id)) {
          for (std::int32_t i = 0; i < count.i; ++i) fill_point({i, j, k}, id.lod);
        } else {
          fill_bounds(id, j, k, count.i);
        }
      }
    }
    sink_(id, *page_);
  }

  static std::size_t place(LatticePoint q) { return PageGrid::place(q, 0); }

  void fill_samples(const PageId& id, std::int32_t j, std::int32_t k, std::int32_t count) {
    const LatticePoint p = PageGrid::kSide * id.block + LatticePoint{0, j, k};
    Word* to = page_->samples.data() + place({0, j, k});
    if (id.lod < CoarseSamples<Word>::kBits) {
      const LodValues<Word>& values = lods_[static_cast<std::size_t>(id.lod)];
      // Only the coarsest page reaches farther than its LOD; beyond lies what lies at the end.
      const LatticePoint end = values.size() - LatticePoint{1, 1, 1};
      const Word* from = values.samples(std::min(p.j, end.j), std::min(p.k, end.k));
      const std::int32_t there = std::min(count, end.i + 1 - p.i);
      std::copy_n(from + p.i, there, to);
      std::fill(to + there, to + count, from[end.i]);
    } else {
      for (std::int32_t i = 0; i < count; ++i)
        to[i] = coarse_.at((std::int32_t{1} << id.lod) * (p + LatticePoint{i, 0, 0}));
    }
  }

  /// Those of the points that the LOD adds, and anything at the others.
  void fill_bounds(const PageId& id, std::int32_t j, std::int32_t k, std::int32_t count) {
    const LatticePoint p = PageGrid::kSide * id.block + LatticePoint{0, j, k};
    const std::size_t at = place({0, j, k});
    LodValues<Word>& values = lods_[static_cast<std::size_t>(id.lod)];
    std::copy_n(values.low(p.j, p.k) + p.i, count, page_->low.data() + at);
    std::copy_n(values.high(p.j, p.k) + p.i, count, page_->high.data() + at);
    std::copy_n(values.codes(p.j, p.k) + p.i, count, page_->errors.data() + at);
  }

  /// Of the coarsest page, whose points belong to several LODs.
  void fill_point(LatticePoint q, int page_lod) {
    const std::size_t at = place(q);
    const int lod = page_lod + trailing_zeros(q);
    if (lod >= grid_.depth()) {
      fill_empty(at);
      return;
    }
    const int shift = lod - page_lod;
    const LatticePoint p{q.i >> shift, q.j >> shift, q.k >> shift};
    LodValues<Word>& values = lods_[static_cast<std::size_t>(lod)];
    // Other LODs of the page may reach farther.
    const LatticePoint size = values.size();
    if (p.i >= size.i || p.j >= size.j || p.k >= size.k) {
      fill_empty(at);
      return;
    }
    page_->low[at] = values.low(p.j, p.k)[p.i];
    page_->high[at] = values.high(p.j, p.k)[p.i];
    page_->errors[at] = values.codes(p.j, p.k)[p.i];
  }

  void fill_empty(std::size_t at) {
    page_->low[at] = LodValues<Word>::kGreatest;
    page_->high[at] = 0;
    page_->errors[at] = 0;
  }

  const PageGrid& grid_;
  Lods& lods_;
  const CoarseSamples<Word>& coarse_;
  const PageSink<Sample>& sink_;
  std::vector<std::int32_t> next_;  ///< row of pages along k, by LOD
  std::unique_ptr<Page<Word>> page_;
};

}  // namespace adamas::isosurface
