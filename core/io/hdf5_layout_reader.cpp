#include "core/io/hdf5_layout_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "core/base/error.h"
#include "core/io/amr_cells.h"
#include "core/io/mesh_builder.h"
#include "core/io/rectilinear_levels.h"

namespace adamas::io {

namespace {

/// The greatest number of components of an array.
constexpr std::uint64_t kMostComponents = 4096;

/// Whether a name fits a pattern, in which a '*' stands for any letters.
bool fits_pattern(std::string_view name, std::string_view pattern) {
  const std::size_t star = pattern.find('*');
  if (star == std::string_view::npos) return name == pattern;
  const std::string_view before = pattern.substr(0, star), after = pattern.substr(star + 1);
  return name.size() >= before.size() + after.size() && name.starts_with(before) && name.ends_with(after);
}

/// Reads one time of a file as a layout says.
class LaidOutReader {
 public:
  LaidOutReader(const Hdf5Meshes& source, const Hdf5Layout& layout) : source_(source), layout_(layout) {
    if (!layout_.steps.empty() && !layout_.times.empty()) fail_for_keys("steps or times", "both");
    find_groups();
    if (!layout_.times.empty()) {
      const Numbers all = read("times", layout_.times);
      times_ = all.values;
    }
    for (std::size_t g = 0; g < groups_.size(); ++g)
      times_.push_back(source_.time_of(groups_[g]).value_or(static_cast<double>(g)));
    for (const double time : times_) {
      if (!std::isfinite(time)) fail("{}: expected finite times, found others", source_.name());
    }
  }

  [[nodiscard]] const std::vector<double>& times() const { return times_; }

  MeshFile run(std::optional<std::uint64_t> time) {
    if (time.value_or(0) >= std::max<std::size_t>(times_.size(), 1))
      fail_for_time(source_.name(), times_.size(), *time);
    if (!times_.empty()) number_ = time.value_or(times_.size() - 1);
    file_.kind = "HDF5 mesh";
    if (!layout_.cells.empty()) {
      add_cells();
    } else if (!layout_.boxes.empty()) {
      add_blocks();
    } else if (!layout_.nodes.empty()) {
      fail_for_keys("cells beside nodes", "none");
    } else {
      add_grid();
    }
    add_arrays();
    file_.times = times_;
    if (!time && times_.size() > 1) file_.add_remark(last_time_remark(times_.size(), times_.back()));
    return std::move(file_);
  }

  /// The axes of a grid.
  [[nodiscard]] std::array<std::vector<double>, 3> axes() const {
    std::array<std::vector<double>, 3> result;
    if (layout_.axes[0].empty() || layout_.axes[1].empty())
      fail_for_keys("x and y, and z in space", "others");
    for (std::size_t a = 0; a < 3; ++a) {
      if (layout_.axes[a].empty()) continue;
      const std::string key(1, "xyz"[a]);
      result[a] = read(key, layout_.axes[a]).values;
      bool ascends = result[a].size() >= 2;
      for (std::size_t i = 0; i < result[a].size(); ++i)
        ascends = ascends && std::isfinite(result[a][i]) && (i == 0 || result[a][i] > result[a][i - 1]);
      if (!ascends)
        fail("{}: --hdf5 {}: expected coordinates that ascend, found others in '{}'", source_.name(), key,
             layout_.axes[a]);
    }
    return result;
  }

 private:
  [[noreturn]] void fail_for_keys(const char* expected, const char* found) const {
    fail("{}: --hdf5: expected {}, found {}", source_.name(), expected, found);
  }

  /// Throws the Error that there is no data set, or no group, of a name, and lists some that there are.
  [[noreturn]] void fail_for_name(const std::string& key, const std::string& name,
                                  const std::vector<std::string>& known) const {
    constexpr std::size_t kListed = 8;
    std::string list;
    for (std::size_t n = 0; n < std::min(known.size(), kListed); ++n)
      list += fmt::format("{}'{}'", n == 0 ? "" : ", ", known[n]);
    if (known.size() > kListed) list += ", ...";
    fail("{}: --hdf5 {}: expected '{}', found {}", source_.name(), key, name, list.empty() ? "none" : list);
  }

