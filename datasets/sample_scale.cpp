#include "datasets/sample_scale.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "core/base/assert.h"

namespace adamas::datasets {

namespace {

template <class Sample>
void put_as(double number, std::size_t at, std::span<std::byte> samples) {
  const auto sample = static_cast<Sample>(number);
  std::memcpy(samples.data() + at * sizeof(Sample), &sample, sizeof(Sample));
}

}  // namespace

SampleScale::SampleScale(SampleType type, double low, double high) : type_(type) {
  ADAMAS_ASSERT(low < high && type != SampleType::kInt16);
  if (type == SampleType::kFloat32) return;
  greatest_ = type == SampleType::kUint8 ? 255 : 65535;
  slope_ = (high - low) / greatest_;
  intercept_ = low;
}

bool SampleScale::put(double value, std::size_t at, std::span<std::byte> samples) const {
  if (type_ == SampleType::kFloat32) {
    put_as<float>(value, at, samples);
    return true;
  }
  const double exact = std::round((value - intercept_) / slope_);
  const double sample = std::clamp(exact, 0.0, greatest_);
  if (type_ == SampleType::kUint8) {
    put_as<std::uint8_t>(sample, at, samples);
  } else {
    put_as<std::uint16_t>(sample, at, samples);
  }
  return sample == exact;
}

}  // namespace adamas::datasets
