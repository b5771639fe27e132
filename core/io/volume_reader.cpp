#include "core/io/volume_reader.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

#include "core/base/assert.h"
#include "core/base/error.h"
#include "core/io/input_file.h"

namespace adamas {

namespace {

static_assert(std::endian::native == std::endian::little, "big-endian files are those to turn round");

/// Bytes of a file that are looked at or converted in one go.
constexpr std::size_t kPiece = std::size_t{1} << 18;

void swap_bytes(std::byte* samples, std::size_t bytes, std::size_t width) {
  for (std::size_t at = 0; at < bytes; at += width) std::reverse(samples + at, samples + at + width);
}

/// The nearest value of the other type: numbers beyond its range become its greatest.
template <class Sample, class Stored>
Sample converted(Stored value) {
  if constexpr (std::is_same_v<Stored, double>) {
    constexpr double kMost = std::numeric_limits<Sample>::max();
    if (std::isfinite(value)) value = std::clamp(value, -kMost, kMost);
  }
  return static_cast<Sample>(value);
}

/// Turns a plane round along x and y where the file counts down.
template <class T>
void turn(std::byte* samples, std::uint64_t nx, std::uint64_t ny, bool along_x, bool along_y) {
  using Sample = std::array<std::byte, sizeof(T)>;
  auto* first = reinterpret_cast<Sample*>(samples);
  if (along_x) {
    for (std::uint64_t j = 0; j < ny; ++j) std::reverse(first + j * nx, first + (j + 1) * nx);
  }
  for (std::uint64_t j = 0; along_y && j < ny / 2; ++j) {
    std::swap_ranges(first + j * nx, first + (j + 1) * nx, first + (ny - 1 - j) * nx);
  }
}

}  // namespace

VolumeReader::VolumeReader(VolumeSource source) : source_(std::move(source)) {
  source_.grid.check(source_.name);
  find_samples();
}

void VolumeReader::find_samples() {
  const std::string& name = source_.name;
  const std::uint64_t size = check_input_file(source_.file);
  const std::uint64_t expected = source_.sample_file_bytes();
  stream_.open(source_.file, std::ios::binary);
  begin_ = source_.header_bytes;
  std::vector<std::byte> piece;
  for (std::uint64_t lines = source_.skip_lines; lines > 0;) {
    if (begin_ >= size)
      fail("{}: expected {} lines to skip, found {}", name, source_.skip_lines, source_.skip_lines - lines);
    piece.resize(std::min<std::uint64_t>(kPiece, size - begin_));
    read_at(begin_, piece.data(), piece.size());
    for (const std::byte b : piece) {
      ++begin_;
      if (b == std::byte{'\n'} && --lines == 0) break;
    }
  }
  const std::uint64_t left = size - std::min(begin_, size);
  if (source_.at_end) source_.skip_bytes = left - std::min(expected, left);
  const std::uint64_t before = source_.skip_bytes + source_.count_bytes;
  const bool whole = source_.skip_bytes <= left && before <= left && left - before >= expected;
  if (!whole || (source_.exact && left - before != expected)) {
    const auto& n = source_.grid.dimensions;
    fail("{}: expected {} bytes for {} x {} x {} samples of {}{}, found {}", name, expected, n[0], n[1], n[2],
         stored_name(source_.stored),
         begin_ + before > 0 ? fmt::format(" after {} others", begin_ + before) : "",
         left - std::min(before, left));
  }
  begin_ += before;
  if (source_.count_bytes == 0) return;
  std::array<std::byte, 8> bytes{};
  read_at(begin_ - source_.count_bytes, bytes.data(), source_.count_bytes);
  if (source_.big_endian)
    std::reverse(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(source_.count_bytes));
  const auto count = std::bit_cast<std::uint64_t>(bytes);
  if (count != expected) fail("{}: expected an array of {} bytes, found one of {}", name, expected, count);
}

void VolumeReader::read_at(std::uint64_t at, std::byte* bytes, std::size_t size) {
  stream_.clear();
  stream_.seekg(static_cast<std::streamoff>(at));
  stream_.read(reinterpret_cast<char*>(bytes), static_cast<std::streamsize>(size));
  if (!stream_) {
    fail("{}: expected {} bytes from byte {} on, found {}", source_.name, size, at, stream_.gcount());
  }
}

void VolumeReader::read_as_stored(std::uint64_t at, std::span<std::byte> samples) {
  read_at(at, samples.data(), samples.size());
  const std::size_t width = stored_bytes(source_.stored);
  if (source_.big_endian && width > 1) swap_bytes(samples.data(), samples.size(), width);
}

template <class Stored, class Sample>
void VolumeReader::read_converted(std::uint64_t at, std::span<std::byte> samples) {
  constexpr std::size_t kCount = kPiece / sizeof(Stored);
  const std::size_t total = samples.size() / sizeof(Sample);
  for (std::size_t begin = 0; begin < total; begin += kCount) {
    const std::size_t count = std::min(kCount, total - begin);
    buffer_.resize(count * sizeof(Stored));
    read_as_stored(at + begin * sizeof(Stored), buffer_);
    for (std::size_t i = 0; i < count; ++i) {
      Stored value;
      std::memcpy(&value, buffer_.data() + i * sizeof(Stored), sizeof(Stored));
      const auto sample = converted<Sample>(value);
      std::memcpy(samples.data() + (begin + i) * sizeof(Sample), &sample, sizeof(Sample));
      // Wide enough for both, so that the difference is that of the numbers themselves; NaN differs from
      // none.
      const long double change = std::abs(static_cast<long double>(sample) - static_cast<long double>(value));
      if (!(change > 0)) continue;
      ++changed_;
      greatest_change_ = std::max(greatest_change_, static_cast<double>(change));
    }
  }
}

void VolumeReader::read_plane(std::uint64_t k, std::span<std::byte> samples) {
  const VolumeGrid& volume = source_.grid;
  ADAMAS_ASSERT(k < volume.dimensions[2] && samples.size() == volume.plane_bytes());
  const std::uint64_t plane = source_.reversed[2] ? volume.dimensions[2] - 1 - k : k;
  const std::uint64_t at = begin_ + plane * volume.plane_samples() * stored_bytes(source_.stored);
  switch (source_.stored) {
    case StoredType::kInt8:
      read_converted<std::int8_t, std::int16_t>(at, samples);
      break;
    case StoredType::kInt32:
      read_converted<std::int32_t, float>(at, samples);
      break;
    case StoredType::kUint32:
      read_converted<std::uint32_t, float>(at, samples);
      break;
    case StoredType::kInt64:
      read_converted<std::int64_t, float>(at, samples);
      break;
    case StoredType::kUint64:
      read_converted<std::uint64_t, float>(at, samples);
      break;
    case StoredType::kFloat64:
      read_converted<double, float>(at, samples);
      break;
    default:
      read_as_stored(at, samples);
  }
  const auto [nx, ny, nz] = volume.dimensions;
  const auto [along_x, along_y, along_z] = source_.reversed;
  if (sample_bytes(volume.type) == 1) return turn<std::uint8_t>(samples.data(), nx, ny, along_x, along_y);
  if (sample_bytes(volume.type) == 2) return turn<std::uint16_t>(samples.data(), nx, ny, along_x, along_y);
  turn<float>(samples.data(), nx, ny, along_x, along_y);
}

std::string VolumeReader::note() const {
  const std::string from = stored_name(source_.stored), to = sample_name(source_.grid.type);
  if (from == to) return {};
  return fmt::format("{}: {} samples are read as {}, {}", source_.name, from, to,
                     changed_ == 0
                         ? "without loss"
                         : fmt::format("{} of them changed, by at most {:.3g}", changed_, greatest_change_));
}

VolumeReader open_volume(const std::filesystem::path& path, const std::string& array) {
  const std::string extension = file_extension(path);
  const bool nrrd = extension == ".nrrd" || extension == ".nhdr";
  const bool meta_image = extension == ".mha" || extension == ".mhd";
  if (!nrrd && !meta_image && extension != ".vti") {
    fail("{}: expected a volume whose name ends in .nrrd, .nhdr, .mha, .mhd or .vti, found '{}'",
         path.string(), extension);
  }
  const std::string text = read_beginning(path);
  return VolumeReader(nrrd         ? nrrd_source(text, path)
                      : meta_image ? meta_image_source(text, path)
                                   : vti_source(text, path, array));
}

VolumeReader open_raw_volume(const std::filesystem::path& path, const RawVolume& volume) {
  VolumeSource source;
  source.name = path.string();
  source.file = path;
  source.skip_bytes = volume.header_bytes;
  source.exact = true;
  source.set_stored(volume.type);
  source.big_endian = volume.big_endian;
  source.grid.dimensions = volume.dimensions;
  source.grid.spacing = volume.spacing;
  source.grid.origin = volume.origin;
  return VolumeReader(std::move(source));
}

}  // namespace adamas