  /// Finds the groups of the times: those that fit the last part of a name, or all in the group of that name.
  void find_groups() {
    if (layout_.steps.empty()) return;
    const std::size_t slash = layout_.steps.rfind('/');
    const bool pattern = layout_.steps.find('*', slash == std::string::npos ? 0 : slash) != std::string::npos;
    const std::string parent = !pattern                     ? layout_.steps
                               : slash == std::string::npos ? "/"
                                                            : layout_.steps.substr(0, slash);
    const std::string last = !pattern                     ? "*"
                             : slash == std::string::npos ? layout_.steps
                                                          : layout_.steps.substr(slash + 1);
    if (parent != "/" && !source_.has(parent)) fail_for_name("steps", layout_.steps, source_.names("/"));
    for (const std::string& name : source_.names(parent)) {
      if (fits_pattern(name, last)) groups_.push_back(parent == "/" ? name : parent + "/" + name);
    }
    if (groups_.empty()) fail_for_name("steps", layout_.steps, source_.names(parent));
  }

  /// Reads a data set of the layout, in the group of the time or else of the whole file.
  [[nodiscard]] Numbers read(const std::string& key, const std::string& name) const {
    if (!groups_.empty()) {
      const std::string own = groups_[number_] + "/" + name;
      if (source_.has(own) && source_.look_at(own)) return source_.read(own);
    }
    if (!source_.has(name) || !source_.look_at(name)) fail_for_name(key, name, source_.data_sets("/"));
    return source_.read(name);
  }

  /// The places of nodes.
  [[nodiscard]] std::vector<Vec3> read_nodes() {
    std::vector<Vec3> result;
    if (!layout_.nodes.empty()) {
      const Numbers all = read("nodes", layout_.nodes);
      if (all.row() != 2 && all.row() != 3)
        fail("{}: --hdf5 nodes: expected 2 or 3 coordinates per node, found {}", source_.name(), all.row());
      file_.flat = all.row() == 2;
      for (std::size_t n = 0; n < all.size[0]; ++n) {
        const auto own = all.values.begin() + static_cast<std::ptrdiff_t>(n * all.row());
        result.push_back({own[0], own[1], file_.flat ? 0 : own[2]});
      }
      return result;
    }
    if (layout_.axes[0].empty() || layout_.axes[1].empty())
      fail_for_keys("nodes, or x and y, beside cells", "none");
    file_.flat = layout_.axes[2].empty();
    for (std::size_t a = 0; a < (file_.flat ? 2u : 3u); ++a) {
      const Numbers all = read(std::string(1, "xyz"[a]), layout_.axes[a]);
      if (a == 0) result.resize(all.values.size());
      if (all.values.size() != result.size())
        fail("{}: --hdf5: expected as many coordinates along all axes, found {} and {}", source_.name(),
             result.size(), all.values.size());
      for (std::size_t n = 0; n < result.size(); ++n) result[n][static_cast<int>(a)] = all.values[n];
    }
    return result;
  }

  void add_cells() {
    const std::vector<Vec3> nodes = read_nodes();
    nodes_ = add_merged_points(source_.name(), nodes, file_);
    const Numbers cells = read("cells", layout_.cells);
    const std::size_t row = cells.row();
    std::vector<std::uint32_t> corners, face;
    for (std::size_t c = 0; row > 0 && c < cells.size[0]; ++c) {
      corners.clear();
      for (std::size_t i = 0; i < row; ++i) {
        const double node = cells.values[row * c + i] - static_cast<double>(layout_.base);
        // Rows of cells with fewer nodes are filled up with numbers below the first.
        if (node < 0) break;
        if (!(node < static_cast<double>(nodes.size())))
          fail("{}: --hdf5 cells: expected nodes from {} to {}, found {} in cell {}", source_.name(),
               layout_.base, nodes.size() - 1 + static_cast<std::size_t>(layout_.base),
               cells.values[row * c + i], c);
        corners.push_back(nodes_.numbers[static_cast<std::size_t>(node)]);
      }
      if (file_.flat) {
        if (corners.size() < 3) fail_for_corners(corners.size(), c, "3 nodes or more");
        append_face(corners, file_);
      } else {
        for (const auto& places : faces_of(corners.size(), c)) {
          face.clear();
          for (const std::size_t place : places) face.push_back(corners[place]);
          append_face(face, file_);
        }
      }
      if (!end_cell(file_))
        fail("{}: --hdf5 cells: expected cells that enclose a volume, found cell {}", source_.name(), c);
    }
    cell_sizes_ = {file_.cell_ends.size()};
    point_sizes_ = {nodes.size()};
    cells_.resize(file_.cell_ends.size());
    for (std::size_t c = 0; c < cells_.size(); ++c) cells_[c] = c;
  }

