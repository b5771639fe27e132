#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

#include "core/geometry/vec3.h"

namespace adamas {

enum class SampleType : std::uint8_t { kUint8, kUint16, kInt16, kFloat32 };

/// Size of one sample.
constexpr std::size_t sample_bytes(SampleType type) {
  switch (type) {
    case SampleType::kUint8:
      return 1;
    case SampleType::kUint16:
    case SampleType::kInt16:
      return 2;
    case SampleType::kFloat32:
      return 4;
  }
  return 0;
}

/// "uint8", "uint16", "int16", "float32".
const char* sample_name(SampleType type);

/// What a volume is, its samples apart: a regular grid of samples, i running fastest.
struct VolumeGrid {
  std::array<std::uint64_t, 3> dimensions{};  ///< samples per axis
  SampleType type = SampleType::kUint8;
  Vec3 spacing{1, 1, 1};  ///< between neighbouring samples; positive
  Vec3 origin;            ///< of the sample (0, 0, 0)

  [[nodiscard]] std::uint64_t plane_samples() const { return dimensions[0] * dimensions[1]; }
  [[nodiscard]] std::uint64_t samples() const { return plane_samples() * dimensions[2]; }
  /// Of one plane of equal k.
  [[nodiscard]] std::uint64_t plane_bytes() const { return plane_samples() * sample_bytes(type); }
  [[nodiscard]] std::uint64_t bytes() const { return plane_bytes() * dimensions[2]; }

  /// From the first sample to the last.
  [[nodiscard]] Box3 box() const;

  /// Throws Error with `name` where there is no sample, the samples take more bytes than can be counted (at
  /// eight bytes each), a spacing is not positive, or a place is not finite.
  void check(const std::string& name) const;
};

}  // namespace adamas
