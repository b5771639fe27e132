#include "core/io/nrrd_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "adamas/text.h"
#include "adamas/volume.h"
#include "core/base/error.h"
#include "core/data/anatomical_space.h"
#include "core/io/header_text.h"
#include "core/io/input_file.h"
#include "core/io/input_formats.h"
#include "core/io/material_arrays.h"
#include "core/io/referred_files.h"

namespace adamas::io {

namespace {

/// A word of a header as a number; empty if it is none.
template <class T>
std::optional<T> nrrd_number(std::string_view word) {
  T value{};
  const auto [end, code] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (code != std::errc() || end != word.data() + word.size()) return {};
  return value;
}

/// The fields of an NRRD header that have an entry for each axis, as words of its text.
struct NrrdAxisFields {
  using Words = std::vector<std::string_view>;

  std::size_t dimension = 0;  ///< 0: not given
  std::vector<std::size_t> sizes;
  Words spacings, mins, maxs, centers, kinds, origin;
  std::vector<Words> directions;

  /// Sets the sizes, components, axes and centers of a header. Throws Error with `name` if they describe no
  /// grid in space.
  void apply(const std::string& name, NrrdHeader& header) const;

 private:
  enum class Other { kNone, kFirst, kLast };
  /// Whether the first or the last axis is an axis of components.
  [[nodiscard]] Other other_axis(const std::string& name) const;
  /// Whether the header says that an axis is not one of space.
  [[nodiscard]] bool is_other(std::size_t at) const;
  void set_axis(std::size_t axis, std::size_t at, NrrdHeader& header) const;
  [[nodiscard]] Vec3 direction(const std::string& name, std::size_t at) const;
};

/// A number of a list with an entry per axis; empty if it is left out or "nan".
std::optional<double> entry(const NrrdAxisFields::Words& words, std::size_t at) {
  if (at >= words.size()) return {};
  const auto value = nrrd_number<double>(words[at]);
  return value && std::isfinite(*value) ? value : std::nullopt;
}

std::optional<Centering> center(const NrrdAxisFields::Words& words, std::size_t at) {
  if (at < words.size() && words[at] == "cell") return Centering::kCells;
  if (at < words.size() && words[at] == "node") return Centering::kPoints;
  return {};
}

bool is_step(double step) { return step != 0 && std::isfinite(step); }

bool NrrdAxisFields::is_other(std::size_t at) const {
  const bool other_kind =
      at < kinds.size() && kinds[at] != "domain" && kinds[at] != "space" && kinds[at] != "???";
  return other_kind || (at < directions.size() && directions[at].size() < 2);
}

NrrdAxisFields::Other NrrdAxisFields::other_axis(const std::string& name) const {
  if (dimension != 0 && sizes.size() != dimension)
    fail("{}: expected {} sizes, found {}", name, dimension, sizes.size());
  if (sizes.size() < 2 || sizes.size() > 4)
    fail("{}: expected two to four sizes, found {}", name, sizes.size());
  constexpr std::size_t kMostUnsaid = 9;
  const std::size_t last = sizes.size() - 1;
  const bool four = sizes.size() == 4;
  Other other = is_other(0) ? Other::kFirst : four && is_other(last) ? Other::kLast : Other::kNone;
  if (other == Other::kNone && four) {
    other = sizes[0] <= kMostUnsaid ? Other::kFirst : Other::kLast;
    if (sizes[0] > kMostUnsaid && sizes[last] > kMostUnsaid)
      fail("{}: expected three axes of space, or kinds that say which of four is none, found four", name);
  }
  if (other != Other::kNone && last < 2) fail("{}: expected two or three axes of space, found one", name);
  return other;
}

/// Sets an axis without a direction, which is parallel to the axis of space with its number. Its least and
/// greatest coordinate are those of the first and the last sample or, for values of cells, of the outer faces
/// of their cells.
void NrrdAxisFields::set_axis(std::size_t axis, std::size_t at, NrrdHeader& header) const {
  const int a = static_cast<int>(axis);
  SampleCentering& center = header.centers[axis];
  const auto min = entry(mins, at), max = entry(maxs, at);
  const bool cells = center.stated == Centering::kCells;
  double step = entry(spacings, at).value_or(0);
  if (!is_step(step) && min && max) {
    const auto n = static_cast<double>(header.sizes[axis]);
    const double cell = (*max - *min) / n;
    step = cells || n == 1 ? cell : (*max - *min) / (n - 1);
    if (is_step(step)) center.cell = cell / step;
  }
  if (!is_step(step)) step = 1;
  header.axes.directions[axis] = {};
  header.axes.directions[axis][a] = step;
  header.axes.origin[a] = min.value_or(0);
  if (!min) return;
  if (cells) {
    header.axes.origin[a] += 0.5 * step;
  } else {
    center.first_face = 0;
  }
}

Vec3 NrrdAxisFields::direction(const std::string& name, std::size_t at) const {
  if (at >= directions.size() || directions[at].size() < 2 || directions[at].size() > 3) {
    fail("{}: expected a space direction of two or three numbers for axis {}, found none", name, at);
  }
  Vec3 result;
  for (int i = 0; i < 3; ++i) {
    result[i] = entry(directions[at], static_cast<std::size_t>(i)).value_or(0);
  }
  return result;
}

void NrrdAxisFields::apply(const std::string& name, NrrdHeader& header) const {
  const Other other = other_axis(name);
  header.planar = other == Other::kLast;
  const std::size_t before = other == Other::kFirst ? 1 : 0;
  const std::size_t count = sizes.size() - (other == Other::kNone ? 0 : 1);
  if (other != Other::kNone) header.components = header.planar ? sizes.back() : sizes[0];
  for (std::size_t axis = 0; axis < count; ++axis) {
    header.sizes[axis] = sizes[axis + before];
    header.centers[axis].stated = center(centers, axis + before);
  }
  if (directions.empty()) {
    // Entries of an axis of components, which follow the others, are not axes of space.
    for (std::size_t axis = 0; axis < 3; ++axis)
      set_axis(axis, axis < count ? axis + before : sizes.size(), header);
    return;
  }
  auto& steps = header.axes.directions;
  for (std::size_t axis = 0; axis < count; ++axis) steps[axis] = direction(name, axis + before);
  // The third axis of a plane image is perpendicular to its two axes.
  if (count == 2) steps[2] = normalized(cross(steps[0], steps[1]));
  for (int axis = 0; axis < 3; ++axis) {
    header.axes.origin[axis] = entry(origin, static_cast<std::size_t>(axis)).value_or(0);
  }
}

using Words = NrrdAxisFields::Words;

constexpr std::string_view kBlanks = " \t";

Words split(std::string_view text, std::string_view separators) {
  Words words;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find_first_of(separators), text.size());
    if (end > 0) words.push_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return words;
}

/// A type of samples, and all names that NRRD has for it.
struct TypeNames {
  StoredType type;
  std::vector<std::string_view> names;
};

const std::vector<TypeNames>& types() {
  static const std::vector<TypeNames> kTypes{
      {StoredType::kInt8, {"signed char", "int8", "int8_t"}},
      {StoredType::kUint8, {"uchar", "unsigned char", "uint8", "uint8_t"}},
      {StoredType::kInt16, {"short", "short int", "signed short", "signed short int", "int16", "int16_t"}},
      {StoredType::kUint16, {"ushort", "unsigned short", "unsigned short int", "uint16", "uint16_t"}},
      {StoredType::kInt32, {"int", "signed int", "int32", "int32_t"}},
      {StoredType::kUint32, {"uint", "unsigned int", "uint32", "uint32_t"}},
      {StoredType::kInt64,
       {"longlong", "long long", "long long int", "signed long long", "signed long long int", "int64",
        "int64_t"}},
      {StoredType::kUint64,
       {"ulonglong", "unsigned long long", "unsigned long long int", "uint64", "uint64_t"}},
      {StoredType::kFloat32, {"float"}},
      {StoredType::kFloat64, {"double"}}};
  return kTypes;
}

class Parser {
 public:
  Parser(std::string_view text, const std::string& name) : text_(text), name_(name) {}

