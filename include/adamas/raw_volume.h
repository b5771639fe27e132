#pragma once

#include <array>
#include <cstdint>

#include "adamas/geometry.h"

namespace adamas {

/// The type of samples in a file.
enum class StoredType : std::uint8_t {
  kInt8,
  kUint8,
  kInt16,
  kUint16,
  kInt32,
  kUint32,
  kInt64,
  kUint64,
  kFloat32,
  kFloat64
};

/// What a file of samples without a header holds.
struct RawVolume {
  std::array<std::uint64_t, 3> dimensions{};
  StoredType type = StoredType::kUint8;
  bool big_endian = false;
  std::uint64_t header_bytes = 0;  ///< number of bytes before the samples
  Vec3 spacing{1, 1, 1};
  Vec3 origin;
};

}  // namespace adamas
