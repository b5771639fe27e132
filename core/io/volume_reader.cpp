#include "core/io/volume_reader.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <type_traits>
#include <utility>

#include "core/base/assert.h"
#include "core/base/error.h"
#include "core/io/file_handle.h"
#include "core/io/input_formats.h"
#include "core/io/volume_unpacking.h"

namespace adamas::io {

namespace {

static_assert(std::endian::native == std::endian::little, "big-endian files are those to turn round");

/// The number of bytes of a file that are read or converted together.
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

}  // namespace

VolumeReader::VolumeReader(VolumeSource source) : source_(std::move(source)) {
  ADAMAS_ASSERT(!source_.packed());
  source_.check_size();
  file_ = source_.scratch ? source_.scratch : FileHandle::open(source_.file);
  find_samples();
}

void VolumeReader::find_samples() {
  const std::string& name = source_.name;
  const std::uint64_t size = file_->size();
  const std::uint64_t expected = source_.sample_file_bytes();
  begin_ = file_->behind_lines(source_.header_bytes, source_.skip_lines, name);
  const std::uint64_t left = size - std::min(begin_, size);
  if (source_.at_end) source_.skip_bytes = left - std::min(expected, left);
  const std::uint64_t before = source_.skip_bytes + source_.count_bytes;
  const bool whole = source_.skip_bytes <= left && before <= left && left - before >= expected;
  const std::uint64_t more = whole ? left - before - expected : 0;
  if (!whole || (source_.trailing == TrailingBytes::kRefused && more > 0)) {
    fail("{}: expected {}{}, found {}", name, source_.size_text(),
         begin_ + before > 0 ? fmt::format(" after {} others", begin_ + before) : "",
         left - std::min(before, left));
  }
  if (source_.trailing == TrailingBytes::kRemark && more > 0)
    source_.remark = fmt::format("{} bytes behind the samples are not read", more);
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
  const std::size_t found = file_->read_some(at, {bytes, size});
  if (found != size) {
    fail("{}: expected {} bytes from byte {} on, found {}", source_.name, size, at, found);
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
      // long double holds both exactly, so that the difference is that of the numbers themselves; NaN differs
      // from none.
      long double exact = static_cast<long double>(value);
      Sample sample{};
      if (source_.scaled()) {
        exact = source_.slope * exact + source_.intercept;
        sample = converted<Sample>(static_cast<double>(exact));
      } else {
        sample = converted<Sample>(value);
      }
      std::memcpy(samples.data() + (begin + i) * sizeof(Sample), &sample, sizeof(Sample));
      const long double change = std::abs(static_cast<long double>(sample) - exact);
      if (!(change > 0)) continue;
      ++changed_;
      if (std::abs(exact) > static_cast<long double>(std::numeric_limits<Sample>::max())) {
        ++cut_off_;
        continue;
      }
      greatest_change_ = std::max(greatest_change_, static_cast<double>(change));
    }
  }
}

template <class Stored>
void VolumeReader::read_plane_of(std::uint64_t at, std::span<std::byte> samples) {
  if constexpr (std::is_same_v<Stored, std::int8_t>) {
    if (!source_.scaled()) return read_converted<Stored, std::int16_t>(at, samples);
  } else if constexpr (sizeof(Stored) <= 2 || std::is_same_v<Stored, float>) {
    if (!source_.scaled()) return read_as_stored(at, samples);
  }
  read_converted<Stored, float>(at, samples);
}

void VolumeReader::read_plane(std::uint64_t k, std::span<std::byte> samples) {
  const VolumeGrid& volume = source_.grid;
  ADAMAS_ASSERT(k < volume.dimensions[2] && samples.size() == volume.plane_bytes());
  const std::uint64_t at = begin_ + k * volume.plane_samples() * stored_bytes(source_.stored);
  const std::uint64_t changed_before = changed_, cut_off_before = cut_off_;
  visit_stored_type(source_.stored, [&]<class Stored>(Stored) { read_plane_of<Stored>(at, samples); });
  was_read_.resize(volume.dimensions[2]);
  if (was_read_[k]) changed_ = changed_before, cut_off_ = cut_off_before;
  was_read_[k] = true;
}

