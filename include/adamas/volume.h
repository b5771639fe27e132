#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "adamas/export.h"
#include "adamas/geometry.h"

namespace adamas ADAMAS_API {

enum class SampleType : std::uint8_t { kUint8, kUint16, kInt16, kFloat32 };

/// Returns the number of bytes of one sample.
constexpr std::size_t sample_bytes(SampleType type) {
  switch (type) {
    case SampleType::kUint8:
      return 1;
    case SampleType::kUint16:
    case SampleType::kInt16:
      return 2;
    case SampleType::kFloat32:
      return 4;
  }
  return 0;
}

/// Returns the name of a type: "uint8", "uint16", "int16" or "float32".
const char* sample_name(SampleType type);

/// The type of numbers in a file, which samples are read from.
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

/// Describes a volume without its samples: a regular grid of samples, i running fastest.
struct VolumeGrid {
  static constexpr std::array<Vec3, 3> kStraight{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  static constexpr std::size_t kLongestUnit = 64;

  std::array<std::uint64_t, 3> dimensions{};  ///< samples per axis
  SampleType type = SampleType::kUint8;
  Vec3 spacing{1, 1, 1};  ///< distance of neighbouring samples along each axis; positive
  Vec3 origin;            ///< the place of the sample (0, 0, 0)
  /// Unit vectors along which i, j and k ascend; they do not lie in one plane, and may be left-handed.
  std::array<Vec3, 3> directions = kStraight;
  /// The coordinate space: "RAS", "LAS", "LPS" (the directions in which x, y and z ascend: right or left,
  /// anterior or posterior, superior), or another name of NRRD; empty where it is not known.
  std::string space{};
  /// The units of coordinates ("mm") and of values ("HU"), of up to kLongestUnit bytes; empty where they are
  /// not known.
  std::string length_unit{}, value_unit{};
  /// Samples stand for values, slope * sample + intercept: isovalues and ranges are values. The slope is
  /// positive.
  double slope = 1, intercept = 0;

  [[nodiscard]] std::uint64_t plane_samples() const { return dimensions[0] * dimensions[1]; }
  [[nodiscard]] std::uint64_t samples() const { return plane_samples() * dimensions[2]; }
  /// Returns the number of bytes of one plane of samples with equal k.
  [[nodiscard]] std::uint64_t plane_bytes() const { return plane_samples() * sample_bytes(type); }
  [[nodiscard]] std::uint64_t bytes() const { return plane_bytes() * dimensions[2]; }

  /// Returns whether samples differ from their values.
  [[nodiscard]] bool is_scaled() const { return slope != 1 || intercept != 0; }
  [[nodiscard]] double value(double sample) const { return slope * sample + intercept; }
  /// Returns the sample of a value, which need not be a whole number.
  [[nodiscard]] double sample(double value) const {
    return is_scaled() ? (value - intercept) / slope : value;
  }

  /// Returns whether i, j and k ascend along x, y and z.
  [[nodiscard]] bool is_straight() const { return directions == kStraight; }
  /// Returns whether i, j and k run along x, y and z, in any order and sense.
  [[nodiscard]] bool is_along_axes() const;
  /// Returns whether the directions are left-handed: a left turn in the frame is a right turn in space.
  [[nodiscard]] bool is_left_handed() const;

  // The *frame* of a grid is the space in which the grid would be straight, with its first sample at the same
  // place. Computations are in the frame; inputs and results are in space.
  [[nodiscard]] Vec3 in_space(const Vec3& in_frame) const;
  [[nodiscard]] Vec3 in_frame(const Vec3& in_space) const;
  /// Returns the greatest factor by which a distance is longer in space than in the frame: 1 where the
  /// directions are orthogonal.
  [[nodiscard]] double greatest_stretch() const;

  /// Returns the box from the first sample to the last, in the frame.
  [[nodiscard]] Box3 frame_box() const;
  /// Returns the least box round all samples in space.
  [[nodiscard]] Box3 box() const;

  /// Checks the grid. Throws Error with `name` where there is no sample, the samples take more bytes than can
  /// be counted (at eight bytes each), a spacing or the slope is not positive, a place or the intercept is
  /// not finite, directions are no unit vectors or lie in one plane, or units are too long, cannot be printed
  /// or contain a quotation mark.
  void check(const std::string& name) const;

  bool operator==(const VolumeGrid&) const = default;
};

/// A volume that owns its samples.
struct Volume {
  VolumeGrid grid;
  /// The grid.bytes() bytes of the samples, i running fastest, then j, in the machine's byte order.
  std::vector<std::byte> samples;

  /// Returns the samples as numbers of the grid's type: std::uint8_t, std::uint16_t, std::int16_t or float.
  /// Throws Error where the grid has another type.
  template <class Sample>
  [[nodiscard]] std::span<const Sample> as() const;
};

}  // namespace adamas
