#include "core/io/spy_dump.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "adamas/text.h"
#include "core/base/error.h"
#include "core/io/amr_cells.h"
#include "core/io/file_handle.h"
#include "core/io/header_bytes.h"
#include "core/io/input_file.h"
#include "core/io/rectilinear_levels.h"

namespace adamas::io {

namespace {

constexpr std::string_view kMagic("spydata\0", 8);
constexpr const char* kList = ".spcth-timeseries";

/// The bytes of a file, whose numbers are big-endian, from any place on.
class SpyBytes {
 public:
  explicit SpyBytes(const std::filesystem::path& path)
      : name_(path.string()), file_(FileHandle::open(path)) {}

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] std::uint64_t size() const { return file_->size(); }
  [[nodiscard]] std::uint64_t at() const { return at_; }

  void seek(std::uint64_t at) { at_ = at; }

  /// The next bytes, which are valid until others are taken.
  std::string_view take(std::uint64_t count) {
    if (at_ > size() || count > size() - at_)
      fail("{}: expected {} bytes at byte {}, found {} bytes in the file", name_, count, at_, size());
    if (at_ < begin_ || at_ + count > begin_ + held_) {
      constexpr std::uint64_t kAhead = std::uint64_t{1} << 16;
      buffer_.resize(std::max(count, std::min(kAhead, size() - at_)));
      begin_ = at_;
      held_ = file_->read_some(at_, std::as_writable_bytes(std::span(buffer_)));
      if (held_ < count) fail("{}: expected {} bytes at byte {}, found {}", name_, count, at_, held_);
    }
    const std::string_view result = std::string_view(buffer_).substr(at_ - begin_, count);
    at_ += count;
    return result;
  }
  template <class T>
  T number() {
    return number_at<T>(take(sizeof(T)), 0, true);
  }
  std::int32_t whole() { return number<std::int32_t>(); }
  /// A number of things; what each of them takes is checked as it is read.
  std::uint64_t count(const char* what, std::int64_t most = std::numeric_limits<std::int32_t>::max()) {
    const std::int64_t found = whole();
    if (found < 0 || found > most)
      fail("{}: expected up to {} {}, found {} at byte {}", name_, most, what, found, at_ - 4);
    return static_cast<std::uint64_t>(found);
  }
  /// A place in the file, which is written as a floating-point number.
  std::uint64_t place() {
    const double found = number<double>();
    if (!(found >= 0 && found <= static_cast<double>(size())))
      fail("{}: expected a place in the file, of {} bytes, found {:g} at byte {}", name_, size(), found,
           at_ - 8);
    return static_cast<std::uint64_t>(found);
  }
  /// A text that is filled up with zeros.
  std::string text(std::uint64_t length) {
    const std::string_view bytes = take(length);
    return std::string(trimmed(bytes.substr(0, bytes.find('\0')), " "));
  }
  /// The next bytes, which begin with their number.
  std::string_view packed() { return take(count("bytes")); }

