#include "core/io/nifti_header.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <type_traits>
#include <utility>

#include "core/base/error.h"
#include "core/io/decompression.h"
#include "core/io/header_bytes.h"
#include "core/io/input_file.h"
#include "core/io/input_formats.h"

namespace adamas::io {

namespace {

struct Datatype {
  int code;
  StoredType type;
  std::size_t components = 1;
};
/// The types of samples: single numbers first; then complex numbers, RGB and RGBA.
constexpr Datatype kDatatypes[] = {
    {2, StoredType::kUint8},      {4, StoredType::kInt16},       {8, StoredType::kInt32},
    {16, StoredType::kFloat32},   {64, StoredType::kFloat64},    {256, StoredType::kInt8},
    {512, StoredType::kUint16},   {768, StoredType::kUint32},    {1024, StoredType::kInt64},
    {1280, StoredType::kUint64},  {32, StoredType::kFloat32, 2}, {1792, StoredType::kFloat64, 2},
    {128, StoredType::kUint8, 3}, {2304, StoredType::kUint8, 4}};

const Datatype* find_datatype(int code) {
  const auto* found = std::find_if(std::begin(kDatatypes), std::end(kDatatypes),
                                   [code](const Datatype& d) { return d.code == code; });
  return found == std::end(kDatatypes) ? nullptr : found;
}

/// The units of length, by their codes, which are in the lowest three bits of a header's.
struct LengthUnit {
  int code;
  std::string_view name;
};
constexpr LengthUnit kLengthUnits[] = {{1, "m"}, {2, "mm"}, {3, "um"}};
constexpr int kLengthBits = 7;

/// The places of the fields in a version's header, and the types of their numbers.
struct Version1 {
  static constexpr std::size_t kBytes = 348, kMagic = 344;
  static constexpr std::string_view kSingle{"n+1\0", 4}, kPair{"ni1\0", 4};
  static constexpr std::size_t kDim = 40, kDatatype = 70, kBits = 72, kPixdim = 76, kOffset = 108,
                               kSlope = 112, kIntercept = 116, kUnits = 123, kQcode = 252, kScode = 254,
                               kQuaternion = 256, kQoffset = 268, kSrow = 280;
  using Size = std::int16_t;
  using Real = float;
  using Offset = float;
  using Code = std::int16_t;
  using Units = std::int8_t;
};
struct Version2 {
  static constexpr std::size_t kBytes = 540, kMagic = 4;
  static constexpr std::string_view kSingle{"n+2\0\r\n\x1a\n", 8}, kPair{"ni2\0\r\n\x1a\n", 8};
  static constexpr std::size_t kDim = 16, kDatatype = 12, kBits = 14, kPixdim = 104, kOffset = 168,
                               kSlope = 176, kIntercept = 184, kUnits = 500, kQcode = 344, kScode = 348,
                               kQuaternion = 352, kQoffset = 376, kSrow = 400;
  using Size = std::int64_t;
  using Real = double;
  using Offset = std::int64_t;
  using Code = std::int32_t;
  using Units = std::int32_t;
};

template <class V>
NiftiHeader parse_version(std::string_view text, bool big_endian, const std::string& name) {
  if (text.size() < V::kBytes) {
    fail("{}: expected a NIfTI header of {} bytes, found {}", name, V::kBytes, text.size());
  }
  const std::string_view magic = text.substr(V::kMagic, V::kSingle.size());
  if (magic != V::kSingle && magic != V::kPair) fail("{}: expected NIfTI, found something else", name);
  NiftiHeader header;
  header.big_endian = big_endian;
  header.single = magic == V::kSingle;
  header.bytes = V::kBytes;
  const auto read = [&]<class T>(T, std::size_t at, auto& values) {
    for (std::size_t i = 0; i < values.size(); ++i) {
      values[i] = static_cast<std::remove_reference_t<decltype(values[0])>>(
          number_at<T>(text, at + i * sizeof(T), big_endian));
    }
  };
  using Real = typename V::Real;
  const auto real = [&](std::size_t at) {
    return static_cast<double>(number_at<Real>(text, at, big_endian));
  };
  read(typename V::Size{}, V::kDim, header.dim);
  read(Real{}, V::kPixdim, header.pixdim);
  read(Real{}, V::kQuaternion, header.quaternion);
  read(Real{}, V::kQoffset, header.qoffset);
  for (std::size_t row = 0; row < 3; ++row) read(Real{}, V::kSrow + row * 4 * sizeof(Real), header.srow[row]);
  header.datatype = number_at<std::int16_t>(text, V::kDatatype, big_endian);
  header.bits = number_at<std::int16_t>(text, V::kBits, big_endian);
  header.offset = static_cast<double>(number_at<typename V::Offset>(text, V::kOffset, big_endian));
  header.slope = real(V::kSlope);
  header.intercept = real(V::kIntercept);
  header.qform_code = static_cast<int>(number_at<typename V::Code>(text, V::kQcode, big_endian));
  header.sform_code = static_cast<int>(number_at<typename V::Code>(text, V::kScode, big_endian));
  header.units = static_cast<int>(number_at<typename V::Units>(text, V::kUnits, big_endian));
  return header;
}

GridAxes sform(const NiftiHeader& header) {
  GridAxes axes;
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t a = 0; a < 3; ++a) axes.directions[a][static_cast<int>(row)] = header.srow[row][a];
    axes.origin[static_cast<int>(row)] = header.srow[row][3];
  }
  return axes;
}

