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
#include "core/io/whole_runs.h"

namespace adamas::io {

namespace {

/// Labels as indices of names, in the order of the labels.
struct GridLabels {
  LabelArray index;
  std::vector<std::string> names;
};

/// The name of the array of labels that write_multi_material_data writes.
constexpr const char* kWrittenLabels = "labels";

/// Values of an array of floats, or of numbers with a scale, as whole numbers.
struct WholeValues {
  std::vector<std::int64_t> values;
  std::optional<double> other;  ///< the first that is not whole
};

WholeValues whole_values(const GridArray& array) {
  WholeValues result;
  result.values.reserve(array.size());
  const auto take = [&](const auto& numbers) {
    for (const auto number : numbers) {
      // Whole numbers of 64 bits are exact here.
      const long double value = static_cast<long double>(array.slope) * static_cast<long double>(number) +
                                static_cast<long double>(array.intercept);
      // Scales have no more digits than float, which represents halves below this number.
      constexpr long double kHalves = 1 << 22;
      const bool rounded = array.scaled() && std::abs(value) < kHalves;
      if (!(rounded ? is_whole<std::int64_t>(static_cast<float>(value)) : is_whole<std::int64_t>(value))) {
        result.other = static_cast<double>(value);
        return;
      }
      result.values.push_back(static_cast<std::int64_t>(std::nearbyint(value)));
    }
  };
  std::visit(take, array.values);
  return result;
}

void make_integral(const std::string& source, GridArray& array,
                   const std::function<void(const std::string&)>& note) {
  WholeValues whole = whole_values(array);
  if (!whole.other) {
    array.values = std::move(whole.values);
  } else if (array.has_fractions()) {
    fail("{}: labels '{}': expected whole numbers, found {} at index {}", source, array.name, *whole.other,
         whole.values.size());
  } else if (note) {
    note(fmt::format(
        "{}: labels '{}' are taken as they are stored, without the scale of the file (times {:.9g} "
        "plus {:.9g}), which makes no whole numbers of 64 bits of them",
        source, array.name, array.slope, array.intercept));
  }
  array.slope = 1;
  array.intercept = 0;
}

template <class Label>
std::string label_name(Label label, const std::vector<std::string>& names) {
  const bool named = std::in_range<std::size_t>(label) && static_cast<std::size_t>(label) < names.size();
  return named ? names[static_cast<std::size_t>(label)] : std::to_string(label);
}

template <class Label>
GridLabels indexed(const std::string& source, const std::string& array, const std::vector<Label>& values,
                   const std::vector<std::string>& names) {
  std::vector<Label> distinct = values;
  sort_unique(distinct);
  if (distinct.size() > kMostLabels) {
    fail("{}: labels '{}': expected at most {} materials, found {}", source, array, kMostLabels,
         distinct.size());
  }
  GridLabels result;
  std::vector<std::uint16_t> index;
  index.reserve(values.size());
  for (const Label v : values) {
    const auto at = std::lower_bound(distinct.begin(), distinct.end(), v);
    index.push_back(static_cast<std::uint16_t>(at - distinct.begin()));
  }
  result.index = std::move(index);
  for (const Label v : distinct) result.names.push_back(label_name(v, names));
  return result;
}

/// Makes labels of whole numbers. The name of a label is the entry of `names` at its value, else the value
/// itself. A scale that does not lead to whole numbers is ignored, and a remark on it is appended to `note`
/// if it is given. Throws Error, with `source`, at numbers that are not whole.
GridLabels name_labels(const std::string& source, GridArray array, const std::vector<std::string>& names,
                       const std::function<void(const std::string&)>& note) {
  GridLabels result;
  if (array.runs) {
    result.index = std::move(array.runs->index);
    for (const std::int64_t v : array.runs->numbers) result.names.push_back(label_name(v, names));
    return result;
  }
  if (!array.integral()) make_integral(source, array, note);
  const auto set = [&](const auto& values) {
    if constexpr (std::is_integral_v<typename std::decay_t<decltype(values)>::value_type>)
      result = indexed(source, array.name, values, names);
  };
  std::visit(set, array.values);
  return result;
}

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

/// Quotes a name as one word of a command line.
std::string as_argument(const std::string& name) {
  const bool plain = std::all_of(name.begin(), name.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 ||
           std::string_view("_-./:,+").find(static_cast<char>(c)) != std::string_view::npos;
  });
  return plain ? name : "'" + name + "'";
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
    plain_ = options_.plain && !has_materials();
    const GridCentering centering = choose_centering(data_.source, options_.centering,
                                                     plain_ ? Centering::kPoints : Centering::kCells, main_);
    if (!(fraction_scale() > 0))
      fail("{}: expected a positive scale of volume fractions, found {}", data_.source, fraction_scale());
    read_materials();
    if (options_.note && !main_.remark.empty()) options_.note(data_.source + ": " + main_.remark);
    if (!plain_) note_centering(centering);
    read_fields();
    if (raw_ && !raw_used_)
      fail("{}: --dimensions: expected a raw file, found none whose name ends as no format's", data_.source);
    progress_.step("check materials", 0.9);
    if (options_.region) crop(*options_.region, data_);
    data_.normalise();
    data_.report.step = step_.value_or(0);
    for (const std::string& field : options_.extensive) make_intensive(field, data_);
    data_.check();
    progress_.step("check materials", 1);
    return std::move(data_);
  }

