#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <type_traits>

#include "core/base/error.h"
#include "core/io/input_file.h"
#include "core/io/volume_source.h"

namespace adamas {

namespace {

constexpr std::size_t kHeaderBytes = 348;

/// Where fields begin in the header of NIfTI-1.
enum Field : std::size_t {
  kDim = 40,
  kDatatype = 70,
  kBitpix = 72,
  kPixdim = 76,
  kVoxOffset = 108,
  kSlope = 112,
  kIntercept = 116,
  kQformCode = 252,
  kSformCode = 254,
  kQuatern = 256,
  kQoffset = 268,
  kSrow = 280,
  kMagic = 344
};

struct Datatype {
  int code;
  StoredType type;
};
constexpr Datatype kDatatypes[] = {{2, StoredType::kUint8},    {4, StoredType::kInt16},
                                   {8, StoredType::kInt32},    {16, StoredType::kFloat32},
                                   {64, StoredType::kFloat64}, {256, StoredType::kInt8},
                                   {512, StoredType::kUint16}, {768, StoredType::kUint32},
                                   {1024, StoredType::kInt64}, {1280, StoredType::kUint64}};

class Parser {
 public:
  Parser(std::string_view text, const std::filesystem::path& path) : text_(text), path_(path) {
    source_.name = path.string();
  }

  VolumeSource run() {
    find_byte_order();
    set_dimensions();
    set_type();
    find_samples();
    set_places();
    return source_;
  }

 private:
  template <class T>
  [[nodiscard]] T value(std::size_t at) const {
    std::array<char, sizeof(T)> bytes;
    std::memcpy(bytes.data(), text_.data() + at, sizeof(T));
    if (source_.big_endian) std::reverse(bytes.begin(), bytes.end());
    return std::bit_cast<T>(bytes);
  }
  template <class T>
  [[nodiscard]] T entry(Field field, std::size_t i) const {
    return value<T>(field + i * sizeof(T));
  }

  void find_byte_order() {
    if (text_.size() < kHeaderBytes) {
      fail("{}: expected a NIfTI-1 header of {} bytes, found {}", source_.name, kHeaderBytes, text_.size());
    }
    const auto size = value<std::int32_t>(0);
    source_.big_endian = true;
    const auto turned = value<std::int32_t>(0);
    source_.big_endian = size != kHeaderBytes;
    if (size == 540 || turned == 540) fail("{}: expected NIfTI-1, found NIfTI-2", source_.name);
    const std::string_view magic = text_.substr(kMagic, 4);
    single_ = magic == std::string_view("n+1\0", 4);
    if ((size != kHeaderBytes && turned != kHeaderBytes) ||
        (!single_ && magic != std::string_view("ni1\0", 4))) {
      fail("{}: expected NIfTI-1, found something else", source_.name);
    }
  }

  void set_dimensions() {
    const auto axes = entry<std::int16_t>(kDim, 0);
    if (axes < 1 || axes > 7) fail("{}: expected one to seven dimensions, found {}", source_.name, axes);
    source_.grid.dimensions = {1, 1, 1};
    for (std::size_t axis = 0; axis < static_cast<std::size_t>(axes); ++axis) {
      const auto size = entry<std::int16_t>(kDim, axis + 1);
      if (size < 1) fail("{}: expected positive sizes, found {}", source_.name, size);
      if (axis < 3) {
        source_.grid.dimensions[axis] = static_cast<std::uint64_t>(size);
      } else if (size != 1) {
        fail("{}: expected one value per sample and one time, found {} along dimension {}", source_.name,
             size, axis + 1);
      }
    }
  }

  void set_type() {
    const int code = value<std::int16_t>(kDatatype), bits = value<std::int16_t>(kBitpix);
    const auto* found = std::find_if(std::begin(kDatatypes), std::end(kDatatypes),
                                     [code](const Datatype& d) { return d.code == code; });
    if (found == std::end(kDatatypes)) {
      fail("{}: expected a type of one number per sample, found the datatype {}", source_.name, code);
    }
    source_.set_stored(found->type);
    const int expected = 8 * static_cast<int>(stored_bytes(found->type));
    // Some writers leave it empty.
    if (bits != 0 && bits != expected) {
      fail("{}: expected {} bits for samples of {}, found {}", source_.name, expected,
           stored_name(found->type), bits);
    }
    const double slope = value<float>(kSlope), intercept = value<float>(kIntercept);
    if (slope == 0 || !std::isfinite(slope) || !std::isfinite(intercept)) return;
    source_.slope = slope;
    source_.intercept = intercept;
    if (source_.scaled()) source_.grid.type = SampleType::kFloat32;
  }