/// The axes by the rotation of a unit quaternion whose first component is not stored.
GridAxes qform(const NiftiHeader& header) {
  const auto [b, c, d] = header.quaternion;
  const double a = std::sqrt(std::max(0.0, 1 - (b * b + c * c + d * d)));
  GridAxes axes;
  axes.directions = {{{a * a + b * b - c * c - d * d, 2 * (b * c + a * d), 2 * (b * d - a * c)},
                      {2 * (b * c - a * d), a * a + c * c - b * b - d * d, 2 * (c * d + a * b)},
                      {2 * (b * d + a * c), 2 * (c * d - a * b), a * a + d * d - b * b - c * c}}};
  if (header.pixdim[0] < 0) axes.directions[2] *= -1;
  for (int axis = 0; axis < 3; ++axis) {
    axes.directions[static_cast<std::size_t>(axis)] *= header.spacing(axis);
    axes.origin[axis] = header.qoffset[static_cast<std::size_t>(axis)];
  }
  return axes;
}

template <class V>
std::string header_bytes(const VolumeGrid& grid, StoredType type) {
  // Four zero bytes say that no extension follows.
  std::string bytes(V::kBytes + 4, '\0');
  const auto put = [&bytes]<class T>(std::size_t at, T value) { std::memcpy(&bytes[at], &value, sizeof(T)); };
  using Real = typename V::Real;
  put(0, static_cast<std::int32_t>(V::kBytes));
  std::memcpy(&bytes[V::kMagic], V::kSingle.data(), V::kSingle.size());
  for (std::size_t i = 0; i < 8; ++i) {
    const std::uint64_t size = i == 0 ? 3 : i <= 3 ? grid.dimensions[i - 1] : 1;
    const double step = i == 0 || i > 3 ? 1 : grid.spacing[static_cast<int>(i) - 1];
    put(V::kDim + i * sizeof(typename V::Size), static_cast<typename V::Size>(size));
    put(V::kPixdim + i * sizeof(Real), static_cast<Real>(step));
  }
  const auto* datatype = std::find_if(std::begin(kDatatypes), std::end(kDatatypes),
                                      [&](const Datatype& d) { return d.type == type; });
  put(V::kDatatype, static_cast<std::int16_t>(datatype->code));
  put(V::kBits, static_cast<std::int16_t>(8 * stored_bytes(type)));
  put(V::kOffset, static_cast<typename V::Offset>(bytes.size()));
  put(V::kSlope, static_cast<Real>(grid.slope));
  put(V::kIntercept, static_cast<Real>(grid.intercept));
  // Coordinates are those of the scanner, in millimetres unless they have a unit, or those of an unknown
  // space.
  const bool known = grid.space == "RAS";
  const std::string_view own = grid.length_unit, wanted = known && own.empty() ? std::string_view("mm") : own;
  const auto unit = std::ranges::find(kLengthUnits, wanted, &LengthUnit::name);
  put(V::kUnits, static_cast<typename V::Units>(unit == std::end(kLengthUnits) ? 0 : unit->code));
  put(V::kScode, static_cast<typename V::Code>(known ? 1 : 2));
  for (int row = 0; row < 3; ++row) {
    for (std::size_t column = 0; column < 4; ++column) {
      const double value = column == 3
                               ? grid.origin[row]
                               : grid.spacing[static_cast<int>(column)] * grid.directions[column][row];
      put(V::kSrow + (4 * static_cast<std::size_t>(row) + column) * sizeof(Real), static_cast<Real>(value));
    }
  }
  return bytes;
}

}  // namespace

