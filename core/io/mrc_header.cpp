#include "core/io/mrc_header.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <utility>

#include "core/base/error.h"
#include "core/io/header_bytes.h"
#include "core/io/input_file.h"
#include "core/io/input_formats.h"

namespace adamas::io {

namespace {

constexpr std::size_t kBytes = 1024;
/// Offsets of words: one for each of three axes, unless they are single.
constexpr std::size_t kSizes = 0, kMode = 12, kStarts = 16, kSteps = 28, kLengths = 40, kAngles = 52,
                      kAxes = 64, kGroup = 88, kExtended = 92, kImodStamp = 152, kImodFlags = 156,
                      kOrigin = 196, kMagic = 208, kMachine = 212;
constexpr std::string_view kMap = "MAP";
/// Space groups of stacks of volumes are those of one volume, from 1 on, and 400.
constexpr std::int32_t kFirstStack = 401, kLastStack = 630;

class Parser {
 public:
  Parser(std::string_view text, const std::filesystem::path& path) : text_(text) {
    image_.kind = "MRC";
    image_.name = source_.name = path.string();
    image_.centers.emplace();
    source_.file = path;
    source_.trailing = TrailingBytes::kRemark;
    if (text.size() < kBytes)
      fail("{}: expected an MRC header of {} bytes, found {}", image_.name, kBytes, text.size());
    find_byte_order();
  }

  ImageHeader run() {
    set_sizes();
    set_type();
    const std::int32_t extended = word(kExtended);
    if (extended < 0)
      fail("{}: expected a number of bytes of an extended header, found {}", image_.name, extended);
    source_.header_bytes = kBytes + static_cast<std::uint64_t>(extended);
    source_.check_size();
    image_.time_step = source_.sample_file_bytes();
    set_places();
    image_.arrays.push_back({.name = {}, .centering = Centering::kPoints, .source = std::move(source_)});
    return std::move(image_);
  }

 private:
  [[nodiscard]] std::int32_t word(std::size_t at, std::size_t i = 0) const {
    return number_at<std::int32_t>(text_, at + 4 * i, source_.big_endian);
  }
  [[nodiscard]] double real(std::size_t at, std::size_t i) const {
    return static_cast<double>(number_at<float>(text_, at + 4 * i, source_.big_endian));
  }

  /// The stamp of the machine tells, or else the mode, which is a small number.
  void find_byte_order() {
    const char stamp = text_[kMachine];
    source_.big_endian = stamp == 0x11;
    if (stamp == 0x11 || stamp == 0x44) return;
    source_.big_endian = word(kMode) < 0 || word(kMode) > 0xffff;
  }

  void set_sizes() {
    std::array<std::int32_t, 3> sizes{};
    for (std::size_t a = 0; a < 3; ++a) {
      sizes[a] = word(kSizes, a);
      if (sizes[a] < 1) fail("{}: expected an MRC file of positive sizes, found {}", image_.name, sizes[a]);
    }
    const std::int32_t group = word(kGroup), planes = word(kSteps, 2);
    if (group >= kFirstStack && group <= kLastStack) {
      if (planes < 1 || sizes[2] % planes != 0) {
        fail("{}: expected a stack of volumes of {} sections each, found {} sections", image_.name, planes,
             sizes[2]);
      }
      image_.times = static_cast<std::uint64_t>(sizes[2] / planes);
      sizes[2] = planes;
    }
    for (std::size_t a = 0; a < 3; ++a) image_.dimensions[a] = static_cast<std::uint64_t>(sizes[a]);
    source_.grid.dimensions = image_.dimensions;
    source_.grid.check(image_.name);
  }

  void set_type() {
    const std::int32_t mode = word(kMode);
    const std::optional<StoredType> type = type_of(mode);
    if (!type) {
      fail("{}: expected the mode 0, 1, 2 or 6 of MRC (int8, int16, float32, uint16), found {}", image_.name,
           mode);
    }
    source_.set_stored(*type);
  }

  [[nodiscard]] std::optional<StoredType> type_of(std::int32_t mode) const {
    // IMOD once wrote bytes without a sign, and says since then which ones have one.
    constexpr std::int32_t kImod = 1146047817;
    switch (mode) {
      case 0: {
        const bool has_sign = word(kImodStamp) != kImod || (word(kImodFlags) & 1) != 0;
        return has_sign ? StoredType::kInt8 : StoredType::kUint8;
      }
      case 1:
        return StoredType::kInt16;
      case 2:
        return StoredType::kFloat32;
      case 6:
        return StoredType::kUint16;
      default:
        return {};
    }
  }

