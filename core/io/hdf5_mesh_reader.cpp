#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <span>
#include <utility>

#include "core/base/error.h"
#include "core/io/amr_cells.h"
#include "core/io/hdf5_layout_reader.h"
#include "core/io/hdf5_meshes.h"
#include "core/io/mesh_builder.h"
#include "core/io/mesh_file.h"

namespace adamas::io {

namespace {

constexpr const char* kPoints = "Meshes/DEFAULT/Nodal Coordinates";
constexpr const char* kCells = "Meshes/DEFAULT/Element Connectivity";
constexpr const char* kSteps = "Simulations/MAIN/Series Data";
constexpr const char* kBlocks = "Simulations/MAIN/Non-series Data/BLOCKID";
constexpr const char* kVtkHdf = "VTKHDF";
constexpr const char* kLevels = "refine level";
constexpr const char* kBoxes = "bounding box";
constexpr const char* kNodeTypes = "node type";

/// Reads a mesh of hexahedra or tetrahedra with series of values, as Truchas writes it: tetrahedra, wedges
/// and pyramids are hexahedra with points that are the same.
class TruchasReader {
 public:
  explicit TruchasReader(const Hdf5Meshes& source) : source_(source) {}

  /// The groups of the times, in their order.
  [[nodiscard]] std::vector<std::string> steps() const {
    std::vector<std::string> groups;
    for (const std::string& name : source_.has(kSteps) ? source_.names(kSteps) : std::vector<std::string>())
      groups.push_back(std::string(kSteps) + "/" + name);
    return groups;
  }

  [[nodiscard]] std::vector<double> times() const {
    std::vector<double> result;
    for (const std::string& group : steps()) result.push_back(source_.time_of(group).value_or(0));
    return result;
  }

  MeshFile run(std::optional<std::uint64_t> time) {
    file_.kind = "Truchas HDF5";
    add_cells();
    const std::vector<std::string> groups = steps();
    if (time.value_or(0) >= std::max<std::size_t>(groups.size(), 1))
      fail_for_time(source_.name(), groups.size(), *time);
    file_.times = times();
    if (!groups.empty()) {
      const std::string& group = groups[time.value_or(groups.size() - 1)];
      if (!time && groups.size() > 1) file_.add_remark(last_time_remark(groups.size(), file_.times.back()));
      for (const std::string& set : source_.names(group)) add_set(group + "/" + set, set);
    }
    if (source_.has(kBlocks)) add_blocks(source_.read(kBlocks));
    return std::move(file_);
  }

 private:
  void add_cells() {
    const Numbers points = source_.read(kPoints), cells = source_.read(kCells);
    if (points.row() != 3)
      fail("{}: {}: expected 3 coordinates per point, found {}", source_.name(), kPoints, points.row());
    const std::size_t corners = cells.row();
    if (corners != 4 && corners != 8)
      fail("{}: {}: expected cells of 4 or 8 points, found {}", source_.name(), kCells, corners);
    std::vector<Vec3> given;
    for (std::size_t p = 0; p < points.size[0]; ++p)
      given.push_back({points.values[3 * p], points.values[3 * p + 1], points.values[3 * p + 2]});
    points_ = add_merged_points(fmt::format("{}: {}", source_.name(), kPoints), given, file_);
    const std::vector<std::uint32_t>& numbers = points_.numbers;
    std::vector<std::uint32_t> face;
    for (std::size_t c = 0; c < cells.size[0]; ++c) {
      for (const auto& places : corners == 8 ? kHexahedronFaces : kTetrahedronFaces) {
        face.clear();
        for (const std::size_t place : places) {
          const double number = cells.values[corners * c + place] - 1;
          if (!(number >= 0 && number < static_cast<double>(numbers.size())))
            fail("{}: {}: expected points from 1 to {}, found {}", source_.name(), kCells, numbers.size(),
                 number + 1);
          face.push_back(numbers[static_cast<std::size_t>(number)]);
        }
        append_face(face, file_);
      }
      if (!end_cell(file_))
        fail("{}: {}: expected cells that enclose a volume, found cell {}", source_.name(), kCells, c);
    }
  }

