#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace adamas::io {

/// A name for comparison: in lower case, with '_' as ' ' and runs of spaces as one.
std::string plain_name(std::string_view name);

/// The name of the material whose fractions an array has, by the array's name ("Volume Fraction for Armor
/// Plate", "Void Volume Fraction", "volume_fraction_steel"); empty for other arrays.
std::optional<std::string> fraction_material(const std::string& array);

/// The parts of an array's name: "Mass for Steel [g]" is the field "Mass", of material index 0, in "g".
struct FieldName {
  std::string name;
  std::string unit;                     ///< empty where none is stated
  std::optional<std::size_t> material;  ///< index into the materials given; empty for a mixed field
  std::optional<int> axis;     ///< the axis in "X Velocity" or "velocity_x", which `name` does not contain
  std::string name_with_axis;  ///< the name before an axis was taken off
};
FieldName parse_field_name(const std::string& array, const std::vector<std::string>& materials);

/// The end of a message about a file that has no array on points from which a volume could be made; it names
/// the first of its arrays on cells.
std::string no_points_text(const std::vector<std::string>& on_cells);

}  // namespace adamas::io
