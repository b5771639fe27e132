#pragma once

#include <cstdint>

#include "core/base/assert.h"
#include "core/data/volume.h"

namespace adamas {

/// fn with a sample of that type.
template <class Fn>
decltype(auto) with_sample_type(SampleType type, Fn&& fn) {
  switch (type) {
    case SampleType::kUint8:
      return fn(std::uint8_t{});
    case SampleType::kUint16:
      return fn(std::uint16_t{});
    case SampleType::kInt16:
      return fn(std::int16_t{});
    case SampleType::kFloat32:
      break;
  }
  ADAMAS_ASSERT(type == SampleType::kFloat32);
  return fn(float{});
}

}  // namespace adamas
