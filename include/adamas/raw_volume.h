#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "adamas/export.h"
#include "adamas/geometry.h"
#include "adamas/volume.h"

namespace adamas ADAMAS_API {

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
