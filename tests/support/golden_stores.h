#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>
#include <type_traits>

#include "tests/support/volume_store.h"

namespace adamas::test {

using namespace isosurface;

/// A store of a small volume that is kept among the tests as a file. It stands for all files that later
/// versions have to read.
struct GoldenStore {
  std::string name;
  SampleType type;
  Dimensions dimensions;
  Vec3 spacing;
  StoreOptions options;

  [[nodiscard]] std::filesystem::path path() const {
    return std::filesystem::path(ADAMAS_SOURCE_DIR) / "tests" / "isosurface" / "golden" / (name + ".adm");
  }
};

inline std::vector<GoldenStore> golden_stores() {
  constexpr auto kEdge = SampleCoding::kSplitEdge, kOurs = SampleCoding::kInterpolation;
  const auto options = [](SampleCoding coding, bool gradients) {
    StoreOptions result;
    result.coding = coding;
    result.gradients = gradients;
    result.smoothing.reset();
    return result;
  };
  return {{"uint8", SampleType::kUint8, {37, 18, 17}, {1, 1, 1}, options(kOurs, false)},
          {"uint8_noise", SampleType::kUint8, {18, 17, 33}, {1, 1, 1}, options(kOurs, false)},
          {"uint8_split_edge", SampleType::kUint8, {20, 33, 12}, {1, 1, 2.5}, options(kEdge, true)},
          {"uint16", SampleType::kUint16, {19, 21, 34}, {0.957, 0.957, 1.5}, options(kOurs, true)},
          {"int16", SampleType::kInt16, {33, 18, 19}, {0.1, 0.3, 0.2}, options(kOurs, false)},
          {"float32", SampleType::kFloat32, {18, 20, 33}, {1, 2, 1}, options(kOurs, false)},
          {"float32_split_edge", SampleType::kFloat32, {34, 17, 9}, {1e-3, 2, 1e3}, options(kEdge, true)}};
}

/// Returns the volume of a golden store: waves and some noise, in whole numbers, so that it is the same on
/// all machines. A few samples of floats are not finite. The second half of one volume is noise alone.
template <class Sample>
MemoryVolume<Sample> golden_volume(const GoldenStore& store) {
  std::uint32_t random = 1;
  const auto wave = [](int x, int length) { return std::abs(x % (2 * length) - length); };
  const auto sample = [&](LatticePoint p) {
    random = random * 1664525u + 1013904223u;
    const int noise = random >> 30 == 0 ? static_cast<int>(random >> 24 & 3) : 0;
    const int number = 4 * wave(p.i + 2 * p.j, 13) + 5 * wave(3 * p.k + p.j, 17) + noise;
    if constexpr (std::is_same_v<Sample, float>) {
      if (random % 701 == 0) return std::numeric_limits<float>::quiet_NaN();
      if (random % 503 == 0) return -std::numeric_limits<float>::infinity();
      return static_cast<float>(number * number - 3000) / 128;
    } else if constexpr (sizeof(Sample) == 2) {
      // A store codes the ranks of samples where few different samples occur; an int16 has many.
      return static_cast<Sample>(std::is_signed_v<Sample> ? number * number / 2 - 9000 + p.i * p.k
                                                          : 100 * number);
    } else {
      if (store.name == "uint8_noise" && p.k >= 16) return static_cast<Sample>(random >> 20);
      return static_cast<Sample>(p.i > 30 ? 0 : number);
    }
  };
  return MemoryVolume<Sample>(store.dimensions, sample, store.spacing);
}

}  // namespace adamas::test
