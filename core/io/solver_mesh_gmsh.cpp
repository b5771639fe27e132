#include <fmt/format.h>

#include <algorithm>

#include "core/io/output_stream.h"
#include "core/io/solver_mesh_io.h"

namespace adamas::io {

namespace {

constexpr int kTriangle = 2, kTetrahedron = 4;  // types of elements
constexpr std::size_t kChunk = 1 << 16;         // bytes

/// Text that is written to a file piece by piece.
class Text {
 public:
  explicit Text(const std::filesystem::path& path) : stream_(path) {}

  template <class... Arguments>
  void add(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
    fmt::format_to(std::back_inserter(buffer_), format, std::forward<Arguments>(arguments)...);
    if (buffer_.size() > kChunk) flush();
  }
  void finish() {
    flush();
    stream_.finish();
  }

 private:
  void flush() {
    stream_.write(std::string_view(buffer_.data(), buffer_.size()));
    buffer_.clear();
  }

  OutputStream stream_;
  fmt::memory_buffer buffer_;
};

/// Makes a name that can stand between quotation marks on one line.
std::string quotable(std::string name) {
  std::replace(name.begin(), name.end(), '"', '\'');
  std::replace(name.begin(), name.end(), '\n', ' ');
  return name;
}

void add_names(const SolverMesh& mesh, Text& text) {
  text.add("$PhysicalNames\n{}\n", mesh.blocks.size() + mesh.face_groups.size());
  for (std::size_t g = 0; g < mesh.face_groups.size(); ++g)
    text.add("2 {} \"{}\"\n", mesh.blocks.size() + g + 1, quotable(mesh.face_groups[g].name));
  for (std::size_t b = 0; b < mesh.blocks.size(); ++b)
    text.add("3 {} \"{}\"\n", b + 1, quotable(mesh.blocks[b]));
  text.add("$EndPhysicalNames\n");
}

/// Writes tetrahedra first, so that they have the numbers that element data refer to.
void add_elements(const SolverMesh& mesh, Text& text) {
  std::size_t count = mesh.tetrahedra.size();
  for (const auto& group : mesh.face_groups) count += group.faces.size();
  text.add("$Elements\n{}\n", count);
  std::size_t number = 0;
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    const auto& v = mesh.tetrahedra[t];
    const std::uint32_t group = mesh.block[t] + 1;
    text.add("{} {} 2 {} {} {} {} {} {}\n", ++number, kTetrahedron, group, group, v[0] + 1, v[1] + 1,
             v[2] + 1, v[3] + 1);
  }
  for (std::size_t g = 0; g < mesh.face_groups.size(); ++g) {
    const std::size_t group = mesh.blocks.size() + g + 1;
    for (const SolverMesh::Face& face : mesh.face_groups[g].faces) {
      const auto v = mesh.corners(face);
      text.add("{} {} 2 {} {} {} {} {}\n", ++number, kTriangle, group, group, v[0] + 1, v[1] + 1, v[2] + 1);
    }
  }
  text.add("$EndElements\n");
}

/// The number of components that Gmsh takes: one, three or nine.
std::size_t padded(std::size_t components) { return components == 1 ? 1 : components <= 3 ? 3 : 9; }

void add_field(const SolverMesh& mesh, const NamedArray& field, Text& text) {
  const auto components = static_cast<std::size_t>(field.components);
  const auto& values = std::get<std::vector<double>>(field.values);
  text.add("$ElementData\n1\n\"{}\"\n1\n0.0\n3\n0\n{}\n{}\n", quotable(field.name), padded(components),
           mesh.tetrahedra.size());
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    text.add("{}", t + 1);
    for (std::size_t k = 0; k < padded(components); ++k)
      text.add(" {}", k < components ? values[t * components + k] : 0.0);
    text.add("\n");
  }
  text.add("$EndElementData\n");
}

}  // namespace

void write_gmsh(const std::filesystem::path& path, const SolverMesh& mesh) {
  Text text(path);
  text.add("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n");
  add_names(mesh, text);
  text.add("$Nodes\n{}\n", mesh.points.size());
  for (std::size_t p = 0; p < mesh.points.size(); ++p)
    text.add("{} {} {} {}\n", p + 1, mesh.points[p].x, mesh.points[p].y, mesh.points[p].z);
  text.add("$EndNodes\n");
  add_elements(mesh, text);
  for (const NamedArray& field : mesh.fields) {
    if (field.components <= 9) add_field(mesh, field, text);
  }
  text.finish();
}

}  // namespace adamas::io
