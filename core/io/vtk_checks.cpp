#include "core/io/vtk_checks.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cstdint>
#include <fstream>
#include <limits>
#include <map>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.h"
#include "core/io/header_text.h"
#include "core/io/input_file.h"
#include "core/io/volume_unpacking.h"
#include "core/io/vtk_xml_array.h"

namespace adamas::io {

namespace {

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

/// Bits of a value; 0 for an unknown type.
std::uint64_t type_bits(const std::string& type) {
  static const std::map<std::string, std::uint64_t> kBits{
      {"bit", 1},         {"char", 8},          {"unsigned_char", 8},
      {"signed_char", 8}, {"short", 16},        {"unsigned_short", 16},
      {"int", 32},        {"unsigned_int", 32}, {"float", 32},
      {"vtkidtype", 32},  {"long", 64},         {"unsigned_long", 64},
      {"double", 64},     {"vtktypeint64", 64}};
  const auto found = kBits.find(type);
  return found != kBits.end() ? found->second : 0;
}

class LegacyWalker {
 public:
  LegacyWalker(const std::filesystem::path& path, std::uint64_t size)
      : name_(path.string()), size_(size), stream_(path, std::ios::binary) {}

  void run() {
    std::string line;
    for (int i = 0; i < 3; ++i) {
      if (!std::getline(stream_, line)) fail("{}: expected a legacy VTK header, found {} line(s)", name_, i);
      if (i == 0 && lower(line).rfind("# vtk datafile", 0) != 0) {
        fail("{}: expected a legacy VTK header, found something else", name_);
      }
    }
    check_dimensions();
    if (lower(line).rfind("binary", 0) != 0) {
      check_counts_in_text();
      return check_last_line();
    }
    while (std::getline(stream_, line)) {
      if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
      if (!step(line)) return;
    }
    if (data_ == 0) fail("{}: expected data, found the file's end", name_);
  }

 private:
  /// Checks the dimensions before any data: VTK allocates the axes first, so they must not be longer than any
  /// axis can be.
  void check_dimensions() {
    constexpr int kLines = 8;
    constexpr std::int64_t kMostNodes = 1 << 24;
    const auto begin = stream_.tellg();
    std::string line, keyword;
    for (int i = 0; i < kLines && std::getline(stream_, line); ++i) {
      std::istringstream words(line);
      words >> keyword;
      if (lower(keyword) != "dimensions") continue;
      const std::string found = line.substr(0, line.find_last_not_of(" \t\r") + 1);
      std::int64_t nodes = 0, sum = 0;
      nodes_.clear();
      while (words >> nodes && nodes >= 1 && nodes <= kMostNodes) {
        sum += nodes;
        nodes_.push_back(static_cast<std::uint64_t>(nodes));
      }
      if (nodes_.size() == 3 && words.eof() && sum <= kMostNodes) break;
      fail("{}: expected DIMENSIONS of three numbers from 1 on, at most {} in all, found '{}'", name_,
           kMostNodes, printable(found, 60));
    }
    stream_.clear();
    stream_.seekg(begin);
  }

  /// `keyword` is "point_data" or "cell_data", `count` how many values their arrays have.
  void check_count(const std::string& keyword, std::uint64_t count) const {
    if (nodes_.size() != 3) return;
    std::uint64_t expected = 1;
    // Along an axis with one point there is one cell.
    for (const std::uint64_t n : nodes_)
      expected *= keyword == "point_data" ? n : std::max<std::uint64_t>(n - 1, 1);
    if (count == expected) return;
    fail("{}: {}: expected {} values for {} x {} x {} points, found {}", name_,
         keyword == "point_data" ? "POINT_DATA" : "CELL_DATA", expected, nodes_[0], nodes_[1], nodes_[2],
         count);
  }

  void check_counts_in_text() {
    std::string line, keyword;
    while (std::getline(stream_, line)) {
      if (line.find_first_of("PpCc") != line.find_first_not_of(" \t")) continue;
      std::istringstream words(line);
      std::uint64_t count = 0;
      if (!(words >> keyword >> count)) continue;
      keyword = lower(keyword);
      if (keyword == "point_data" || keyword == "cell_data") check_count(keyword, count);
    }
    stream_.clear();
  }

