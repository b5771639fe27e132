#include "core/io/stored_type.h"

#include <array>
#include <cstring>

namespace adamas {

namespace io {

namespace {

struct StoredTypeInfo {
  std::array<const char*, 3> names;  ///< in the order of TypeNames
  std::size_t bytes;
  SampleType becomes;
};

/// The types, in the order of StoredType. MET_LONG is not among them, since its size depends on the writer's
/// machine.
constexpr StoredTypeInfo kTypes[] = {{{"int8", "Int8", "MET_CHAR"}, 1, SampleType::kInt16},
                                     {{"uint8", "UInt8", "MET_UCHAR"}, 1, SampleType::kUint8},
                                     {{"int16", "Int16", "MET_SHORT"}, 2, SampleType::kInt16},
                                     {{"uint16", "UInt16", "MET_USHORT"}, 2, SampleType::kUint16},
                                     {{"int32", "Int32", "MET_INT"}, 4, SampleType::kFloat32},
                                     {{"uint32", "UInt32", "MET_UINT"}, 4, SampleType::kFloat32},
                                     {{"int64", "Int64", "MET_LONG_LONG"}, 8, SampleType::kFloat32},
                                     {{"uint64", "UInt64", "MET_ULONG_LONG"}, 8, SampleType::kFloat32},
                                     {{"float32", "Float32", "MET_FLOAT"}, 4, SampleType::kFloat32},
                                     {{"float64", "Float64", "MET_DOUBLE"}, 8, SampleType::kFloat32}};

const StoredTypeInfo& info(StoredType type) { return kTypes[static_cast<std::size_t>(type)]; }

}  // namespace

std::size_t stored_bytes(StoredType type) { return info(type).bytes; }

const char* stored_name(StoredType type, TypeNames names) {
  return info(type).names[static_cast<std::size_t>(names)];
}

std::optional<StoredType> find_stored_type(std::string_view name, TypeNames names) {
  for (std::size_t i = 0; i < std::size(kTypes); ++i) {
    const auto type = static_cast<StoredType>(i);
    if (stored_name(type, names) == name) return type;
  }
  return {};
}

SampleType sample_type_for(StoredType type) { return info(type).becomes; }

StoredType stored_type(SampleType type) { return find_stored_type(sample_name(type)).value(); }

void find_values(const VolumeGrid& grid, std::span<const std::byte> samples, std::vector<float>& values) {
  visit_stored_type(stored_type(grid.type), [&]<class Sample>(Sample) {
    values.resize(samples.size() / sizeof(Sample));
    for (std::size_t n = 0; n < values.size(); ++n) {
      Sample sample;
      std::memcpy(&sample, samples.data() + n * sizeof(Sample), sizeof(Sample));
      values[n] = static_cast<float>(grid.value(static_cast<double>(sample)));
    }
  });
}

}  // namespace io

std::string to_string(StoredType type) { return io::stored_name(type); }

std::optional<StoredType> parse_stored_type(std::string_view name) { return io::find_stored_type(name); }

}  // namespace adamas