  /// Adds the values of cells or points at a time, and passes over others.
  void add_set(const std::string& path, const std::string& set) {
    const auto found = source_.look_at(path);
    if (!found || found->size.size() > 2) return;
    const std::uint64_t components = found->size.size() == 2 ? found->size[1] : 1;
    const bool of_points = source_.text(path, "FIELDTYPE") == "NODE";
    if (components < 1 || components > kMostComponents ||
        found->size[0] != (of_points ? points_.numbers.size() : file_.cell_ends.size()))
      return;
    std::vector<std::string> names;
    for (std::uint64_t c = 1; components > 1 && c <= components; ++c)
      names.push_back(source_.text(path, "FIELDNAME" + std::to_string(c)));
    if (set == "VOF") return add_fractions(source_.read(path), names);
    const std::string own = source_.text(path, "FIELDNAME");
    const Numbers all = source_.read(path);
    add_array(own.empty() ? set : own, of_points ? Centering::kPoints : Centering::kCells,
              of_points ? rows_of(all, points_.taken) : all, static_cast<int>(components), file_);
    if (std::ranges::find(names, "") == names.end()) file_.arrays.back().component_names = names;
  }

  /// Adds the volume fractions of materials, one in each component, as arrays that are found by their names.
  void add_fractions(const Numbers& all, const std::vector<std::string>& names) {
    const std::size_t components = all.row();
    for (std::size_t m = 0; m < components; ++m) {
      Numbers own{all.type, {all.size[0]}, {}};
      for (std::size_t c = 0; c < all.size[0]; ++c) own.values.push_back(all.values[components * c + m]);
      const bool named = m < names.size() && !names[m].empty();
      add_array("Volume Fraction for " + (named ? names[m] : fmt::format("material {}", m + 1)),
                Centering::kCells, own, 1, file_);
    }
  }

  void add_blocks(const Numbers& numbers) {
    if (numbers.values.size() != file_.cell_ends.size()) return;
    std::map<double, std::int32_t> blocks;
    for (const double number : numbers.values) blocks.emplace(number, 0);
    if (blocks.size() < 2 || blocks.size() > kMostBlocks) return;
    for (auto& [number, index] : blocks) {
      index = static_cast<std::int32_t>(file_.blocks.size());
      file_.blocks.push_back(fmt::format("block {:g}", number));
    }
    for (const double number : numbers.values) file_.block_of_cell.push_back(blocks.at(number));
  }

  static constexpr std::uint64_t kMostComponents = 4096;  // of an array
  static constexpr std::size_t kMostBlocks = 65535;

  const Hdf5Meshes& source_;
  MergedPoints points_;
  MeshFile file_;
};

/// Reads blocks of cells of several levels, as FLASH writes them: all blocks have as many cells, and those of
/// node type 1 are covered by none.
class FlashReader {
 public:
  explicit FlashReader(const Hdf5Meshes& source)
      : source_(source),
        name_(source.name()),
        levels_(source.read(kLevels)),
        types_(source.read(kNodeTypes)),
        boxes_(source.read(kBoxes)) {}

  MeshFile run() {
    find_sets();
    find_levels();
    for (const std::size_t b : taken_) add_block(b);
    file_.kind = "FLASH HDF5";
    const AmrSources cells = add_amr_cells(name_, amr_, file_);
    for (const std::string& set : sets_) add_values(set, cells);
    return std::move(file_);
  }