  /// Requires a line end after the last number of a text file: a number that was cut off would look like
  /// another one.
  void check_last_line() {
    stream_.seekg(-1, std::ios::end);
    if (std::isspace(stream_.get()) == 0)
      fail("{}: expected a line end after the last number, found none", name_);
  }

  /// Returns false at an unknown keyword.
  bool step(const std::string& line) {
    std::istringstream words(line);
    std::string keyword, array, type;
    words >> keyword;
    keyword = lower(keyword);
    if (keyword == "dataset" || keyword == "dimensions" || keyword == "spacing" ||
        keyword == "aspect_ratio" || keyword == "origin") {
      return true;
    }
    if (keyword == "metadata") return skip_metadata();
    if (keyword == "point_data" || keyword == "cell_data") {
      words >> count_;
      ++data_;
      if (words) check_count(keyword, count_);
      return static_cast<bool>(words);
    }
    if (keyword.size() == 13 && keyword.compare(1, 12, "_coordinates") == 0) {
      std::uint64_t count = 0;
      words >> count >> type;
      return words && skip(keyword, type, count, 1);
    }
    if (keyword == "field") return fields(words);
    words >> array >> type;
    if (!words) return false;
    if (keyword == "vectors" || keyword == "normals") return skip(array, type, count_, 3);
    if (keyword == "tensors") return skip(array, type, count_, 9);
    if (keyword != "scalars") return false;
    std::uint64_t components = 1;
    if (!(words >> components)) components = 1;
    const auto before = stream_.tellg();
    std::string table;
    std::getline(stream_, table);
    if (lower(table).rfind("lookup_table", 0) != 0) stream_.seekg(before);
    return skip(array, type, count_, components);
  }

  bool fields(std::istringstream& words) {
    std::string array, line, type;
    std::uint64_t arrays = 0;
    if (!(words >> array >> arrays)) return false;
    for (std::uint64_t i = 0; i < arrays; ++i) {
      do {
        if (!std::getline(stream_, line)) fail("{}: expected {} field arrays, found {}", name_, arrays, i);
      } while (line.find_first_not_of(" \t\r") == std::string::npos);
      std::uint64_t components = 0, tuples = 0;
      std::istringstream header(line);
      header >> array >> components >> tuples >> type;
      if (lower(array) == "metadata") {
        skip_metadata();
        --i;
        continue;
      }
      if (!header || !skip(array, type, tuples, components)) return false;
    }
    return true;
  }

  bool skip_metadata() {
    std::string line;
    while (std::getline(stream_, line) && !line.empty()) {
    }
    return true;
  }

  bool skip(const std::string& array, const std::string& type, std::uint64_t tuples,
            std::uint64_t components) {
    const std::uint64_t bits = type_bits(lower(type));
    if (bits == 0) return false;
    const auto at = static_cast<std::uint64_t>(stream_.tellg());
    const std::uint64_t left = size_ - std::min(at, size_);
    const bool whole = components == 0 || tuples <= (left * 8 + 7) / components / bits;
    const std::uint64_t bytes = whole ? (tuples * components * bits + 7) / 8 : 0;
    if (!whole || bytes > left) {
      fail("{}: array '{}': expected {} x {} values of type {}, found {} bytes before the file's end", name_,
           array, tuples, components, type, left);
    }
    stream_.seekg(static_cast<std::streamoff>(bytes), std::ios::cur);
    return true;
  }

  std::string name_;
  std::uint64_t size_;
  std::ifstream stream_;
  std::vector<std::uint64_t> nodes_;  ///< numbers of nodes along the axes, if the file has them
  std::uint64_t count_ = 0;
  int data_ = 0;
};

}  // namespace

void check_legacy_vtk(const std::filesystem::path& path) { LegacyWalker(path, check_input_file(path)).run(); }

namespace {

constexpr std::size_t kShown = 60;

struct Extent {
  std::array<std::int64_t, 6> ends{};

