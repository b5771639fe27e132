#include "core/data/grid_data.h"

#include <cmath>
#include <limits>
#include <type_traits>
#include <utility>

#include "core/base/error.h"

namespace adamas::inline core {

namespace {

/// The span's numbers as type T: borrowed if they have that type, else converted.
template <class T>
SiteArray<T> site_array(const NumberSpan& numbers) {
  return std::visit(
      [](const auto& span) {
        if constexpr (std::is_same_v<std::decay_t<decltype(span)>, std::span<const T>>) {
          return SiteArray<T>::borrowed(span);
        } else {
          std::vector<T> converted(span.size());
          for (std::size_t i = 0; i < span.size(); ++i) converted[i] = static_cast<T>(span[i]);
          return SiteArray<T>(std::move(converted));
        }
      },
      numbers);
}

/// The values of a field: doubles where floats may not represent all numbers of the type.
FieldValues field_values(const NumberSpan& numbers) {
  return std::visit(
      [&numbers]<class Number>(std::span<const Number>) -> FieldValues {
        constexpr int kFloatDigits = std::numeric_limits<float>::digits;
        if (std::numeric_limits<Number>::digits > kFloatDigits) return site_array<double>(numbers);
        return site_array<float>(numbers);
      },
      numbers);
}

/// Throws Error at numbers that are no label.
void check_labels(const GridData& data) {
  std::visit(
      [&data](const auto& span) {
        using Number = typename std::decay_t<decltype(span)>::value_type;
        if (span.empty()) return;
        if constexpr (std::is_floating_point_v<Number>) {
          fail("{}: labels: expected an array of whole numbers, found one of floating-point numbers",
               data.name);
        } else {
          constexpr auto kMost = std::numeric_limits<std::uint16_t>::max();
          for (std::size_t i = 0; i < span.size(); ++i) {
            if (!std::in_range<std::uint16_t>(span[i]))
              fail("{}: labels: expected numbers from 0 to {}, found {} at index {}", data.name, kMost,
                   span[i], i);
          }
        }
      },
      data.labels);
}

Field to_field(const GridField& field, const std::string& source) {
  if (field.components < 1)
    fail("{}: field '{}': expected at least one component, found {}", source, field.name, field.components);
  Field result{field.name, field.unit, field.components, field_values(field.values), {}};
  for (const NumberSpan& values : field.material_values)
    result.material_values.push_back(field_values(values));
  return result;
}

/// Throws Error unless a field has exactly one kind of values.
void check_kind(const GridField& given, const Field& field, const MultiMaterialData& data) {
  const bool mixed = !field.values.empty(), own = !given.material_values.empty();
  if (mixed && own)
    fail("{}: field '{}': expected values or values per material, found both", data.source, field.name);
  if (!mixed && !own) fail("{}: field '{}': expected values, found none", data.source, field.name);
  if (own && field.material_values.size() != data.materials.size()) {
    fail("{}: field '{}': expected values of {} materials, found {}", data.source, field.name,
         data.materials.size(), field.material_values.size());
  }
}

}  // namespace

MultiMaterialData to_multi_material_data(const GridData& data) {
  MultiMaterialData result;
  result.source = data.name;
  result.grid = data.grid;
  result.materials.assign(data.materials.begin(), data.materials.end());
  for (const NumberSpan& fractions : data.fractions) result.fractions.push_back(site_array<float>(fractions));
  check_labels(data);
  result.labels = site_array<std::uint16_t>(data.labels);
  for (const GridField& field : data.fields) {
    result.fields.push_back(to_field(field, data.name));
    check_kind(field, result.fields.back(), result);
  }
  result.check();
  result.normalise();
  return result;
}

GridData view(const MultiMaterialData& data) {
  const auto span = [](const auto& array) { return NumberSpan(std::span(array.data(), array.size())); };
  GridData result;
  result.name = data.source;
  result.grid = data.grid;
  result.materials.assign(data.materials.begin(), data.materials.end());
  for (const auto& fractions : data.fractions) result.fractions.push_back(span(fractions));
  // Those of OwnedGridData are dense.
  if (!data.labels.empty()) result.labels = span(data.labels.dense());
  for (const Field& field : data.fields) {
    GridField& shown = result.fields.emplace_back(GridField{field.name, field.unit, field.components});
    if (!field.per_material()) shown.values = field.values.visit(span);
    for (const auto& values : field.material_values) shown.material_values.push_back(values.visit(span));
  }
  return result;
}

}  // namespace adamas::inline core

namespace adamas {

void check(const GridData& data) { static_cast<void>(to_multi_material_data(data)); }

std::vector<double> material_volumes(const GridData& data) { return to_multi_material_data(data).volumes(); }

OwnedGridData::OwnedGridData(std::unique_ptr<MultiMaterialData> data) : data_(std::move(data)) {
  // A view has an array with the label of each site.
  if (!data_->labels.is_dense()) data_->labels.own();
}
OwnedGridData::OwnedGridData(OwnedGridData&&) noexcept = default;
OwnedGridData& OwnedGridData::operator=(OwnedGridData&&) noexcept = default;
OwnedGridData::~OwnedGridData() = default;

std::unique_ptr<MultiMaterialData> OwnedGridData::release() && { return std::move(data_); }

GridData OwnedGridData::view() const { return core::view(*data_); }

}  // namespace adamas