 private:
  /// Finds the variables: data sets with a value for each cell of each block.
  void find_sets() {
    const std::size_t count = levels_.values.size(), axes = boxes_.row() / 2;
    if (types_.values.size() != count || boxes_.size[0] != count || axes < 2 || axes > 3 ||
        boxes_.row() != 2 * axes)
      fail("{}: expected a level, a type and a box for each of {} blocks, found others", name_, count);
    for (const std::string& set : source_.names("/")) {
      const auto found = source_.look_at(set);
      if (!found || found->size.size() != 4 || found->size[0] != count) continue;
      if (size_.empty()) size_ = found->size;
      if (found->size == size_) sets_.push_back(set);
    }
    if (sets_.empty()) fail("{}: expected values of the cells of {} blocks, found none", name_, count);
    amr_.flat = axes == 2 || size_[1] == 1;
    if (size_[1] < 1 || size_[2] < 1 || size_[3] < 1 || (amr_.flat && size_[1] != 1))
      fail("{}: {}: expected blocks of cells as their boxes say, found {} x {} x {}", name_, sets_.front(),
           size_[3], size_[2], size_[1]);
  }

  /// Finds the levels that have blocks, and the size of their cells.
  void find_levels() {
    for (std::size_t b = 0; b < types_.values.size(); ++b) {
      if (types_.values[b] != 1) continue;
      taken_.push_back(b);
      numbers_.emplace(levels_.values[b], 0);
    }
    if (taken_.empty()) fail("{}: expected blocks that none covers (node type 1), found none", name_);
    for (auto& [level, number] : numbers_)
      number = static_cast<std::size_t>(std::distance(numbers_.begin(), numbers_.find(level)));
    amr_.spacing.resize(numbers_.size());
    constexpr double kFar = std::numeric_limits<double>::infinity();
    amr_.origin = {kFar, kFar, amr_.flat ? 0 : kFar};
    for (const std::size_t b : taken_) {
      Vec3& spacing = amr_.spacing[numbers_.at(levels_.values[b])];
      for (std::size_t axis = 0; axis < axes(); ++axis) {
        const auto a = static_cast<int>(axis);
        spacing[a] = (side(b, axis, 1) - side(b, axis, 0)) / static_cast<double>(size_[3 - axis]);
        if (!(spacing[a] > 0) || !std::isfinite(spacing[a]))
          fail("{}: {}: expected boxes with a volume, found block {}", name_, kBoxes, b);
        amr_.origin[a] = std::min(amr_.origin[a], side(b, axis, 0));
      }
    }
  }

  void add_block(std::size_t b) {
    AmrBlock block;
    block.level = numbers_.at(levels_.values[b]);
    block.size = {1, 1, 1};
    for (std::size_t axis = 0; axis < axes(); ++axis) {
      const auto a = static_cast<int>(axis);
      const double cells = (side(b, axis, 0) - amr_.origin[a]) / amr_.spacing[block.level][a];
      if (!(cells < 1e9)) fail("{}: {}: expected boxes near each other, found block {}", name_, kBoxes, b);
      block.begin[axis] = std::llround(cells);
      block.size[axis] = static_cast<std::int64_t>(size_[3 - axis]);
    }
    amr_.blocks.push_back(std::move(block));
  }

  void add_values(const std::string& set, const AmrSources& cells) {
    const std::size_t of_block = static_cast<std::size_t>(size_[1] * size_[2] * size_[3]);
    const Numbers all = source_.read(set);
    Numbers own{all.type, {file_.cell_ends.size()}, {}};
    for (std::size_t t = 0; t < taken_.size(); ++t) {
      for (const std::int64_t c : cells.cells[t])
        own.values.push_back(all.values[of_block * taken_[t] + static_cast<std::size_t>(c)]);
    }
    // Names are filled up with blanks.
    add_array(set.substr(0, set.find_last_not_of(' ') + 1), Centering::kCells, own, 1, file_);
  }

  [[nodiscard]] double side(std::size_t b, std::size_t axis, std::size_t end) const {
    return boxes_.values[boxes_.row() * b + 2 * axis + end];
  }
  [[nodiscard]] std::size_t axes() const { return amr_.flat ? 2 : 3; }