  NrrdHeader run() {
    if (next_line().value_or("").substr(0, 4) != "NRRD")
      fail("{}: expected NRRD, found something else", name_);
    for (auto line = next_line(); line && !line->empty(); line = next_line()) read_line(*line);
    header_.header_bytes = at_;
    if (at_ == text_.size() && header_.data_file.empty()) {
      fail("{}: line {}: expected an empty line and data after the header, found the file's end", name_,
           line_);
    }
    if (!header_.type) fail("{}: expected a header with type, found none", name_);
    if (places_.sizes.empty()) fail("{}: expected a header with sizes, found none", name_);
    if (!has_encoding_) fail("{}: expected a header with encoding, found none", name_);
    places_.apply(name_, header_);
    set_segments();
    return header_;
  }

 private:
  struct Segment {
    std::string name;
    std::optional<std::int64_t> label;
    std::optional<std::uint32_t> layer;
    std::optional<std::array<double, 3>> colour;
  };

  std::optional<std::string_view> next_line() {
    if (at_ >= text_.size()) return {};
    const std::size_t end = text_.find('\n', at_);
    std::string_view line = text_.substr(at_, end == std::string_view::npos ? end : end - at_);
    at_ = end == std::string_view::npos ? text_.size() : end + 1;
    ++line_;
    while (!line.empty() && (line.back() == '\r' || line.back() == ' ')) line.remove_suffix(1);
    return line;
  }

