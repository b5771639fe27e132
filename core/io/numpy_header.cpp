#include "core/io/numpy_header.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>
#include <utility>

#include "core/base/error.h"
#include "core/io/decompression.h"
#include "core/io/header_text.h"
#include "core/io/input_file.h"
#include "core/io/input_formats.h"
#include "core/io/zip_directory.h"

namespace adamas::io {

namespace {

constexpr std::string_view kMagic = "\x93NUMPY", kZipMagic = "PK\3\4", kEnding = ".npy";
/// The bytes before the length of a header's text.
constexpr std::size_t kBeforeLength = 8;
constexpr std::size_t kShown = 60;

/// Parses the text of a header, a dictionary of Python: {'descr': '<f4', 'fortran_order': False, 'shape': (4,
/// 5), }.
class Dictionary {
 public:
  Dictionary(std::string_view text, const std::string& name) : text_(text), rest_(text), name_(name) {}

  NumpyHeader parse() {
    expect('{');
    while (!take('}')) {
      const std::string_view key = quoted();
      expect(':');
      if (key == "descr") {
        set_type();
      } else if (key == "fortran_order") {
        header_.fortran_order = truth();
      } else if (key == "shape") {
        set_shape();
      } else {
        refuse();
      }
      found_ += key.front();
      if (!take(',') && !see('}')) refuse();
    }
    std::ranges::sort(found_);
    if (found_ != "dfs") refuse();
    return std::move(header_);
  }

 private:
  [[noreturn]] void refuse() const {
    fail("{}: expected a header of NumPy with descr, fortran_order and shape, found '{}'", name_,
         printable(text_, kShown));
  }
  void skip_blanks() { rest_.remove_prefix(std::min(rest_.find_first_not_of(" \t\r\n"), rest_.size())); }
  bool see(char c) {
    skip_blanks();
    return rest_.starts_with(c);
  }
  bool take(char c) {
    if (!see(c)) return false;
    rest_.remove_prefix(1);
    return true;
  }
  void expect(char c) {
    if (!take(c)) refuse();
  }
  std::string_view quoted() {
    skip_blanks();
    const char quote = rest_.empty() ? '\0' : rest_.front();
    if (quote != '\'' && quote != '"') refuse();
    const std::size_t end = rest_.find(quote, 1);
    if (end == std::string_view::npos || end == 1) refuse();
    const std::string_view text = rest_.substr(1, end - 1);
    rest_.remove_prefix(end + 1);
    return text;
  }
  bool truth() {
    skip_blanks();
    for (const auto& [word, value] : {std::pair(std::string_view("True"), true), {"False", false}}) {
      if (!rest_.starts_with(word)) continue;
      rest_.remove_prefix(word.size());
      return value;
    }
    refuse();
  }

  /// Sets the type by a text as "<f4": the order of bytes, a kind and a number of bytes.
  void set_type() {
    if (see('[')) return skip_records();
    const std::string_view text = quoted();
    constexpr std::array kKinds{std::pair(std::string_view("b1"), StoredType::kUint8),
                                std::pair(std::string_view("u1"), StoredType::kUint8),
                                std::pair(std::string_view("i1"), StoredType::kInt8),
                                std::pair(std::string_view("u2"), StoredType::kUint16),
                                std::pair(std::string_view("i2"), StoredType::kInt16),
                                std::pair(std::string_view("u4"), StoredType::kUint32),
                                std::pair(std::string_view("i4"), StoredType::kInt32),
                                std::pair(std::string_view("u8"), StoredType::kUint64),
                                std::pair(std::string_view("i8"), StoredType::kInt64),
                                std::pair(std::string_view("f4"), StoredType::kFloat32),
                                std::pair(std::string_view("f8"), StoredType::kFloat64)};
    const std::string_view kind = text.substr(text.find_first_of("<>|") == 0 ? 1 : 0);
    const auto* found = std::ranges::find(kKinds, kind, [](const auto& entry) { return entry.first; });
    if (found != kKinds.end()) header_.type = found->second;
    header_.type_text = text;
    header_.big_endian = text.starts_with('>');
  }

  /// Skips a list of fields with names, as [('a', '<f4'), ('b', '<i2', (3,))].
  void skip_records() {
    int depth = 0;
    do {
      skip_blanks();
      const char c = rest_.empty() ? '\0' : rest_.front();
      if (c == '\0') refuse();
      if (c == '\'' || c == '"') {
        quoted();
        continue;
      }
      depth += c == '[' || c == '(' ? 1 : c == ']' || c == ')' ? -1 : 0;
      rest_.remove_prefix(1);
    } while (depth > 0);
  }

  void set_shape() {
    expect('(');
    while (!take(')')) {
      skip_blanks();
      std::uint64_t length = 0;
      const auto [end, code] = std::from_chars(rest_.data(), rest_.data() + rest_.size(), length);
      if (code != std::errc()) refuse();
      rest_.remove_prefix(static_cast<std::size_t>(end - rest_.data()));
      header_.shape.push_back(length);
      // Python 2 wrote long numbers as 3L.
      take('L');
      if (!take(',') && !see(')')) refuse();
    }
  }

