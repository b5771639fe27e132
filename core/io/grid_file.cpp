#include "core/io/grid_file.h"

#include <algorithm>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/io/input_file.h"
#include "core/io/legacy_vtk_check.h"
#include "core/io/meta_image_check.h"
#include "core/io/nrrd_reader.h"
#include "core/io/reader_program.h"
#include "core/io/vtk_grid_reader.h"
#include "core/io/vtk_xml_check.h"

namespace adamas {

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
    sink.put(array.integral());
    std::visit([&sink](const auto& values) { sink.put(values); }, array.values);
  }
  sink.put(static_cast<std::uint64_t>(file.material_names.size()));
  for (const std::string& name : file.material_names) sink.put(name);
  for (const auto& faces : file.faces) sink.put(faces);
  sink.put(file.aslant);
  sink.put(file.space);
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
    if (source.get<bool>()) {
      array.values = source.get_vector<std::int32_t>();
    } else {
      array.values = source.get_vector<float>();
    }
    file.arrays.push_back(std::move(array));
  }
  const auto names = source.get<std::uint64_t>();
  for (std::uint64_t i = 0; i < names; ++i) file.material_names.push_back(source.get_string());
  for (auto& faces : file.faces) faces = source.get_vector<double>();
  file.aslant = source.get<std::optional<GridAxes>>();
  file.space = source.get_string();
  return file;
}

/// What the reader must have got right before anybody indexes its arrays.
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

/// Names as they are shown, since that is how they are asked for, and since XML cannot hold all characters.
void show_names(GridFile& file) {
  for (GridArray& array : file.arrays) array.name = visible_text(array.name);
  for (std::string& name : file.material_names) name = visible_text(name);
}

}  // namespace

std::vector<float> GridArray::take_floats() {
  if (!integral()) return std::move(std::get<0>(values));
  std::vector<float> result;
  result.reserve(size());
  for (const std::int32_t v : std::get<1>(values)) result.push_back(static_cast<float>(v));
  values = std::vector<float>();
  return result;
}

const GridArray* GridFile::find(const std::string& name) const {
  const auto found =
      std::find_if(arrays.begin(), arrays.end(), [&](const auto& a) { return a.name == name; });
  return found == arrays.end() ? nullptr : &*found;
}

std::string GridFile::array_names() const {
  std::string names;
  for (const GridArray& array : arrays) names += (names.empty() ? "'" : ", '") + array.name + "'";
  return names.empty() ? "no array" : names;
}

void send_grid(const ReaderRequest& request, ByteSink& sink) {
  send(read_grid_with_vtk(request.paths.front()), sink);
}

GridFile read_grid_file(const std::filesystem::path& path) {
  const std::size_t size = check_input_file(path);
  GridFile file;
  if (file_extension(path) == ".nrrd" || file_extension(path) == ".nhdr") {
    file = read_nrrd(path);
    show_names(file);
    check_sizes(path.string(), file);
    return file;
  }
  if (file_extension(path) == ".vtk") check_legacy_vtk(path);
  if (file_extension(path) == ".vti" || file_extension(path) == ".vtr") check_vtk_xml(path);
  if (file_extension(path) == ".mha" || file_extension(path) == ".mhd") check_meta_image(path);
  const ReaderRequest request{LibraryReader::kGrid, path.string(), size, {path.string()}};
  read_in_child(request, [&file](ByteSource& source) { file = receive(source); });
  show_names(file);
  check_sizes(path.string(), file);
  return file;
}

}  // namespace adamas