 private:
  std::string name_;
  std::shared_ptr<FileHandle> file_;
  std::uint64_t at_ = 0;
  std::string buffer_;
  std::uint64_t begin_ = 0, held_ = 0;  // of the buffer
};

/// Unpacks floats: a byte below 128 is the number of times that the float behind it is repeated, and one from
/// 128 on is 128 more than the number of floats behind it.
void unpack(const SpyBytes& source, std::string_view bytes, std::span<float> values) {
  constexpr std::size_t kSingle = 128;
  std::size_t at = 0, done = 0;
  const auto float_at = [bytes](std::size_t place) { return number_at<float>(bytes, place, true); };
  while (at < bytes.size() && done < values.size()) {
    const std::size_t run = static_cast<unsigned char>(bytes[at]);
    ++at;
    const bool repeated = run < kSingle;
    const std::size_t count = repeated ? run : run - kSingle, floats = repeated ? 1 : count;
    if (count > values.size() - done || sizeof(float) * floats > bytes.size() - at) break;
    for (std::size_t i = 0; i < count; ++i)
      values[done + i] = float_at(at + (repeated ? 0 : sizeof(float) * i));
    done += count;
    at += sizeof(float) * floats;
  }
  if (done < values.size() || at < bytes.size())
    fail("{}: expected {} packed numbers before byte {}, found others", source.name(), values.size(),
         source.at());
}

/// The most values that a byte of packed ones stands for.
constexpr std::uint64_t kMostPacked = 127;

struct SpyVariable {
  std::string id, comment;
};

/// What a dump has of a time.
struct SpyTime {
  std::int32_t cycle = 0;
  double time = 0;
  std::uint64_t place = 0;
};

/// A block of cells as a file has it, with a layer of copies of others round it.
struct SpyBlock {
  std::array<std::size_t, 3> size{};  ///< cells along each axis, with that layer
  bool held = false;                  ///< whether the file has its values
  std::int32_t level = 0;             ///< 0 for all blocks of a mesh without refinement
  std::array<std::vector<double>, 3> nodes;
};

/// The file of one processor.
class SpyFile {
 public:
  explicit SpyFile(const std::filesystem::path& path) : bytes_(path) {
    read_header();
    cell_variables_ = read_variables();
    material_variables_ = read_variables();
    read_times();
  }

  [[nodiscard]] const std::string& name() const { return bytes_.name(); }
  [[nodiscard]] std::uint64_t processor() const { return processor_; }
  [[nodiscard]] std::uint64_t processors() const { return processors_; }
  [[nodiscard]] std::int32_t geometry() const { return geometry_; }
  [[nodiscard]] std::uint64_t materials() const { return materials_; }
  [[nodiscard]] const std::vector<SpyTime>& times() const { return times_; }
  /// Places of the values of each variable at the time that was read last.
  [[nodiscard]] const std::map<std::int32_t, std::uint64_t>& places() const { return places_; }

  /// A variable of cells, below 100, or of materials: hundreds, and the number of the material from 1 on.
  [[nodiscard]] SpyVariable variable(std::int32_t number) const {
    const auto& known = is_of_material(number) ? material_variables_ : cell_variables_;
    const auto found = known.find(is_of_material(number) ? number / 100 * 100 : number);
    return found != known.end() ? found->second : SpyVariable{fmt::format("variable {}", number), ""};
  }
  static bool is_of_material(std::int32_t number) { return number >= 100; }

  /// Reads the blocks of a time, and where the values of variables are.
  std::vector<SpyBlock> read_blocks(std::size_t time) {
    bytes_.seek(times_[time].place);
    const std::uint64_t count = bytes_.count("variables");
    std::vector<std::int32_t> numbers;
    for (std::uint64_t v = 0; v < count; ++v) numbers.push_back(bytes_.whole());
    places_.clear();
    for (const std::int32_t number : numbers) places_[number] = bytes_.place();
    if (places_.empty()) fail("{}: expected variables at time {}, found none", name(), time);
    pass_tracers();
    pass_histograms();
    least_bytes_ = 0;
    std::vector<SpyBlock> blocks;
    const std::uint64_t block_count = bytes_.count("blocks");
    for (std::uint64_t b = 0; b < block_count; ++b) blocks.push_back(read_block(b));
    for (SpyBlock& block : blocks) {
      if (block.held) read_nodes(block);
    }
    return blocks;
  }

  /// Goes to the values of a variable.
  void begin_values(std::int32_t variable) { bytes_.seek(places_.at(variable)); }
  /// Reads the values of the next block.
  void read_values(const SpyBlock& block, std::vector<float>& values) {
    const std::size_t plane = block.size[0] * block.size[1];
    values.resize(plane * block.size[2]);
    for (std::size_t k = 0; k < block.size[2]; ++k)
      unpack(bytes_, bytes_.packed(), std::span(values).subspan(k * plane, plane));
  }

