#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "adamas/raw_volume.h"
#include "adamas/volume.h"

namespace adamas::io {

/// Sets of names of types: ours ("float64"), those of VTK's XML files ("Float64") and of MetaImage
/// ("MET_DOUBLE").
enum class TypeNames : std::uint8_t { kOwn, kVtk, kMetaImage };

/// The size of one sample in a file, in bytes.
std::size_t stored_bytes(StoredType type);
const char* stored_name(StoredType type, TypeNames names = TypeNames::kOwn);
std::optional<StoredType> find_stored_type(std::string_view name, TypeNames names = TypeNames::kOwn);
/// The type that samples are read as: int16 for int8, the type itself if VolumeGrid has it, else float32.
SampleType sample_type_for(StoredType type);
/// The type that samples of a type are written as.
StoredType stored_type(SampleType type);

/// Calls `visit` with a zero of the type.
template <class Visit>
void visit_stored_type(StoredType type, Visit&& visit) {
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

/// Computes the values (VolumeGrid::value) of samples of the grid's type.
void find_values(const VolumeGrid& grid, std::span<const std::byte> samples, std::vector<float>& values);

}  // namespace adamas::io
