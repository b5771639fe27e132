#include "core/io/field_assembly.h"

#include <algorithm>
#include <map>
#include <set>

#include "core/base/error.h"
#include "core/io/array_names.h"
#include "core/io/grid_centering.h"

namespace adamas::io {

namespace {

/// An array, with the parts of its name.
struct Part {
  FieldName name;
  int components = 1;
  FieldValues values;
};

[[noreturn]] void fail_twice(const std::string& source, const std::string& name) {
  fail("{}: expected fields of different names, found '{}' twice", source, name);
}

/// The places in the list of the x, y and z parts of one name and material; -1 for a missing part.
using Triple = std::array<int, 3>;
using TripleKey = std::pair<std::string, std::size_t>;

TripleKey key_of(const Part& part) {
  return {plain_name(part.name.name), part.name.material.value_or(static_cast<std::size_t>(-1))};
}

std::map<TripleKey, Triple> find_triples(const std::string& source, const std::vector<Part>& parts) {
  std::map<TripleKey, Triple> triples;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (!parts[i].name.axis) continue;
    Triple& triple = triples.try_emplace(key_of(parts[i]), Triple{-1, -1, -1}).first->second;
    int& slot = triple[static_cast<std::size_t>(*parts[i].name.axis)];
    if (slot >= 0) fail_twice(source, parts[i].name.name_with_axis);
    slot = static_cast<int>(i);
  }
  return triples;
}

Part join(const std::vector<Part>& parts, const Triple& triple, const FieldName& name) {
  const auto part = [&](std::size_t axis) -> const FieldValues& {
    return parts[static_cast<std::size_t>(triple[axis])].values;
  };
  Part vector{name, 3, {}};
  const std::size_t count = 3 * part(0).size();
  if (part(0).are_doubles() || part(1).are_doubles() || part(2).are_doubles()) {
    vector.values = std::vector<double>(count);
  } else {
    vector.values = std::vector<float>(count);
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::size_t site = 0; 3 * site < count; ++site) vector.values.set(3 * site + axis, part(axis)[site]);
  }
  return vector;
}

/// Joins x, y and z parts of one name and material to vectors; an incomplete set of parts keeps its full
/// names.
std::vector<Part> join_axes(const std::string& source, std::vector<Part> parts) {
  const auto triples = find_triples(source, parts);
  std::vector<Part> result;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    Part& part = parts[i];
    if (part.name.axis) {
      const Triple& triple = triples.at(key_of(part));
      const int first = *std::min_element(triple.begin(), triple.end());
      if (first >= 0) {
        if (static_cast<int>(i) == first) result.push_back(join(parts, triple, part.name));
        continue;
      }
      part.name.name = part.name.name_with_axis;
    }
    result.push_back(std::move(part));
  }
  return result;
}

Field& field_for(const Part& part, std::size_t materials, std::vector<Field>& fields) {
  const std::string name = plain_name(part.name.name);
  if (part.name.material) {
    for (Field& field : fields) {
      if (field.per_material() && plain_name(field.name) == name && field.components == part.components &&
          field.material_values[MaterialId(*part.name.material)].empty()) {
        return field;
      }
    }
  }
  Field field;
  field.name = part.name.name;
  field.unit = part.name.unit;
  field.components = part.components;
  if (part.name.material) field.material_values.resize(materials);
  fields.push_back(std::move(field));
  return fields.back();
}

/// Throws Error where two fields have one name: fields are asked for by name, so the second could never be
/// found.
void check_names(const std::string& source, const std::vector<Field>& fields) {
  std::set<std::string> names;
  for (const Field& field : fields) {
    if (!names.insert(field.name).second) fail_twice(source, field.name);
  }
}

template <class T>
std::vector<T> cropped(const std::vector<T>& values, const RectilinearGrid& grid,
                       const std::array<std::size_t, 3>& begin, const std::array<std::size_t, 3>& end) {
  const std::size_t components = values.size() / grid.site_count();
  std::vector<T> result;
  result.reserve((end[0] - begin[0]) * (end[1] - begin[1]) * (end[2] - begin[2]) * components);
  for (std::size_t k = begin[2]; k < end[2]; ++k) {
    for (std::size_t j = begin[1]; j < end[1]; ++j) {
      const auto row =
          values.begin() + static_cast<std::ptrdiff_t>(grid.site_index(begin[0], j, k) * components);
      result.insert(result.end(), row, row + static_cast<std::ptrdiff_t>((end[0] - begin[0]) * components));
    }
  }
  return result;
}

}  // namespace

