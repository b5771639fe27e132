#include "core/io/solver_mesh_io.h"

#include <exodusII.h>
#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "core/base/error.h"
#include "core/base/output_file.h"
#include "core/io/input_file.h"
#include "core/io/output_stream.h"
#include "core/io/polygon_selection.h"
#include "core/io/unstructured_mesh_io.h"

namespace adamas::io {

namespace {

using Integers = std::vector<std::int32_t>;

/// The fields on cells, with names that differ from those of the other arrays there.
std::vector<NamedArray> cell_fields(const SolverMesh& mesh) {
  std::vector<NamedArray> fields = mesh.fields;
  for (NamedArray& field : fields) {
    if (field.name == "material" || field.name == "body") field.name += " (field)";
  }
  return fields;
}

void write_vtk_mesh(const std::filesystem::path& path, const SolverMesh& mesh, const NamedColours& colours) {
  UnstructuredMesh file;
  file.points = mesh.points;
  for (const auto& v : mesh.tetrahedra) {
    file.connectivity.insert(file.connectivity.end(), v.begin(), v.end());
    file.offsets.push_back(file.connectivity.size());
  }
  file.cell_arrays.push_back({"material", 1, Integers(mesh.block.begin(), mesh.block.end())});
  if (!mesh.body.empty()) file.cell_arrays.push_back({"body", 1, mesh.body});
  if (mesh.point_fields.empty()) {
    for (NamedArray& field : cell_fields(mesh)) file.cell_arrays.push_back(std::move(field));
  } else {
    file.point_arrays = mesh.point_fields;
  }
  file.field_arrays.push_back({"material_names", 1, mesh.blocks});
  IdVector<MaterialId, std::string> blocks;
  blocks.assign(mesh.blocks.begin(), mesh.blocks.end());
  add_colours(blocks, colours, file.field_arrays);
  write_unstructured_mesh(path, file);
}

/// Gmsh's types of elements.
constexpr int kTriangle = 2, kTetrahedron = 4;

/// Makes a name that can stand between quotation marks on one line.
std::string quotable(std::string name) {
  std::replace(name.begin(), name.end(), '"', '\'');
  std::replace(name.begin(), name.end(), '\n', ' ');
  return name;
}

void add_names(const SolverMesh& mesh, TextBlock& text) {
  text.add("$PhysicalNames\n{}\n", mesh.blocks.size() + mesh.face_groups.size());
  for (std::size_t g = 0; g < mesh.face_groups.size(); ++g)
    text.add("2 {} \"{}\"\n", mesh.blocks.size() + g + 1, quotable(mesh.face_groups[g].name));
  for (std::size_t b = 0; b < mesh.blocks.size(); ++b)
    text.add("3 {} \"{}\"\n", b + 1, quotable(mesh.blocks[b]));
  text.add("$EndPhysicalNames\n");
}

/// Writes tetrahedra first, so that they have the numbers that element data refer to.
void add_elements(const SolverMesh& mesh, TextBlock& text) {
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

void add_field(const SolverMesh& mesh, const NamedArray& field, TextBlock& text) {
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

void write_gmsh(const std::filesystem::path& path, const SolverMesh& mesh) {
  OutputStream stream(path);
  TextBlock text(stream);
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
  text.flush();
  stream.finish();
}

constexpr int kLongestName = 255;

/// An ExodusII file that is being written; every call is checked.
class ExodusFile {
 public:
  explicit ExodusFile(const std::filesystem::path& path) : file_(path) {
    ex_opts(EX_DEFAULT);  // no messages of the library's own
    int computed = sizeof(double), stored = sizeof(double);
    id_ = ex_create(file_.temporary().c_str(), EX_CLOBBER | EX_LARGE_MODEL, &computed, &stored);
    if (id_ < 0) refuse();
  }
  ~ExodusFile() {
    if (id_ >= 0) ex_close(id_);
  }
  ExodusFile(const ExodusFile&) = delete;
  ExodusFile& operator=(const ExodusFile&) = delete;

  [[nodiscard]] int id() const { return id_; }
  void check(int status) const {
    if (status < 0) refuse();
  }
  void finish() {
    const int id = std::exchange(id_, -1);
    check(ex_close(id));
    file_.commit();
  }

 private:
  [[noreturn]] void refuse() const {
    fail("{}: expected to write an ExodusII file, found that it cannot be written", file_.path().string());
  }

  OutputFile file_;
  int id_ = -1;
};

std::string short_name(const std::string& name) { return name.substr(0, kLongestName); }

/// The order of tetrahedra by block: those of a block follow each other in the file.
struct BlockOrder {
  std::vector<std::uint32_t> tetrahedra;
  std::vector<std::size_t> starts;  ///< the first place of each block, and the end

  explicit BlockOrder(const SolverMesh& mesh)
      : tetrahedra(mesh.tetrahedra.size()), starts(mesh.blocks.size() + 1) {
    for (const std::uint32_t b : mesh.block) ++starts[b + 1];
    std::partial_sum(starts.begin(), starts.end(), starts.begin());
    std::vector<std::size_t> next(starts.begin(), starts.end() - 1);
    for (std::uint32_t t = 0; t < tetrahedra.size(); ++t) tetrahedra[next[mesh.block[t]]++] = t;
  }
  [[nodiscard]] std::size_t size(std::size_t block) const { return starts[block + 1] - starts[block]; }
};

void put_points(const SolverMesh& mesh, const ExodusFile& file) {
  std::array<std::vector<double>, 3> x;
  for (const Vec3& p : mesh.points) {
    for (int axis = 0; axis < 3; ++axis) x[static_cast<std::size_t>(axis)].push_back(p[axis]);
  }
  file.check(ex_put_coord(file.id(), x[0].data(), x[1].data(), x[2].data()));
}

void put_blocks(const SolverMesh& mesh, const BlockOrder& order, const ExodusFile& file) {
  for (std::size_t b = 0; b < mesh.blocks.size(); ++b) {
    if (order.size(b) == 0) continue;
    const auto number = static_cast<ex_entity_id>(b + 1);
    std::vector<int> corners;
    for (std::size_t i = order.starts[b]; i < order.starts[b + 1]; ++i) {
      for (const std::uint32_t v : mesh.tetrahedra[order.tetrahedra[i]])
        corners.push_back(static_cast<int>(v + 1));
    }
    file.check(ex_put_block(file.id(), EX_ELEM_BLOCK, number, "TETRA",
                            static_cast<std::int64_t>(order.size(b)), 4, 0, 0, 0));
    file.check(ex_put_conn(file.id(), EX_ELEM_BLOCK, number, corners.data(), nullptr, nullptr));
    file.check(ex_put_name(file.id(), EX_ELEM_BLOCK, number, short_name(mesh.blocks[b]).c_str()));
  }
}

/// Writes side sets; the sides of a tetrahedron are numbered as in the manual of ExodusII.
void put_sides(const SolverMesh& mesh, const BlockOrder& order, const ExodusFile& file) {
  constexpr std::array<int, 4> kSide{2, 3, 1, 4};  // the side opposite to each corner
  std::vector<int> place(mesh.tetrahedra.size());
  for (std::size_t i = 0; i < place.size(); ++i) place[order.tetrahedra[i]] = static_cast<int>(i + 1);
  for (std::size_t g = 0; g < mesh.face_groups.size(); ++g) {
    const auto& group = mesh.face_groups[g];
    if (group.faces.empty()) continue;
    const auto number = static_cast<ex_entity_id>(g + 1);
    std::vector<int> elements, sides;
    for (const SolverMesh::Face& face : group.faces) {
      elements.push_back(place[face.tetrahedron]);
      sides.push_back(kSide[face.opposite]);
    }
    file.check(ex_put_set_param(file.id(), EX_SIDE_SET, number, static_cast<std::int64_t>(sides.size()), 0));
    file.check(ex_put_set(file.id(), EX_SIDE_SET, number, elements.data(), sides.data()));
    file.check(ex_put_name(file.id(), EX_SIDE_SET, number, short_name(group.name).c_str()));
  }
}

/// Names of the variables for the components of the fields.
std::vector<std::string> variable_names(const SolverMesh& mesh) {
  std::vector<std::string> names;
  for (const NamedArray& field : mesh.fields) {
    for (int k = 0; k < field.components; ++k) {
      const std::string suffix = field.components == 1   ? ""
                                 : field.components <= 3 ? std::string("_") + "xyz"[k]
                                                         : fmt::format("_{}", k + 1);
      names.push_back(short_name(field.name + suffix));
    }
  }
  return names;
}

void put_fields(const SolverMesh& mesh, const BlockOrder& order, const ExodusFile& file) {
  const std::vector<std::string> names = variable_names(mesh);
  if (names.empty()) return;
  std::vector<std::string> texts = names;
  std::vector<char*> pointers;
  for (std::string& text : texts) pointers.push_back(text.data());
  const int count = static_cast<int>(names.size());
  file.check(ex_put_variable_param(file.id(), EX_ELEM_BLOCK, count));
  file.check(ex_put_variable_names(file.id(), EX_ELEM_BLOCK, count, pointers.data()));
  const double time = 0;
  file.check(ex_put_time(file.id(), 1, &time));
  int variable = 0;
  for (const NamedArray& field : mesh.fields) {
    const auto& values = std::get<std::vector<double>>(field.values);
    const auto components = static_cast<std::size_t>(field.components);
    for (std::size_t k = 0; k < components; ++k) {
      ++variable;
      for (std::size_t b = 0; b < mesh.blocks.size(); ++b) {
        if (order.size(b) == 0) continue;
        std::vector<double> of_block;
        for (std::size_t i = order.starts[b]; i < order.starts[b + 1]; ++i)
          of_block.push_back(values[order.tetrahedra[i] * components + k]);
        file.check(ex_put_var(file.id(), 1, EX_ELEM_BLOCK, variable, static_cast<ex_entity_id>(b + 1),
                              static_cast<std::int64_t>(of_block.size()), of_block.data()));
      }
    }
  }
}

void write_exodus(const std::filesystem::path& path, const SolverMesh& mesh) {
  if (mesh.tetrahedra.empty()) fail("{}: expected tetrahedra to write, found none", path.string());
  const BlockOrder order(mesh);
  std::int64_t blocks = 0;
  for (std::size_t b = 0; b < mesh.blocks.size(); ++b) blocks += order.size(b) > 0 ? 1 : 0;
  const auto sets = std::count_if(mesh.face_groups.begin(), mesh.face_groups.end(),
                                  [](const auto& group) { return !group.faces.empty(); });
  ExodusFile file(path);
  file.check(ex_set_max_name_length(file.id(), kLongestName));
  file.check(ex_put_init(file.id(), "adamas", 3, static_cast<std::int64_t>(mesh.points.size()),
                         static_cast<std::int64_t>(mesh.tetrahedra.size()), blocks, 0, sets));
  put_points(mesh, file);
  put_blocks(mesh, order, file);
  put_sides(mesh, order, file);
  put_fields(mesh, order, file);
  file.finish();
}

}  // namespace

UnstructuredMesh face_surface(const SolverMesh& mesh) {
  PolygonSelection selection(mesh.points);
  Integers groups, tetrahedra;
  std::vector<std::string> names;
  for (const SolverMesh::FaceGroup& group : mesh.face_groups) {
    for (const SolverMesh::Face& face : group.faces) {
      selection.add(mesh.corners(face));
      groups.push_back(static_cast<std::int32_t>(names.size()));
      tetrahedra.push_back(static_cast<std::int32_t>(face.tetrahedron));
    }
    names.push_back(group.name);
  }
  UnstructuredMesh surface = std::move(selection.mesh);
  surface.point_arrays.push_back({"point", 1, std::move(selection.taken)});
  surface.cell_arrays.push_back({"group", 1, std::move(groups)});
  surface.cell_arrays.push_back({"tetrahedron", 1, std::move(tetrahedra)});
  surface.field_arrays.push_back({"group_names", 1, std::move(names)});
  return surface;
}

SolverMesh read_solver_mesh(const std::filesystem::path& path) {
  const std::string name = path.string();
  if (file_extension(path) != ".vtu") fail("{}: expected tetrahedra as .vtu", name);
  UnstructuredMesh file = read_unstructured_mesh(path);
  if (file.kind != CellKind::kTetrahedra) fail("{}: expected tetrahedra, found other cells", name);
  const auto find = [&]<class Values>(const std::vector<NamedArray>& arrays, const char* array,
                                      const Values*& values) {
    for (const NamedArray& a : arrays) {
      if (a.name == array) values = std::get_if<Values>(&a.values);
    }
    if (values == nullptr)
      fail("{}: expected an array '{}' of tetrahedra in materials, found none", name, array);
  };
  const Integers* materials = nullptr;
  const std::vector<std::string>* names = nullptr;
  find(file.cell_arrays, "material", materials);
  find(file.field_arrays, "material_names", names);
  if (materials->size() != file.cell_count())
    fail("{}: expected a material of each of {} tetrahedra, found {}", name, file.cell_count(),
         materials->size());
  SolverMesh mesh;
  mesh.points = std::move(file.points);
  mesh.blocks = *names;
  for (std::size_t t = 0; t < file.cell_count(); ++t) {
    const std::int32_t material = (*materials)[t];
    if (material < 0 || static_cast<std::size_t>(material) >= names->size())
      fail("{}: expected the number of one of {} materials, found {} at tetrahedron {}", name, names->size(),
           material, t);
    mesh.block.push_back(static_cast<std::uint32_t>(material));
    std::array<std::uint32_t, 4> corners{};
    std::copy_n(file.connectivity.data() + file.offsets[t], 4, corners.data());
    mesh.tetrahedra.push_back(corners);
  }
  return mesh;
}

void write_solver_mesh(const std::filesystem::path& path, const SolverMesh& mesh,
                       const NamedColours& colours) {
  const std::string extension = file_extension(path);
  if (extension == ".vtu" || extension == ".vtkhdf") return write_vtk_mesh(path, mesh, colours);
  if (extension == ".msh") return write_gmsh(path, mesh);
  if (extension == ".exo") return write_exodus(path, mesh);
  fail("{}: expected .vtu, .vtkhdf, .msh or .exo, found '{}'", path.string(), extension);
}

}  // namespace adamas::io
