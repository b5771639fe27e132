#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "isosurface/compression/sample_codec.h"
#include "isosurface/volume/page.h"
#include "isosurface/volume/page_grid.h"

namespace adamas::test {

using namespace isosurface;

/// What a codec of samples is given of a page.
template <class Word>
struct PageContent {
  PageShape shape;
  typename SampleCodec<Word>::Around around;
  typename SampleCodec<Word>::Samples samples;
};

/// A volume in memory and its pages, made directly from their definitions.
template <class Word>
class VolumePages {
 public:
  using Content = PageContent<Word>;

  /// Takes one sample per point, i running fastest.
  VolumePages(const std::array<std::uint64_t, 3>& dimensions, std::vector<Word> samples)
      : grid_(dimensions), dimensions_(dimensions), samples_(std::move(samples)) {
    for (int lod = grid_.top(); lod >= 0; --lod) {
      const LatticePoint n = grid_.blocks(lod);
      for (std::int32_t k = 0; k < n.k; ++k)
        for (std::int32_t j = 0; j < n.j; ++j)
          for (std::int32_t i = 0; i < n.i; ++i) {
            const PageId page{lod, {i, j, k}};
            if (grid_.contains(page)) pages_.push_back(page);
          }
    }
  }

  [[nodiscard]] const PageGrid& grid() const { return grid_; }
  [[nodiscard]] const std::vector<PageId>& pages() const { return pages_; }
  [[nodiscard]] std::size_t bytes() const { return samples_.size() * sizeof(Word); }

  /// Returns the sample at a point; at a virtual point, the nearest sample.
  [[nodiscard]] Word at(LatticePoint p) const {
    const LatticePoint last = grid_.last();
    const auto i = static_cast<std::size_t>(std::min(p.i, last.i));
    const auto j = static_cast<std::size_t>(std::min(p.j, last.j));
    const auto k = static_cast<std::size_t>(std::min(p.k, last.k));
    return samples_[i + dimensions_[0] * (j + dimensions_[1] * k)];
  }

  /// Fills a page's content; samples are `unused` where there is no point.
  void content(const PageId& page, Content& result, Word unused = 0) const {
    const LatticePoint end = grid_.extent(page.lod);
    const auto point = [&](LatticePoint q) {
      LatticePoint p{};
      for (int axis = 0; axis < 3; ++axis) {
        const std::int32_t at = PageGrid::kSide * page.block[axis] + q[axis];
        // The points of the surroundings belong to the next coarser LOD, and end where it does.
        const std::int32_t greatest = (q[axis] & 1) == 0 ? (end[axis] + 1) / 2 * 2 : end[axis];
        p[axis] = std::clamp(at, 0, greatest) * (1 << page.lod);
      }
      return p;
    };
    result.shape = {grid_.count(page), grid_.is_complete(page), page.lod};
    const LatticePoint n = result.shape.count;
    for (std::int32_t k = 0; k < PageGrid::kSide; ++k)
      for (std::int32_t j = 0; j < PageGrid::kSide; ++j)
        for (std::int32_t i = 0; i < PageGrid::kSide; ++i) {
          const bool inside = i < n.i && j < n.j && k < n.k;
          result.samples[PageGrid::place({i, j, k}, 0)] = inside ? at(point({i, j, k})) : unused;
        }
    for (std::int32_t k = -2; k <= 18; k += 2)
      for (std::int32_t j = -2; j <= 18; j += 2)
        for (std::int32_t i = -2; i <= 18; i += 2) {
          result.around[surrounding_place({i, j, k})] = at(point({i, j, k}));
        }
  }

 private:
  PageGrid grid_;
  std::array<std::uint64_t, 3> dimensions_;
  std::vector<Word> samples_;
  std::vector<PageId> pages_;
};

}  // namespace adamas::test
