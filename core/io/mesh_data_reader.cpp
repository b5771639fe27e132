#include "core/io/mesh_data_reader.h"

#include <algorithm>
#include <utility>

#include "adamas/series.h"
#include "core/base/error.h"
#include "core/io/field_assembly.h"
#include "core/io/material_arrays.h"
#include "core/io/mesh_file.h"

namespace adamas::io {

namespace {

class Reader {
 public:
  Reader(const std::filesystem::path& path, const MaterialDataOptions& options, Progress& progress)
      : path_(path), options_(options), progress_(progress) {}

  MeshData run() {
    progress_.step("read " + path_.filename().string(), 0);
    file_ = read_mesh_file(path_, options_.time);
    data_.source = path_.string();
    refuse_options();
    extrude_if_flat(data_.source, file_);
    choose_blocks();
    progress_.step("joining cells", -1);
    data_.mesh = PolyhedralMesh::make(data_.source, std::move(file_.points), std::move(file_.face_points),
                                      file_.face_ends, file_.cell_ends);
    if (data_.mesh.tangled_cells() > 0 && options_.note)
      options_.note(
          fmt::format("{}: {} of {} cells are tangled: interfaces in them are as good as they can be",
                      data_.source, data_.mesh.tangled_cells(), data_.mesh.cell_count()));
    data_.sets = std::move(file_.sets);
    const std::vector<std::string>& names = by_blocks_ ? file_.blocks : file_.material_names;
    MaterialArrays arrays(path_, options_, std::move(file_.arrays), names,
                          [this](const std::string& option, const std::filesystem::path& file) {
                            return read_other(option, file);
                          });
    take_materials(arrays);
    if (options_.note && !file_.remark.empty()) options_.note(data_.source + ": " + file_.remark);
    take_fields(arrays.take_fields());
    progress_.step("check materials", 0.9);
    data_.normalise();
    data_.report.step = step_;
    take_whole_cells_for_labels();
    data_.check();
    progress_.step("check materials", 1);
    return std::move(data_);
  }

 private:
  void refuse_options() const {
    if (options_.region) fail("{}: --region: expected data on a grid, found a mesh", data_.source);
    if (!options_.extensive.empty())
      fail("{}: --extensive: expected data on a grid, found a mesh", data_.source);
    if (options_.centering)
      fail("{}: --{}: expected data on a grid, found a mesh", data_.source,
           *options_.centering == Centering::kCells ? "cells" : "points");
  }

  void extrude_if_flat(const std::string& name, MeshFile& file) const {
    if (options_.extrude && options_.axisymmetric)
      fail("{}: --extrude and --axisymmetric: expected one of them", name);
    if (!file.flat && (options_.extrude || options_.axisymmetric))
      fail("{}: {}: expected cells of two dimensions, found cells with a volume", name,
           options_.extrude ? "--extrude" : "--axisymmetric");
    if (!file.flat) return;
    if (!options_.extrude && !options_.axisymmetric)
      fail(
          "{}: expected cells with a volume, found those of two dimensions: pass --extrude H for cells of "
          "this "
          "height, or --axisymmetric for rings round the axis of y",
          name);
    options_.axisymmetric ? revolve(name, file) : extrude(name, file, *options_.extrude);
  }

  /// Takes the blocks for materials if nothing else says what these are.
  void choose_blocks() {
    const bool named = MaterialArrays::name_materials(options_, file_.arrays, file_.material_names);
    if (file_.blocks.empty() || named) return;
    by_blocks_ = true;
    options_.labels = kBlocks;
    GridArray array;
    array.name = kBlocks;
    array.type = "int32";
    array.centering = Centering::kCells;
    array.values = std::move(file_.block_of_cell);
    file_.arrays.insert(file_.arrays.begin(), std::move(array));
    if (options_.note)
      options_.note(
          fmt::format("{}: no array has volume fractions or labels: its {} blocks are the materials",
                      data_.source, file_.blocks.size()));
  }

