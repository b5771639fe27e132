#include "core/io/grid_file.h"

#include <algorithm>
#include <cmath>

#include "adamas/text.h"
#include "core/base/error.h"
#include "core/io/grid_numbers.h"
#include "core/io/input_file.h"
#include "core/io/input_formats.h"
#include "core/io/reader_program.h"
#include "core/io/sent_grids.h"
#include "core/io/volume_import.h"
#include "core/io/volume_stack.h"

namespace adamas::io {

namespace {

/// Throws unless the sizes that the reader has set fit each other, before its arrays are indexed.
void check_sizes(const std::string& name, const GridFile& file) {
  for (const GridArray& array : file.arrays) {
    std::size_t expected = static_cast<std::size_t>(std::max(array.components, 0));
    for (const auto& nodes : file.nodes) {
      expected *= array.centering == Centering::kPoints
                      ? nodes.size()
                      : nodes.size() - std::min<std::size_t>(1, nodes.size());
    }
    if (array.components < 1 || array.size() != expected) {
      fail("{}: array '{}': expected {} values, found {}", name, array.name, expected, array.size());
    }
  }
}

/// The part of a pattern before its first placeholder, as "labels" of "labels_*.tif"; else all of its name.
std::string stack_name(const std::filesystem::path& pattern) {
  std::string name = file_stem(pattern);
  name.resize(std::min(name.find_first_of("*?#%"), name.size()));
  while (!name.empty() && std::string_view("_-. ").find(name.back()) != std::string_view::npos)
    name.pop_back();
  return name.empty() ? file_stem(pattern) : name;
}

GridFile read_stack(const std::filesystem::path& pattern, const GridReading& reading) {
  ImageHeader header;
  header.kind = "stack of pictures";
  header.name = pattern.string();
  header.spacing = reading.stack_spacing;
  header.axes.origin = reading.stack_origin;
  for (int axis = 0; axis < 3; ++axis)
    header.axes.directions[static_cast<std::size_t>(axis)][axis] = reading.stack_spacing[axis];
  header.centers.emplace();
  ImageArray array;
  array.name = stack_name(pattern);
  array.source = import_stack(match_stack(pattern), {1, 1, 1}, {}, {}, SilentProgress::instance());
  header.dimensions = array.source.grid.dimensions;
  header.arrays.push_back(std::move(array));
  return grid_of(header, pattern, reading);
}

GridFile read_by_format(const std::filesystem::path& path, const GridReading& reading) {
  if (is_file_pattern(path)) return read_stack(path, reading);
  if (reading.raw != nullptr && find_format_by_name(path) == nullptr)
    return grid_of(raw_image(path, *reading.raw), path, reading);
  const InputFormat* format = find_input_format(path);
  if (format == nullptr || !format->gives_grids())
    fail("{}: expected data on a grid ({}) or bare samples (--dimensions, --type), found {}", path.string(),
         list_grid_endings("or"), name_unread_format(path));
  if (format->read_series != nullptr && !reading.wanted.empty())
    return format->read_series(path, reading.wanted);
  return format->read_grid != nullptr ? format->read_grid(path)
                                      : grid_of(format->read_header(path), path, reading);
}

}  // namespace

void show_names(std::vector<GridArray>& arrays, std::vector<std::string>& material_names) {
  for (GridArray& array : arrays) {
    array.name = visible_text(array.name);
    for (std::string& name : array.component_names) name = visible_text(name);
    for (std::string& name : array.label_names) name = visible_text(name);
  }
  for (std::string& name : material_names) name = visible_text(name);
}

void interleave(GridArray& array) {
  if (array.components == 1) return;
  const auto turn = [components = static_cast<std::size_t>(array.components)](auto& values) {
    const auto planar = values;
    const std::size_t sites = planar.size() / components;
    for (std::size_t c = 0; c < components; ++c) {
      for (std::size_t i = 0; i < sites; ++i) values[i * components + c] = planar[c * sites + i];
    }
  };
  std::visit(turn, array.values);
}

void GridArray::expand() {
  if (!runs) return;
  const SiteArray<LabelArray::Label> index = runs->index.dense();
  const auto for_each = [&](const auto& take) {
    for (const LabelArray::Label i : std::as_const(index)) {
      if (!take(runs->numbers[i])) return;
    }
  };
  set_numbers<std::int64_t>(for_each, index.size(), *this);
  runs.reset();
}

FieldValues GridArray::take_field() {
  expand();
  const auto all_fit = [this](const auto& numbers) {
    for (const auto number : numbers) {
      if (!float_has(value(number))) return false;
    }
    return true;
  };
  if (auto* const doubles = std::get_if<std::vector<double>>(&values)) return std::move(*doubles);
  if (std::holds_alternative<std::vector<float>>(values) || std::visit(all_fit, values)) return take_floats();
  std::vector<double> result;
  result.reserve(size());
  const auto add = [&](const auto& numbers) {
    for (const auto number : numbers) result.push_back(value(number));
  };
  std::visit(add, values);
  values = std::vector<float>();
  return result;
}

std::vector<float> GridArray::take_floats() {
  expand();
  if (values.index() == 0) return std::move(std::get<0>(values));
  std::vector<float> result;
  result.reserve(size());
  const auto add = [&](const auto& numbers) {
    for (const auto number : numbers)
      result.push_back(scaled() ? static_cast<float>(value(number)) : static_cast<float>(number));
  };
  std::visit(add, values);
  values = std::vector<float>();
  return result;
}

std::string names_of(const std::vector<GridArray>& arrays) {
  std::string names;
  for (const GridArray& array : arrays) names += (names.empty() ? "'" : ", '") + array.name + "'";
  return names.empty() ? "no array" : names;
}

GridFile read_grid_by_library(const std::filesystem::path& path) {
  return receive_from_child<GridFile>(request_of(LibraryReader::kGrid, path));
}

GridFile read_series_by_library(const std::filesystem::path& path, const std::vector<std::string>& wanted) {
  ReaderRequest request = request_of(LibraryReader::kGrid, path);
  request.arrays = wanted;
  return receive_from_child<GridFile>(request);
}

GridFile read_hdf5_by_library(const std::filesystem::path& path) {
  return receive_from_child<GridFile>(request_of(LibraryReader::kHdf5Grid, path));
}

GridFile read_grid_file(const std::filesystem::path& path, const GridReading& reading) {
  check_input_file(path);
  GridFile file = read_by_format(path, reading);
  show_names(file.arrays, file.material_names);
  check_sizes(path.string(), file);
  return file;
}

}  // namespace adamas::io