 private:
  GridFile read_file(const std::filesystem::path& path) {
    raw_used_ = raw_used_ || find_format_by_name(path) == nullptr;
    const bool asked = !options_.labels.empty();
    return read_grid_file(path, {.raw = raw_ ? &*raw_ : nullptr,
                                 .labels = asked ? options_.labels : kWrittenLabels,
                                 .only_array = asked});
  }

  [[nodiscard]] bool names_fractions() const {
    return !options_.fractions.empty() || !options_.fraction_array.empty();
  }

  [[nodiscard]] bool has_materials() const {
    if (!options_.labels.empty() || names_fractions()) return true;
    return std::any_of(main_.arrays.begin(), main_.arrays.end(), [this](const GridArray& array) {
      return fraction_material(array.name) || is_written_labels(array);
    });
  }

  /// Whether an array is the labels that write_multi_material_data writes.
  [[nodiscard]] bool is_written_labels(const GridArray& array) const {
    return array.name == kWrittenLabels && array.integral() && array.components == 1 &&
           !main_.material_names.empty();
  }

  void read_plain() {
    if (!main_.arrays.empty()) data_.grid.centering = main_.arrays.front().centering;
    add_material(kPlainMaterial);
    const RectilinearGrid& grid = data_.grid;
    data_.labels = LabelArray::constant(grid.sites(0), grid.sites(1) * grid.sites(2), 0);
  }

