#include "core/io/volume_unpacking.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstring>
#include <optional>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/io/byte_supply.h"
#include "core/io/decompression.h"
#include "core/io/header_text.h"

namespace adamas::io {

namespace {

constexpr std::string_view kStage = "unpacking";
/// The number of bytes between two reports.
constexpr std::uint64_t kStep = std::uint64_t{1} << 22;

class Unpacker {
 public:
  Unpacker(const VolumeSource& source, ByteSupply supply)
      : source_(source), name_(source.name), bytes_(std::move(supply)) {}

  void run(SampleSink& sink) {
    sink_ = &sink;
    switch (source_.coding) {
      case SamplePacking::kRaw:
        return copy_counted();
      case SamplePacking::kDeflate:
      case SamplePacking::kRawDeflate:
      case SamplePacking::kBzip2:
        return decompress_all();
      case SamplePacking::kText:
        return read_text();
      case SamplePacking::kVtkBlocks:
        return inflate_blocks();
    }
  }

  std::uint64_t measure() {
    if (source_.coding == SamplePacking::kText) {
      std::uint64_t words = 0;
      while (!word().empty()) ++words;
      return words * stored_bytes(source_.stored);
    }
    if (source_.coding != SamplePacking::kVtkBlocks) return count();
    const std::uint64_t blocks = count(), size = count(), last = count();
    constexpr std::uint64_t kMost = std::uint64_t{1} << 31;
    if (blocks > kMost || size > kMost || last > size || (blocks == 0 && last > 0))
      fail("{}: expected compressed blocks, found {} of {} bytes", name_, blocks, size);
    return last > 0 ? (blocks - 1) * size + last : blocks * size;
  }

 private:
  /// Reads the next of the unsigned numbers that precede samples.
  std::uint64_t count() {
    std::array<char, 8> bytes{};
    const auto end = bytes.begin() + static_cast<std::ptrdiff_t>(source_.count_bytes);
    if (!bytes_.take_all(bytes.data(), source_.count_bytes)) {
      fail("{}: expected a count of {} bytes before the samples, found the end", name_, source_.count_bytes);
    }
    if (source_.big_endian) std::reverse(bytes.begin(), end);
    return std::bit_cast<std::uint64_t>(bytes);
  }

  void copy_counted() {
    const std::uint64_t size = source_.count_bytes > 0 ? count() : sink_->expected();
    if (size != sink_->expected()) {
      fail("{}: expected an array of {} bytes, found one of {}", name_, sink_->expected(), size);
    }
    const ByteSupply part = bytes_.part(size);
    for (std::string_view piece = part(); !piece.empty(); piece = part()) sink_->take(piece);
    expect_end(size);
  }

  /// Throws Error if bytes follow an array of that size and the source refuses them.
  void expect_end(std::uint64_t size) {
    if (source_.trailing != TrailingBytes::kRefused) return;
    std::uint64_t more = 0;
    for (std::string_view piece = bytes_.take(kPiece); !piece.empty(); piece = bytes_.take(kPiece))
      more += piece.size();
    if (more > 0) fail("{}: expected an array of {} bytes, found {} more behind it", name_, size, more);
  }

  void decompress_all() {
    std::uint64_t skip = source_.skip_bytes;
    const auto take = [&](std::string_view piece) {
      const std::size_t skipped = static_cast<std::size_t>(std::min<std::uint64_t>(skip, piece.size()));
      skip -= skipped;
      return sink_->take(piece.substr(skipped));
    };
    const ByteSupply all = bytes_.part(~std::uint64_t{0});
    if (source_.coding == SamplePacking::kBzip2) {
      bunzip_stream(all, name_, take);
    } else if (source_.coding == SamplePacking::kRawDeflate) {
      inflate_raw_stream(all, source_.checksum, name_, take);
    } else {
      inflate_stream(all, name_, take);
    }
  }

  void inflate_blocks() {
    const std::uint64_t blocks = count(), size = count(), last = count();
    // The comparison is written without a product that could overflow.
    const std::uint64_t expected = sink_->expected(), full = last > 0 ? blocks - 1 : blocks;
    if (blocks == 0 || last > size || full > expected / std::max<std::uint64_t>(size, 1) ||
        full * size + last != expected) {
      fail("{}: expected compressed blocks for {} bytes, found {} of {} bytes with {} in the last", name_,
           expected, blocks, size, last > 0 ? last : size);
    }
    std::vector<std::uint64_t> packed;
    for (std::uint64_t i = 0; i < blocks; ++i) packed.push_back(count());
    for (std::uint64_t i = 0; i < blocks; ++i) inflate_block(i, packed[i], i < full ? size : last);
    expect_end(expected);
  }

