#include "core/io/multi_material_reader.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "core/base/error.h"
#include "core/base/sort_unique.h"
#include "core/io/array_names.h"
#include "core/io/field_assembly.h"
#include "core/io/grid_axes.h"
#include "core/io/grid_centering.h"
#include "core/io/grid_file.h"
#include "core/io/grid_numbers.h"
#include "core/io/input_formats.h"
#include "core/io/material_arrays.h"
#include "core/io/whole_runs.h"

namespace adamas::io {

namespace {

/// Whether the samples of a file lie on as many cells as the main file has.
bool fits_cells(const GridFile& file, const GridFile& main) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (file.faces[axis].size() != main.nodes[axis].size()) return false;
  }
  return true;
}

/// Throws if two grids differ by more than a millionth of their size.
void check_same_grid(const std::string& name, const GridFile& file, const std::string& main_name,
                     const GridFile& main) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto &a = file.nodes[axis], &b = main.nodes[axis];
    if (a.size() != b.size()) {
      fail("{}: expected the grid of {} with {} nodes along {}, found {}", name, main_name, b.size(),
           "xyz"[axis], a.size());
    }
    const double tolerance = b.empty() ? 0 : 1e-6 * std::max(std::abs(b.back() - b.front()), 1e-300);
    for (std::size_t i = 0; i < a.size(); ++i) {
      if (!(std::abs(a[i] - b[i]) <= tolerance)) {
        fail("{}: expected the grid of {}, {} = {} at node {}, found {}", name, main_name, "xyz"[axis], b[i],
             i, a[i]);
      }
    }
  }
}

class Reader {
 public:
  Reader(const std::filesystem::path& path, const MaterialDataOptions& options, Progress& progress,
         const std::optional<RawVolume>& raw)
      : path_(path), options_(options), progress_(progress), raw_(raw) {}

  MultiMaterialData run() {
    progress_.step("read " + path_.filename().string(), 0);
    main_ = read_file(path_);
    data_.source = path_.string();
    require_laid_out(data_.source, main_);
    plain_ = options_.plain && !MaterialArrays::name_materials(options_, main_.arrays, main_.material_names);
    const GridCentering centering = choose_centering(data_.source, options_.centering,
                                                     plain_ ? Centering::kPoints : Centering::kCells, main_);
    data_.grid.nodes = main_.nodes;
    if (!main_.arrays.empty()) data_.grid.centering = main_.arrays.front().centering;
    MaterialArrays arrays(path_, options_, std::move(main_.arrays), main_.material_names,
                          [this](const std::string& option, const std::filesystem::path& file) {
                            return read_other(option, file);
                          });
    plain_ ? make_plain() : take_materials(arrays);
    if (options_.note && !main_.remark.empty()) options_.note(data_.source + ": " + main_.remark);
    if (!plain_) note_centering(centering);
    add_fields(arrays.take_fields(), data_);
    if (raw_ && !raw_used_)
      fail("{}: --dimensions: expected a raw file, found none whose name ends as no format's", data_.source);
    progress_.step("check materials", 0.9);
    if (options_.region) crop(*options_.region, data_);
    data_.normalise();
    data_.report.step = step_;
    for (const std::string& field : options_.extensive) make_intensive(field, data_);
    data_.check();
    progress_.step("check materials", 1);
    return std::move(data_);
  }

 private:
  GridFile read_file(const std::filesystem::path& path) {
    raw_used_ = raw_used_ || find_format_by_name(path) == nullptr;
    const bool asked = !options_.labels.empty();
    std::vector<std::string> wanted{options_.labels, options_.fraction_array};
    for (const auto& fraction : options_.fractions) wanted.push_back(fraction.second);
    for (const auto& field : options_.fields) wanted.push_back(field.second);
    std::erase(wanted, "");
    return read_grid_file(path, {.raw = raw_ ? &*raw_ : nullptr,
                                 .labels = asked ? options_.labels : kWrittenLabels,
                                 .only_array = asked,
                                 .wanted = wanted,
                                 .stack_spacing = options_.stack_spacing.value_or(Vec3{1, 1, 1}),
                                 .stack_origin = options_.stack_origin.value_or(Vec3{})});
  }

  /// Reads the one array of another file.
  GridArray read_other(const std::string& option, const std::filesystem::path& file) {
    progress_.step("read " + file.filename().string(), 0.5);
    GridFile other = read_file(file);
    require_laid_out(file.string(), other);
    choose_centering(file.string(), options_.centering,
                     fits_cells(other, main_) ? Centering::kCells : Centering::kPoints, other);
    check_same_grid(file.string(), other, data_.source, main_);
    if (other.arrays.size() != 1)
      fail("{}: {}: expected a file of one array, found {}", file.string(), option, other.array_names());
    return std::move(other.arrays[0]);
  }

  void make_plain() {
    data_.materials.push_back(kPlainMaterial);
    const RectilinearGrid& grid = data_.grid;
    data_.labels = LabelArray::constant(grid.sites(0), grid.sites(1) * grid.sites(2), 0);
  }

  void take_materials(MaterialArrays& arrays) {
    ChosenMaterials chosen = arrays.take_materials();
    for (std::string& name : chosen.names) data_.materials.push_back(std::move(name));
    data_.grid.centering = chosen.centering;
    step_ = chosen.step;
    if (chosen.labels) {
      LabelArray& index = chosen.labels->index;
      data_.labels = index.is_dense() ? index.as_runs(data_.grid.sites(0)) : std::move(index);
      return;
    }
    for (GridArray& array : chosen.fractions) {
      const RectilinearGrid from{main_.nodes, array.centering};
      std::vector<float> values = arrays.take_fractions(array);
      if (from.centering != chosen.centering) values = average_to(chosen.centering, from, 1, values);
      data_.fractions.push_back(std::move(values));
    }
    if (chosen.rest)
      data_.fractions.push_back(MaterialArrays::rest_of(data_.fractions, data_.grid.site_count()));
  }

  void note_centering(const GridCentering& centering) const {
    if (!options_.note) return;
    if (centering.assumed)
      options_.note(data_.source +
                    ": nothing says whether its values are of cells or points: taken for those of cells "
                    "(--cells or --points chooses)");
    if (centering.mixed)
      options_.note(
          data_.source +
          ": cells along some axes, nodes along others: along these the samples are taken for those "
          "of cells up to halfway to the next (--cells or --points chooses)");
  }

  const std::filesystem::path& path_;
  const MaterialDataOptions& options_;
  Progress& progress_;
  const std::optional<RawVolume>& raw_;
  bool raw_used_ = false;
  GridFile main_;  // its arrays are given to MaterialArrays
  bool plain_ = false;
  double step_ = 0;  // see FractionReport
  MultiMaterialData data_;
};

}  // namespace

bool is_plain(const MultiMaterialData& data) {
  return !data.labels.empty() && data.materials.size() == 1 &&
         data.materials[MaterialId(0)] == kPlainMaterial;
}

MultiMaterialData read_multi_material_data(const std::filesystem::path& path,
                                           const MaterialDataOptions& options, Progress& progress,
                                           const std::optional<RawVolume>& raw) {
  return Reader(path, options, progress, raw).run();
}

}  // namespace adamas::io
