#include "core/io/mesh_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <string_view>
#include <utility>

#include "adamas/series.h"
#include "adamas/text.h"
#include "core/base/error.h"
#include "core/base/sort_unique.h"
#include "core/data/unstructured_mesh.h"
#include "core/io/file_handle.h"
#include "core/io/hdf5_layout.h"
#include "core/io/input_file.h"
#include "core/io/input_formats.h"
#include "core/io/mesh_builder.h"
#include "core/io/reader_program.h"
#include "core/io/sent_grids.h"
#include "core/io/spy_dump.h"
#include "core/io/vtk_checks.h"

namespace adamas::io {

namespace {

/// Throws unless the sizes that the reader has set fit each other, before its arrays are indexed.
void check_sent(const std::string& name, const MeshFile& file) {
  const auto ascends = [](const std::vector<std::uint32_t>& ends, std::size_t last, std::size_t least) {
    std::size_t before = 0;
    for (const std::uint32_t end : ends) {
      if (end < before + least) return false;
      before = end;
    }
    return before == last;
  };
  bool fits = ascends(file.face_ends, file.face_points.size(), 3) &&
              ascends(file.cell_ends, file.face_ends.size(), 1) &&
              (!file.flat || file.cell_ends.size() == file.face_ends.size()) &&
              (file.blocks.empty() || file.block_of_cell.size() == file.cell_ends.size());
  for (const std::int32_t block : file.block_of_cell)
    fits = fits && block >= 0 && static_cast<std::size_t>(block) < file.blocks.size();
  for (const GridArray& array : file.arrays) {
    const std::size_t items =
        array.centering == Centering::kCells ? file.cell_ends.size() : file.points.size();
    fits = fits && array.components > 0 && array.size() == items * static_cast<std::size_t>(array.components);
  }
  for (const MeshSet& set : file.sets) {
    const bool by_sides = ascends(set.side_ends, set.points.size(), file.flat ? 2 : 3);
    fits = fits && (set.of_nodes ? set.side_ends.empty() : by_sides) &&
           std::ranges::all_of(set.points, [&file](std::uint32_t p) { return p < file.points.size(); });
  }
  if (!fits) fail("{}: expected arrays that fit the mesh, found others", name);
}

}  // namespace

InputFormat cells_format() {
  return {.name = "cells of a mesh",
          .kind = InputKind::kCells,
          .endings = ".vts .pvtu .pvts .vtm .vth .foam .exo .cgns .silo .pdb",
          .more_endings = ".vthb .e .ex2 .exii .g .gen .spcth-timeseries"};
}

namespace {

bool is_legacy_mesh(const std::filesystem::path& path) {
  std::array<char, 1024> bytes{};
  const std::size_t size = FileHandle::open(path)->read_some(0, std::as_writable_bytes(std::span(bytes)));
  const std::string_view beginning(bytes.data(), size);
  return beginning.find("DATASET UNSTRUCTURED_GRID") != std::string_view::npos ||
         beginning.find("DATASET STRUCTURED_GRID") != std::string_view::npos;
}

/// Returns whether the name that resampled meshes have is missing at the beginning of a file, where adamas
/// writes it.
bool is_foreign_vtu(const std::filesystem::path& path) {
  std::string bytes(std::size_t{1} << 20, '\0');
  const std::size_t size = FileHandle::open(path)->read_some(0, std::as_writable_bytes(std::span(bytes)));
  return std::string_view(bytes).substr(0, size).find(fmt::format("Name=\"{}\"", kResampledVersion)) ==
         std::string_view::npos;
}

}  // namespace

Hdf5Origin hdf5_origin(const std::filesystem::path& path) {
  const std::string extension = file_extension(path);
  if (extension == ".silo" || extension == ".pdb") return Hdf5Origin::kSilo;
  const bool by_name = extension == ".h5" || extension == ".hdf5" || extension == ".vtkhdf";
  // The files of FLASH have no endings.
  if (!by_name && find_format_by_name(path) != nullptr) return Hdf5Origin::kNone;
  const auto file = FileHandle::open(path);
  std::array<char, 8> magic{};
  if (file->read_some(0, std::as_writable_bytes(std::span(magic))) != magic.size() ||
      std::string_view(magic.data(), magic.size()) != "\x89HDF\r\n\x1a\n")
    return Hdf5Origin::kNone;
  if (hdf5_layout().of_cells()) return Hdf5Origin::kMesh;
  constexpr std::size_t kSearched = 4 << 20;
  std::string bytes(kSearched, '\0');
  const std::uint64_t size = std::filesystem::file_size(path);
  for (const std::uint64_t offset : {std::uint64_t{0}, size - std::min<std::uint64_t>(size, kSearched)}) {
    const std::size_t found = file->read_some(offset, std::as_writable_bytes(std::span(bytes)));
    const std::string_view text = std::string_view(bytes).substr(0, found);
    const auto has = [text](std::string_view name) { return text.find(name) != std::string_view::npos; };
    if (has("_silolibinfo")) return Hdf5Origin::kSilo;
    if (has("Nodal Coordinates") && has("Element Connectivity")) return Hdf5Origin::kMesh;
    if (has("refine level") && has("bounding box") && has("node type")) return Hdf5Origin::kMesh;
    if (extension != ".vtkhdf") continue;
    if (has("OverlappingAMR")) return Hdf5Origin::kMesh;
    if (has("UnstructuredGrid")) return Hdf5Origin::kVtk;
  }
  return Hdf5Origin::kNone;
}

bool is_mesh_by_header(const std::filesystem::path& path) {
  std::error_code code;
  if (!std::filesystem::is_regular_file(path, code)) return false;
  const std::string extension = file_extension(path);
  if (extension == ".vtk") return is_legacy_mesh(path);
  if (is_spy_dump(path)) return true;
  return extension == ".vtu" ? is_foreign_vtu(path) : hdf5_origin(path) != Hdf5Origin::kNone;
}

void fail_for_time(const std::string& name, std::size_t count, std::uint64_t time) {
  fail("{}: --time: expected a time from 0 to {}, found {}", name, std::max<std::size_t>(count, 1) - 1, time);
}

std::string last_time_remark(std::size_t count, double time) {
  return fmt::format("of {} times the last one is read, {:g} (others by --time N, from 0 on)", count, time);
}

}  // namespace adamas::io