  void find_samples() {
    constexpr float kFarthest = 1 << 30;
    float offset = value<float>(kVoxOffset);
    if (single_ && offset == 0) offset = 352;
    const float least = single_ ? static_cast<float>(kHeaderBytes) : 0;
    if (!(offset >= least && offset <= kFarthest) || offset != std::floor(offset)) {
      fail("{}: expected samples from byte {} on or later, found a vox_offset of {}", source_.name, least,
           offset);
    }
    source_.file = path_;
    const bool packed = file_extension(path_).ends_with(".gz");
    (packed ? source_.skip_bytes : source_.header_bytes) = static_cast<std::uint64_t>(offset);
    if (packed) source_.coding = SamplePacking::kDeflate;
    if (single_) return;
    set_image_file();
  }

  /// The samples of x.hdr lie in x.img, or in x.img.gz as well.
  void set_image_file() {
    const std::filesystem::path stem = path_.parent_path() / file_stem(path_);
    const bool upper = path_.extension() == ".HDR";
    source_.file = stem.string() + (upper ? ".IMG" : ".img");
    std::filesystem::path gzip = source_.file;
    gzip += ".gz";
    const std::uint64_t offset = source_.skip_bytes + source_.header_bytes;
    const bool packed = !std::filesystem::exists(source_.file) && std::filesystem::exists(gzip);
    if (packed) source_.file = gzip;
    source_.coding = packed ? SamplePacking::kDeflate : SamplePacking::kRaw;
    source_.skip_bytes = packed ? offset : 0;
    source_.header_bytes = packed ? 0 : offset;
    source_.name += ": " + source_.file.string();
  }

  [[nodiscard]] GridAxes sform() const {
    GridAxes axes;
    for (std::size_t row = 0; row < 3; ++row) {
      for (std::size_t a = 0; a < 3; ++a) {
        axes.directions[a][static_cast<int>(row)] = entry<float>(kSrow, 4 * row + a);
      }
      axes.origin[static_cast<int>(row)] = entry<float>(kSrow, 4 * row + 3);
    }
    return axes;
  }

  /// The rotation of a unit quaternion whose first part is not stored.
  [[nodiscard]] GridAxes qform() const {
    const double b = entry<float>(kQuatern, 0), c = entry<float>(kQuatern, 1), d = entry<float>(kQuatern, 2);
    const double a = std::sqrt(std::max(0.0, 1 - (b * b + c * c + d * d)));
    GridAxes axes;
    axes.directions = {{{a * a + b * b - c * c - d * d, 2 * (b * c + a * d), 2 * (b * d - a * c)},
                        {2 * (b * c - a * d), a * a + c * c - b * b - d * d, 2 * (c * d + a * b)},
                        {2 * (b * d + a * c), 2 * (c * d - a * b), a * a + d * d - b * b - c * c}}};
    if (entry<float>(kPixdim, 0) < 0) axes.directions[2] *= -1;
    for (int axis = 0; axis < 3; ++axis) {
      axes.directions[static_cast<std::size_t>(axis)] *= spacing(axis);
      axes.origin[axis] = entry<float>(kQoffset, static_cast<std::size_t>(axis));
    }
    return axes;
  }

  [[nodiscard]] double spacing(int axis) const {
    const double step = std::abs(entry<float>(kPixdim, static_cast<std::size_t>(axis) + 1));
    return step > 0 && std::isfinite(step) ? step : 1;
  }

  void set_places() {
    const bool has_s = value<std::int16_t>(kSformCode) > 0, has_q = value<std::int16_t>(kQformCode) > 0;
    if (has_s || has_q) {
      const GridAxes axes = has_s ? sform() : qform();
      if (are_in_place(axes)) return source_.set_axes(axes);
      source_.remark = "axes that are not parallel to x, y and z, in this order, are left out";
    }
    GridAxes axes;
    for (int axis = 0; axis < 3; ++axis) axes.directions[static_cast<std::size_t>(axis)] *= spacing(axis);
    source_.set_axes(axes);
  }

  std::string_view text_;
  const std::filesystem::path& path_;
  VolumeSource source_;
  bool single_ = false;
};

}  // namespace

VolumeSource nifti_source(std::string_view text, const std::filesystem::path& path) {
  return Parser(text, path).run();
}

}  // namespace adamas