  void read_materials() {
    data_.grid.nodes = main_.nodes;
    if (plain_) return read_plain();
    if (!options_.labels.empty()) return read_labels(resolve("labels", options_.labels));
    for (const auto& [name, value] : options_.fractions)
      add_fraction(name, resolve("fraction " + name, value));
    if (!options_.fraction_array.empty()) {
      GridArray array = resolve("fractions", options_.fraction_array);
      const std::string name = array.name;
      add_fractions(name, std::move(array));
    }
    for (std::size_t i = 0; !names_fractions() && i < main_.arrays.size();) {
      const auto name = fraction_material(main_.arrays[i].name);
      if (name) {
        add_fractions(*name, take(i));
      } else {
        ++i;
      }
    }
    if (data_.materials.empty()) return read_labels_unasked();
    if (!options_.rest.empty()) add_rest();
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

  /// Reads labels without being asked: those that write_multi_material_data has written; otherwise suggests
  /// what the user may have meant.
  void read_labels_unasked() {
    for (std::size_t i = 0; i < main_.arrays.size(); ++i) {
      const GridArray& array = main_.arrays[i];
      if (is_written_labels(array)) return read_labels(take(i));
    }
    for (const GridArray& array : main_.arrays) {
      if (array.components < 2) continue;
      fail(
          "{}: expected arrays named \"Volume Fraction for ...\", found {}: pass --fractions {} if the {} "
          "components of '{}' are the fractions of materials",
          data_.source, main_.array_names(), as_argument(array.name), array.components, array.name);
    }
    const bool one = main_.arrays.size() == 1;
    const std::string name = main_.arrays.empty() ? "ARRAY" : as_argument(main_.arrays[0].name);
    if (one && main_.arrays[0].integral() && main_.arrays[0].components == 1) {
      fail(
          "{}: expected volume fractions or labels, found one array of whole numbers, '{}': pass --labels {} "
          "if its "
          "values name materials, or --fraction NAME={} if it is the fraction of a material",
          data_.source, main_.arrays[0].name, name, name);
    }
    fail(
        "{}: expected arrays named \"Volume Fraction for ...\", found {}: name others by --fraction NAME={}, "
        "or an "
        "array of labels by --labels",
        data_.source, main_.array_names(), name);
  }

  GridArray take(std::size_t i) {
    GridArray array = std::move(main_.arrays[i]);
    taken_.push_back(array.name);
    main_.arrays.erase(main_.arrays.begin() + static_cast<std::ptrdiff_t>(i));
    return array;
  }

  /// Returns the array that FILE-or-ARRAY names; an array of the main file is removed from it.
  GridArray resolve(const std::string& option, const std::string& value) {
    for (std::size_t i = 0; i < main_.arrays.size(); ++i) {
      if (main_.arrays[i].name == value) return take(i);
    }
    if (std::find(taken_.begin(), taken_.end(), value) != taken_.end()) fail_used_twice(option, value);
    std::error_code code;
    std::filesystem::path file = value;
    if (!std::filesystem::exists(file, code)) file = path_.parent_path() / value;
    if (!std::filesystem::exists(file, code)) {
      fail("{}: {}: expected an array or a file, found neither called '{}' (arrays: {})", data_.source,
           option, value, main_.array_names());
    }
    if (std::filesystem::equivalent(file, path_, code)) {
      if (main_.arrays.empty()) fail_used_twice(option, value);
      if (main_.arrays.size() != 1) {
        fail("{}: {}: expected a file of one array, found {}", data_.source, option, main_.array_names());
      }
      return take(0);
    }
    progress_.step("read " + file.filename().string(), 0.5);
    GridFile other = read_file(file);
    require_laid_out(file.string(), other);
    choose_centering(file.string(), options_.centering,
                     fits_cells(other, main_) ? Centering::kCells : Centering::kPoints, other);
    check_same_grid(file.string(), other, data_.source, main_);
    if (other.arrays.size() != 1) {
      fail("{}: {}: expected a file of one array, found {}", file.string(), option, other.array_names());
    }
    return std::move(other.arrays[0]);
  }

  [[noreturn]] void fail_used_twice(const std::string& option, const std::string& value) const {
    fail("{}: {}: expected an array that is not in use, found '{}' used twice", data_.source, option, value);
  }

  void require_scalar(const GridArray& array, const char* hint = "") const {
    if (array.components != 1) {
      fail("{}: array '{}': expected one component, found {}{}", data_.source, array.name, array.components,
           hint);
    }
  }

  void add_material(const std::string& name) {
    if (name.empty()) fail("{}: expected a material's name, found none", data_.source);
    if (std::find(data_.materials.begin(), data_.materials.end(), name) != data_.materials.end()) {
      fail("{}: expected materials of different names, found '{}' twice", data_.source, name);
    }
    data_.materials.push_back(name);
  }

  /// What a volume fraction of 1 is stored as.
  [[nodiscard]] double fraction_scale() const { return options_.fraction_scale.value_or(1); }

  /// The step between one stored fraction and the next; 0 where they are no whole numbers, or the step is no
  /// small part.
  [[nodiscard]] double step_of(const GridArray& array) const {
    constexpr double kGreatestStep = 0.1;
    const double step = array.has_fractions() ? 0 : std::abs(array.slope) / fraction_scale();
    return step <= kGreatestStep ? step : 0;
  }

  void add_fraction(const std::string& name, GridArray array) {
    require_scalar(array, " (--fractions makes a material of each)");
    const double step = step_of(array);
    add_fraction(name, std::move(array), step);
  }

  void add_fraction(const std::string& name, GridArray array, double step) {
    add_material(name);
    if (data_.materials.size() == 1) data_.grid.centering = array.centering;
    const RectilinearGrid from{main_.nodes, array.centering};
    // If arrays are of several kinds, their steps say nothing.
    step_ = !step_ || *step_ == step ? step : 0;
    std::vector<float> values = array.take_floats();
    if (from.centering != data_.grid.centering) values = average_to(data_.grid.centering, from, 1, values);
    if (const double scale = fraction_scale(); scale != 1) {
      for (float& v : values) v = static_cast<float>(static_cast<double>(v) / scale);
    }
    data_.fractions.push_back(std::move(values));
  }

  /// Adds a material for each component of an array.
  void add_fractions(const std::string& name, GridArray array) {
    const auto count = static_cast<std::size_t>(array.components);
    const std::vector<std::string> names = component_materials(name, array);
    const Centering centering = array.centering;
    const double step = step_of(array);
    const std::vector<float> values = array.take_floats();
    for (std::size_t c = 0; c < count; ++c) {
      std::vector<float> of_one;
      of_one.reserve(values.size() / count);
      for (std::size_t at = c; at < values.size(); at += count) of_one.push_back(values[at]);
      add_fraction(names[c], {array.name, array.type, centering, 1, {}, std::move(of_one)}, step);
    }
  }

  [[nodiscard]] std::vector<std::string> component_materials(const std::string& name,
                                                             const GridArray& array) const {
    const auto count = static_cast<std::size_t>(array.components);
    const std::vector<std::string>& given = options_.fraction_names;
    if (!given.empty() && given.size() != count)
      fail("{}: --fractions: expected names of {} materials, found {}", data_.source, count, given.size());
    if (!given.empty()) return given;
    if (count == 1) return {name};
    if (array.component_names.size() == count) return array.component_names;
    if (main_.material_names.size() == count) return main_.material_names;
    std::vector<std::string> names;
    for (std::size_t c = 1; c <= count; ++c) names.push_back(fmt::format("{}_{}", name, c));
    return names;
  }

  void add_rest() {
    std::vector<float> rest(data_.grid.site_count());
    for (std::size_t site = 0; site < rest.size(); ++site) {
      double left = 1;
      for (const auto& fraction : data_.fractions) left -= static_cast<double>(fraction[site]);
      rest[site] = left < 0 ? 0.0f : static_cast<float>(left);
    }
    add_material(options_.rest);
    data_.fractions.push_back(std::move(rest));
  }

  void read_labels(GridArray array) {
    if (names_fractions() || !options_.rest.empty()) {
      fail("{}: expected labels or volume fractions, found both", data_.source);
    }
    require_scalar(array);
    data_.grid.centering = array.centering;
    GridLabels labels = name_labels(data_.source, std::move(array), main_.material_names, options_.note);
    data_.labels =
        labels.index.is_dense() ? labels.index.as_runs(data_.grid.sites(0)) : std::move(labels.index);
    for (const std::string& name : labels.names) add_material(name);
  }

  void read_fields() {
    std::vector<GridArray> arrays;
    for (const auto& [name, value] : options_.fields) {
      arrays.push_back(resolve("field " + name, value));
      arrays.back().name = name;
    }
    std::move(main_.arrays.begin(), main_.arrays.end(), std::back_inserter(arrays));
    add_fields(std::move(arrays), data_);
  }

  const std::filesystem::path& path_;
  const MaterialDataOptions& options_;
  Progress& progress_;
  const std::optional<RawVolume>& raw_;
  bool raw_used_ = false;
  GridFile main_;
  std::vector<std::string> taken_;  // arrays of the main file that are used
  bool plain_ = false;
  std::optional<double> step_;  // see FractionReport
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
