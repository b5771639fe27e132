#include <algorithm>
#include <cctype>
#include <cstdint>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/io/header_text.h"
#include "core/io/input_file.h"
#include "core/io/vtk_checks.h"

namespace adamas::io {

namespace {

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

/// Bits of a value; 0 for a type that is not known.
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
  /// Axes are made before any data are looked for: they must not be longer than any can be.
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
    // Where an axis has one point, it counts as a cell.
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

  /// A number that was cut off looks like another number: a text file has to end its last line.
  void check_last_line() {
    stream_.seekg(-1, std::ios::end);
    if (std::isspace(stream_.get()) == 0)
      fail("{}: expected a line end after the last number, found none", name_);
  }

  /// False at a keyword that this walk does not know.
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
  std::vector<std::uint64_t> nodes_;  ///< along the axes, where the file has them
  std::uint64_t count_ = 0;
  int data_ = 0;
};

}  // namespace

void check_legacy_vtk(const std::filesystem::path& path) { LegacyWalker(path, check_input_file(path)).run(); }

}  // namespace adamas::io
