#pragma once

#include <vtkImageData.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>

#include "adamas/volume.h"

namespace adamas::bench {

inline int vtk_type(SampleType type) {
  switch (type) {
    case SampleType::kUint8:
      return VTK_UNSIGNED_CHAR;
    case SampleType::kUint16:
      return VTK_UNSIGNED_SHORT;
    case SampleType::kInt16:
      return VTK_SHORT;
    case SampleType::kFloat32:
      return VTK_FLOAT;
  }
  throw std::logic_error("a type of samples that is none");
}

/// Allocates an image for every `stride`-th sample along each axis of a volume. Returns the place of the
/// first one.
inline std::byte* make_room(vtkImageData& image, const std::array<std::uint64_t, 3>& dimensions,
                            SampleType type, int stride) {
  const auto count = [stride](std::uint64_t n) {
    return static_cast<int>((n - 1) / static_cast<std::uint64_t>(stride)) + 1;
  };
  image.SetDimensions(count(dimensions[0]), count(dimensions[1]), count(dimensions[2]));
  image.AllocateScalars(vtk_type(type), 1);
  return static_cast<std::byte*>(image.GetScalarPointer());
}

/// Copies every `stride`-th sample along each axis of a volume, of which all samples are given.
inline void copy_strided(std::span<const std::byte> samples, const std::array<std::uint64_t, 3>& dimensions,
                         SampleType type, int stride, std::byte* to) {
  const std::size_t width = sample_bytes(type);
  const auto step = static_cast<std::uint64_t>(stride);
  for (std::uint64_t k = 0; k < dimensions[2]; k += step) {
    for (std::uint64_t j = 0; j < dimensions[1]; j += step) {
      const std::uint64_t row = dimensions[0] * (j + dimensions[1] * k);
      for (std::uint64_t i = 0; i < dimensions[0]; i += step, to += width)
        std::copy_n(samples.data() + width * (row + i), width, to);
    }
  }
}

}  // namespace adamas::bench