  const Hdf5Meshes& source_;
  const std::string& name_;
  Numbers levels_, types_, boxes_;
  std::vector<std::string> sets_;
  std::vector<std::uint64_t> size_;        // of the variables: blocks, z, y, x
  std::map<double, std::size_t> numbers_;  // of the levels that have blocks, the coarsest first
  std::vector<std::size_t> taken_;         // the blocks that none covers
  AmrBlocks amr_;
  MeshFile file_;
};

/// Reads overlapping AMR as VTKHDF has it: a group for each level, with the boxes of its blocks and the
/// values of all of them behind each other.
class VtkHdfAmr {
 public:
  explicit VtkHdfAmr(const Hdf5Meshes& source) : source_(source) {}

  MeshFile run() {
    const std::vector<double> origin = source_.attribute(kVtkHdf, "Origin", 3);
    amr_.origin = {origin[0], origin[1], origin[2]};
    const std::string plane = source_.text(kVtkHdf, "GridDescription");
    if (!plane.empty() && plane != "XYZ" && plane != "XY")
      fail("{}: expected AMR in space, or in the plane of x and y, found {}", source_.name(), plane);
    amr_.flat = plane == "XY";
    if (source_.has(std::string(kVtkHdf) + "/Steps"))
      fail("{}: expected AMR of one time, found several", source_.name());
    while (source_.has(group(levels_))) add_level();
    if (amr_.blocks.empty()) fail("{}: expected levels with blocks, found none", source_.name());
    MeshFile file;
    file.kind = "VTKHDF AMR";
    cells_ = add_amr_cells(source_.name(), amr_, file);
    add_values("CellData", Centering::kCells, file);
    add_values("PointData", Centering::kPoints, file);
    return file;
  }

 private:
  static std::string group(std::size_t level) { return fmt::format("{}/Level{}", kVtkHdf, level); }

  void add_level() {
    const std::string path = group(levels_);
    const std::vector<double> spacing = source_.attribute(path, "Spacing", 3);
    for (std::size_t axis = 0; axis < (amr_.flat ? 2u : 3u); ++axis) {
      if (!(spacing[axis] > 0))
        fail("{}: {}: expected cells with a size, found {}", source_.name(), path, spacing[axis]);
    }
    amr_.spacing.push_back({spacing[0], spacing[1], spacing[2]});
    const Numbers boxes = source_.read(path + "/AMRBox");
    if (boxes.row() != 6)
      fail("{}: {}: expected boxes of 6 numbers, found {}", source_.name(), path, boxes.row());
    for (std::size_t b = 0; b < boxes.size[0]; ++b) {
      AmrBlock block;
      block.level = levels_;
      block.size = {1, 1, 1};
      for (std::size_t axis = 0; axis < (amr_.flat ? 2u : 3u); ++axis) {
        const double low = boxes.values[6 * b + 2 * axis], high = boxes.values[6 * b + 2 * axis + 1];
        if (!(high >= low && std::abs(low) < 1e9 && high < 1e9))
          fail("{}: {}: expected boxes with a volume, found block {}", source_.name(), path, b);
        block.begin[axis] = static_cast<std::int64_t>(low);
        block.size[axis] = static_cast<std::int64_t>(high - low) + 1;
      }
      amr_.blocks.push_back(block);
    }
    if (const std::string ghosts = path + "/CellData/vtkGhostType"; source_.has(ghosts))
      leave_out(source_.read(ghosts));
    ++levels_;
  }

