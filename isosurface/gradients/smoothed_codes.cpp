#include "isosurface/gradients/smoothed_codes.h"

#include <algorithm>
#include <cstdint>
#include <span>

#include "core/base/parallel.h"
#include "core/base/unnamed_file.h"
#include "isosurface/gradients/plane_gradients.h"

namespace adamas::isosurface {

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
  /// Returns the number of rows that are smoothed at a time.
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

}  // namespace adamas::isosurface