  void inflate_block(std::uint64_t block, std::uint64_t packed, std::uint64_t size) {
    const std::string name = fmt::format("{}: block {}", name_, block);
    const ByteSupply part = bytes_.part(packed);
    std::uint64_t found = 0;
    inflate_stream(part, name, [&](std::string_view piece) {
      found += piece.size();
      if (found > size) fail("{}: expected {} bytes, found more", name, size);
      return sink_->take(piece);
    });
    if (found != size) fail("{}: expected {} bytes, found {}", name, size, found);
    // The rest of the block, which the stream did not need, is skipped.
    for (std::string_view rest = part(); !rest.empty();) rest = part();
  }

  void read_text() {
    for (std::uint64_t skip = source_.skip_bytes; skip > 0;) {
      const std::string_view skipped = bytes_.take(skip);
      if (skipped.empty()) fail("{}: expected {} bytes to skip, found fewer", name_, source_.skip_bytes);
      skip -= skipped.size();
    }
    visit_stored_type(source_.stored, [this]<class Stored>(Stored) { read_numbers<Stored>(); });
  }

  /// The next word between blanks and commas, empty at the end. A word at the end may have been cut off: only
  /// a tag or a blank behind it shows that it is complete.
  std::string_view word() {
    constexpr std::string_view kSpace = " \t\r\n,";
    constexpr std::size_t kLongest = 512;
    word_.clear();
    while (true) {
      if (text_.empty()) text_ = bytes_.take(kPiece);
      if (text_.empty()) return source_.before_tag ? std::string_view(word_) : std::string_view();
      if (word_.empty()) text_.remove_prefix(std::min(text_.find_first_not_of(kSpace), text_.size()));
      const std::size_t end = text_.find_first_of(kSpace);
      word_ += text_.substr(0, std::min(end, kLongest));
      if (word_.size() > kLongest || end != std::string_view::npos) {
        text_.remove_prefix(std::min(end, text_.size()));
        return word_;
      }
      text_ = {};
    }
  }

  template <class Stored>
  void read_numbers() {
    const std::uint64_t count = source_.values();
    std::vector<Stored> values;
    for (std::uint64_t i = 0; i < count; ++i) {
      const std::string_view text = word();
      if (text.empty()) fail("{}: expected {} numbers, found {}", name_, count, i);
      Stored value{};
      const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
      if (code != std::errc() || end != text.data() + text.size()) {
        fail("{}: expected {} numbers of {}, found '{}' after {}", name_, count, stored_name(source_.stored),
             printable(text, 40), i);
      }
      values.push_back(value);
      if (values.size() * sizeof(Stored) < kPiece && i + 1 < count) continue;
      sink_->take(std::as_bytes(std::span(values)));
      values.clear();
    }
    if (source_.trailing != TrailingBytes::kRefused) return;
    std::uint64_t found = count;
    while (!word().empty()) ++found;
    // A word that ends with the file counts too.
    if (!word_.empty()) ++found;
    if (found != count) fail("{}: expected {} numbers, found {}", name_, count, found);
  }

  static constexpr std::size_t kPiece = std::size_t{1} << 18;