 private:
  void read_header() {
    if (bytes_.take(kMagic.size()) != kMagic)
      fail("{}: expected a dump of CTH, which begins with 'spydata', found another file", name());
    bytes_.take(128);  // a description
    version_ = bytes_.whole();
    if (version_ < 101 || version_ > 1000)
      fail("{}: expected a dump of CTH of version 101 or later, found {}", name(), version_);
    if (version_ >= 102) bytes_.whole();  // the size of places, which are of 8 bytes in any case
    bytes_.whole();                       // how values are packed, which is one way only
    processor_ = bytes_.count("processors");
    processors_ = bytes_.count("processors");
    geometry_ = bytes_.whole();
    if (const std::int32_t dimensions = bytes_.whole(); dimensions < 2 || dimensions > 3)
      fail("{}: expected a dump of two or three dimensions, found {}", name(), dimensions);
    materials_ = bytes_.count("materials", 99);
    bytes_.whole();                       // the greatest number of materials that the program can have
    bytes_.take(2 * 3 * sizeof(double));  // the box of the domain
    bytes_.whole();                       // the number of blocks
    constexpr std::int32_t kWithMarkers = 105;
    if (version_ >= kWithMarkers && bytes_.whole() != 0) pass_markers();
    bytes_.whole();  // the greatest number of levels
    if (version_ >= kWithMarkers) bytes_.take(5 * sizeof(std::int32_t));
  }

  void pass_markers() {
    for (std::uint64_t m = 0; m < materials_; ++m) {
      const std::uint64_t markers = bytes_.count("markers");
      bytes_.take(4 * sizeof(std::int32_t));
      if (markers == 0) continue;
      const std::uint64_t variables = bytes_.count("variables");
      for (std::uint64_t v = 0; v < variables; ++v) bytes_.take(30 + 256);
    }
  }

  std::map<std::int32_t, SpyVariable> read_variables() {
    std::map<std::int32_t, SpyVariable> result;
    const std::uint64_t count = bytes_.count("variables");
    for (std::uint64_t v = 0; v < count; ++v) {
      SpyVariable variable{bytes_.text(30), bytes_.text(80)};
      result[bytes_.whole()] = std::move(variable);
    }
    return result;
  }

  /// Reads the lists of times, of which each but the last is full.
  void read_times() {
    constexpr std::int32_t kInList = 100;
    while (true) {
      const std::uint64_t list = bytes_.place();
      if (list < bytes_.at())
        fail("{}: expected a list of times behind byte {}, found it at byte {}", name(), bytes_.at(), list);
      bytes_.seek(list);
      const std::uint64_t count = bytes_.count("times in a list", kInList);
      std::array<std::int32_t, kInList> cycles{};
      std::array<double, kInList> times{};
      for (std::int32_t& cycle : cycles) cycle = bytes_.whole();
      for (double& time : times) time = bytes_.number<double>();
      if (version_ >= 102) bytes_.take(kInList * sizeof(double));  // steps of time
      for (std::uint64_t t = 0; t < static_cast<std::uint64_t>(kInList); ++t) {
        // Of times that are not there, the places mean nothing.
        if (t < count) {
          times_.push_back({cycles[t], times[t], bytes_.place()});
        } else {
          bytes_.take(sizeof(double));
        }
      }
      if (count < static_cast<std::uint64_t>(kInList)) break;
    }
    for (const SpyTime& time : times_) {
      if (!std::isfinite(time.time)) fail("{}: expected finite times, found others", name());
    }
  }

  void pass_tracers() {
    if (bytes_.count("tracers") == 0) return;
    constexpr int kArrays = 7;  // places and blocks
    for (int n = 0; n < kArrays; ++n) bytes_.packed();
  }

