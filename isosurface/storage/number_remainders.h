#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "adamas/volume.h"
#include "core/data/stored_type.h"

namespace adamas::isosurface {

// Files may hold *numbers* of types that samples do not have: these are stored as the nearest samples, which
// everything but restoring works with, and *remainders*, what numbers are more than their samples say. A
// record has those of some whole planes of LOD 0.

/// Returns whether numbers of this type may differ from their samples.
constexpr bool has_remainders(StoredType type) {
  return sample_type_for(type) == SampleType::kFloat32 && type != StoredType::kFloat32;
}

/// The number of planes of a record, but perhaps of the last one.
inline std::uint64_t remainder_planes(const VolumeGrid& grid) {
  constexpr std::uint64_t kSamples = std::uint64_t{1} << 20;
  return std::max<std::uint64_t>(1, kSamples / grid.plane_samples());
}

/// The number of records of a step.
inline std::uint64_t remainder_records(const VolumeGrid& grid) {
  const std::uint64_t planes = remainder_planes(grid);
  return (grid.dimensions[2] + planes - 1) / planes;
}

/// Makes numbers of samples: the nearest of the type, 0 for those that are none. `samples` are of
/// sample_type_for(type).
void nearest_numbers(StoredType type, std::span<const std::byte> samples, std::span<std::byte> numbers);

/// Makes a record of numbers, of a type with remainders, and their samples; it is empty where no remainder
/// differs from 0.
std::vector<std::byte> encode_remainders(StoredType type, std::span<const std::byte> numbers,
                                         std::span<const float> samples);
/// Reads the remainders of `count` numbers, least byte first. Returns false where the bytes are not those of
/// so many.
bool decode_remainders(StoredType type, std::span<const std::byte> record, std::size_t count,
                       std::vector<std::byte>& remainders);
/// Makes the numbers of samples and remainders.
void add_remainders(StoredType type, std::span<const float> samples, std::span<const std::byte> remainders,
                    std::span<std::byte> numbers);

}  // namespace adamas::isosurface