  [[noreturn]] void fail_field(std::string_view expected, std::string_view found) const {
    fail("{}: line {}: expected {}, found '{}'", name_, line_, expected, printable(found, 40));
  }

  void set_segments() {
    for (const auto& [number, segment] : segments_) {
      if (segment.layer.value_or(0) >= header_.components)
        fail("{}: Segment{}_Layer: expected a layer from 0 to {}, found {}", name_, number,
             header_.components - 1, *segment.layer);
    }
    if (header_.components > 1) return set_layers();
    for (const auto& [number, segment] : segments_) add_segment(segment.label.value_or(number + 1), segment);
  }

  void add_segment(std::int64_t label, const Segment& segment) {
    if (!segment.name.empty()) header_.segments.emplace(label, segment.name);
    if (segment.colour) header_.colours.emplace(label, *segment.colour);
  }

  /// Sets the segments of several layers. In older files no segment names its layer or its number: each has a
  /// layer of its own, where it is 1.
  void set_layers() {
    const auto has_layer = [](const auto& segment) { return segment.second.layer.has_value(); };
    const bool older = std::ranges::none_of(segments_, has_layer);
    if (older && !segments_.empty() && segments_.size() != header_.components)
      fail("{}: expected a layer for each of {} segments, or SegmentN_Layer, found {} layers", name_,
           segments_.size(), header_.components);
    if (segments_.size() > kMostLayerSegments)
      fail("{}: expected at most {} segments, found {}", name_, kMostLayerSegments, segments_.size());
    for (auto& [number, segment] : segments_) {
      if (!older && !segment.layer)
        fail("{}: expected Segment{}_Layer beside those of other segments, found none", name_, number);
      const std::size_t place = header_.layered.size();
      if (segment.name.empty()) segment.name = fmt::format("segment {}", number);
      add_segment(static_cast<std::int64_t>(place) + 1, segment);
      header_.layered.push_back({segment.name, segment.layer.value_or(place), segment.label.value_or(1)});
    }
  }

  /// Takes the names, labels and layers of segments, as "Segment2_Name", of other keys.
  void read_key(std::string_view key, std::string_view value) {
    constexpr std::string_view kSegment = "Segment";
    const std::size_t end = key.find('_');
    if (!key.starts_with(kSegment) || end == std::string_view::npos) return;
    const auto number = nrrd_number<std::uint16_t>(key.substr(kSegment.size(), end - kSegment.size()));
    if (!number) return;
    const std::string_view what = key.substr(end + 1);
    if (what == "Name") segments_[*number].name = value;
    if (what == "LabelValue") segments_[*number].label = segment_number<std::int64_t>(value);
    if (what == "Layer") segments_[*number].layer = segment_number<std::uint32_t>(value);
    if (what == "Color") segments_[*number].colour = segment_colour(value);
  }

  [[nodiscard]] std::array<double, 3> segment_colour(std::string_view text) const {
    const Words words = split(text, kBlanks);
    std::array<double, 3> colour{};
    for (std::size_t i = 0; i < colour.size(); ++i) {
      const auto part = words.size() == colour.size() ? nrrd_number<double>(words[i]) : std::nullopt;
      if (!part || !(*part >= 0 && *part <= 1)) fail_field("three numbers of a colour from 0 to 1", text);
      colour[i] = *part;
    }
    return colour;
  }