NiftiHeader NiftiHeader::parse(std::string_view text, const std::string& name) {
  if (text.size() < sizeof(std::int32_t))
    fail("{}: expected a NIfTI header, found {} bytes", name, text.size());
  for (const bool big_endian : {false, true}) {
    const auto size = number_at<std::int32_t>(text, 0, big_endian);
    if (size == Version1::kBytes) return parse_version<Version1>(text, big_endian, name);
    if (size == Version2::kBytes) return parse_version<Version2>(text, big_endian, name);
  }
  fail("{}: expected NIfTI, found something else", name);
}

std::optional<GridAxes> NiftiHeader::axes() const {
  if (sform_code > 0) return sform(*this);
  return qform_code > 0 ? std::optional(qform(*this)) : std::nullopt;
}

double NiftiHeader::spacing(int axis) const {
  const double step = std::abs(pixdim[static_cast<std::size_t>(axis) + 1]);
  return step > 0 && std::isfinite(step) ? step : 1;
}

double NiftiHeader::time_spacing() const {
  double step = pixdim[4];
  if (!(step > 0 && std::isfinite(step))) return 1;
  // A number in single precision stands for the shortest decimal number that rounds to it.
  if (static_cast<double>(static_cast<float>(step)) == step) {
    const std::string text = fmt::format("{}", static_cast<float>(step));
    std::from_chars(text.data(), text.data() + text.size(), step);
  }
  constexpr int kTimeUnits = 0x38, kMilliseconds = 16, kMicroseconds = 24;
  const int unit = units & kTimeUnits;
  return unit == kMilliseconds ? step / 1e3 : unit == kMicroseconds ? step / 1e6 : step;
}

std::optional<StoredType> NiftiHeader::type() const {
  const Datatype* found = find_datatype(datatype);
  return found == nullptr ? std::nullopt : std::optional(found->type);
}

std::size_t NiftiHeader::components() const {
  const Datatype* found = find_datatype(datatype);
  return found == nullptr ? 1 : found->components;
}

bool nifti_tells(const std::string& length_unit) {
  return std::ranges::find(kLengthUnits, length_unit, &LengthUnit::name) != std::end(kLengthUnits);
}

std::string read_nifti_header(const std::filesystem::path& path) {
  if (!file_extension(path).ends_with(".gz")) return read_beginning(path);
  constexpr std::size_t kHeader = NiftiHeader::kMostBytes;
  std::string header;
  inflate_stream(supply_file(FileHandle::open(path), 0), path.string(), [&](std::string_view piece) {
    header += piece.substr(0, kHeader - header.size());
    return header.size() < kHeader;
  });
  return header;
}

std::string nifti_file_header(const VolumeGrid& grid, StoredType type) {
  constexpr std::uint64_t kMost = 32767;
  bool large =
      std::any_of(grid.dimensions.begin(), grid.dimensions.end(), [](std::uint64_t n) { return n > kMost; });
  // The first version stores lengths in single precision.
  for (int axis = 0; axis < 3; ++axis) {
    for (const double length : {grid.spacing[axis], grid.origin[axis]}) {
      const auto single = static_cast<float>(length);
      large = large || !std::isfinite(single) ||
              (length != 0 && std::abs(single) < std::numeric_limits<float>::min());
    }
  }
  for (const double factor : {grid.slope, grid.intercept})
    large = large || static_cast<double>(static_cast<float>(factor)) != factor;
  return large ? header_bytes<Version2>(grid, type) : header_bytes<Version1>(grid, type);
}