  [[nodiscard]] std::int64_t first(std::size_t axis) const { return ends[2 * axis]; }
  [[nodiscard]] std::int64_t last(std::size_t axis) const { return ends[2 * axis + 1]; }
  [[nodiscard]] bool contains(const Extent& other) const {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (other.first(axis) < first(axis) || other.last(axis) > last(axis)) return false;
    }
    return true;
  }
  [[nodiscard]] double nodes() const {
    double sum = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) sum += static_cast<double>(last(axis) - first(axis) + 1);
    return sum;
  }
  /// The number of cells; an axis with one point counts as one cell.
  [[nodiscard]] double cells() const {
    double product = 1;
    for (std::size_t axis = 0; axis < 3; ++axis)
      product *= static_cast<double>(std::max<std::int64_t>(last(axis) - first(axis), 1));
    return product;
  }
};

/// The greatest number of values per byte of a file; values may be bits.
double values_per_byte(std::string_view compressor) {
  constexpr double kBits = 8;
  if (compressor.empty()) return kBits;
  // Deflate makes at most 258 bytes of two bits.
  constexpr double kDeflate = 1032, kOthers = 1e5;
  return kBits * (compressor == "vtkZLibDataCompressor" ? kDeflate : kOthers);
}

class XmlChecker {
 public:
  XmlChecker(const std::filesystem::path& path, std::uint64_t size) : name_(path.string()), size_(size) {}

  void run(const std::vector<XmlTag>& tags) {
    for (const XmlTag& tag : tags) {
      if (tag.name == "PointData" || tag.name == "CellData") in_data_ = !tag.closing;
      if (tag.closing) continue;
      if (tag.name == "VTKFile") values_per_byte_ = values_per_byte(tag.value("compressor"));
      if (tag.name == "ImageData" || tag.name == "RectilinearGrid") read_whole(tag);
      if (tag.name == "Piece") read_piece(tag);
      if (tag.name == "DataArray") read_array(tag);
    }
    if (!whole_) return;
    if (pieces_ > 0 && cells_ != whole_->cells()) {
      fail("{}: expected pieces that make up the WholeExtent of {} cells, found {}", name_, whole_->cells(),
           cells_);
    }
    check_size();
  }

 private:
  [[nodiscard]] Extent extent(const XmlTag& tag, std::string_view attribute) const {
    constexpr std::int64_t kMost = std::numeric_limits<std::int32_t>::max();
    const auto values = parse_number_list<std::int64_t>(tag.value(attribute));
    Extent result;
    bool good = values && values->size() == 6;
    for (std::size_t axis = 0; good && axis < 3; ++axis) {
      const std::int64_t first = (*values)[2 * axis], last = (*values)[2 * axis + 1];
      result.ends[2 * axis] = first;
      result.ends[2 * axis + 1] = last;
      good = -kMost <= first && first <= last && last <= kMost;
    }
    if (!good) {
      fail("{}: {}: expected x0 x1 y0 y1 z0 z1 with x0 <= x1 and so on, all below 2^31, found '{}'", name_,
           attribute, printable(tag.value(attribute), kShown));
    }
    return result;
  }

  void read_whole(const XmlTag& tag) {
    whole_ = extent(tag, "WholeExtent");
    whole_text_ = printable(tag.value("WholeExtent"), kShown);
  }

  void read_piece(const XmlTag& tag) {
    if (!whole_) return;
    const Extent piece = extent(tag, "Extent");
    if (!whole_->contains(piece)) {
      fail("{}: expected a piece within the WholeExtent '{}', found '{}'", name_, whole_text_,
           printable(tag.value("Extent"), kShown));
    }
    cells_ += piece.cells();
    ++pieces_;
  }

