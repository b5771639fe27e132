#include "core/io/grid_labels.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <type_traits>

#include "core/base/error.h"
#include "core/io/grid_numbers.h"

namespace adamas::io {

namespace {

constexpr std::size_t kMostLabels = 65535;

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
  std::sort(distinct.begin(), distinct.end());
  distinct.erase(std::unique(distinct.begin(), distinct.end()), distinct.end());
  if (distinct.size() > kMostLabels) {
    fail("{}: labels '{}': expected at most {} materials, found {}", source, array, kMostLabels,
         distinct.size());
  }
  GridLabels result;
  result.index.reserve(values.size());
  for (const Label v : values) {
    const auto at = std::lower_bound(distinct.begin(), distinct.end(), v);
    result.index.push_back(static_cast<std::uint16_t>(at - distinct.begin()));
  }
  for (const Label v : distinct) result.names.push_back(label_name(v, names));
  return result;
}

}  // namespace

GridLabels name_labels(const std::string& source, GridArray array, const std::vector<std::string>& names,
                       const std::function<void(const std::string&)>& note) {
  if (!array.integral()) make_integral(source, array, note);
  GridLabels result;
  const auto set = [&](const auto& values) {
    if constexpr (std::is_integral_v<typename std::decay_t<decltype(values)>::value_type>)
      result = indexed(source, array.name, values, names);
  };
  std::visit(set, array.values);
  return result;
}

}  // namespace adamas::io