  /// Reads the one array of another file, which has to be on the same mesh.
  GridArray read_other(const std::string& option, const std::filesystem::path& file) {
    progress_.step("read " + file.filename().string(), 0.5);
    // A file of one time goes with all of them.
    MeshFile other = read_mesh_file(file, mesh_times(file).size() > 1 ? options_.time : std::nullopt);
    extrude_if_flat(file.string(), other);
    const std::vector<Vec3>& points = data_.mesh.points();
    if (other.cell_ends.size() != data_.mesh.cell_count() || other.points.size() != points.size())
      fail("{}: {}: expected the mesh of {} with {} cells and {} points, found {} and {}", file.string(),
           option, data_.source, data_.mesh.cell_count(), points.size(), other.cell_ends.size(),
           other.points.size());
    for (std::size_t p = 0; p < points.size(); ++p) {
      if (!(distance(points[p], other.points[p]) <= kSamePlace * data_.mesh.box().diagonal()))
        fail("{}: {}: expected the mesh of {}, found point {} at another place", file.string(), option,
             data_.source, p);
    }
    if (other.arrays.size() != 1)
      fail("{}: {}: expected a file of one array, found {}", file.string(), option, names_of(other.arrays));
    return std::move(other.arrays[0]);
  }

  /// Averages values of points to cells.
  [[nodiscard]] std::vector<float> of_cells(const std::vector<float>& of_points) const {
    std::vector<float> result;
    result.reserve(data_.mesh.cell_count());
    for (std::size_t c = 0; c < data_.mesh.cell_count(); ++c) {
      const auto points = data_.mesh.points_of_cell(c);
      double sum = 0;
      for (const auto p : points) sum += static_cast<double>(of_points[p]);
      result.push_back(static_cast<float>(sum / static_cast<double>(points.size())));
    }
    return result;
  }

  void take_materials(MaterialArrays& arrays) {
    ChosenMaterials chosen = arrays.take_materials();
    for (std::string& name : chosen.names) data_.materials.push_back(std::move(name));
    step_ = chosen.step;
    if (chosen.labels) {
      if (chosen.centering != Centering::kCells)
        fail("{}: labels '{}': expected labels of cells, found those of points", data_.source,
             options_.labels);
      const auto labels = chosen.labels->index.dense();
      data_.labels.assign(labels.begin(), labels.end());
      return;
    }
    for (GridArray& array : chosen.fractions) {
      const Centering centering = array.centering;
      std::vector<float> values = arrays.take_fractions(array);
      if (centering == Centering::kPoints) values = of_cells(values);
      data_.fractions.push_back(std::move(values));
    }
    if (chosen.rest)
      data_.fractions.push_back(MaterialArrays::rest_of(data_.fractions, data_.mesh.cell_count()));
  }

  /// Makes labels of fractions if no cell has several materials: the interfaces are then faces of cells.
  void take_whole_cells_for_labels() {
    if (data_.fractions.empty()) return;
    std::vector<std::uint16_t> labels(data_.mesh.cell_count(), 0);
    for (MaterialId m(0); m.value < data_.fractions.size(); ++m.value) {
      for (std::size_t c = 0; c < labels.size(); ++c) {
        const float fraction = std::as_const(data_.fractions)[m][c];
        if (fraction > 0 && fraction < 1) return;
        if (fraction >= 1) labels[c] = static_cast<std::uint16_t>(m.value);
      }
    }
    data_.labels = std::move(labels);
    data_.fractions.clear();
  }

  void take_fields(std::vector<GridArray> arrays) {
    for (const Centering centering : {Centering::kCells, Centering::kPoints}) {
      std::vector<FieldArray> own;
      for (GridArray& array : arrays) {
        if (array.centering == centering) own.push_back({array.name, array.components, array.take_field()});
      }
      for (Field& field : assemble_fields(data_.source, data_.materials, std::move(own))) {
        const auto known = std::ranges::find(data_.fields, field.name, &MeshField::name);
        if (known == data_.fields.end()) {
          data_.fields.push_back({std::move(field), centering});
        } else if (options_.note) {
          options_.note(fmt::format("{}: field '{}' is taken from cells, and not from points", data_.source,
                                    field.name));
        }
      }
    }
  }

  /// The name of the array that says which block a cell belongs to.
  static constexpr const char* kBlocks = "block";
  /// Two meshes are the same if their points are this near to each other, in relation to the diagonal.
  static constexpr double kSamePlace = 1e-6;

  const std::filesystem::path& path_;
  MaterialDataOptions options_;
  Progress& progress_;
  MeshFile file_;
  bool by_blocks_ = false;  // whether blocks are the materials
  double step_ = 0;         // see FractionReport
  MeshData data_;
};

}  // namespace

MeshData read_mesh_data(const std::filesystem::path& path, const MaterialDataOptions& options,
                        Progress& progress) {
  return Reader(path, options, progress).run();
}

}  // namespace adamas::io
