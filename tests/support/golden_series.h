#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/support/golden_stores.h"
#include "timevarying/series_builder.h"

namespace adamas::test {

using namespace isosurface;
using namespace timevarying;

/// A store of a small series that is kept among the tests, as GoldenStore is.
struct GoldenSeries {
  std::string name;
  SampleType type;
  /// The number of steps after the store was made, and after each time that steps were added.
  std::vector<std::uint32_t> ends;
  StoreOptions options;

  [[nodiscard]] std::filesystem::path path() const { return GoldenStore{name, type, {}, {}, options}.path(); }
};

inline std::vector<GoldenSeries> golden_series() {
  const auto options = [](SampleCoding coding, std::uint32_t block_steps, std::uint32_t group_pages) {
    StoreOptions result;
    result.coding = coding;
    result.block_steps = block_steps;
    result.group_pages = group_pages;
    return result;
  };
  constexpr auto kEdge = SampleCoding::kSplitEdge, kOurs = SampleCoding::kInterpolation;
  std::vector<GoldenSeries> all{{"series_uint8", SampleType::kUint8, {10}, options(kOurs, 32, 1)},
                                {"series_groups", SampleType::kUint8, {10}, options(kOurs, 4, 8)},
                                {"series_gradients", SampleType::kUint8, {3}, options(kOurs, 32, 1)},
                                {"series_added", SampleType::kUint16, {2, 3, 9}, options(kOurs, 4, 1)},
                                {"series_split_edge", SampleType::kFloat32, {3}, options(kEdge, 32, 1)}};
  all[2].options.gradients = true;
  return all;
}

/// Returns a step of a golden series, in whole numbers. Where i is 16 or more nothing changes; elsewhere
/// there are waves that travel and samples that rise evenly.
template <class Sample>
MemoryVolume<Sample> golden_step(const Dimensions& dimensions, std::uint32_t step) {
  std::uint32_t random = 7;
  const auto wave = [](int x, int length) { return std::abs(x % (2 * length) - length); };
  return MemoryVolume<Sample>(dimensions, [&, t = static_cast<int>(step)](LatticePoint p) {
    random = random * 1664525u + 1013904223u;
    const int noise = random >> 29 == 0 ? static_cast<int>(random >> 24 & 1) : 0;
    const bool is_still = p.i >= 16, is_even = p.j < 8;
    const int moved = is_still || is_even ? 0 : t * t;
    const int risen = is_still || !is_even ? 0 : (1 + p.k % 3) * t;
    const int number = 4 * wave(p.i + 2 * p.j + moved, 13) + 3 * wave(2 * p.k + p.j, 11) + noise + risen;
    const int sample = sizeof(Sample) == 1 ? number : number * (number + 3);
    return static_cast<Sample>(std::is_floating_point_v<Sample> ? sample / 64.0 : sample);
  });
}

/// The volumes of all steps; they must outlive every source() made of them.
template <class Sample>
struct GoldenSteps {
  std::vector<MemoryVolume<Sample>> steps;

  explicit GoldenSteps(const GoldenSeries& series, const Dimensions& dimensions = {35, 20, 18}) {
    for (std::uint32_t step = 0; step < series.ends.back(); ++step)
      steps.push_back(golden_step<Sample>(dimensions, step));
  }
  [[nodiscard]] SeriesSource source(std::uint32_t begin, std::uint32_t end) const {
    SeriesSource source{
        steps.front().grid, {}, [this, begin](std::uint32_t n) { return steps[begin + n].planes(); }};
    for (std::uint32_t step = begin; step < end; ++step) source.times.push_back(0.25 * step);
    return source;
  }
  /// Makes the store at a path, and adds the later steps to it.
  void build(const GoldenSeries& series, const std::filesystem::path& path) const {
    build_series(path, path.string(), source(0, series.ends[0]), series.options);
    for (std::size_t n = 1; n < series.ends.size(); ++n)
      append_series(StoreLock(path), source(series.ends[n - 1], series.ends[n]), series.options);
  }
};

}  // namespace adamas::test
