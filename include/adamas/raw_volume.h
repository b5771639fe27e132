#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "adamas/export.h"
#include "adamas/geometry.h"

namespace adamas ADAMAS_API {

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

/// Returns the name of a type: "int8", "uint8", ..., "float32", "float64".
std::string to_string(StoredType type);
/// Returns the type of that name; none where there is no such type.
std::optional<StoredType> parse_stored_type(std::string_view name);

/// Describes the content of a file of samples without a header.
struct RawVolume {
  std::array<std::uint64_t, 3> dimensions{};
  StoredType type = StoredType::kUint8;
  bool big_endian = false;
  std::uint64_t header_bytes = 0;  ///< number of bytes before the samples
  Vec3 spacing{1, 1, 1};
  Vec3 origin;
};

/// What is said of files that have no header, or none that tells all. A value that is not given has its
/// default.
struct RawOptions {
  std::optional<std::array<std::uint64_t, 3>> dimensions{};  ///< samples along each axis
  std::optional<StoredType> type{};                          ///< of the samples; needed with `dimensions`
  std::optional<bool> big_endian{};                          ///< the order of bytes; default: little-endian
  std::optional<std::uint64_t> header_bytes{};  ///< the number of bytes before the samples; default: 0
  std::optional<Vec3> spacing{};                ///< between neighbouring samples; default: 1, 1, 1
  std::optional<Vec3> origin{};                 ///< the place of the first sample; default: 0, 0, 0

  /// Returns the name that the first value given has on the command line, as "--dimensions"; empty where none
  /// is given.
  [[nodiscard]] std::string option() const;
};

/// Returns what a file of samples without a header holds; none where no dimensions are given. Throws Error
/// (kUsage) where values lack others.
std::optional<RawVolume> raw_volume(const RawOptions& options);

}  // namespace adamas
