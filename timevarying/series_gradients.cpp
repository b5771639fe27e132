#include "timevarying/series_gradients.h"

#include <algorithm>
#include <array>
#include <vector>

#include "core/base/parallel.h"
#include "isosurface/gradients/plane_gradients.h"
#include "timevarying/series_smoothing.h"

namespace adamas::timevarying {

using namespace isosurface;

namespace {

/// The rows [begin, end) of all planes.
struct Rows {
  std::size_t begin, end;
};

/// The gradients of some rows of one step, plane by plane.
template <class Sample>
class RowGradients {
 public:
  RowGradients(const VolumeGrid& grid, const RowSource& source, const Rows& rows)
      : nx_(grid.dimensions[0]),
        nz_(grid.dimensions[2]),
        source_(source),
        rows_(rows),
        // One more row on either side is needed for the differences.
        around_{rows.begin - std::min<std::size_t>(rows.begin, 1),
                std::min<std::size_t>(grid.dimensions[1], rows.end + 1)},
        gradients_(grid.spacing, nx_, around_.end - around_.begin) {
    for (auto& plane : samples_) plane.resize((around_.end - around_.begin) * nx_);
    read(0);
  }

  /// The gradients of the next plane, which are stored in `buffer`.
  std::span<const Gradient> next(std::vector<Gradient>& buffer) {
    if (k_ + 1 < nz_) read(k_ + 1);
    const auto plane = [this](std::uint64_t k) { return samples_[k % 3].data(); };
    buffer.resize(samples_[0].size());
    gradients_(std::array<const Sample*, 3>{k_ > 0 ? plane(k_ + 2) : nullptr, plane(k_),
                                            k_ + 1 < nz_ ? plane(k_ + 1) : nullptr},
               std::span(buffer));
    ++k_;
    for (Gradient& g : buffer) {
      for (float& component : g) component = std::clamp(component, -kGreatestGradient, kGreatestGradient);
    }
    return std::span(buffer).subspan((rows_.begin - around_.begin) * nx_, (rows_.end - rows_.begin) * nx_);
  }

 private:
  void read(std::uint64_t k) {
    source_(k, around_.begin, std::as_writable_bytes(std::span(samples_[k % 3])));
  }

  std::size_t nx_;
  std::uint64_t nz_, k_ = 0;
  const RowSource& source_;
  Rows rows_, around_;
  PlaneGradients gradients_;
  std::array<std::vector<Sample>, 3> samples_;  ///< plane k lies at k % 3
};

template <class Sample>
class SeriesCodes {
 public:
  SeriesCodes(const VolumeGrid& grid, std::span<const RowSource> steps, const GradientPageOptions& options,
              ScratchFile& file, Progress& progress)
      : grid_(grid), steps_(steps), options_(options), file_(file), progress_(progress) {}

  void run() {
    const std::size_t ny = grid_.dimensions[1];
    for (std::size_t n = 0; n < steps_.size(); ++n) {
      progress_.step("gradients", static_cast<double>(n) / static_cast<double>(steps_.size()));
      RowGradients<Sample> gradients(grid_, steps_[n], {0, ny});
      GradientScale& scale = scales_.emplace_back();
      for (std::uint64_t k = 0; k < grid_.dimensions[2]; ++k) scale.add(gradients.next(buffer_));
    }
    const std::size_t rows = strip_rows();
    for (std::size_t j = 0; j < ny; j += rows) smooth({j, std::min(ny, j + rows)});
  }

 private:
  /// The number of rows that are smoothed together.
  [[nodiscard]] std::size_t strip_rows() const {
    const std::size_t each = SmoothingRounds::bytes(*options_.smoothing) + 3 * sizeof(Sample);
    const std::size_t fit = options_.memory / (each * grid_.dimensions[0] * steps_.size());
    const std::size_t beside = options_.smoothing->rounds();
    if (fit >= grid_.dimensions[1]) return grid_.dimensions[1];
    return fit > 3 * beside ? fit - 2 * beside : std::max<std::size_t>(beside, 1);
  }