  void read_array(const XmlTag& tag) {
    if (in_data_) ++arrays_;
    if (tag.value("format") != "appended") return;
    const auto offset = parse_number_list<std::uint64_t>(tag.value("offset"));
    if (!offset || offset->size() != 1 || offset->front() >= size_) {
      fail("{}: array '{}': expected an offset into the file's {} bytes, found '{}'", name_,
           printable(tag.value("Name"), kShown), size_, printable(tag.value("offset"), kShown));
    }
  }

  void check_size() const {
    constexpr double kMostNodes = 1 << 24;
    const double most = static_cast<double>(size_) * values_per_byte_;
    if (arrays_ > 0 && whole_->cells() > most) {
      fail("{}: expected at most {:.0f} values of each array in {} bytes, found the WholeExtent '{}'", name_,
           most, size_, whole_text_);
    }
    if (arrays_ == 0 && whole_->nodes() > kMostNodes) {
      fail("{}: expected arrays, or at most {:.0f} nodes, found none with the WholeExtent '{}'", name_,
           kMostNodes, whole_text_);
    }
  }

  std::string name_, whole_text_;
  std::uint64_t size_;
  double values_per_byte_ = 1;
  std::optional<Extent> whole_;
  double cells_ = 0;
  int pieces_ = 0, arrays_ = 0;
  bool in_data_ = false;  ///< whether the tags of PointData or CellData are open
};

}  // namespace

void check_vtk_xml(const std::vector<XmlTag>& tags, const std::filesystem::path& path) {
  XmlChecker(path, check_input_file(path)).run(tags);
}

namespace {

/// Tags that contain arrays; some of the arrays have tags inside.
constexpr std::string_view kSections[] = {"PointData", "CellData", "FieldData", "Points", "Coordinates",
                                          "Cells",     "Verts",    "Lines",     "Strips", "Polys"};

/// Counts the values of arrays and compares the number with that of their piece.
class CountChecker {
 public:
  explicit CountChecker(const std::filesystem::path& path) : name_(path.string()), arrays_(name_, path) {}

  void run(const std::vector<XmlTag>& tags) {
    for (const XmlTag& tag : tags) {
      if (tag.name == "AppendedData") {
        for (Counted& counted : counted_) arrays_.find_appended(tag, counted.array.source);
      } else if (tag.closing) {
        if (tag.name == section_) section_.clear();
      } else if (tag.name == "VTKFile") {
        arrays_.read_file_tag(tag);
      } else if (tag.name == "Piece") {
        read_piece(tag);
      } else if (tag.name == "DataArray") {
        read_array(tag);
      } else if (std::ranges::find(kSections, tag.name) != std::end(kSections)) {
        section_ = tag.name;
        coordinates_ = 0;
      }
    }
    std::for_each(counted_.begin(), counted_.end(), [this](const Counted& counted) { check(counted); });
  }

 private:
  struct Counted {
    ImageArray array;
    std::uint64_t tuples = 0;
  };

  void read_piece(const XmlTag& tag) {
    counts_.clear();
    nodes_.clear();
    if (const auto extent = parse_number_list<std::int64_t>(tag.value("Extent"));
        extent && extent->size() == 6) {
      std::uint64_t points = 1, cells = 1;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        // Extents that are out of order are reported by the reader.
        const auto steps = static_cast<std::uint64_t>((*extent)[2 * axis + 1]) -
                           static_cast<std::uint64_t>((*extent)[2 * axis]);
        nodes_.push_back(steps + 1);
        points *= steps + 1;
        // Along an axis with one point there is one cell.
        cells *= std::max<std::uint64_t>(steps, 1);
      }
      counts_ = {{"PointData", points}, {"CellData", cells}};
      return;
    }
    std::uint64_t cells = 0;
    for (const char* section : {"Cells", "Verts", "Lines", "Strips", "Polys"}) {
      const auto count = parse_number_list<std::uint64_t>(tag.value(std::string("NumberOf") + section));
      if (!count || count->size() != 1) continue;
      counts_[section] = count->front();
      cells += count->front();
    }
    counts_["CellData"] = cells;
    const auto points = parse_number_list<std::uint64_t>(tag.value("NumberOfPoints"));
    if (points && points->size() == 1) counts_["PointData"] = counts_["Points"] = points->front();
  }

