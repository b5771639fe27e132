#include "core/io/grid_file.h"

#include <algorithm>
#include <cmath>

#include "adamas/text.h"
#include "core/base/error.h"
#include "core/io/grid_numbers.h"
#include "core/io/input_file.h"
#include "core/io/input_formats.h"
#include "core/io/reader_program.h"

namespace adamas::io {

namespace {

void send(const GridFile& file, ByteSink& sink) {
  sink.put(file.kind);
  for (const auto& nodes : file.nodes) sink.put(nodes);
  sink.put(static_cast<std::uint64_t>(file.arrays.size()));
  for (const GridArray& array : file.arrays) {
    sink.put(array.name);
    sink.put(array.type);
    sink.put(array.centering);
    sink.put(array.components);
    sink.put(static_cast<std::uint64_t>(array.component_names.size()));
    for (const std::string& name : array.component_names) sink.put(name);
    sink.put(static_cast<std::uint64_t>(array.values.index()));
    std::visit([&sink](const auto& values) { sink.put(values); }, array.values);
  }
  sink.put(static_cast<std::uint64_t>(file.material_names.size()));
  for (const std::string& name : file.material_names) sink.put(name);
  for (const auto& faces : file.faces) sink.put(faces);
  sink.put(file.aslant);
  sink.put(file.space);
}

std::vector<std::string> receive_names(ByteSource& source) {
  const auto count = source.get<std::uint64_t>();
  std::vector<std::string> names;
  for (std::uint64_t i = 0; i < count; ++i) names.push_back(source.get_string());
  return names;
}

void receive_numbers(ByteSource& source, GridArray& array) {
  switch (source.get<std::uint64_t>()) {
    case 0:
      array.values = source.get_vector<float>();
      break;
    case 1:
      array.values = source.get_vector<std::int32_t>();
      break;
    case 2:
      array.values = source.get_vector<std::int64_t>();
      break;
    case 3:
      array.values = source.get_vector<std::uint64_t>();
      break;
    case 4:
      array.values = source.get_vector<double>();
      break;
    default:
      fail("array '{}': expected numbers, found none", array.name);
  }
}

GridFile receive(ByteSource& source) {
  GridFile file;
  file.kind = source.get_string();
  for (auto& nodes : file.nodes) nodes = source.get_vector<double>();
  const auto count = source.get<std::uint64_t>();
  for (std::uint64_t i = 0; i < count; ++i) {
    GridArray array;
    array.name = source.get_string();
    array.type = source.get_string();
    array.centering = source.get<Centering>();
    array.components = source.get<int>();
    array.component_names = receive_names(source);
    receive_numbers(source, array);
    file.arrays.push_back(std::move(array));
  }
  file.material_names = receive_names(source);
  for (auto& faces : file.faces) faces = source.get_vector<double>();
  file.aslant = source.get<std::optional<GridAxes>>();
  file.space = source.get_string();
  return file;
}

GridFile read_by_library(const std::filesystem::path& path, LibraryReader reader) {
  const std::size_t size = check_input_file(path);
  GridFile file;
  const ReaderRequest request{reader, path.string(), size, {path.string()}};
  read_in_child(request, [&file](ByteSource& source) { file = receive(source); });
  return file;
}

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

/// Converts names to the form in which they are shown: users ask for them in this form, and XML cannot hold
/// all characters.
void show_names(GridFile& file) {
  for (GridArray& array : file.arrays) {
    array.name = visible_text(array.name);
    for (std::string& name : array.component_names) name = visible_text(name);
  }
  for (std::string& name : file.material_names) name = visible_text(name);
}

GridFile read_by_format(const std::filesystem::path& path, const RawVolume* raw) {
  if (raw != nullptr && find_format_by_name(path) == nullptr) return grid_of(raw_image(path, *raw), path);
  const InputFormat* format = find_input_format(path);
  if (format == nullptr || !format->gives_grids())
    fail("{}: expected data on a grid ({}) or bare samples (--dimensions, --type), found something else",
         path.string(), list_grid_endings("or"));
  return format->read_grid != nullptr ? format->read_grid(path) : grid_of(format->read_header(path), path);
}

}  // namespace

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

FieldValues GridArray::take_field() {
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

std::string GridFile::array_names() const {
  std::string names;
  for (const GridArray& array : arrays) names += (names.empty() ? "'" : ", '") + array.name + "'";
  return names.empty() ? "no array" : names;
}

void send_grid(const ReaderRequest& request, ByteSink& sink) {
  const std::filesystem::path path = request.paths.front();
  send(request.reader == LibraryReader::kHdf5Grid ? read_hdf5_grid(path) : read_grid_with_vtk(path), sink);
}

GridFile read_grid_by_library(const std::filesystem::path& path) {
  return read_by_library(path, LibraryReader::kGrid);
}

GridFile read_hdf5_by_library(const std::filesystem::path& path) {
  return read_by_library(path, LibraryReader::kHdf5Grid);
}

GridFile read_grid_file(const std::filesystem::path& path, const RawVolume* raw) {
  check_input_file(path);
  GridFile file = read_by_format(path, raw);
  show_names(file);
  check_sizes(path.string(), file);
  return file;
}

}  // namespace adamas::io