  void pass_histograms() {
    const std::uint64_t count = bytes_.count("histograms");
    if (count == 0) return;
    bytes_.whole();
    for (std::uint64_t h = 0; h < count; ++h) {
      bytes_.take(sizeof(std::int32_t) + 6 * sizeof(double));
      if (bytes_.count("bins") > 0) bytes_.packed();
    }
  }

  SpyBlock read_block(std::uint64_t number) {
    SpyBlock block;
    for (std::size_t& size : block.size) size = bytes_.count("cells along an axis", 1 << 20);
    block.held = bytes_.whole() != 0;
    bytes_.whole();  // whether it is active
    block.level = bytes_.whole();
    if (version_ >= 103) bytes_.take(6 * sizeof(std::int32_t));
    if (!block.held) return block;
    const auto [x, y, z] = block.size;
    if (x < 3 || y < 3 || z < 1 || z == 2)
      fail("{}: block {}: expected cells inside a layer of others, found {} x {} x {}", name(), number, x, y,
           z);
    // Each plane of a variable takes some bytes.
    const auto packed = static_cast<double>(sizeof(std::int32_t) + x * y / kMostPacked);
    least_bytes_ += static_cast<double>(z) * static_cast<double>(places_.size()) * packed;
    if (least_bytes_ > static_cast<double>(bytes_.size()))
      fail("{}: block {}: expected values of {} x {} x {} cells, found {} bytes in the file", name(), number,
           x, y, z, bytes_.size());
    return block;
  }

  /// Reads the nodes of a block along each axis: they are packed as what is left of evenly spaced ones.
  void read_nodes(SpyBlock& block) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      std::string_view bytes = bytes_.packed();
      if (bytes.size() < 2 * sizeof(float))
        fail("{}: expected nodes of a block before byte {}, found {} bytes", name(), bytes_.at(),
             bytes.size());
      const auto step = static_cast<double>(number_at<float>(bytes, sizeof(float), true));
      std::vector<float> rest(block.size[axis] + 1);
      unpack(bytes_, bytes.substr(2 * sizeof(float)), rest);
      for (std::size_t i = 0; i < rest.size(); ++i) {
        block.nodes[axis].push_back(static_cast<double>(rest[i]) + static_cast<double>(i) * step);
        const bool ascends = i == 0 || block.nodes[axis][i] > block.nodes[axis][i - 1];
        if (!std::isfinite(block.nodes[axis][i]) || (block.size[axis] > 1 && !ascends))
          fail("{}: expected nodes of a block that ascend before byte {}, found others", name(), bytes_.at());
      }
    }
  }

  SpyBytes bytes_;
  std::int32_t version_ = 0, geometry_ = 0;
  std::uint64_t processor_ = 0, processors_ = 0, materials_ = 0;
  std::map<std::int32_t, SpyVariable> cell_variables_, material_variables_;
  std::vector<SpyTime> times_;
  std::map<std::int32_t, std::uint64_t> places_;
  double least_bytes_ = 0;  // that the values of the blocks so far take
};

/// The files of all processors.
class SpyDump {
 public:
  /// `path`: the file of any of them.
  explicit SpyDump(const std::filesystem::path& path) {
    auto own = std::make_unique<SpyFile>(path);
    const std::uint64_t count = own->processors();
    if (count <= 1) {
      files_.push_back(std::move(own));
    } else {
      const std::string name = path.filename().string();
      const std::size_t dot = name.rfind('.');
      const std::string number = dot == std::string::npos ? "" : name.substr(dot + 1);
      if (number.empty() || number.find_first_not_of("0123456789") != std::string::npos)
        fail("{}: expected a name that ends in the number of a processor, as NAME.0, for one of {} files",
             own->name(), count);
      for (std::uint64_t p = 0; p < count; ++p)
        files_.push_back(std::make_unique<SpyFile>(file_of(path, name.substr(0, dot + 1), number.size(), p)));
    }
    for (std::uint64_t p = 0; p < files_.size(); ++p) check(*files_[p], p);
  }