  /// The number of tuples that an array of the section must have; empty if unknown.
  std::optional<std::uint64_t> tuples_of(const XmlTag& tag) {
    if (section_ == "Coordinates")
      return coordinates_ < nodes_.size() ? std::optional(nodes_[coordinates_++]) : std::nullopt;
    const auto found = counts_.find(section_);
    if (found == counts_.end()) return {};
    const bool of_cells = section_ != "PointData" && section_ != "CellData" && section_ != "Points";
    // Only the last offset tells how many indices there are.
    if (of_cells && tag.value("Name") != "offsets" && tag.value("Name") != "types") return {};
    return found->second;
  }

  void read_array(const XmlTag& tag) {
    const auto tuples = tuples_of(tag);
    if (!tuples || !arrays_.has_file_tag()) return;
    ImageArray array = arrays_.array_of(tag);
    // VTK reports what is wrong with the type or form of the other arrays.
    if (array.missing.empty() && array.source.components > 0) counted_.push_back({std::move(array), *tuples});
  }

  void check(const Counted& counted) const {
    const VolumeSource& source = counted.array.source;
    const bool has_place = source.header_bytes > 0;
    if (!has_place && !source.before_tag) return;
    const std::uint64_t found = has_place ? measure_vtk_array(source) / stored_bytes(source.stored) : 0;
    if (found / source.components == counted.tuples && found % source.components == 0) return;
    fail("{}: array '{}': expected {}{} values, found {}", name_, printable(counted.array.name, 40),
         counted.tuples, source.components > 1 ? fmt::format(" x {}", source.components) : "", found);
  }

  std::string name_, section_;
  VtkXmlArrays arrays_;
  /// Number of tuples of arrays by the tag round them.
  std::map<std::string, std::uint64_t, std::less<>> counts_;
  std::vector<std::uint64_t> nodes_;  ///< numbers of nodes along the axes of the piece
  std::size_t coordinates_ = 0;       ///< number of arrays of coordinates so far
  std::vector<Counted> counted_;
};

}  // namespace

void check_vtk_counts(const std::vector<XmlTag>& tags, const std::filesystem::path& path) {
  CountChecker(path).run(tags);
}

namespace {

constexpr std::string_view kBlanks = " \t\r\n\v\f";

/// Takes the words of a header, which are separated by blanks and comments.
class PnmWords {
 public:
  PnmWords(std::string_view text, const std::string& name) : text_(text), name_(name) {}

  std::string_view next(std::string_view what) {
    while (at_ < text_.size()) {
      at_ = std::min(text_.find_first_not_of(kBlanks, at_), text_.size());
      if (at_ == text_.size() || text_[at_] != '#') break;
      at_ = std::min(text_.find('\n', at_), text_.size());
    }
    const std::size_t end = text_.find_first_of(" \t\r\n\v\f#", at_);
    if (end == std::string_view::npos) fail("{}: expected {}, found the end of the header", name_, what);
    const std::string_view word = text_.substr(at_, end - at_);
    at_ = end;
    return word;
  }

  std::uint64_t number(std::string_view what, std::uint64_t most) {
    const std::string_view word = next(what);
    std::uint64_t value = 0;
    const auto [end, code] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (code != std::errc() || end != word.data() + word.size() || value < 1 || value > most)
      fail("{}: expected {} from 1 to {}, found '{}'", name_, what, most, printable(word, 40));
    return value;
  }

  [[nodiscard]] std::size_t at() const { return at_; }