  std::string_view text_, rest_;
  const std::string& name_;
  NumpyHeader header_;
  std::string found_;  ///< the first letters of the keys
};

/// How the axes of an array run through a grid.
struct Layout {
  std::array<std::uint64_t, 3> dimensions{1, 1, 1};  ///< along x, y, z
  std::uint64_t components = 1;
  bool slowest = false;  ///< whether all values of a component lie together
  std::string axes;      ///< their names in the order of the shape: "z, y, x"
};

std::string shape_text(const std::vector<std::uint64_t>& shape) {
  return fmt::format("({})", fmt::join(shape, ", "));
}

/// Returns the layout of an array; none if it has more than four axes, or no values.
std::optional<Layout> layout_of(const NumpyHeader& header) {
  std::vector<std::uint64_t> lengths = header.shape;
  if (lengths.size() > 3) std::erase(lengths, 1u);
  if (std::ranges::count(lengths, 0u) > 0 || lengths.size() > 4) return {};
  Layout layout;
  const bool has_components = lengths.size() == 4, first = has_components && lengths[0] <= lengths[3];
  if (has_components) {
    const auto place = first ? lengths.begin() : lengths.end() - 1;
    layout.components = *place;
    layout.slowest = first != header.fortran_order;
    lengths.erase(place);
  }
  if (!header.fortran_order) std::ranges::reverse(lengths);
  std::ranges::copy(lengths, layout.dimensions.begin());

  std::vector<std::string_view> names{"x", "y", "z"};
  names.resize(std::max<std::size_t>(lengths.size(), 1));
  if (!header.fortran_order) std::ranges::reverse(names);
  if (has_components) names.insert(first ? names.begin() : names.end(), "component");
  layout.axes = fmt::format("{}", fmt::join(names, ", "));
  return layout;
}

/// Returns the source of an array of which a header tells, without its place.
VolumeSource source_of(const NumpyHeader& header, const Layout& layout, const std::string& name) {
  VolumeSource source;
  source.name = name;
  source.set_stored(*header.type);
  source.big_endian = header.big_endian;
  source.components = static_cast<std::size_t>(layout.components);
  source.grid.dimensions = layout.dimensions;
  source.grid.check(name);
  source.check_size();
  return source;
}

std::string kind_of(const NumpyHeader& header, const Layout& layout) {
  return fmt::format("NumPy array of axes {}{}", layout.axes, header.fortran_order ? " (Fortran order)" : "");
}

ImageHeader image_of_array(const std::filesystem::path& path) {
  const std::string name = path.string();
  const NumpyHeader header = parse_numpy_header(read_beginning(path), name);
  if (!header.type) {
    fail("{}: expected whole numbers of 8 to 64 bits, truth values, float32 or float64, found {}", name,
         header.type_text.empty() ? "records" : "'" + printable(header.type_text, kShown) + "'");
  }
  std::optional<Layout> found = layout_of(header);
  if (!found)
    fail("{}: expected one to four axes with values, found the shape {}", name, shape_text(header.shape));
  Layout& layout = *found;
  ImageHeader image;
  image.name = name;
  image.kind = kind_of(header, layout);
  image.centers.emplace();
  image.dimensions = layout.dimensions;
  if (layout.slowest) image.times = std::exchange(layout.components, 1);
  VolumeSource source = source_of(header, layout, name);
  image.time_step = source.sample_file_bytes();
  source.file = path;
  source.header_bytes = header.bytes;
  // numpy.save() may have written several arrays, of which numpy.load() reads the first.
  source.trailing = TrailingBytes::kRemark;
  image.arrays.push_back({.name = {}, .centering = Centering::kPoints, .source = std::move(source)});
  return image;
}

/// Returns the first bytes of a member, unpacked.
std::string beginning_of(const std::shared_ptr<const FileHandle>& file, const ZipMember& member) {
  const auto most = static_cast<std::size_t>(std::min<std::uint64_t>(member.size, kLongestHeader));
  std::string bytes(member.deflated ? 0 : most, '\0');
  if (!member.deflated) {
    bytes.resize(file->read_some(member.begin, std::as_writable_bytes(std::span(bytes))));
    return bytes;
  }
  ByteTaker taker(supply_file(file, member.begin));
  const std::string name = fmt::format("{}: '{}'", file->name(), printable(member.name, kShown));
  inflate_raw_stream(taker.part(member.packed), member.checksum, name, [&](std::string_view piece) {
    bytes += piece.substr(0, most - bytes.size());
    return bytes.size() < most;
  });
  return bytes;
}

/// Reads the headers of the arrays in an archive.
class ArrayArchive {
 public:
  explicit ArrayArchive(const std::filesystem::path& path) : path_(path), file_(FileHandle::open(path)) {}