  [[nodiscard]] std::vector<std::unique_ptr<SpyFile>>& files() { return files_; }
  [[nodiscard]] SpyFile& first() { return *files_.front(); }

  /// The times that all files have: some may lack the last one of a run that was stopped.
  [[nodiscard]] std::vector<double> times() const {
    std::size_t count = std::numeric_limits<std::size_t>::max();
    for (const auto& file : files_) count = std::min(count, file->times().size());
    std::vector<double> result;
    for (std::size_t t = 0; t < count; ++t) result.push_back(files_.front()->times()[t].time);
    return result;
  }

 private:
  static std::filesystem::path file_of(const std::filesystem::path& path, const std::string& stem,
                                       std::size_t width, std::uint64_t processor) {
    const std::filesystem::path folder = path.parent_path();
    for (const std::string& number :
         {fmt::format("{}", processor), fmt::format("{:0{}}", processor, width)}) {
      std::error_code unknown;
      if (std::filesystem::exists(folder / (stem + number), unknown)) return folder / (stem + number);
    }
    fail("{}: expected the file of processor {} beside it, found no '{}{}'", path.string(), processor, stem,
         processor);
  }

  void check(const SpyFile& file, std::uint64_t processor) const {
    const SpyFile& one = *files_.front();
    if (file.processors() > 1 && file.processor() != processor)
      fail("{}: expected the file of processor {}, found that of processor {}", file.name(), processor,
           file.processor());
    const std::size_t common = std::min(one.times().size(), file.times().size());
    bool same = file.processors() == one.processors() && file.materials() == one.materials() &&
                file.geometry() == one.geometry();
    for (std::size_t t = 0; t < common; ++t)
      same = same && one.times()[t].cycle == file.times()[t].cycle &&
             one.times()[t].time == file.times()[t].time;
    if (!same)
      fail("{}: expected a file of the same run as {}, found one of another", file.name(), one.name());
  }

  std::vector<std::unique_ptr<SpyFile>> files_;
};

/// A block's cells that are no copies, for a mesh of one level or several.
RectilinearBlock inner_block(const SpyBlock& block) {
  RectilinearBlock result;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto& nodes = block.nodes[axis];
    const std::ptrdiff_t layer = block.size[axis] > 1 ? 1 : 0;
    result.nodes[axis].assign(nodes.begin() + layer, nodes.end() - layer);
    result.taken.min[static_cast<int>(axis)] = result.nodes[axis].front();
    result.taken.max[static_cast<int>(axis)] = result.nodes[axis].back();
  }
  return result;
}

/// Names of the arrays of variables.
class ArrayNames {
 public:
  ArrayNames(const SpyFile& file, const std::map<std::int32_t, std::uint64_t>& variables) {
    for (const auto& [number, place] : variables) {
      const auto [name, unit] = parts_of(file.variable(number));
      if (!SpyFile::is_of_material(number)) of_cells_.insert(name);
    }
    for (const auto& [number, place] : variables) add(number, file.variable(number));
  }

  [[nodiscard]] const std::string& operator[](std::int32_t number) const { return names_.at(number); }

  static bool is_fraction(const SpyVariable& variable) {
    return variable.id == "VOLM" || variable.comment.find("olume fraction") != std::string::npos ||
           variable.comment.find("olume Fraction") != std::string::npos;
  }

 private:
  struct Parts {
    std::string name, unit;
  };
  /// "Pressure (dynes/cm^2^)" is the name "Pressure" and the unit "dynes/cm^2^".
  static Parts parts_of(const SpyVariable& variable) {
    const std::string& text = variable.comment;
    const std::size_t open = text.ends_with(')') ? text.rfind('(') : std::string::npos;
    const std::string name(trimmed(std::string_view(text).substr(0, std::min(open, text.size())), " "));
    return {name.empty() ? variable.id : name,
            open == std::string::npos ? "" : text.substr(open + 1, text.size() - open - 2)};
  }

