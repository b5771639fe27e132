#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "adamas/volume.h"

namespace adamas::inline core {

/// Sets of names of types: ours ("float64"), those of VTK's XML files ("Float64") and of MetaImage
/// ("MET_DOUBLE").
enum class TypeNames : std::uint8_t { kOwn, kVtk, kMetaImage };

const char* stored_name(StoredType type, TypeNames names = TypeNames::kOwn);
std::optional<StoredType> find_stored_type(std::string_view name, TypeNames names = TypeNames::kOwn);
/// Calls `visit` with a zero of the type.
template <class Visit>
constexpr void visit_stored_type(StoredType type, Visit&& visit) {
  switch (type) {
    case StoredType::kInt8:
      return std::forward<Visit>(visit)(std::int8_t{});
    case StoredType::kUint8:
      return std::forward<Visit>(visit)(std::uint8_t{});
    case StoredType::kInt16:
      return std::forward<Visit>(visit)(std::int16_t{});
    case StoredType::kUint16:
      return std::forward<Visit>(visit)(std::uint16_t{});
    case StoredType::kInt32:
      return std::forward<Visit>(visit)(std::int32_t{});
    case StoredType::kUint32:
      return std::forward<Visit>(visit)(std::uint32_t{});
    case StoredType::kInt64:
      return std::forward<Visit>(visit)(std::int64_t{});
    case StoredType::kUint64:
      return std::forward<Visit>(visit)(std::uint64_t{});
    case StoredType::kFloat32:
      return std::forward<Visit>(visit)(float{});
    case StoredType::kFloat64:
      return std::forward<Visit>(visit)(double{});
  }
}

/// The size of a number of the type, in bytes.
constexpr std::size_t stored_bytes(StoredType type) {
  std::size_t bytes = 0;
  visit_stored_type(type, [&bytes](auto number) { bytes = sizeof(number); });
  return bytes;
}

/// The type that samples are read as: int16 for int8, the type itself if VolumeGrid has it, else float32.
constexpr SampleType sample_type_for(StoredType type) {
  switch (type) {
    case StoredType::kUint8:
      return SampleType::kUint8;
    case StoredType::kUint16:
      return SampleType::kUint16;
    case StoredType::kInt8:
    case StoredType::kInt16:
      return SampleType::kInt16;
    default:
      return SampleType::kFloat32;
  }
}

/// The type that samples of a type are written as.
constexpr StoredType stored_type(SampleType type) {
  switch (type) {
    case SampleType::kUint8:
      return StoredType::kUint8;
    case SampleType::kUint16:
      return StoredType::kUint16;
    case SampleType::kInt16:
      return StoredType::kInt16;
    case SampleType::kFloat32:
      break;
  }
  return StoredType::kFloat32;
}

/// Computes the values (VolumeGrid::value) of numbers of a type.
void find_values(const VolumeGrid& grid, StoredType type, std::span<const std::byte> numbers,
                 std::vector<float>& values);

}  // namespace adamas::inline core