  ImageHeader read() {
    for (const ZipMember& member : list_zip_archive(*file_)) {
      if (!member.name.ends_with(kEnding) || !member.is_readable || !add(member))
        left_out_.push_back(member.name);
    }
    if (arrays_.empty()) fail("{}: expected an array of numbers, found {}", path_.string(), names_left_out());
    return image();
  }

 private:
  /// Adds an array; returns false if it has no numbers of ours along one to four axes.
  bool add(const ZipMember& member) {
    const std::string name = fmt::format("{}: '{}'", path_.string(), printable(member.name, kShown));
    const NumpyHeader header = parse_numpy_header(beginning_of(file_, member), name);
    const std::optional<Layout> layout = layout_of(header);
    if (!header.type || !layout) return false;
    VolumeSource source = source_of(header, *layout, name);
    source.kind = kind_of(header, *layout);
    if (member.size != header.bytes + source.sample_file_bytes()) {
      fail("{}: expected {} behind a header of {} bytes, found {} bytes in all", name, source.size_text(),
           header.bytes, member.size);
    }
    source.file = path_;
    source.header_bytes = member.begin + (member.deflated ? 0 : header.bytes);
    source.skip_bytes = member.deflated ? header.bytes : 0;
    if (member.deflated) {
      source.coding = SamplePacking::kRawDeflate;
      source.checksum = member.checksum;
      source.trailing = TrailingBytes::kRefused;
    }
    arrays_.push_back({.name = member.name.substr(0, member.name.size() - kEnding.size()),
                       .centering = Centering::kPoints,
                       .source = std::move(source),
                       .planar = layout->slowest});
    return true;
  }

  [[nodiscard]] std::string names_left_out() const {
    if (left_out_.empty()) return "none";
    std::vector<std::string> names;
    for (const std::string& name : left_out_) names.push_back("'" + printable(name, kShown) + "'");
    return fmt::format("{}", fmt::join(names, ", "));
  }

  /// Takes the arrays of the greatest shape.
  ImageHeader image() {
    const auto samples = [](const ImageArray& array) { return array.source.grid.samples(); };
    const VolumeSource& largest = std::ranges::max_element(arrays_, {}, samples)->source;
    ImageHeader image;
    image.name = path_.string();
    image.kind = largest.kind;
    image.centers.emplace();
    image.dimensions = largest.grid.dimensions;
    for (ImageArray& array : arrays_) {
      if (array.source.grid.dimensions != image.dimensions) {
        left_out_.push_back(array.name + std::string(kEnding));
        continue;
      }
      if (array.source.kind != image.kind) image.kind = "NumPy arrays, some of them in Fortran order";
      image.arrays.push_back(std::move(array));
    }
    if (left_out_.empty()) return image;
    for (ImageArray& array : image.arrays)
      array.source.remark = fmt::format("{} of another shape or kind: not read", names_left_out());
    return image;
  }

  const std::filesystem::path& path_;
  std::shared_ptr<const FileHandle> file_;
  std::vector<ImageArray> arrays_;
  std::vector<std::string> left_out_;
};

VolumeSeries find_series(const std::filesystem::path& path, const std::string& array) {
  return series_of(numpy_image(path), array, StepTimes::kCounted);
}

}  // namespace

NumpyHeader parse_numpy_header(std::string_view beginning, const std::string& name) {
  if (!beginning.starts_with(kMagic)) fail("{}: expected an array of NumPy, found something else", name);
  const auto byte = [&](std::size_t at) {
    if (at >= beginning.size())
      fail("{}: expected a header of NumPy, found {} bytes of one", name, beginning.size());
    return static_cast<std::uint64_t>(static_cast<unsigned char>(beginning[at]));
  };
  const std::uint64_t version = byte(kMagic.size());
  if (version < 1 || version > 3) fail("{}: expected NumPy's format 1 to 3, found {}", name, version);
  const std::size_t length_bytes = version == 1 ? 2 : 4, begin = kBeforeLength + length_bytes;
  std::uint64_t length = 0;
  for (std::size_t i = 0; i < length_bytes; ++i) length |= byte(kBeforeLength + i) << (8 * i);
  if (length > beginning.size() - begin) {
    fail("{}: expected a header of {} bytes, found {} of them", name, length, beginning.size() - begin);
  }
  NumpyHeader header = Dictionary(beginning.substr(begin, static_cast<std::size_t>(length)), name).parse();
  header.bytes = begin + length;
  return header;
}

ImageHeader numpy_image(const std::filesystem::path& path) {
  std::array<char, kZipMagic.size()> bytes{};
  FileHandle::open(path)->read_some(0, std::as_writable_bytes(std::span(bytes)));
  const bool archive = std::string_view(bytes.data(), bytes.size()) == kZipMagic;
  return archive ? ArrayArchive(path).read() : image_of_array(path);
}

InputFormat numpy_format() {
  return {.name = "NumPy",
          .endings = ".npy .npz",
          .shown_by = [](std::string_view bytes) { return bytes.starts_with(kMagic); },
          .read_header = numpy_image,
          .find_series = find_series,
          .several_arrays = true,
          .several_times = true};
}

}  // namespace adamas::io
