#pragma once

#include <string>
#include <vector>

#include "core/data/multi_material_data.h"
#include "core/io/grid_file.h"

namespace adamas::io {

/// An array of values that becomes a field or a part of one.
struct FieldArray {
  std::string name;
  int components = 1;
  FieldValues values;
};

/// Turns arrays on the same sites into fields by their names (parse_field_name): joins the pieces of a field
/// per material and the three parts of a vector. Throws Error if two fields have one name.
std::vector<Field> assemble_fields(const std::string& source,
                                   const IdVector<MaterialId, std::string>& materials,
                                   std::vector<FieldArray> arrays);

/// Sets the data's fields to those of arrays on `data.grid`'s nodes, as assemble_fields() does; values are
/// moved to the data's centering.
void add_fields(std::vector<GridArray> arrays, MultiMaterialData& data);

/// Divides amounts per cell by the volume of their material in the cell. Throws Error if no field has that
/// name.
void make_intensive(const std::string& field, MultiMaterialData& data);

/// Keeps the sites in the box x0, x1, y0, y1, z0, z1. Throws Error if they are too few to make a grid.
void crop(const std::array<double, 6>& box, MultiMaterialData& data);

}  // namespace adamas::io