namespace {

class Parser {
 public:
  Parser(std::string_view text, const std::filesystem::path& path)
      : header_(NiftiHeader::parse(text, path.string())), path_(path) {
    image_.kind = "NIfTI";
    image_.name = source_.name = path.string();
    image_.centers.emplace();
    source_.big_endian = header_.big_endian;
    // Other programs ignore bytes behind the samples.
    source_.trailing = TrailingBytes::kRemark;
  }

  ImageHeader run() {
    set_dimensions();
    set_type();
    find_samples();
    set_places();
    const bool planar = header_.components() == 1;
    image_.arrays.push_back(
        {.name = {}, .centering = Centering::kPoints, .source = std::move(source_), .planar = planar});
    return std::move(image_);
  }

 private:
  void set_dimensions() {
    const std::int64_t axes = header_.dim[0];
    if (axes < 1 || axes > 7) fail("{}: expected one to seven dimensions, found {}", image_.name, axes);
    for (std::size_t axis = 0; axis < static_cast<std::size_t>(axes); ++axis) {
      const std::int64_t size = header_.dim[axis + 1];
      if (size < 1) fail("{}: expected positive sizes, found {}", image_.name, size);
      if (axis < 3) {
        image_.dimensions[axis] = static_cast<std::uint64_t>(size);
      } else if (axis == 3) {
        image_.times = static_cast<std::uint64_t>(size);
      } else if (axis == 4) {
        source_.components = static_cast<std::size_t>(size);
      } else if (size != 1) {
        fail("{}: expected one to five dimensions, found {} values along dimension {}", image_.name, size,
             axis + 1);
      }
    }
    source_.grid.dimensions = image_.dimensions;
    source_.grid.check(image_.name);
  }

  void set_type() {
    const auto type = header_.type();
    if (!type) fail("{}: expected a type of numbers, found the datatype {}", image_.name, header_.datatype);
    source_.set_stored(*type);
    const std::size_t of_type = header_.components();
    const int expected = 8 * static_cast<int>(stored_bytes(*type) * of_type);
    // Some writers leave this field empty.
    if (header_.bits != 0 && header_.bits != expected) {
      fail("{}: expected {} bits for samples of {}, found {}", image_.name, expected, stored_name(*type),
           header_.bits);
    }
    if (source_.components > 1 && image_.times > 1)
      fail("{}: expected vectors of one time, found {} times", image_.name, image_.times);
    if (of_type > 1 && source_.components > 1)
      fail("{}: expected vectors of numbers, found some of {} numbers each", image_.name, of_type);
    source_.components *= of_type;
    source_.check_size();
    const double slope = header_.slope, intercept = header_.intercept;
    if (slope == 0 || !std::isfinite(slope) || !std::isfinite(intercept)) return;
    source_.slope = slope;
    source_.intercept = intercept;
    if (source_.scaled()) source_.grid.type = SampleType::kFloat32;
  }

  void find_samples() {
    constexpr double kFarthest = 1 << 30;
    double offset = header_.offset;
    const auto behind = static_cast<double>(header_.bytes);
    if (header_.single && offset == 0) offset = behind + 4;
    const double least = header_.single ? behind : 0;
    if (!(offset >= least && offset <= kFarthest) || offset != std::floor(offset)) {
      fail("{}: expected samples from byte {} on or later, found a vox_offset of {}", image_.name, least,
           offset);
    }
    source_.file = path_;
    if (!header_.single) set_image_file();
    image_.time_spacing = header_.time_spacing();
    image_.time_step = source_.grid.samples() * stored_bytes(source_.stored) * header_.components();
    const bool packed = file_extension(source_.file).ends_with(".gz");
    (packed ? source_.skip_bytes : source_.header_bytes) = static_cast<std::uint64_t>(offset);
    if (packed) source_.coding = SamplePacking::kDeflate;
  }