  /// Leaves out the copies of cells of other blocks, and hidden cells, of the level that was added last.
  void leave_out(const Numbers& ghosts) {
    constexpr unsigned kCopy = 1, kHidden = 32;
    std::size_t at = 0;
    for (AmrBlock& block : amr_.blocks) {
      if (block.level != levels_) continue;
      const std::size_t cells = items(block, Centering::kCells);
      if (cells > ghosts.values.size() - at)
        fail("{}: expected ghost types of all cells, found {}", source_.name(), ghosts.values.size());
      block.left_out.resize(cells);
      for (std::size_t c = 0; c < cells; ++c)
        block.left_out[c] = (static_cast<unsigned>(ghosts.values[at + c]) & (kCopy | kHidden)) != 0;
      at += cells;
    }
  }

  /// Adds the arrays that all levels have.
  void add_values(const std::string& kind, Centering centering, MeshFile& file) const {
    const std::string first = group(0) + "/" + kind;
    for (const std::string& name : source_.has(first) ? source_.names(first) : std::vector<std::string>()) {
      if (name == "vtkGhostType") continue;
      Numbers joined;
      std::uint64_t row = 0;
      std::size_t block = 0;
      for (std::size_t level = 0; level < levels_; ++level) {
        const std::string path = group(level) + "/" + kind + "/" + name;
        if (!source_.has(path)) break;
        const Numbers all = source_.read(path);
        if (level == 0) {
          joined.type = all.type;
          row = all.row();
        }
        if (all.row() != row || row < 1) break;
        std::size_t begin = 0;
        for (; block < amr_.blocks.size() && amr_.blocks[block].level == level; ++block) {
          for (const std::int64_t i :
               centering == Centering::kCells ? cells_.cells[block] : cells_.points[block]) {
            const std::size_t at = (begin + static_cast<std::size_t>(i)) * row;
            if (at + row > all.values.size())
              fail("{}: {}: expected values of all blocks, found {}", source_.name(), path, all.size[0]);
            joined.values.insert(joined.values.end(), all.values.begin() + static_cast<std::ptrdiff_t>(at),
                                 all.values.begin() + static_cast<std::ptrdiff_t>(at + row));
          }
          begin += items(amr_.blocks[block], centering);
        }
      }
      if (block < amr_.blocks.size()) {
        file.add_remark(fmt::format("array '{}' is not read: not all levels have it", name));
        continue;
      }
      add_array(name, centering, joined, static_cast<int>(row), file);
    }
  }

  /// The number of a block's cells, or of its points.
  [[nodiscard]] std::size_t items(const AmrBlock& block, Centering centering) const {
    const std::int64_t more = centering == Centering::kPoints ? 1 : 0;
    return static_cast<std::size_t>((block.size[0] + more) * (block.size[1] + more) *
                                    (block.size[2] + (amr_.flat ? 0 : more)));
  }

  const Hdf5Meshes& source_;
  AmrBlocks amr_;
  std::size_t levels_ = 0;
  AmrSources cells_;
};

}  // namespace

MeshFile read_hdf5_mesh(const std::filesystem::path& path, std::optional<std::uint64_t> time) {
  const Hdf5Meshes source(path);
  if (hdf5_layout().of_cells()) return read_laid_out_mesh(source, hdf5_layout(), time);
  if (source.has(kPoints) && source.has(kCells)) return TruchasReader(source).run(time);
  if (source.has(kVtkHdf) && source.text(kVtkHdf, "Type") == "OverlappingAMR") {
    if (time.value_or(0) != 0) fail_for_time(source.name(), 1, *time);
    return VtkHdfAmr(source).run();
  }
  if (!source.has(kLevels) || !source.has(kBoxes) || !source.has(kNodeTypes))
    fail("{}: expected a mesh of Truchas or blocks of FLASH, found neither", source.name());
  if (time.value_or(0) != 0) fail_for_time(source.name(), 1, *time);
  return FlashReader(source).run();
}

std::vector<double> hdf5_mesh_times(const std::filesystem::path& path) {
  const Hdf5Meshes source(path);
  if (hdf5_layout().of_cells()) return laid_out_times(source, hdf5_layout());
  return source.has(kPoints) ? TruchasReader(source).times() : std::vector<double>();
}

}  // namespace adamas::io
