#include "isosurface/gradients/gradient_pages.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>

#include "core/base/parallel.h"
#include "core/base/unnamed_file.h"
#include "isosurface/gradients/plane_gradients.h"

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

namespace {

/// The rows [begin, end) of all planes.
struct Strip {
  std::size_t begin, end;
};

template <class Sample>
class CodeSmoother {
 public:
  CodeSmoother(const VolumeGrid& grid, const PlaneSource& planes, const GradientPageOptions& options,
               Progress& progress)
      : grid_(grid),
        planes_(planes),
        options_(options),
        progress_(progress),
        nx_(grid.dimensions[0]),
        ny_(grid.dimensions[1]) {}

  void run(const CodePlaneSink& sink) {
    for_each_plane("gradients", [this](std::span<const Gradient> plane) { scale_.add(plane); });
    const std::size_t rows = strip_rows();
    std::vector<OctahedralCode> codes(nx_ * ny_);
    if (rows >= ny_) {
      smooth({0, ny_}, codes, [&](std::uint64_t) { sink(codes); });
      return;
    }
    ScratchFile file(options_.scratch);
    const auto place = [this](std::uint64_t k, std::size_t j) {
      return (k * ny_ + j) * nx_ * sizeof(OctahedralCode);
    };
    for (std::size_t j = 0; j < ny_; j += rows) {
      const Strip strip{j, std::min(ny_, j + rows)};
      const std::span part = std::span(codes).first((strip.end - j) * nx_);
      smooth(strip, part, [&](std::uint64_t k) { file.write(place(k, j), std::as_bytes(part)); });
    }
    for (std::uint64_t k = 0; k < grid_.dimensions[2]; ++k) {
      file.read(place(k, 0), std::as_writable_bytes(std::span(codes)));
      sink(codes);
    }
  }

 private:
  [[nodiscard]] std::size_t strip_rows() const {
    const std::size_t fit = options_.memory / (SmoothingRounds::bytes(*options_.smoothing) * nx_);
    const std::size_t beside = options_.smoothing->rounds();
    if (fit >= ny_) return ny_;
    return fit > 3 * beside ? fit - 2 * beside : std::max<std::size_t>(beside, 1);
  }

  template <class Fn>
  void for_each_plane(const char* stage, Fn&& fn) {
    std::vector<Gradient> plane(nx_ * ny_);
    const PlaneGradients gradients(grid_.spacing, nx_, ny_);
    for_each_three_planes<Sample>(
        grid_, planes_, stage,
        [&](const std::array<const Sample*, 3>& three) {
          gradients(three, std::span(plane));
          for (Gradient& g : plane) {
            for (float& component : g)
              component = std::clamp(component, -kGreatestGradient, kGreatestGradient);
          }
          fn(std::span<const Gradient>(plane));
        },
        progress_);
  }

  /// Calls done(k) when `codes` has a strip's rows of plane k.
  template <class Fn>
  void smooth(const Strip& strip, std::span<OctahedralCode> codes, Fn&& done) {
    const std::size_t beside = options_.smoothing->rounds();
    const std::size_t first = strip.begin - std::min(strip.begin, beside),
                      last = std::min(ny_, strip.end + beside);
    std::uint64_t k = 0;
    GradientSmoother smoother(
        scale_, nx_, last - first, *options_.smoothing, [&](std::span<const Gradient> plane) {
          const std::span own = plane.subspan((strip.begin - first) * nx_, codes.size());
          parallel_chunks(own.size(), std::size_t{1} << 14, [&](std::size_t begin, std::size_t end) {
            encode_octahedral(own.subspan(begin, end - begin), codes.subspan(begin, end - begin));
          });
          done(k++);
        });
    for_each_plane("smoothing gradients", [&](std::span<const Gradient> plane) {
      smoother.add(plane.subspan(first * nx_, (last - first) * nx_));
    });
    smoother.finish();
  }

  const VolumeGrid& grid_;
  const PlaneSource& planes_;
  const GradientPageOptions& options_;
  Progress& progress_;
  std::size_t nx_, ny_;
  GradientScale scale_;
};

}  // namespace

template <class Sample>
void smoothed_codes(const VolumeGrid& grid, const PlaneSource& planes, const GradientPageOptions& options,
                    const CodePlaneSink& sink, Progress& progress) {
  CodeSmoother<Sample>(grid, planes, options, progress).run(sink);
}

ADAMAS_INSTANTIATE_FUNCTION_FOR_SAMPLES(smoothed_codes);

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