  /// Finds the samples of x.hdr, which lie in x.img or x.img.gz.
  void set_image_file() {
    const std::filesystem::path stem = path_.parent_path() / file_stem(path_);
    const bool upper = path_.extension() == ".HDR";
    source_.file = stem.string() + (upper ? ".IMG" : ".img");
    std::filesystem::path gzip = source_.file;
    gzip += ".gz";
    if (!std::filesystem::exists(source_.file) && std::filesystem::exists(gzip)) source_.file = gzip;
    source_.name += ": " + source_.file.string();
  }

  void set_places() {
    for (int axis = 0; axis < 3; ++axis) image_.spacing[axis] = header_.spacing(axis);
    const auto unit = std::ranges::find(kLengthUnits, header_.units & kLengthBits, &LengthUnit::code);
    if (unit != std::end(kLengthUnits)) image_.length_unit = unit->name;
    if (const auto stated = header_.axes()) {
      image_.space = "RAS";
      image_.axes = *stated;
      return;
    }
    for (int axis = 0; axis < 3; ++axis)
      image_.axes.directions[static_cast<std::size_t>(axis)] *= image_.spacing[axis];
  }

  NiftiHeader header_;
  const std::filesystem::path& path_;
  ImageHeader image_;
  VolumeSource source_;
};

/// The path of the header of a pair, given either of its files.
std::filesystem::path header_path(const std::filesystem::path& path) {
  if (!file_extension(path).starts_with(".img")) return path;
  const std::filesystem::path header = path.parent_path() / (file_stem(path) + ".hdr");
  std::filesystem::path packed = header;
  packed += ".gz";
  return !std::filesystem::exists(header) && std::filesystem::exists(packed) ? packed : header;
}

ImageHeader read_image(const std::filesystem::path& path) {
  const std::filesystem::path header = header_path(path);
  return nifti_image(read_nifti_header(header), header);
}

VolumeSeries find_series(const std::filesystem::path& path, const std::string& array) {
  // Radiance pictures end in .hdr too.
  if (read_beginning(path).starts_with("#?")) return {};
  return series_of(read_image(path), array, StepTimes::kSpaced);
}

/// Reads a NIfTI as a grid. Radiance pictures end in .hdr too and are read by VTK.
GridFile read_grid(const std::filesystem::path& path) {
  const bool picture = file_extension(path) == ".hdr" && read_beginning(path).starts_with("#?");
  return picture ? read_grid_by_library(path) : grid_of(read_image(path), path);
}

/// The other files that may belong to a pair.
std::vector<std::filesystem::path> others_of_pair(const std::filesystem::path& path) {
  const std::string extension = file_extension(path);
  const bool header = extension.starts_with(".hdr");
  if (!header && !extension.starts_with(".img")) return {};
  std::vector<std::filesystem::path> files;
  for (const char* other :
       {header ? ".img" : ".hdr", header ? ".img.gz" : ".hdr.gz", header ? ".IMG" : ".HDR"})
    files.push_back(path.parent_path() / (file_stem(path) + other));
  return files;
}

bool is_nifti(std::string_view bytes) {
  return (bytes.size() >= 348 && bytes.substr(344, 4) == std::string_view("n+1\0", 4)) ||
         (bytes.size() >= 8 && bytes.substr(4, 4) == std::string_view("n+2\0", 4));
}

}  // namespace

InputFormat nifti_format() {
  return {.name = "NIfTI",
          .endings = ".nii .nii.gz .hdr",
          .more_endings = ".hdr.gz .img .img.gz",
          .shown_by = is_nifti,
          .read_header = read_image,
          .read_grid = read_grid,
          .find_series = find_series,
          .referred_files = others_of_pair,
          .several_times = true};
}

ImageHeader nifti_image(std::string_view text, const std::filesystem::path& path) {
  return Parser(text, path).run();
}

}  // namespace adamas::io
