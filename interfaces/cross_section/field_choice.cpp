#include "interfaces/cross_section/field_choice.h"

#include <charconv>
#include <cmath>

#include "core/base/error.h"

namespace adamas::interfaces {

namespace {

std::string known_fields(std::span<const FieldInfo> fields) {
  if (fields.empty()) return "none";
  std::string list;
  for (const FieldInfo& field : fields) {
    list += (list.empty() ? "" : ", ") + field.name;
    if (field.components > 1) list += fmt::format(" ({} components)", field.components);
  }
  return list;
}

}  // namespace

double FieldChoice::scalar(std::span<const double> components) const {
  if (component) return components[*component];
  if (components.size() == 1) return components[0];
  double length = 0;
  for (const double c : components) length = std::hypot(length, c);
  return length;
}

FieldChoice find_field(std::span<const FieldInfo> fields, std::string_view text, std::string_view source) {
  for (std::size_t f = 0; f < fields.size(); ++f) {
    if (fields[f].name == text) return {f, std::nullopt};
  }
  const auto colon = text.rfind(':');
  if (colon != std::string_view::npos) {
    const std::string_view name = text.substr(0, colon), number = text.substr(colon + 1);
    std::size_t component = 0;
    const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), component);
    const bool whole = error == std::errc() && end == number.data() + number.size();
    for (std::size_t f = 0; f < fields.size(); ++f) {
      if (fields[f].name != name) continue;
      if (whole && component < static_cast<std::size_t>(fields[f].components)) return {f, component};
      fail("{}: field '{}': expected a component from 0 to {}, found '{}'", source, name,
           fields[f].components - 1, number);
    }
  }
  fail("{}: expected one of the fields {}, found '{}'", source, known_fields(fields), text);
}

std::string field_label(std::span<const FieldInfo> fields, const FieldChoice& choice) {
  const FieldInfo& field = fields[choice.field];
  std::string label = field.name;
  if (field.components > 1) {
    if (!choice.component) {
      label = "|" + label + "|";
    } else if (field.components == 3) {
      label += std::string(" ") + "xyz"[*choice.component];
    } else {
      label += fmt::format(" {}", *choice.component);
    }
  }
  return field.unit.empty() ? label : fmt::format("{} [{}]", label, field.unit);
}

namespace {

template <class Fields>
std::vector<FieldInfo> infos_of(const Fields& fields) {
  std::vector<FieldInfo> infos;
  std::size_t offset = 0;
  for (const Field& field : fields) {
    infos.push_back({field.name, field.unit, field.components, offset, 0, 0});
    offset += static_cast<std::size_t>(field.components);
  }
  return infos;
}

}  // namespace

std::vector<FieldInfo> field_infos(const MultiMaterialData& data) { return infos_of(data.fields); }

std::vector<FieldInfo> field_infos(const MeshData& data) { return infos_of(data.fields); }

}  // namespace adamas::interfaces