  template <class T>
  T segment_number(std::string_view text) const {
    const auto number = nrrd_number<T>(text);
    if (!number) fail_field("a whole number of a segment", text);
    return *number;
  }

  void read_line(std::string_view line) {
    if (line[0] == '#') return;
    if (const std::size_t sign = line.find(":="); sign != std::string_view::npos)
      return read_key(line.substr(0, sign), line.substr(sign + 2));
    const std::size_t colon = line.find(": ");
    if (colon == std::string_view::npos) {
      if (line.back() == ':') return;
      fail_field("a field and its value", line);
    }
    const std::string_view field = line.substr(0, colon);
    std::string_view value = line.substr(colon + 2);
    value.remove_prefix(std::min(value.find_first_not_of(' '), value.size()));
    if (field == "type") return read_type(value);
    if (field == "encoding") return read_encoding(value);
    if (field == "sizes") return read_sizes(value);
    if (field == "dimension") {
      const auto dimension = nrrd_number<int>(value);
      if (!dimension || *dimension < 2 || *dimension > 4) fail_field("two to four dimensions", value);
      places_.dimension = static_cast<std::size_t>(*dimension);
    } else if (field == "endian") {
      if (value != "little" && value != "big") fail_field("endian little or big", value);
      header_.big_endian = value == "big";
    } else if (field == "data file" || field == "datafile") {
      if (value.substr(0, 4) == "LIST" || value.find('%') != std::string_view::npos)
        fail_field("one data file", value);
      header_.data_file = value;
    } else if (field == "line skip" || field == "lineskip") {
      const auto skip = nrrd_number<std::uint32_t>(value);
      if (!skip) fail_field("a number of lines", value);
      header_.line_skip = *skip;
    } else if (field == "byte skip" || field == "byteskip") {
      const auto skip = nrrd_number<std::int64_t>(value);
      if (!skip || *skip < -1) fail_field("a number of bytes", value);
      header_.byte_skip = *skip;
    } else if (field == "spacings") {
      places_.spacings = split(value, kBlanks);
    } else if (field == "axis mins" || field == "axismins") {
      places_.mins = split(value, kBlanks);
    } else if (field == "axis maxs" || field == "axismaxs") {
      places_.maxs = split(value, kBlanks);
    } else if (field == "centers" || field == "centerings") {
      read_centers(value);
    } else if (field == "kinds") {
      places_.kinds = split(value, kBlanks);
    } else if (field == "space") {
      header_.space = space_of_nrrd(value);
    } else if (field == "space units" || field == "units") {
      read_units(value);
    } else if (field == "sample units" || field == "sampleunits") {
      header_.value_unit = unit_of(trimmed(value, kBlanks));
    } else if (field == "space origin") {
      places_.origin = split(value, " \t(),");
    } else if (field == "space directions") {
      read_directions(value);
    }
  }

  /// Reads the units of axes, each in quotes; axes that are none of space have none, or a mark of it. Axes of
  /// different units have no unit in common.
  void read_units(std::string_view value) {
    std::string common;
    bool same = true;
    for (std::size_t at = value.find('"'); at != std::string_view::npos; at = value.find('"', at)) {
      const std::size_t end = value.find('"', at + 1);
      if (end == std::string_view::npos) return;
      const std::string unit = unit_of(trimmed(value.substr(at + 1, end - at - 1), kBlanks));
      at = end + 1;
      if (unit.empty() || unit == "???" || unit == "none") continue;
      same = same && (common.empty() || common == unit);
      common = unit;
    }
    header_.length_unit = same ? common : "";
  }

  void read_centers(std::string_view value) {
    places_.centers = split(value, kBlanks);
    for (const std::string_view word : places_.centers) {
      if (word != "cell" && word != "node" && word != "???" && word != "none")
        fail_field("cell, node, ??? or none for each axis", value);
    }
  }

  void read_type(std::string_view value) {
    const auto found = std::ranges::find_if(types(), [&](const TypeNames& type) {
      return std::ranges::find(type.names, value) != type.names.end();
    });
    if (found == types().end()) fail_field("a type of numbers", value);
    header_.type = found->type;
  }