 private:
  std::string_view text_;
  const std::string& name_;
  std::size_t at_ = 0;
};

/// Checks a PNM: VTK searches endlessly for the rest of a header that is cut off, and takes samples of two
/// bytes for twice as many of one byte.
std::string check_pnm(const std::string& name, std::string_view text, std::uint64_t size) {
  constexpr std::uint64_t kMostPixels = std::uint64_t{1} << 31, kMostValue = 255;
  PnmWords words(text, name);
  const std::string_view magic = words.next("P5 or P6");
  if (magic != "P5" && magic != "P6")
    fail("{}: expected a binary PGM or PPM (P5 or P6), found '{}'", name, printable(magic, 40));
  const std::uint64_t width = words.number("a width", kMostPixels),
                      height = words.number("a height", kMostPixels);
  words.number("a greatest value", kMostValue);
  const std::uint64_t channels = magic == "P6" ? 3 : 1, expected = width * height * channels,
                      left = size - words.at() - 1;
  if (left < expected) {
    fail("{}: expected {} bytes for {} x {} pixels of {}, found {}", name, expected, width, height, channels,
         left);
  }
  return left == expected ? ""
                          : fmt::format("{} bytes behind the first picture are not read", left - expected);
}

/// Checks a BMP: VTK crashes if the header is cut off.
void check_bmp(const std::string& name, std::uint64_t size) {
  constexpr std::uint64_t kHeader = 54;
  if (size < kHeader) fail("{}: expected a header of {} bytes, found {}", name, kHeader, size);
}

/// Counts the pixels of a run-length encoded picture. The byte before a run says whether one pixel stands for
/// all or each is stored.
void check_tga_runs(const std::string& name, std::uint64_t begin, std::uint64_t pixel, std::uint64_t pixels) {
  std::ifstream stream(name, std::ios::binary);
  stream.seekg(static_cast<std::streamoff>(begin));
  std::uint64_t found = 0;
  std::string skipped;
  while (found < pixels) {
    const int head = stream.get();
    if (head == std::ifstream::traits_type::eof()) break;
    constexpr int kSame = 128;
    const std::uint64_t run = static_cast<std::uint64_t>(head % kSame) + 1;
    skipped.resize((head >= kSame ? 1 : run) * pixel);
    if (!stream.read(skipped.data(), static_cast<std::streamsize>(skipped.size()))) break;
    found += run;
  }
  if (found < pixels) fail("{}: expected {} pixels, found {}", name, pixels, found);
}

/// Checks a TGA: VTK shows arbitrary pixels in place of missing ones.
void check_tga(const std::string& name, std::string_view text, std::uint64_t size) {
  constexpr std::size_t kHeader = 18;
  if (text.size() < kHeader) fail("{}: expected a header of {} bytes, found {}", name, kHeader, text.size());
  const auto byte = [text](std::size_t at) { return std::uint64_t{static_cast<unsigned char>(text[at])}; };
  const auto word = [byte](std::size_t at) { return byte(at) | byte(at + 1) << 8; };
  const std::uint64_t pixel = (byte(16) + 7) / 8, pixels = word(12) * word(14),
                      begin = kHeader + byte(0) + (byte(1) != 0 ? word(5) * ((byte(7) + 7) / 8) : 0);
  constexpr unsigned kRunLengths = 8;
  const bool packed = (byte(2) & kRunLengths) != 0;
  // A run of up to 128 pixels takes at least one pixel and one byte.
  const std::uint64_t least = packed ? (pixels + 127) / 128 * (pixel + 1) : pixels * pixel,
                      left = size - std::min(begin, size);
  if (packed && left >= least) return check_tga_runs(name, begin, pixel, pixels);
  if (left < least) {
    fail("{}: expected {}{} bytes for {} x {} pixels of {}, found {}", name, least, packed ? " or more" : "",
         word(12), word(14), pixel, left);
  }
}

}  // namespace

std::string check_picture(const std::filesystem::path& path) {
  const std::string name = path.string(), extension = file_extension(path);
  const std::uint64_t size = check_input_file(path);
  if (extension == ".bmp") check_bmp(name, size);
  if (extension == ".tga") check_tga(name, read_beginning(path), size);
  const bool pnm = extension == ".pgm" || extension == ".ppm" || extension == ".pnm";
  return pnm ? check_pnm(name, read_beginning(path), size) : "";
}

}  // namespace adamas::io
