#pragma once

#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "tests/support/volume_store.h"
#include "timevarying/restore_steps.h"
#include "timevarying/series_builder.h"

namespace adamas::test {

using namespace isosurface;
using namespace timevarying;

enum class Motion {
  kStill,   ///< all steps are the same
  kLinear,  ///< samples rise evenly in time
  kWaves,   ///< waves that travel, with some noise
  kRandom   ///< no two steps have anything in common
};

template <class Sample>
MemoryVolume<Sample> volume_at(const Dimensions& dimensions, Motion motion, int step) {
  std::mt19937 random(motion == Motion::kStill ? 1u : static_cast<unsigned>(step) + 1u);
  return {dimensions, [&, motion, step](LatticePoint p) {
            const auto word = static_cast<OrderedWord<Sample>>(random());
            if (motion == Motion::kRandom) return from_ordered<Sample>(word);
            const int noise = motion == Motion::kWaves && random() % 16 == 0 ? 1 : 0;
            const double t = motion == Motion::kWaves ? 0.3 * step : 0;
            const double wave = 30 * std::sin(0.4 * p.i - t) * std::cos(0.3 * p.j + 0.1 * p.k) + 60 + noise;
            return static_cast<Sample>(wave + (motion == Motion::kLinear ? (1 + (p.i & 3)) * step : 0));
          }};
}

/// The steps of a motion, beginning with step `first`.
template <class Sample>
struct TestSeries {
  std::vector<MemoryVolume<Sample>> steps;

  TestSeries(const Dimensions& dimensions, Motion motion, int count, int first = 0) {
    for (int step = first; step < first + count; ++step)
      steps.push_back(volume_at<Sample>(dimensions, motion, step));
  }
  /// Returns a source of the steps from `begin` to before `end`.
  [[nodiscard]] SeriesSource source(std::size_t begin, std::size_t end) const {
    SeriesSource source{
        steps.front().grid, {}, [this, begin](std::uint32_t n) { return steps[begin + n].planes(); }};
    for (std::size_t n = begin; n < end; ++n) source.times.push_back(0.5 * static_cast<double>(n));
    return source;
  }
  [[nodiscard]] SeriesSource source() const { return source(0, steps.size()); }
};

inline StoreOptions with_blocks(std::uint32_t steps, SampleCoding coding = SampleCoding::kInterpolation,
                                std::uint32_t group_pages = 1) {
  StoreOptions options;
  options.block_steps = steps;
  options.group_pages = group_pages;
  options.coding = coding;
  return options;
}

/// Returns the bits of all samples of a step.
template <class Sample>
std::vector<OrderedWord<Sample>> restored_step_bits(StoreFile& file, std::uint32_t step) {
  const RestoredPart part = restored_part(file.header().grid, 0, {}, file.name());
  std::vector<OrderedWord<Sample>> bits;
  restore_step(
      file, step, part, std::size_t{1} << 24,
      [&](std::span<const std::byte> plane) {
        const std::size_t at = bits.size();
        bits.resize(at + plane.size() / sizeof(Sample));
        std::memcpy(bits.data() + at, plane.data(), plane.size());
      },
      SilentProgress::instance());
  return bits;
}

}  // namespace adamas::test