  void add(std::int32_t number, const SpyVariable& variable) {
    auto [name, unit] = parts_of(variable);
    if (SpyFile::is_of_material(number)) {
      const std::int32_t material = number % 100;
      if (is_fraction(variable)) {
        name = fmt::format("Volume fraction of material {}", material);
      } else {
        // A field has one value for all materials, or one for each.
        if (of_cells_.contains(name)) name = "Material " + name;
        name += fmt::format(" for material {}", material);
      }
    }
    if (!used_.insert(name).second) {
      name += fmt::format(" {}", number);
      used_.insert(name);
    }
    names_[number] = unit.empty() ? name : fmt::format("{} ({})", name, unit);
  }

  std::set<std::string> of_cells_, used_;
  std::map<std::int32_t, std::string> names_;
};

/// Makes a mesh of a dump at one time.
class SpyMesh {
 public:
  SpyMesh(SpyDump& dump, std::size_t time) : dump_(dump), time_(time) {}

  MeshFile run() {
    file_.kind = "CTH dump";
    add_blocks();
    add_values();
    add_void();
    constexpr std::int32_t kCylinder = 21;
    if (dump_.first().geometry() == kCylinder)
      file_.add_remark("its coordinates are a radius and a height, for --axisymmetric");
    return std::move(file_);
  }

 private:
  void add_blocks() {
    std::vector<RectilinearBlock> inner;
    bool refined = false;
    for (const auto& file : dump_.files()) {
      blocks_.push_back(file->read_blocks(time_));
      for (const SpyBlock& block : blocks_.back()) {
        if (!block.held) continue;
        flat_ = inner.empty() ? block.size[2] == 1 : flat_;
        if ((block.size[2] == 1) != flat_)
          fail("{}: expected blocks of three dimensions or of two, found both", file->name());
        refined = refined || block.level != 0;
        inner.push_back(inner_block(block));
        if (flat_) inner.back().nodes[2] = {0};
      }
      if (keys_of(*file) != keys_of(dump_.first()))
        fail("{}: expected the variables of {}, found others", file->name(), dump_.first().name());
    }
    const std::string& name = dump_.first().name();
    if (inner.empty()) fail("{}: expected blocks with values, found none", name);
    sources_ = add_rectilinear_cells(name, inner, flat_, refined, file_);
  }

  static std::vector<std::int32_t> keys_of(const SpyFile& file) {
    std::vector<std::int32_t> keys;
    for (const auto& [number, place] : file.places()) keys.push_back(number);
    return keys;
  }

  void add_values() {
    const ArrayNames names(dump_.first(), dump_.first().places());
    for (const std::int32_t variable : keys_of(dump_.first())) {
      GridArray array;
      array.name = names[variable];
      array.type = "float32";
      array.centering = Centering::kCells;
      array.values = values_of(variable);
      file_.arrays.push_back(std::move(array));
    }
  }

  std::vector<float> values_of(std::int32_t variable) {
    std::vector<float> result, whole;
    result.reserve(file_.cell_ends.size());
    std::size_t next = 0;
    for (std::size_t f = 0; f < blocks_.size(); ++f) {
      SpyFile& file = *dump_.files()[f];
      file.begin_values(variable);
      for (const SpyBlock& block : blocks_[f]) {
        if (!block.held) continue;
        file.read_values(block, whole);
        const std::size_t nx = block.size[0] - 2, ny = block.size[1] - 2, layer = flat_ ? 0 : 1;
        for (const std::int64_t cell : sources_.cells[next]) {
          const auto c = static_cast<std::size_t>(cell);
          const std::size_t i = c % nx + 1, j = c / nx % ny + 1, k = c / nx / ny + layer;
          result.push_back(whole[i + block.size[0] * (j + block.size[1] * k)]);
        }
        ++next;
      }
    }
    return result;
  }