std::vector<Field> assemble_fields(const std::string& source,
                                   const IdVector<MaterialId, std::string>& materials,
                                   std::vector<FieldArray> arrays) {
  std::vector<Part> parts;
  for (FieldArray& array : arrays) {
    Part part{parse_field_name(array.name, materials), array.components, std::move(array.values)};
    if (array.components != 1 && part.name.axis) {
      part.name.name = part.name.name_with_axis;
      part.name.axis.reset();
    }
    parts.push_back(std::move(part));
  }
  std::vector<Field> fields;
  for (Part& part : join_axes(source, std::move(parts))) {
    Field& field = field_for(part, materials.size(), fields);
    if (part.name.material) {
      field.material_values[MaterialId(*part.name.material)] = std::move(part.values);
    } else {
      field.values = std::move(part.values);
    }
  }
  check_names(source, fields);
  return fields;
}

void add_fields(std::vector<GridArray> arrays, MultiMaterialData& data) {
  std::vector<FieldArray> moved;
  for (GridArray& array : arrays) {
    const RectilinearGrid from{data.grid.nodes, array.centering};
    const Centering to = data.grid.centering;
    FieldArray& result = moved.emplace_back(FieldArray{array.name, array.components, array.take_field()});
    if (to == from.centering) continue;
    result.values.visit([&](auto& values) {
      values = average_to(to, from, static_cast<std::size_t>(array.components), values.own());
    });
  }
  data.fields = assemble_fields(data.source, data.materials, std::move(moved));
}

void make_intensive(const std::string& name, MultiMaterialData& data) {
  bool found = false;
  for (Field& field : data.fields) {
    if (plain_name(field.name) != plain_name(name)) continue;
    found = true;
    const auto divide = [&](auto& values, const auto& fraction) {
      if (values.empty()) return;
      const auto components = static_cast<std::size_t>(field.components);
      const RectilinearGrid& grid = data.grid;
      for (std::size_t k = 0; k < grid.sites(2); ++k) {
        for (std::size_t j = 0; j < grid.sites(1); ++j) {
          for (std::size_t i = 0; i < grid.sites(0); ++i) {
            const std::size_t site = grid.site_index(i, j, k);
            const double volume = grid.site_volume(i, j, k) * fraction(site);
            for (std::size_t c = 0; c < components; ++c) {
              auto& value = values[site * components + c];
              value = volume > 0
                          ? static_cast<std::decay_t<decltype(value)>>(static_cast<double>(value) / volume)
                          : 0;
            }
          }
        }
      }
    };
    const auto divide_all = [&](FieldValues& values, const auto& fraction) {
      values.visit([&](auto& array) { divide(array.own(), fraction); });
    };
    divide_all(field.values, [](std::size_t) { return 1.0; });
    for (MaterialId m(0); m.value < field.material_values.size(); ++m.value) {
      divide_all(field.material_values[m],
                 [&data, m](std::size_t site) { return static_cast<double>(data.fraction(m, site)); });
    }
  }
  if (!found)
    fail("{}: expected a field '{}' to divide by volume, found none of that name", data.source, name);
}

void crop(const std::array<double, 6>& box, MultiMaterialData& data) {
  const RectilinearGrid& grid = data.grid;
  std::array<std::size_t, 3> begin{}, end{};
  RectilinearGrid result;
  result.centering = grid.centering;
  const std::size_t least = grid.centering == Centering::kCells ? 1 : 2;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const int a = static_cast<int>(axis);
    const double low = box[2 * axis], high = box[2 * axis + 1];
    while (begin[axis] < grid.sites(a) && !(grid.site_coordinate(a, begin[axis]) >= low)) ++begin[axis];
    end[axis] = begin[axis];
    while (end[axis] < grid.sites(a) && grid.site_coordinate(a, end[axis]) <= high) ++end[axis];
    if (end[axis] - begin[axis] < least) {
      fail("{}: region: expected at least {} site(s) in [{}, {}] along {}, found {}", data.source, least, low,
           high, "xyz"[axis], end[axis] - begin[axis]);
    }
    const std::size_t last = grid.centering == Centering::kCells ? end[axis] + 1 : end[axis];
    const auto nodes = grid.nodes[axis].begin();
    result.nodes[axis].assign(nodes + static_cast<std::ptrdiff_t>(begin[axis]),
                              nodes + static_cast<std::ptrdiff_t>(last));
  }
  const auto cut = [&](auto& values) {
    if (!values.empty()) values = cropped(values.own(), grid, begin, end);
  };
  if (!data.labels.empty()) {
    std::vector<std::size_t> rows;
    for (std::size_t k = begin[2]; k < end[2]; ++k) {
      for (std::size_t j = begin[1]; j < end[1]; ++j) rows.push_back(j + grid.sites(1) * k);
    }
    data.labels = data.labels.part(grid.sites(0), begin[0], end[0], rows);
  }
  for (auto& values : data.fractions) cut(values);
  for (Field& field : data.fields) {
    field.values.visit(cut);
    for (FieldValues& values : field.material_values) values.visit(cut);
  }
  data.grid = std::move(result);
}

}  // namespace adamas::io
