#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <type_traits>

#include "adamas/geometry.h"
#include "adamas/volume.h"
#include "core/base/assert.h"

namespace adamas::isosurface {

/// A function that fills the samples of plane k, as VolumeReader::read_plane() does.
using PlaneSource = std::function<void(std::uint64_t k, std::span<std::byte> samples)>;

/// The unsigned integer of as many bits as a sample has, which holds a result of ordered().
template <class Sample>
using OrderedWord = std::conditional_t<sizeof(Sample) == 1, std::uint8_t,
                                       std::conditional_t<sizeof(Sample) == 2, std::uint16_t, std::uint32_t>>;

/// Returns a sample as an unsigned integer (a word). Words have the order of the values, and every bit is
/// kept, those of NaN and -0 too.
constexpr std::uint32_t ordered(std::uint8_t sample) { return sample; }
constexpr std::uint32_t ordered(std::uint16_t sample) { return sample; }
constexpr std::uint32_t ordered(std::int16_t sample) { return static_cast<std::uint16_t>(sample) ^ 0x8000u; }
constexpr std::uint32_t ordered(float sample) {
  const auto word = std::bit_cast<std::uint32_t>(sample);
  return (word & 0x80000000u) != 0 ? ~word : word | 0x80000000u;
}

/// Returns the sample of a word of ordered().
template <class Sample>
constexpr Sample from_ordered(std::uint32_t value) {
  if constexpr (std::is_same_v<Sample, float>) {
    return std::bit_cast<float>((value & 0x80000000u) != 0 ? value & 0x7fffffffu : ~value);
  } else if constexpr (std::is_same_v<Sample, std::int16_t>) {
    return static_cast<std::int16_t>(value ^ 0x8000u);
  } else {
    return static_cast<Sample>(value);
  }
}

/// Returns whether a word of ordered() stands for a finite sample, not for a NaN or an infinity. Integers are
/// all finite.
template <class Word>
constexpr bool is_finite_word(Word word) {
  if constexpr (sizeof(Word) < 4) {
    return true;
  } else {
    return word > 0x007fffffu && word < 0xff800000u;
  }
}

/// Calls fn with a sample of that type, and returns its result.
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

}  // namespace adamas::isosurface

// The macros below instantiate a template that is defined in a source file, by its name: for all types of
// samples, or for all words (OrderedWord); a class, or a function that is not overloaded.
#define ADAMAS_INSTANTIATE_FOR_SAMPLES(class_name) \
  template class class_name<std::uint8_t>;         \
  template class class_name<std::uint16_t>;        \
  template class class_name<std::int16_t>;         \
  template class class_name<float>
#define ADAMAS_INSTANTIATE_FOR_WORDS(class_name) \
  template class class_name<std::uint8_t>;       \
  template class class_name<std::uint16_t>;      \
  template class class_name<std::uint32_t>
#define ADAMAS_INSTANTIATE_FUNCTION_FOR_SAMPLES(function)             \
  template decltype(function<std::uint8_t>) function<std::uint8_t>;   \
  template decltype(function<std::uint16_t>) function<std::uint16_t>; \
  template decltype(function<std::int16_t>) function<std::int16_t>;   \
  template decltype(function<float>) function<float>
#define ADAMAS_INSTANTIATE_FUNCTION_FOR_WORDS(function)               \
  template decltype(function<std::uint8_t>) function<std::uint8_t>;   \
  template decltype(function<std::uint16_t>) function<std::uint16_t>; \
  template decltype(function<std::uint32_t>) function<std::uint32_t>
