#include "core/io/material_arrays.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string_view>
#include <type_traits>
#include <utility>

#include "adamas/text.h"
#include "core/base/error.h"
#include "core/base/sort_unique.h"
#include "core/io/array_names.h"
#include "core/io/grid_numbers.h"
#include "core/io/whole_runs.h"

namespace adamas::io {

namespace {

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

/// The names of labels: those that are given, or the entry of a list at a label's value, or else the number.
struct LabelNames {
  const std::vector<std::string>& listed;
  const std::map<std::int64_t, std::string>& given;

  template <class Label>
  [[nodiscard]] std::string operator()(Label label) const {
    if (std::in_range<std::int64_t>(label)) {
      const auto found = given.find(static_cast<std::int64_t>(label));
      if (found != given.end()) return found->second;
    }
    const bool named = std::in_range<std::size_t>(label) && static_cast<std::size_t>(label) < listed.size();
    return named ? listed[static_cast<std::size_t>(label)] : std::to_string(label);
  }
};

template <class Label>
NamedLabels indexed(const std::string& source, const std::string& array, const std::vector<Label>& values,
                    const LabelNames& names) {
  std::vector<Label> distinct = values;
  sort_unique(distinct);
  if (distinct.size() > kMostLabels) {
    fail("{}: labels '{}': expected at most {} materials, found {}", source, array, kMostLabels,
         distinct.size());
  }
  NamedLabels result;
  std::vector<std::uint16_t> index;
  index.reserve(values.size());
  for (const Label v : values) {
    const auto at = std::lower_bound(distinct.begin(), distinct.end(), v);
    index.push_back(static_cast<std::uint16_t>(at - distinct.begin()));
  }
  result.index = std::move(index);
  for (const Label v : distinct) result.names.push_back(names(v));
  return result;
}

/// Makes labels of whole numbers. A scale that does not lead to whole numbers is ignored, and a remark on it
/// is appended to `note` if it is given. Throws Error, with `source`, at numbers that are not whole.
NamedLabels name_labels(const std::string& source, GridArray array, const LabelNames& names,
                        const std::function<void(const std::string&)>& note) {
  NamedLabels result;
  if (array.runs) {
    result.index = std::move(array.runs->index);
    for (const std::int64_t v : array.runs->numbers) result.names.push_back(names(v));
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

/// Returns whether an array is the labels that write_multi_material_data writes.
bool is_written_labels(const GridArray& array, const std::vector<std::string>& material_names) {
  return array.name == kWrittenLabels && array.integral() && array.components == 1 && !material_names.empty();
}

}  // namespace

std::vector<std::string> listed_names(const std::map<std::int64_t, std::string>& names) {
  constexpr std::int64_t kMost = 65535;
  std::vector<std::string> listed;
  for (const auto& [label, name] : names) {
    if (label < 0 || label > kMost) continue;
    while (std::cmp_less(listed.size(), label))
      listed.push_back(listed.empty() ? "background" : std::to_string(listed.size()));
    listed.push_back(name);
  }
  return listed;
}

MaterialArrays::MaterialArrays(const std::filesystem::path& path, const MaterialDataOptions& options,
                               std::vector<GridArray> arrays, std::vector<std::string> material_names,
                               OtherFile other_file)
    : path_(path),
      source_(path.string()),
      options_(options),
      arrays_(std::move(arrays)),
      material_names_(std::move(material_names)),
      other_file_(std::move(other_file)) {
  if (!(fraction_scale() > 0))
    fail("{}: expected a positive scale of volume fractions, found {}", source_, fraction_scale());
}

bool MaterialArrays::name_materials(const MaterialDataOptions& options, const std::vector<GridArray>& arrays,
                                    const std::vector<std::string>& material_names) {
  if (!options.labels.empty() || !options.fractions.empty() || !options.fraction_array.empty()) return true;
  return std::any_of(arrays.begin(), arrays.end(), [&](const GridArray& array) {
    return fraction_material(array.name) || is_written_labels(array, material_names);
  });
}

ChosenMaterials MaterialArrays::take_materials() {
  if (!options_.labels.empty()) {
    set_labels(resolve("labels", options_.labels));
    return std::move(chosen_);
  }
  for (const auto& [name, value] : options_.fractions) {
    GridArray array = resolve("fraction " + name, value);
    require_scalar(array, " (--fractions makes a material of each)");
    const double step = step_of(array);
    add_fraction(name, std::move(array), step);
  }
  if (!options_.fraction_array.empty()) {
    GridArray array = resolve("fractions", options_.fraction_array);
    const std::string name = array.name;
    add_fractions(name, std::move(array));
  }
  for (std::size_t i = 0; !names_fractions() && i < arrays_.size();) {
    const auto name = fraction_material(arrays_[i].name);
    if (name) {
      add_fractions(*name, take(i));
    } else {
      ++i;
    }
  }
  if (chosen_.names.empty()) {
    const auto written = std::ranges::find_if(
        arrays_, [&](const GridArray& a) { return is_written_labels(a, material_names_); });
    if (written == arrays_.end()) fail_without_materials();
    set_labels(take(static_cast<std::size_t>(written - arrays_.begin())));
  } else if (!options_.rest.empty()) {
    add_material(options_.rest);
    chosen_.rest = true;
  }
  chosen_.step = step_.value_or(0);
  return std::move(chosen_);
}

/// Suggests what the user may have meant.
void MaterialArrays::fail_without_materials() const {
  const auto labels = std::ranges::find_if(
      arrays_, [](const GridArray& array) { return array.integral() && array.components == 1; });
  if (labels != arrays_.end() && arrays_.size() > 1)
    fail(
        "{}: expected arrays named \"Volume Fraction for ...\", found {}: pass --labels {} if the values of "
        "that array name materials, or name others by --labels or --fraction NAME=ARRAY",
        source_, names_of(arrays_), as_argument(labels->name));
  for (const GridArray& array : arrays_) {
    if (array.components < 2) continue;
    fail(
        "{}: expected arrays named \"Volume Fraction for ...\", found {}: pass --fractions {} if the {} "
        "components of '{}' are the fractions of materials",
        source_, names_of(arrays_), as_argument(array.name), array.components, array.name);
  }
  const bool one = arrays_.size() == 1;
  const std::string name = arrays_.empty() ? "ARRAY" : as_argument(arrays_[0].name);
  if (one && arrays_[0].integral() && arrays_[0].components == 1) {
    fail(
        "{}: expected volume fractions or labels, found one array of whole numbers, '{}': pass --labels {} "
        "if its "
        "values name materials, or --fraction NAME={} if it is the fraction of a material",
        source_, arrays_[0].name, name, name);
  }
  fail(
      "{}: expected arrays named \"Volume Fraction for ...\", found {}: name others by --fraction NAME={}, "
      "or an "
      "array of labels by --labels",
      source_, names_of(arrays_), name);
}

GridArray MaterialArrays::take(std::size_t i) {
  GridArray array = std::move(arrays_[i]);
  taken_.push_back(array.name);
  arrays_.erase(arrays_.begin() + static_cast<std::ptrdiff_t>(i));
  return array;
}

/// Returns the array that FILE-or-ARRAY names; an array of the main file is removed from it.
GridArray MaterialArrays::resolve(const std::string& option, const std::string& value) {
  for (std::size_t i = 0; i < arrays_.size(); ++i) {
    if (arrays_[i].name == value) return take(i);
  }
  if (std::find(taken_.begin(), taken_.end(), value) != taken_.end()) fail_used_twice(option, value);
  std::error_code code;
  std::filesystem::path file = value;
  if (!std::filesystem::exists(file, code)) file = path_.parent_path() / value;
  if (!std::filesystem::exists(file, code)) {
    fail("{}: {}: expected an array or a file, found neither called '{}' (arrays: {})", source_, option,
         value, names_of(arrays_));
  }
  if (std::filesystem::equivalent(file, path_, code)) {
    if (arrays_.empty()) fail_used_twice(option, value);
    if (arrays_.size() != 1)
      fail("{}: {}: expected a file of one array, found {}", source_, option, names_of(arrays_));
    return take(0);
  }
  return other_file_(option, file);
}

void MaterialArrays::fail_used_twice(const std::string& option, const std::string& value) const {
  fail("{}: {}: expected an array that is not in use, found '{}' used twice", source_, option, value);
}

void MaterialArrays::require_scalar(const GridArray& array, const char* hint) const {
  if (array.components != 1) {
    fail("{}: array '{}': expected one component, found {}{}", source_, array.name, array.components, hint);
  }
}

void MaterialArrays::add_material(const std::string& name) {
  if (name.empty()) fail("{}: expected a material's name, found none", source_);
  if (std::find(chosen_.names.begin(), chosen_.names.end(), name) != chosen_.names.end())
    fail("{}: expected materials of different names, found '{}' twice", source_, name);
  chosen_.names.push_back(name);
}

/// Returns the step between one stored fraction and the next; 0 where they are no whole numbers, or the step
/// is no small part.
double MaterialArrays::step_of(const GridArray& array) const {
  constexpr double kGreatestStep = 0.1;
  const double step = array.has_fractions() ? 0 : std::abs(array.slope) / fraction_scale();
  return step <= kGreatestStep ? step : 0;
}

void MaterialArrays::add_fraction(const std::string& name, GridArray array, double step) {
  add_material(name);
  if (chosen_.fractions.empty()) chosen_.centering = array.centering;
  // If arrays are of several kinds, their steps say nothing.
  step_ = !step_ || *step_ == step ? step : 0;
  chosen_.fractions.push_back(std::move(array));
}

/// Adds a material for each component of an array.
void MaterialArrays::add_fractions(const std::string& name, GridArray array) {
  const auto count = static_cast<std::size_t>(array.components);
  const std::vector<std::string> names = component_materials(name, array);
  const double step = step_of(array);
  const Centering centering = array.centering;
  const std::vector<float> values = array.take_floats();
  for (std::size_t c = 0; c < count; ++c) {
    std::vector<float> of_one;
    of_one.reserve(values.size() / count);
    for (std::size_t at = c; at < values.size(); at += count) of_one.push_back(values[at]);
    add_fraction(names[c], {array.name, array.type, centering, 1, {}, std::move(of_one)}, step);
  }
}

std::vector<std::string> MaterialArrays::component_materials(const std::string& name,
                                                             const GridArray& array) const {
  const auto count = static_cast<std::size_t>(array.components);
  const std::vector<std::string>& given = options_.fraction_names;
  if (!given.empty() && given.size() != count)
    fail("{}: --fractions: expected names of {} materials, found {}", source_, count, given.size());
  if (!given.empty()) return given;
  if (count == 1) return {name};
  if (array.component_names.size() == count) return array.component_names;
  if (material_names_.size() == count) return material_names_;
  std::vector<std::string> names;
  for (std::size_t c = 1; c <= count; ++c) names.push_back(fmt::format("{}_{}", name, c));
  return names;
}

std::vector<float> MaterialArrays::take_fractions(GridArray& array) const {
  std::vector<float> values = array.take_floats();
  if (const double scale = fraction_scale(); scale != 1) {
    for (float& v : values) v = static_cast<float>(static_cast<double>(v) / scale);
  }
  return values;
}

void MaterialArrays::set_labels(GridArray array) {
  if (names_fractions() || !options_.rest.empty())
    fail("{}: expected labels or volume fractions, found both", source_);
  require_scalar(array);
  chosen_.centering = array.centering;
  const std::vector<std::string> own = std::move(array.label_names);
  const LabelNames names{own.empty() ? material_names_ : own, options_.label_names};
  chosen_.labels = name_labels(source_, std::move(array), names, options_.note);
  for (const std::string& name : chosen_.labels->names) add_material(name);
}

std::vector<GridArray> MaterialArrays::take_fields() {
  std::vector<GridArray> result;
  for (const auto& [name, value] : options_.fields) {
    result.push_back(resolve("field " + name, value));
    result.back().name = name;
  }
  std::move(arrays_.begin(), arrays_.end(), std::back_inserter(result));
  arrays_.clear();
  return result;
}

}  // namespace adamas::io
