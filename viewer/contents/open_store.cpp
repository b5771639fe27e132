#include "viewer/contents/open_store.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <span>
#include <utility>

#include "core/base/error.h"
#include "isosurface/extraction/lattice_samples.h"
#include "isosurface/volume/samples.h"
#include "timevarying/restore_steps.h"

namespace adamas::viewer {

using namespace isosurface;
using namespace timevarying;

namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr std::uint64_t kMostOfSome = 1'000'000;

template <class Sample>
class OpenStoreOf final : public OpenStore {
 public:
  OpenStoreOf(std::unique_ptr<StoreFile> file, std::size_t memory, std::uint32_t step)
      : OpenStore(std::move(file), memory), samples_(steps().at(step)) {}

  [[nodiscard]] int coarsest() const override { return std::max(0, samples_.lods() - 1); }

  [[nodiscard]] std::vector<double> some_values(std::uint32_t step) const override {
    int lod = 0;
    while ((grid().samples() >> (3 * lod)) > kMostOfSome) ++lod;
    const std::unique_ptr<StoreFile> file = another_file();
    std::vector<double> values;
    const RestoredPart part =
        restored_part(grid(), std::min(lod, samples_.lods()), std::nullopt, file_->name());
    restore_step(
        *file, file->steps() == 1 ? 0 : step, part, memory_,
        [&](std::span<const std::byte> plane) {
          for (std::size_t n = 0; n < plane.size() / sizeof(Sample); ++n) {
            Sample sample;
            std::memcpy(&sample, plane.data() + n * sizeof(Sample), sizeof(Sample));
            const double value = grid().value(static_cast<double>(sample));
            if (std::isfinite(value)) values.push_back(value);
          }
        },
        SilentProgress::instance());
    return values;
  }

  [[nodiscard]] std::array<double, 2> extended_by_steps(std::array<double, 2> range) const override {
    const PageGrid& pages = file_->grid();
    if (file_->steps() == 1 || pages.depth() == 0) return range;
    const std::unique_ptr<StoreFile> file = another_file();
    for (std::uint32_t step = 0; step < file->steps(); ++step) {
      const std::optional<PageEntry> all = file->entry(step, {pages.top(), {0, 0, 0}});
      // The words of an empty range are no numbers.
      if (!all || all->low > all->high) continue;
      for (const auto word : {all->low, all->high}) {
        const auto sample = from_ordered<Sample>(static_cast<OrderedWord<Sample>>(word));
        const double value = grid().value(static_cast<double>(sample));
        if (std::isfinite(value)) range = {std::min(range[0], value), std::max(range[1], value)};
      }
    }
    return range;
  }

 private:
  [[nodiscard]] StepPages<OrderedWord<Sample>>& steps() {
    return static_cast<SharedPagesOf<OrderedWord<Sample>>&>(*pages_).steps();
  }

  void set_step(std::uint32_t step) override {
    // The pages of the last step may have been dropped.
    samples_.set_pages(steps().at(file_->steps() == 1 ? 0 : step));
  }

  [[nodiscard]] double value(const Vec3& in_space, int lod) override {
    const VolumeGrid& grid = this->grid();
    const Vec3 offset = grid.in_frame(in_space) - grid.origin;
    LatticePoint low{};
    Vec3 part;
    for (int axis = 0; axis < 3; ++axis) {
      const double place = offset[axis] / grid.spacing[axis];
      const auto last = static_cast<double>(grid.dimensions[static_cast<std::size_t>(axis)] - 1);
      // Places slightly outside are round-off.
      if (!(place >= -1e-6 && place <= last + 1e-6)) return kNone;
      const double step = std::ldexp(1.0, lod);
      const double below =
          step * std::clamp(std::floor(place / step), 0.0, std::max(0.0, std::ceil(last / step) - 1));
      low[axis] = static_cast<std::int32_t>(below);
      part[axis] = std::clamp((place - below) / step, 0.0, 1.0);
    }
    try {
      return grid.value(between(low, part, 1 << lod));
    } catch (const PageLost&) {
      return kNone;
    }
  }

  double between(LatticePoint low, const Vec3& part, std::int32_t step) {
    double sum = 0;
    for (int corner = 0; corner < 8; ++corner) {
      LatticePoint p = low;
      double weight = 1;
      for (int axis = 0; axis < 3; ++axis) {
        const int bit = (corner >> axis) & 1;
        p[axis] += bit * step;
        weight *= bit == 0 ? 1 - part[axis] : part[axis];
      }
      // Samples without weight need not exist or be numbers.
      if (weight > 0) sum += weight * LatticeSamples<Sample>::value(samples_.word(p));
    }
    return sum;
  }

  LatticeSamples<Sample> samples_;
};

}  // namespace

OpenStore::OpenStore(std::unique_ptr<StoreFile> file, std::size_t memory)
    : file_(std::move(file)), memory_(memory), pages_(SharedPages::open(*file_, memory)) {}

std::unique_ptr<StoreFile> OpenStore::another_file() const {
  const SharedPages::Lock lock = pages_->lock();
  return file_->for_another_thread();
}

OpenStore::Values::Values(OpenStore& store, std::uint32_t step) : store_(store), lock_(store.pages_->lock()) {
  store_.set_step(step);
}

std::unique_ptr<OpenStore> OpenStore::open(const std::string& path, std::size_t memory, std::uint32_t step) {
  auto file = std::make_unique<StoreFile>(path);
  if (file->steps() == 1) step = 0;
  if (step >= file->steps()) fail("{}: expected a step below {}, found {}", path, file->steps(), step);
  return with_sample_type(file->header().grid.type, [&](auto sample) -> std::unique_ptr<OpenStore> {
    return std::make_unique<OpenStoreOf<decltype(sample)>>(std::move(file), memory, step);
  });
}

}  // namespace adamas::viewer
