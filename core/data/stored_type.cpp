#include "core/data/stored_type.h"

#include <cstring>

namespace adamas {

inline namespace core {

namespace {

/// Names of the types, in the orders of StoredType and TypeNames. MET_LONG is not among them, since its size
/// depends on the writer's machine.
constexpr const char* kNames[][3] = {
    {"int8", "Int8", "MET_CHAR"},        {"uint8", "UInt8", "MET_UCHAR"},
    {"int16", "Int16", "MET_SHORT"},     {"uint16", "UInt16", "MET_USHORT"},
    {"int32", "Int32", "MET_INT"},       {"uint32", "UInt32", "MET_UINT"},
    {"int64", "Int64", "MET_LONG_LONG"}, {"uint64", "UInt64", "MET_ULONG_LONG"},
    {"float32", "Float32", "MET_FLOAT"}, {"float64", "Float64", "MET_DOUBLE"}};

}  // namespace

const char* stored_name(StoredType type, TypeNames names) {
  return kNames[static_cast<std::size_t>(type)][static_cast<std::size_t>(names)];
}

std::optional<StoredType> find_stored_type(std::string_view name, TypeNames names) {
  for (std::size_t i = 0; i < std::size(kNames); ++i) {
    const auto type = static_cast<StoredType>(i);
    if (stored_name(type, names) == name) return type;
  }
  return {};
}

void find_values(const VolumeGrid& grid, StoredType type, std::span<const std::byte> numbers,
                 std::vector<float>& values) {
  visit_stored_type(type, [&]<class Number>(Number) {
    values.resize(numbers.size() / sizeof(Number));
    for (std::size_t n = 0; n < values.size(); ++n) {
      Number number;
      std::memcpy(&number, numbers.data() + n * sizeof(Number), sizeof(Number));
      values[n] = static_cast<float>(grid.value(static_cast<double>(number)));
    }
  });
}

}  // namespace core

std::string to_string(StoredType type) { return stored_name(type); }

std::optional<StoredType> parse_stored_type(std::string_view name) { return find_stored_type(name); }

}  // namespace adamas