  void smooth(const Rows& strip) {
    const std::size_t nx = grid_.dimensions[0], beside = options_.smoothing->rounds();
    const Rows all{strip.begin - std::min(strip.begin, beside),
                   std::min<std::size_t>(grid_.dimensions[1], strip.end + beside)};
    std::vector<OctahedralCode> codes((strip.end - strip.begin) * nx);
    std::uint64_t k = 0;
    const auto take = [&](std::span<const std::span<const Gradient>> planes) {
      for (std::size_t n = 0; n < planes.size(); ++n) {
        const std::span own = planes[n].subspan((strip.begin - all.begin) * nx, codes.size());
        parallel_chunks(own.size(), std::size_t{1} << 14, [&](std::size_t begin, std::size_t end) {
          encode_octahedral(own.subspan(begin, end - begin), std::span(codes).subspan(begin, end - begin));
        });
        file_.write(CodePlaces{grid_}(n, k, strip.begin), std::as_bytes(std::span(codes)));
      }
      ++k;
    };
    SeriesSmoother smoother(scales_, nx, all.end - all.begin, *options_.smoothing, take);
    std::vector<RowGradients<Sample>> gradients;
    for (const RowSource& step : steps_) gradients.emplace_back(grid_, step, all);
    for (std::uint64_t plane = 0; plane < grid_.dimensions[2]; ++plane) {
      const double part = static_cast<double>(plane) / static_cast<double>(grid_.dimensions[2]);
      progress_.step("smoothing gradients", (static_cast<double>(strip.begin) +
                                             part * static_cast<double>(strip.end - strip.begin)) /
                                                static_cast<double>(grid_.dimensions[1]));
      for (RowGradients<Sample>& step : gradients) smoother.add(step.next(buffer_));
    }
    smoother.finish();
  }

  const VolumeGrid& grid_;
  std::span<const RowSource> steps_;
  const GradientPageOptions& options_;
  ScratchFile& file_;
  Progress& progress_;
  std::vector<GradientScale> scales_;  ///< scale of each step
  std::vector<Gradient> buffer_;       ///< gradients of one plane of a step
};

}  // namespace

template <class Sample>
void series_codes(const VolumeGrid& grid, std::span<const RowSource> steps,
                  const GradientPageOptions& options, ScratchFile& file, Progress& progress) {
  SeriesCodes<Sample>(grid, steps, options, file, progress).run();
}

template <class Sample>
void series_gradient_pages(const VolumeGrid& grid, std::span<const RowSource> steps,
                           const SeriesGradientSink& sink, const GradientPageOptions& options,
                           Progress& progress) {
  ScratchFile file(options.scratch);
  series_codes<Sample>(grid, steps, options, file, progress);
  std::vector<OctahedralCode> codes(grid.plane_samples());
  for (std::size_t n = 0; n < steps.size(); ++n) {
    CodePages pages(grid);
    for (std::uint64_t k = 0; k < grid.dimensions[2]; ++k) {
      file.read(CodePlaces{grid}(n, k, 0), std::as_writable_bytes(std::span(codes)));
      pages.add(codes, [&](const PageId& id, const Page<std::uint16_t>& page) { sink(n, id, page); });
    }
  }
}

template void series_codes<std::uint8_t>(const VolumeGrid&, std::span<const RowSource>,
                                         const GradientPageOptions&, ScratchFile&, Progress&);
template void series_codes<std::uint16_t>(const VolumeGrid&, std::span<const RowSource>,
                                          const GradientPageOptions&, ScratchFile&, Progress&);
template void series_codes<std::int16_t>(const VolumeGrid&, std::span<const RowSource>,
                                         const GradientPageOptions&, ScratchFile&, Progress&);
template void series_codes<float>(const VolumeGrid&, std::span<const RowSource>, const GradientPageOptions&,
                                  ScratchFile&, Progress&);

template void series_gradient_pages<std::uint8_t>(const VolumeGrid&, std::span<const RowSource>,
                                                  const SeriesGradientSink&, const GradientPageOptions&,
                                                  Progress&);
template void series_gradient_pages<std::uint16_t>(const VolumeGrid&, std::span<const RowSource>,
                                                   const SeriesGradientSink&, const GradientPageOptions&,
                                                   Progress&);
template void series_gradient_pages<std::int16_t>(const VolumeGrid&, std::span<const RowSource>,
                                                  const SeriesGradientSink&, const GradientPageOptions&,
                                                  Progress&);
template void series_gradient_pages<float>(const VolumeGrid&, std::span<const RowSource>,
                                           const SeriesGradientSink&, const GradientPageOptions&, Progress&);

}  // namespace adamas::timevarying