  void read_encoding(std::string_view value) {
    has_encoding_ = true;
    if (value == "raw") {
      header_.encoding = SamplePacking::kRaw;
    } else if (value == "gzip" || value == "gz") {
      header_.encoding = SamplePacking::kDeflate;
    } else if (value == "bzip2" || value == "bz2") {
      header_.encoding = SamplePacking::kBzip2;
    } else if (value == "text" || value == "txt" || value == "ascii") {
      header_.encoding = SamplePacking::kText;
    } else {
      fail_field("the encoding raw, gzip, bzip2 or text", value);
    }
  }

  void read_sizes(std::string_view value) {
    constexpr std::uint64_t kMost = std::uint64_t{1} << 44;
    std::uint64_t product = 1;
    places_.sizes.clear();
    for (const std::string_view word : split(value, kBlanks)) {
      const auto size = nrrd_number<std::uint64_t>(word);
      if (!size || *size == 0 || *size > kMost / product) fail_field("positive sizes", value);
      product *= *size;
      places_.sizes.push_back(static_cast<std::size_t>(*size));
    }
  }

  /// Reads directions as "(1,0,0) none (0,1,0)": three numbers, or none, per axis.
  void read_directions(std::string_view value) {
    places_.directions.clear();
    while (!value.empty()) {
      const std::size_t open = value.find_first_not_of(" \t");
      if (open == std::string_view::npos) return;
      value.remove_prefix(open);
      const std::size_t end = value[0] == '(' ? value.find(')') : std::min(value.find(' '), value.size());
      if (end == std::string_view::npos) fail_field("directions in brackets", value);
      places_.directions.push_back(split(value.substr(0, end), " (,"));
      value.remove_prefix(std::min(end + 1, value.size()));
    }
  }

  std::string_view text_;
  const std::string& name_;
  std::size_t at_ = 0, line_ = 0;
  NrrdHeader header_;
  bool has_encoding_ = false;
  std::map<std::uint16_t, Segment> segments_;
  NrrdAxisFields places_;
};

}  // namespace

NrrdHeader parse_nrrd_header(std::string_view text, const std::string& name) {
  return Parser(text, name).run();
}

InputFormat nrrd_format() {
  return {
      .name = "NRRD",
      .endings = ".nrrd .nhdr",
      .shown_by = [](std::string_view bytes) { return bytes.starts_with("NRRD0"); },
      .read_header = [](const std::filesystem::path& path) { return nrrd_image(read_beginning(path), path); },
      .referred_files = files_in_header};
}

ImageHeader nrrd_image(std::string_view text, const std::filesystem::path& path) {
  const NrrdHeader header = parse_nrrd_header(text, path.string());
  ImageHeader image;
  image.kind = "NRRD";
  image.name = path.string();
  for (std::size_t axis = 0; axis < 3; ++axis) image.dimensions[axis] = header.sizes[axis];
  image.axes = header.axes;
  image.space = header.space;
  image.length_unit = header.length_unit;
  image.value_unit = header.value_unit;
  image.centers = header.centers;
  VolumeSource source;
  source.name = image.name;
  source.file = path;
  source.coding = header.encoding;
  if (!header.data_file.empty()) {
    source.file = path.parent_path() / header.data_file;
    source.name += ": " + source.file.string();
  } else if (header.header_bytes >= kLongestHeader) {
    fail("{}: expected a header of less than {} bytes, found a longer one", image.name, kLongestHeader);
  } else {
    source.header_bytes = header.header_bytes;
  }
  source.skip_lines = header.line_skip;
  // Bytes can be counted from the end only of a file that is not packed.
  source.at_end = header.byte_skip < 0 && !source.packed();
  if (header.byte_skip > 0) source.skip_bytes = static_cast<std::uint64_t>(header.byte_skip);
  source.trailing = TrailingBytes::kRefused;
  source.set_stored(*header.type);
  source.components = header.components;
  source.big_endian = header.big_endian;
  source.grid.dimensions = image.dimensions;
  image.label_names = header.segments;
  image.label_colours = header.colours;
  // Segmentations are taken for labels without being named, as those that adamas writes.
  image.arrays.push_back({.name = header.segments.empty() ? "" : kWrittenLabels,
                          .centering = Centering::kPoints,
                          .source = std::move(source),
                          .planar = header.planar,
                          .segments = header.layered});
  return image;
}

}  // namespace adamas::io