std::vector<double> adamas::mesh_times(const std::filesystem::path& path) {
  using namespace io;
  check_input_file(path);
  if (kind_by_format(path) != InputKind::kCells) return {};
  return receive_from_child<std::vector<double>>(request_of(LibraryReader::kCellTimes, path));
}

namespace adamas::io {

MeshFile read_mesh_file(const std::filesystem::path& path, std::optional<std::uint64_t> time) {
  ReaderRequest request = request_of(LibraryReader::kCells, path);
  if (file_extension(path) == ".vtu")
    check_vtk_counts(read_xml_tags(supply_file(FileHandle::open(path), 0), path.string()), path);
  request.time = time;
  MeshFile file = receive_from_child<MeshFile>(request);
  check_sent(path.string(), file);
  show_names(file.arrays, file.material_names);
  for (std::string& block : file.blocks) block = visible_text(block);
  for (MeshSet& set : file.sets) set.name = visible_text(set.name);
  return file;
}

namespace {

/// Moves a flat mesh through places: each of its cells becomes one between each two of them.
class Sweep {
 public:
  /// `layers`: the number of places; `closed`: whether the first one follows the last.
  Sweep(const std::string& name, MeshFile& file, std::uint32_t layers, bool closed)
      : name_(name),
        file_(file),
        numbers_(layers),
        between_(closed ? layers : layers - 1),
        points_(std::exchange(file.face_points, {})),
        ends_(std::exchange(file.face_ends, {})) {
    file_.flat = false;
    file_.cell_ends.clear();
  }

  /// `move(p, layer)`: where a point is at a place.
  template <class Move>
  void run(const Move& move) {
    add_points(move);
    for (std::uint32_t layer = 0; layer < between_; ++layer) add_cells(layer);
    for (GridArray& array : file_.arrays) {
      array.centering == Centering::kCells
          ? std::visit([&](auto& values) { repeat(values); }, array.values)
          : std::visit([&](auto& values) { move_values(array.components, values); }, array.values);
    }
    repeat(file_.block_of_cell);
    for (MeshSet& set : file_.sets) sweep(set);
  }

 private:
  /// Adds the points of all places; those that stay where they are stay one.
  template <class Move>
  void add_points(const Move& move) {
    const std::vector<Vec3> flat = std::exchange(file_.points, {});
    if (flat.size() * numbers_.size() >= std::numeric_limits<std::uint32_t>::max())
      fail("{}: expected fewer than {} points of a flat mesh, found {}", name_,
           std::numeric_limits<std::uint32_t>::max() / numbers_.size(), flat.size());
    for (std::uint32_t layer = 0; layer < numbers_.size(); ++layer) {
      for (std::size_t p = 0; p < flat.size(); ++p) {
        const Vec3 at = move(flat[p], layer);
        const bool stays = layer > 0 && at == file_.points[numbers_[0][p]];
        numbers_[layer].push_back(stays ? numbers_[0][p] : static_cast<std::uint32_t>(file_.points.size()));
        if (!stays) file_.points.push_back(at);
      }
    }
  }