  [[nodiscard]] const CellFaces& faces_of(std::size_t corners, std::size_t cell) const {
    switch (corners) {
      case 4:
        return kTetrahedronFaces;
      case 5:
        return kPyramidFaces;
      case 6:
        return kWedgeFaces;
      case 8:
        return kHexahedronFaces;
      default:
        fail_for_corners(corners, cell, "4, 5, 6 or 8 nodes");
    }
  }
  [[noreturn]] void fail_for_corners(std::size_t corners, std::size_t cell, const char* expected) const {
    fail("{}: --hdf5 cells: expected cells of {}, found {} in cell {}", source_.name(), expected, corners,
         cell);
  }

  /// Adds a grid, whose values are along z, y and x.
  void add_grid() {
    RectilinearBlock block;
    block.nodes = axes();
    const bool flat = block.nodes[2].empty();
    if (flat) block.nodes[2] = {0};
    for (std::size_t a = flat ? 2 : 3; a-- > 0;) {
      point_sizes_.push_back(block.nodes[a].size());
      cell_sizes_.push_back(block.nodes[a].size() - 1);
    }
    take(add_rectilinear_cells(source_.name(), {block}, flat, false, file_), 1);
  }

  /// Adds blocks with the same number of cells, which is that of the first data set with values for them.
  void add_blocks() {
    const Numbers boxes = read("boxes", layout_.boxes);
    const std::size_t count = boxes.size[0], axes = boxes.row() / 2;
    if (count < 1 || axes < 2 || axes > 3 || boxes.row() != 2 * axes)
      fail("{}: --hdf5 boxes: expected a low and a high end along 2 or 3 axes per block, found {} numbers",
           source_.name(), boxes.row());
    const bool ends_first = boxes.size.size() == 3 && boxes.size[1] == 2 && boxes.size[2] == 3;
    const bool flat = axes == 2;
    for (const auto& [path, size] : value_sets()) {
      if (size.size() == axes + 1 && size[0] == count) {
        cell_sizes_ = size;
        break;
      }
    }
    if (cell_sizes_.empty())
      fail("{}: --hdf5 boxes: expected data sets with values of the cells of {} blocks, found none",
           source_.name(), count);
    std::vector<RectilinearBlock> blocks(count);
    bool refined = false;
    for (std::size_t b = 0; b < count; ++b) {
      for (std::size_t a = 0; a < axes; ++a) {
        const auto end_of = [&](std::size_t block, std::size_t end) {
          return boxes.values[2 * axes * block + (ends_first ? axes * end + a : 2 * a + end)];
        };
        const double low = end_of(b, 0), high = end_of(b, 1);
        const std::size_t cells = cell_sizes_[axes - a];
        if (!(high > low) || !std::isfinite(high - low) || cells < 1)
          fail("{}: --hdf5 boxes: expected boxes with a volume, found block {}", source_.name(), b);
        refined = refined || std::abs((high - low) / (end_of(0, 1) - end_of(0, 0)) - 1) > 0.1;
        for (std::size_t i = 0; i <= cells; ++i)
          blocks[b].nodes[a].push_back(low +
                                       (high - low) * static_cast<double>(i) / static_cast<double>(cells));
        blocks[b].taken.min[static_cast<int>(a)] = low;
        blocks[b].taken.max[static_cast<int>(a)] = high;
      }
      if (flat) blocks[b].nodes[2] = {0};
    }
    take(add_rectilinear_cells(source_.name(), blocks, flat, refined, file_), count);
  }

  /// Takes the cells and, of a single block, the points that have become a part of the mesh.
  void take(const AmrSources& sources, std::size_t blocks) {
    std::size_t of_block = 1;
    for (const std::uint64_t n : cell_sizes_) of_block *= n;
    of_block /= blocks;
    for (std::size_t b = 0; b < blocks; ++b) {
      for (const std::int64_t cell : sources.cells[b])
        cells_.push_back(of_block * b + static_cast<std::size_t>(cell));
    }
    if (point_sizes_.empty()) return;
    for (const std::int64_t point : sources.points[0])
      nodes_.taken.push_back(static_cast<std::size_t>(point));
  }

