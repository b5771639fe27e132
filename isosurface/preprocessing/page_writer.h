#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <vector>

#include "isosurface/preprocessing/coarse_samples.h"
#include "isosurface/preprocessing/level_values.h"
#include "isosurface/preprocessing/preprocess.h"
#include "isosurface/volume/samples.h"

namespace adamas {

/// Makes pages of the levels' values, as soon as these are final.
template <class Sample>
class PageWriter {
 public:
  using Word = OrderedWord<Sample>;
  using Levels = std::vector<LevelValues<Word>>;

  PageWriter(const PageGrid& grid, int subtree_depth, Levels& levels, const CoarseSamples<Word>& coarse,
             const PageSink<Sample>& sink)
      : grid_(grid),
        subtree_depth_(subtree_depth),
        levels_(levels),
        coarse_(coarse),
        sink_(sink),
        next_(levels.size(), 0),
        page_(std::make_unique<Page<Word>>()) {}

  /// Hands over the pages of a level whose planes are all among those up to `done`; not the coarsest page.
  void write(int level, std::int32_t done) {
    if (level >= grid_.top()) return;
    const LatticePoint blocks = grid_.blocks(level);
    const std::int32_t last = grid_.extent(level).k;
    std::int32_t& k = next_[static_cast<std::size_t>(level)];
    for (; k < blocks.k && std::min(PageGrid::kSide * k + PageGrid::kSide - 1, last) <= done; ++k) {
      for (std::int32_t j = 0; j < blocks.j; ++j) {
        for (std::int32_t i = 0; i < blocks.i; ++i) {
          const PageId id{level, {i, j, k}};
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
          for (std::int32_t i = 0; i < count.i; ++i) fill_point({i, j, k}, id.level);
        } else {
          fill_values(id, j, k, count.i);
        }
      }
    }
    sink_(id, *page_);
  }

  static std::size_t place(LatticePoint q) { return PageGrid::place(q, 0); }

  void fill_samples(const PageId& id, std::int32_t j, std::int32_t k, std::int32_t count) {
    const LatticePoint p = PageGrid::kSide * id.block + LatticePoint{0, j, k};
    Word* to = page_->samples.data() + place({0, j, k});
    if (id.level < CoarseSamples<Word>::kBits) {
      const LevelValues<Word>& values = levels_[static_cast<std::size_t>(id.level)];
      // Only the coarsest page reaches farther than its level; beyond lies what lies at the end.
      const LatticePoint end = values.size() - LatticePoint{1, 1, 1};
      const Word* from = values.samples(std::min(p.j, end.j), std::min(p.k, end.k));
      const std::int32_t there = std::min(count, end.i + 1 - p.i);
      std::copy_n(from + p.i, there, to);
      std::fill(to + there, to + count, from[end.i]);
    } else {
      for (std::int32_t i = 0; i < count; ++i)
        to[i] = coarse_.at((std::int32_t{1} << id.level) * (p + LatticePoint{i, 0, 0}));
    }
  }

  /// Those of the points that the level adds, and anything at the others.
  void fill_values(const PageId& id, std::int32_t j, std::int32_t k, std::int32_t count) {
    const LatticePoint p = PageGrid::kSide * id.block + LatticePoint{0, j, k};
    const std::size_t at = place({0, j, k});
    if (id.level < subtree_depth_) {
      for (std::int32_t i = 0; i < count; ++i) fill_empty(at + static_cast<std::size_t>(i));
      return;
    }
    LevelValues<Word>& values = levels_[static_cast<std::size_t>(id.level)];
    std::copy_n(values.low(p.j, p.k) + p.i, count, page_->low.data() + at);
    std::copy_n(values.high(p.j, p.k) + p.i, count, page_->high.data() + at);
    std::copy_n(values.codes(3 * subtree_depth_, p.j, p.k) + p.i, count, page_->errors.data() + at);
  }

  /// Of the coarsest page, whose points belong to several levels.
  void fill_point(LatticePoint q, int page_level) {
    const std::size_t at = place(q);
    const int level = page_level + trailing_zeros(q);
    if (level >= grid_.depth() || level < subtree_depth_) {
      fill_empty(at);
      return;
    }
    const int shift = level - page_level;
    const LatticePoint p{q.i >> shift, q.j >> shift, q.k >> shift};
    LevelValues<Word>& values = levels_[static_cast<std::size_t>(level)];
    // Other levels of the page may reach farther.
    const LatticePoint size = values.size();
    if (p.i >= size.i || p.j >= size.j || p.k >= size.k) {
      fill_empty(at);
      return;
    }
    page_->low[at] = values.low(p.j, p.k)[p.i];
    page_->high[at] = values.high(p.j, p.k)[p.i];
    page_->errors[at] = values.codes(3 * subtree_depth_, p.j, p.k)[p.i];
  }

  void fill_empty(std::size_t at) {
    page_->low[at] = LevelValues<Word>::kGreatest;
    page_->high[at] = 0;
    page_->errors[at] = 0;
  }

  const PageGrid& grid_;
  int subtree_depth_;
  Levels& levels_;
  const CoarseSamples<Word>& coarse_;
  const PageSink<Sample>& sink_;
  std::vector<std::int32_t> next_;  ///< row of pages along k, by level
  std::unique_ptr<Page<Word>> page_;
};

}  // namespace adamas