  void add_cells(std::uint32_t layer) {
    const auto &below = numbers_[layer], &above = numbers_[(layer + 1) % numbers_.size()];
    std::vector<std::uint32_t> face;
    std::size_t begin = 0;
    for (const std::uint32_t end : ends_) {
      const std::span<const std::uint32_t> own = std::span(points_).subspan(begin, end - begin);
      for (const auto* side : {&below, &above}) {
        face.clear();
        for (const std::uint32_t p : own) face.push_back((*side)[p]);
        append_face(face, file_);
      }
      for (std::size_t i = 0; i < own.size(); ++i)
        append_face(swept(own[i], own[(i + 1) % own.size()], layer), file_);
      if (!end_cell(file_)) fail("{}: expected cells that enclose a volume, found others", name_);
      begin = end;
    }
  }

  /// The corners of the side that an edge becomes in a layer.
  [[nodiscard]] std::array<std::uint32_t, 4> swept(std::uint32_t a, std::uint32_t b,
                                                   std::uint32_t layer) const {
    const auto &below = numbers_[layer], &above = numbers_[(layer + 1) % numbers_.size()];
    return {below[a], below[b], above[b], above[a]};
  }

  /// Makes sides of the edges of a set, or takes the points of a node set at all places.
  void sweep(MeshSet& set) const {
    const MeshSet flat = std::exchange(set, {set.name, set.of_nodes});
    if (set.of_nodes) {
      for (const auto& numbers : numbers_) {
        for (const std::uint32_t p : flat.points) set.points.push_back(numbers[p]);
      }
      sort_unique(set.points);
    }
    for (std::size_t n = 0; n < flat.side_ends.size(); ++n) {
      const auto edge = flat.side(n);
      for (std::uint32_t layer = 0; layer < between_; ++layer) {
        std::vector<std::uint32_t> side;
        for (const std::uint32_t p : swept(edge[0], edge[1], layer)) {
          if (std::ranges::find(side, p) == side.end()) side.push_back(p);
        }
        // An edge on the axis sweeps nothing.
        if (side.size() >= 3) set.add_side(side);
      }
    }
  }

  /// Repeats the values of cells for each layer of them.
  template <class Values>
  void repeat(Values& values) const {
    const Values once = values;
    for (std::uint32_t layer = 1; layer < between_; ++layer)
      values.insert(values.end(), once.begin(), once.end());
  }

  /// Gives the points of all places the values of those that they come from.
  template <class Values>
  void move_values(int per_point, Values& values) const {
    const auto components = static_cast<std::size_t>(per_point);
    const Values flat = std::exchange(values, {});
    values.resize(file_.points.size() * components);
    for (const auto& own : numbers_) {
      for (std::size_t p = 0; p < own.size(); ++p)
        std::copy_n(flat.begin() + static_cast<std::ptrdiff_t>(p * components), components,
                    values.begin() + static_cast<std::ptrdiff_t>(own[p] * components));
    }
  }

  const std::string& name_;
  MeshFile& file_;
  std::vector<std::vector<std::uint32_t>> numbers_;  // of the points at each place
  std::uint32_t between_;                            // the number of layers of cells
  std::vector<std::uint32_t> points_, ends_;         // of the flat cells
};

}  // namespace

void extrude(const std::string& name, MeshFile& file, double height) {
  Sweep(name, file, 2, false).run([height](const Vec3& p, std::uint32_t layer) {
    return p + Vec3{0, 0, layer * height};
  });
}

void revolve(const std::string& name, MeshFile& file) {
  constexpr std::uint32_t kSectors = 48;
  constexpr double kAngle = 2 * std::numbers::pi / kSectors;
  double most = 0;
  for (const Vec3& p : file.points) most = std::max(most, std::abs(p.x));
  for (Vec3& p : file.points) {
    if (p.x < -1e-9 * most) fail("{}: --axisymmetric: expected x of 0 or more, found {}", name, p.x);
    // Up to round-off, a point on the axis lies on it.
    if (p.x < 1e-9 * most) p.x = 0;
  }
  // A polygon of this radius has the area of the circle.
  const double radius = std::sqrt(kAngle / std::sin(kAngle));
  Sweep(name, file, kSectors, true).run([radius](const Vec3& p, std::uint32_t layer) {
    if (p.x == 0) return p;
    return Vec3{radius * p.x * std::cos(layer * kAngle), p.y, p.z + radius * p.x * std::sin(layer * kAngle)};
  });
}

}  // namespace adamas::io