void VolumeReader::read_stored(std::uint64_t first, std::span<std::byte> numbers) {
  read_as_stored(begin_ + first * stored_bytes(source_.stored), numbers);
}

std::string VolumeReader::changes() const {
  const std::uint64_t rounded = changed_ - cut_off_;
  const std::string near = fmt::format("{} of them changed, by at most {:.3g}", rounded, greatest_change_);
  const std::string far = fmt::format("{} beyond its range set to its ends", cut_off_);
  return cut_off_ == 0 ? near : rounded == 0 ? far : near + ", " + far;
}

bool VolumeReader::loses_digits() const {
  return changed_ > 0 && !(source_.scaled() && stored_bytes(source_.stored) <= 2);
}

std::string VolumeReader::note() const {
  std::string text = source_.remark;
  const std::string from = stored_name(source_.stored), to = sample_name(source_.grid.type);
  if (from != to || source_.scaled()) {
    if (!text.empty()) text += "; ";
    text += fmt::format("{} samples are read as {}, ", from, to);
    if (source_.scaled()) text += fmt::format("times {:.9g} plus {:.9g}, ", source_.slope, source_.intercept);
    text += changed_ == 0 ? "without loss" : changes();
  }
  return text.empty() ? text : source_.name + ": " + text;
}

void note_reading(const VolumeReader& reader, Progress& progress) {
  const std::string text = reader.note();
  if (!text.empty()) progress.note(reader.loses_digits() ? NoteKind::kLoss : NoteKind::kRemark, text);
}

namespace {

/// Opens one time of a compressed file; the first call unpacks all times.
VolumeSource unpacked_time(const ImageHeader& header, const VolumeOptions& options, Progress& progress) {
  VolumeSource source = volume_of(header, options.array, options.time);
  std::shared_ptr<const FileHandle>& samples = options.all_times->samples;
  if (samples == nullptr) {
    // volume_of the last time throws if the bytes of all times cannot be counted.
    VolumeSource all = volume_of(header, options.array, header.times - 1);
    all.skip_bytes -= (header.times - 1) * header.time_step;
    all.grid.dimensions[2] *= header.times;
    const VolumeSource unpacked = unpack_volume(std::move(all), options.scratch_folder, progress);
    samples = unpacked.scratch;
    source.remark = unpacked.remark;
  }
  source.scratch = samples;
  source.coding = SamplePacking::kRaw;
  source.header_bytes = options.time.value_or(0) * header.time_step;
  source.skip_bytes = 0;
  return source;
}

/// Finds the samples of a volume, by the header of its file or by the reader of its format.
VolumeSource find_samples(const InputFormat& format, const std::filesystem::path& path,
                          const VolumeOptions& options, Progress& progress) {
  if (format.read_header == nullptr) return format.find_volume(path, options, progress);
  const ImageHeader header = format.read_header(path);
  const bool packed = header.times > 1 && header.arrays.front().source.packed();
  if (packed && options.all_times != nullptr) return unpacked_time(header, options, progress);
  return volume_of(header, options.array, options.time);
}

}  // namespace

VolumeReader open_volume(const std::filesystem::path& path, const VolumeOptions& options,
                         Progress& progress) {
  const InputFormat& format = find_volume_format(path);
  if (options.time && !format.several_times)
    fail("{}: expected NIfTI or HDF5, which may have several times, found {}", path.string(), format.name);
  VolumeSource source = find_samples(format, path, options, progress);
  if (options.keep_scale) source.keep_scale();
  if (source.packed()) source = unpack_volume(std::move(source), options.scratch_folder, progress);
  return VolumeReader(std::move(source));
}

VolumeReader open_raw_volume(const std::filesystem::path& path, const RawVolume& volume) {
  return VolumeReader(volume_of(raw_image(path, volume), {}, {}));
}

}  // namespace adamas::io