  const VolumeSource& source_;
  const std::string& name_;
  ByteTaker bytes_;
  SampleSink* sink_ = nullptr;
  std::string_view text_;
  std::string word_;
};

/// Throws Error if not even the best compression could hold the samples in the rest of the file.
void check_size(const VolumeSource& source, std::uint64_t left) {
  const std::uint64_t expected = source.sample_file_bytes();
  const bool bunzip = source.coding == SamplePacking::kBzip2;
  if (expected / (bunzip ? kGreatestBunzip : kGreatestInflation) <= left) return;
  fail("{}: expected {}, found {} packed ones", source.name, source.size_text(), left);
}

/// Throws Error unless each of several files holds an equal part of the samples; otherwise all would be
/// misplaced.
void check_parts(const VolumeSource& source) {
  const std::uint64_t count = source.more_files.size() + 1, expected = source.sample_file_bytes() / count;
  const auto check = [&](const std::filesystem::path& path) {
    const std::uint64_t found = FileHandle::open(path)->size();
    if (found != expected) {
      fail("{}: expected {} bytes, as in each of {} files, found {}", path.string(), expected, count, found);
    }
  };
  if (count == 1 || source.coding != SamplePacking::kRaw) return;
  check(source.file);
  std::for_each(source.more_files.begin(), source.more_files.end(), check);
}

/// The packed bytes, with base64 decoded; sets how many bytes of files are left for them.
ByteSupply packed_bytes(const VolumeSource& source, std::uint64_t& left) {
  const auto file = FileHandle::open(source.file);
  // Behind a tag the offset leads into text, where blanks count as characters.
  std::uint64_t begin = file->behind_lines(source.header_bytes, source.skip_lines, source.name);
  // Bytes of streams and words of text are skipped when they are unpacked.
  if (source.coding == SamplePacking::kRaw || source.coding == SamplePacking::kVtkBlocks)
    begin += std::min(source.skip_bytes, file->size());
  left = file->size() - std::min(begin, file->size());
  ByteSupply bytes = supply_file(file, begin);
  for (const auto& path : source.more_files) {
    const auto more = FileHandle::open(path);
    left += more->size();
    bytes = supply_both(std::move(bytes), supply_file(more, 0));
  }
  if (source.before_tag) bytes = supply_before(std::move(bytes), '<');
  if (source.base64) bytes = supply_base64(std::move(bytes), source.name);
  return bytes;
}

}  // namespace

SampleSink::SampleSink(const VolumeSource& source, Put put, Progress& progress)
    : source_(source), progress_(progress), put_(std::move(put)), expected_(source.sample_file_bytes()) {
  progress_.step(kStage, 0);
}

SampleSink::SampleSink(const VolumeSource& source, std::shared_ptr<FileHandle> scratch, Progress& progress)
    : SampleSink(
          source, [scratch](std::span<const std::byte> bytes) { scratch->append(bytes); }, progress) {
  file_ = std::move(scratch);
}

bool SampleSink::take(std::span<const std::byte> bytes) {
  progress_.check();
  const std::uint64_t left = expected_ - found();
  if (bytes.size() > left) note_others(bytes.size() - left);
  const std::span<const std::byte> taken =
      bytes.first(static_cast<std::size_t>(std::min<std::uint64_t>(left, bytes.size())));
  put_(taken);
  found_ += taken.size();
  if (found() - reported_ >= kStep) {
    reported_ = found();
    progress_.report(kStage, static_cast<double>(found()) / static_cast<double>(expected_));
  }
  return bytes.size() <= left;
}

void SampleSink::note_others(std::uint64_t bytes) {
  if (source_.trailing == TrailingBytes::kOtherData) return;
  if (source_.trailing == TrailingBytes::kRemark) {
    remark_ = "bytes behind the samples are not read";
    return;
  }
  fail("{}: expected {}, found {} or more unpacked", source_.name, source_.size_text(), expected_ + bytes);
}

VolumeSource SampleSink::finish() const {
  if (found() != expected_)
    fail("{}: expected {}, found {} unpacked", source_.name, source_.size_text(), found());
  VolumeSource result = source_;
  result.scratch = file_;
  result.more_files.clear();
  result.header_bytes = result.skip_lines = result.skip_bytes = 0;
  result.count_bytes = 0;
  result.at_end = result.base64 = result.before_tag = false;
  result.trailing = TrailingBytes::kRefused;
  if (!remark_.empty()) result.remark = remark_;
  result.coding = SamplePacking::kRaw;
  progress_.report(kStage, 1);
  return result;
}

VolumeSource unpack_volume(VolumeSource source, const std::filesystem::path& folder, Progress& progress) {
  return unpack_into(FileHandle::scratch(folder), source, progress);
}

namespace {

VolumeSource unpack(const VolumeSource& source, SampleSink sink) {
  std::uint64_t left = 0;
  ByteSupply bytes = packed_bytes(source, left);
  check_size(source, left);
  check_parts(source);
  Unpacker(source, std::move(bytes)).run(sink);
  VolumeSource result = sink.finish();
  // Numbers in text were stored in this machine's byte order.
  if (source.coding == SamplePacking::kText) result.big_endian = false;
  return result;
}

}  // namespace

VolumeSource unpack_into(std::shared_ptr<FileHandle> scratch, const VolumeSource& source,
                         Progress& progress) {
  source.check_size();
  return unpack(source, SampleSink(source, std::move(scratch), progress));
}

VolumeSource unpack_pieces(const VolumeSource& source, SampleSink::Put put, Progress& progress) {
  source.check_size();
  return unpack(source, SampleSink(source, std::move(put), progress));
}

std::uint64_t measure_vtk_array(const VolumeSource& source) {
  std::uint64_t left = 0;
  return Unpacker(source, packed_bytes(source, left)).measure();
}

}  // namespace adamas::io