  /// Adds the fraction that the materials leave, where all of them are there and no array has it.
  void add_void() {
    std::vector<const std::vector<float>*> fractions;
    std::size_t at = 0;
    for (const std::int32_t variable : keys_of(dump_.first())) {
      const GridArray& array = file_.arrays[at++];
      if (!ArrayNames::is_fraction(dump_.first().variable(variable))) continue;
      if (!SpyFile::is_of_material(variable)) return;
      fractions.push_back(&std::get<std::vector<float>>(array.values));
    }
    if (fractions.empty() || fractions.size() != dump_.first().materials()) return;
    GridArray rest;
    rest.name = "Void volume fraction";
    rest.type = "float32";
    rest.centering = Centering::kCells;
    std::vector<float> values;
    for (std::size_t c = 0; c < file_.cell_ends.size(); ++c) {
      double left = 1;
      for (const auto* own : fractions) left -= static_cast<double>((*own)[c]);
      values.push_back(static_cast<float>(std::max(left, 0.0)));
    }
    rest.values = std::move(values);
    file_.arrays.push_back(std::move(rest));
  }

  SpyDump& dump_;
  std::size_t time_;
  bool flat_ = false;
  std::vector<std::vector<SpyBlock>> blocks_;  // of each file
  AmrSources sources_;                         // of the blocks that files have, in their order
  MeshFile file_;
};

/// A time of a list of dumps, or of one.
struct ListedTime {
  std::filesystem::path dump;
  std::size_t number;  // among the times of the dump
  double time;
};

std::vector<ListedTime> listed_times(const std::filesystem::path& path) {
  std::vector<std::filesystem::path> dumps{path};
  if (file_extension(path) == kList) {
    dumps.clear();
    const std::string text = read_beginning(path);
    std::string_view rest = text;
    while (!rest.empty()) {
      const std::size_t end = std::min(rest.find('\n'), rest.size());
      const std::string_view line = trimmed(rest.substr(0, end), " \t\r");
      if (!line.empty()) dumps.push_back(path.parent_path() / std::string(line));
      rest.remove_prefix(std::min(end + 1, rest.size()));
    }
    if (dumps.empty()) fail("{}: expected the names of dumps, found none", path.string());
  }
  std::vector<ListedTime> times;
  for (const std::filesystem::path& dump : dumps) {
    check_input_file(dump);
    const std::vector<double> own = SpyDump(dump).times();
    while (!own.empty() && !times.empty() && times.back().time >= own.front()) times.pop_back();
    for (std::size_t t = 0; t < own.size(); ++t) times.push_back({dump, t, own[t]});
  }
  if (times.empty()) fail("{}: expected a dump with times, found none", path.string());
  return times;
}

}  // namespace

bool is_spy_dump(const std::filesystem::path& path) {
  if (file_extension(path) == kList) return true;
  std::array<char, kMagic.size()> bytes{};
  const std::size_t size = FileHandle::open(path)->read_some(0, std::as_writable_bytes(std::span(bytes)));
  return std::string_view(bytes.data(), size) == kMagic;
}

MeshFile read_spy_dump(const std::filesystem::path& path, std::optional<std::uint64_t> time) {
  const std::vector<ListedTime> times = listed_times(path);
  if (time.value_or(0) >= times.size()) fail_for_time(path.string(), times.size(), *time);
  const ListedTime& chosen = times[time.value_or(times.size() - 1)];
  SpyDump dump(chosen.dump);
  MeshFile file = SpyMesh(dump, chosen.number).run();
  for (const ListedTime& each : times) file.times.push_back(each.time);
  if (!time && times.size() > 1) file.add_remark(last_time_remark(times.size(), chosen.time));
  return file;
}

std::vector<double> spy_dump_times(const std::filesystem::path& path) {
  std::vector<double> result;
  for (const ListedTime& time : listed_times(path)) result.push_back(time.time);
  return result;
}

}  // namespace adamas::io
