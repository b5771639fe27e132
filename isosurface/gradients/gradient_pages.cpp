#include "isosurface/gradients/gradient_pages.h"

#include <algorithm>
#include <array>

#include "isosurface/gradients/plane_gradients.h"
#include "isosurface/gradients/smoothed_codes.h"

namespace adamas::isosurface {

/// Planes of codes of one LOD, which are collected until there are as many as pages are thick.
class CodePages::LodCodes {
 public:
  LodCodes(const PageGrid& grid, int lod)
      : grid_(grid),
        lod_(lod),
        extent_(grid.extent(lod)),
        row_(static_cast<std::size_t>(extent_.i) + 1),
        plane_(row_ * (static_cast<std::size_t>(extent_.j) + 1)),
        codes_(plane_ * static_cast<std::size_t>(std::min(extent_.k + 1, PageGrid::kSide))) {}

  /// Adds the LOD's points of plane k of the samples, and hands over the pages that are complete then. The
  /// last plane stands for all behind it.
  void add(std::int32_t k, const std::vector<OctahedralCode>& codes, Page<std::uint16_t>& page,
           const GradientPageSink& sink) {
    for (; next_ <= extent_.k && std::min(next_ << lod_, grid_.last().k) == k; ++next_) {
      take(codes);
      if (next_ % PageGrid::kSide == PageGrid::kSide - 1 || next_ == extent_.k) {
        for_each_page([&](const PageId& id) {
          fill(id, page);
          sink(id, page);
        });
      }
    }
  }

 private:
  void take(const std::vector<OctahedralCode>& codes) {
    const auto width = static_cast<std::size_t>(grid_.last().i) + 1;
    std::uint16_t* to = codes_.data() + plane_ * static_cast<std::size_t>(next_ % PageGrid::kSide);
    for (std::int32_t j = 0; j <= extent_.j; ++j) {
      const auto y = static_cast<std::size_t>(std::min(j << lod_, grid_.last().j));
      for (std::int32_t i = 0; i <= extent_.i; ++i) {
        const auto [first, second] =
            codes[y * width + static_cast<std::size_t>(std::min(i << lod_, grid_.last().i))];
        *to++ = static_cast<std::uint16_t>(first | second << 8);
      }
    }
  }

  template <class Fn>
  void for_each_page(Fn&& fn) const {
    const LatticePoint blocks = grid_.blocks(lod_);
    for (std::int32_t j = 0; j < blocks.j; ++j) {
      for (std::int32_t i = 0; i < blocks.i; ++i) {
        const PageId id{lod_, {i, j, next_ / PageGrid::kSide}};
        if (grid_.contains(id)) fn(id);
      }
    }
  }

  void fill(const PageId& id, Page<std::uint16_t>& page) const {
    const LatticePoint count = grid_.count(id);
    for (std::int32_t k = 0; k < count.k; ++k) {
      for (std::int32_t j = 0; j < count.j; ++j) {
        const std::size_t from = static_cast<std::size_t>(PageGrid::kSide * id.block.i) +
                                 row_ * static_cast<std::size_t>(PageGrid::kSide * id.block.j + j) +
                                 plane_ * static_cast<std::size_t>(k);
        std::copy_n(codes_.data() + from, count.i, page.samples.data() + PageGrid::place({0, j, k}, 0));
      }
    }
  }

  const PageGrid& grid_;
  int lod_;
  LatticePoint extent_;
  std::size_t row_, plane_;
  std::vector<std::uint16_t> codes_;
  std::int32_t next_ = 0;  ///< the LOD's plane that is added next
};

CodePages::CodePages(const VolumeGrid& grid) : grid_(grid.dimensions) {
  for (int lod = 0; lod <= grid_.top(); ++lod) lods_.emplace_back(grid_, lod);
}
CodePages::~CodePages() = default;

void CodePages::add(const std::vector<OctahedralCode>& codes, const GradientPageSink& sink) {
  for (LodCodes& lod : lods_) lod.add(next_, codes, *page_, sink);
  ++next_;
}

template <class Sample>
void gradient_pages(const VolumeGrid& grid, const PlaneSource& planes, const GradientPageSink& sink,
                    const GradientPageOptions& options, Progress& progress) {
  CodePages pages(grid);
  const auto take = [&](const std::vector<OctahedralCode>& codes) { pages.add(codes, sink); };
  if (options.smoothing) {
    smoothed_codes<Sample>(grid, planes, options, take, progress);
    return;
  }
  std::vector<OctahedralCode> codes(grid.plane_samples());
  const PlaneGradients gradients(grid.spacing, grid.dimensions[0], grid.dimensions[1]);
  for_each_three_planes<Sample>(
      grid, planes, "gradients",
      [&](const std::array<const Sample*, 3>& three) {
        gradients(three, std::span(codes));
        take(codes);
      },
      progress);
}

ADAMAS_INSTANTIATE_FUNCTION_FOR_SAMPLES(gradient_pages);

}  // namespace adamas::isosurface