  struct ValueSet {
    std::string path;
    std::vector<std::uint64_t> size;  // without that of times
    bool timed = false;
  };

  /// The data sets that may be arrays: those of the time, and those of the whole file, by their names.
  [[nodiscard]] std::map<std::string, ValueSet> named_sets() const {
    std::map<std::string, ValueSet> result;
    const auto add = [&](const std::string& name, const std::string& path) {
      ValueSet set{path, source_.look_at(path)->size, false};
      set.timed = !layout_.times.empty() && set.size.size() > 1 && set.size[0] == times_.size();
      if (set.timed) set.size.erase(set.size.begin());
      result.emplace(name, std::move(set));
    };
    if (!groups_.empty()) {
      for (const std::string& name : source_.data_sets(groups_[number_]))
        add(name, groups_[number_] + "/" + name);
    }
    for (const std::string& name : source_.data_sets("/")) {
      const bool of_time = std::ranges::any_of(
          groups_, [&name](const std::string& group) { return name.starts_with(group + "/"); });
      if (!of_time) add(name, name);
    }
    const auto& [nodes, axes, cells, base, boxes, steps, times] = layout_;
    for (const std::string& own : {nodes, axes[0], axes[1], axes[2], cells, boxes, times}) result.erase(own);
    return result;
  }
  [[nodiscard]] std::vector<std::pair<std::string, std::vector<std::uint64_t>>> value_sets() const {
    std::vector<std::pair<std::string, std::vector<std::uint64_t>>> result;
    for (const auto& [name, set] : named_sets()) result.emplace_back(set.path, set.size);
    return result;
  }

  void add_arrays() {
    for (const auto& [name, set] : named_sets()) {
      for (const Centering centering : {Centering::kCells, Centering::kPoints}) {
        const std::vector<std::uint64_t>& sizes = centering == Centering::kCells ? cell_sizes_ : point_sizes_;
        const auto components = components_of(set.size, sizes);
        if (!components) continue;
        Numbers all = set.timed ? source_.read(set.path, number_) : source_.read(set.path);
        all.size = {all.values.size() / *components, *components};
        add_array(name, centering, rows_of(all, centering == Centering::kCells ? cells_ : nodes_.taken),
                  static_cast<int>(*components), file_);
        break;
      }
    }
  }

  /// How many numbers a data set has for each of the sites; none where it is of other sites.
  [[nodiscard]] static std::optional<std::uint64_t> components_of(const std::vector<std::uint64_t>& size,
                                                                  const std::vector<std::uint64_t>& sites) {
    if (sites.empty() || size.size() < sites.size() || size.size() > sites.size() + 1) return {};
    if (!std::equal(sites.begin(), sites.end(), size.begin())) return {};
    if (size.size() == sites.size()) return 1;
    return size.back() >= 1 && size.back() <= kMostComponents ? std::optional(size.back()) : std::nullopt;
  }

  const Hdf5Meshes& source_;
  const Hdf5Layout& layout_;
  std::vector<std::string> groups_;  // of the times
  std::vector<double> times_;
  std::size_t number_ = 0;                               // of the time
  std::vector<std::uint64_t> cell_sizes_, point_sizes_;  // of data sets with values of cells or nodes
  std::vector<std::size_t> cells_;                       // of the file, that the mesh has
  MergedPoints nodes_;
  MeshFile file_;
};

}  // namespace

MeshFile read_laid_out_mesh(const Hdf5Meshes& source, const Hdf5Layout& layout,
                            std::optional<std::uint64_t> time) {
  return LaidOutReader(source, layout).run(time);
}

std::vector<double> laid_out_times(const Hdf5Meshes& source, const Hdf5Layout& layout) {
  return LaidOutReader(source, layout).times();
}

std::array<std::vector<double>, 3> read_laid_out_axes(const Hdf5Meshes& source, const Hdf5Layout& layout) {
  return LaidOutReader(source, layout).axes();
}

}  // namespace adamas::io