  /// Returns which axis of the cell each axis of the array follows: those of old files are not stated.
  [[nodiscard]] std::array<int, 3> axes_of_cell() const {
    if (word(kAxes, 0) == 0 && word(kAxes, 1) == 0 && word(kAxes, 2) == 0) return {0, 1, 2};
    const std::array<int, 3> axes{word(kAxes, 0), word(kAxes, 1), word(kAxes, 2)};
    auto sorted = axes;
    std::ranges::sort(sorted);
    if (sorted != std::array{1, 2, 3})
      fail("{}: expected the axes 1, 2 and 3 in any order, found {}, {}, {}", image_.name, axes[0], axes[1],
           axes[2]);
    return {axes[0] - 1, axes[1] - 1, axes[2] - 1};
  }

  /// Returns the unit vectors along the axes of the cell: x, one in the plane of x and y, and the third.
  [[nodiscard]] std::array<Vec3, 3> cell_directions() const {
    std::array<double, 3> cosines{};
    bool stated = true;
    for (std::size_t a = 0; a < 3; ++a) {
      const double angle = real(kAngles, a);
      if (!std::isfinite(angle)) fail("{}: expected angles of the cell, found {}", image_.name, angle);
      stated = stated && angle > 0;
      cosines[a] = angle == 90 ? 0 : std::cos(angle * std::numbers::pi / 180);
    }
    if (!stated) cosines = {};
    const auto [alpha, beta, gamma] = cosines;
    const double sine = std::sqrt(1 - gamma * gamma), y = (alpha - beta * gamma) / sine;
    const double rest = 1 - beta * beta - y * y;
    if (!(rest > 0)) fail("{}: expected angles of a cell with a volume, found others", image_.name);
    return {{{1, 0, 0}, {gamma, sine, 0}, {beta, y, std::sqrt(rest)}}};
  }

  void set_places() {
    const std::array<int, 3> axes = axes_of_cell();
    const std::array<Vec3, 3> directions = cell_directions();
    Vec3 origin, start;
    for (std::size_t a = 0; a < 3; ++a) {
      const auto axis = static_cast<std::size_t>(axes[a]);
      const double length = real(kLengths, axis);
      const std::int32_t steps = word(kSteps, axis);
      if (length > 0 && std::isfinite(length) && steps > 0)
        image_.spacing[static_cast<int>(a)] = length / steps;
      image_.axes.directions[a] = image_.spacing[static_cast<int>(a)] * directions[axis];
      start += static_cast<double>(word(kStarts, a)) * image_.axes.directions[a];
      origin[static_cast<int>(a)] = real(kOrigin, a);
      if (!std::isfinite(origin[static_cast<int>(a)]))
        fail("{}: expected an origin, found {}", image_.name, origin[static_cast<int>(a)]);
    }
    // Files from before 2000 have other words in its place.
    const bool stated = text_.substr(kMagic, kMap.size()) == kMap && squared_norm(origin) > 0;
    image_.axes.origin = stated ? origin : start;
  }

  std::string_view text_;
  ImageHeader image_;
  VolumeSource source_;
};

ImageHeader read_image(const std::filesystem::path& path) { return mrc_image(read_beginning(path), path); }

VolumeSeries find_series(const std::filesystem::path& path, const std::string& array) {
  return series_of(read_image(path), array, StepTimes::kCounted);
}

}  // namespace

InputFormat mrc_format() {
  return {.name = "MRC",
          .endings = ".mrc .map",
          .more_endings = ".ccp4 .mrcs .rec",
          .shown_by =
              [](std::string_view bytes) {
                return bytes.size() >= kBytes && bytes.substr(kMagic, kMap.size()) == kMap &&
                       (bytes[kMachine] == 0x44 || bytes[kMachine] == 0x11);
              },
          .read_header = read_image,
          .find_series = find_series,
          .several_times = true};
}

ImageHeader mrc_image(std::string_view text, const std::filesystem::path& path) {
  return Parser(text, path).run();
}

}  // namespace adamas::io
