#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/data/mesh_data.h"
#include "core/data/multi_material_data.h"
#include "interfaces/fields/field_source.h"

namespace adamas::interfaces {

/// The choice of one number per point from a field: a component, or the length of a vector.
struct FieldChoice {
  std::size_t field = 0;
  std::optional<std::size_t> component;  ///< if not set, the value of a scalar or the length of a vector

  /// Returns the number, given all components of the field.
  [[nodiscard]] double scalar(std::span<const double> components) const;
};

/// Finds "NAME", or "NAME:C" for component C from 0 on, among the fields. Throws Error that names `source`
/// and the known fields if there is none.
FieldChoice find_field(std::span<const FieldInfo> fields, std::string_view text, std::string_view source);

/// Returns the chosen number's name and unit, as "velocity y [m/s]"; `|velocity|` for a length.
std::string field_label(std::span<const FieldInfo> fields, const FieldChoice& choice);

/// Returns the names, units and offsets of the fields of data on a grid, without ranges.
std::vector<FieldInfo> field_infos(const MultiMaterialData& data);
/// The same of data on a mesh of cells.
std::vector<FieldInfo> field_infos(const MeshData& data);

}  // namespace adamas::interfaces
