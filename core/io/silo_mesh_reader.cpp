#include <fmt/format.h>
#include <silo.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <utility>

#include "core/base/error.h"
#include "core/io/grid_numbers.h"
#include "core/io/mesh_builder.h"
#include "core/io/mesh_file.h"

namespace adamas::io {

namespace {

using Index = std::uint32_t;

/// Frees an object of Silo.
template <auto kFree>
struct Freed {
  template <class T>
  void operator()(T* object) const {
    kFree(object);
  }
};
template <class T, auto kFree>
using Owned = std::unique_ptr<T, Freed<kFree>>;

using File = Owned<DBfile, [](DBfile* file) { DBClose(file); }>;
using QuadMesh = Owned<DBquadmesh, DBFreeQuadmesh>;
using UcdMesh = Owned<DBucdmesh, DBFreeUcdmesh>;
using Material = Owned<DBmaterial, DBFreeMaterial>;
using QuadVariable = Owned<DBquadvar, DBFreeQuadvar>;
using UcdVariable = Owned<DBucdvar, DBFreeUcdvar>;

/// The number at a place of an array of one of Silo's types.
double number_at(const void* values, int type, std::size_t i) {
  switch (type) {
    case DB_CHAR:
      return static_cast<const signed char*>(values)[i];
    case DB_SHORT:
      return static_cast<const short*>(values)[i];
    case DB_INT:
      return static_cast<const int*>(values)[i];
    case DB_LONG:
      return static_cast<double>(static_cast<const long*>(values)[i]);
    case DB_LONG_LONG:
      return static_cast<double>(static_cast<const long long*>(values)[i]);
    case DB_FLOAT:
      return static_cast<double>(static_cast<const float*>(values)[i]);
    default:
      return static_cast<const double*>(values)[i];
  }
}

std::string text(const char* name) { return name != nullptr ? name : ""; }

/// The last part of a path in a file.
std::string last_part(const std::string& name) { return name.substr(name.find_last_of("/:") + 1); }

/// The objects of one block, by their names, which may begin with that of another file.
struct Block {
  std::string mesh, material;
  std::vector<std::string> variables;
};

/// A mesh of a file: all of its blocks.
struct Choice {
  std::vector<Block> blocks;
  std::vector<std::string> variables;    ///< the names of the variables of the blocks
  std::map<int, std::string> materials;  ///< names that go for all blocks, by number
  std::string remark;
};

class SiloReader {
 public:
  explicit SiloReader(const std::filesystem::path& path) : path_(path), name_(path.string()) {
    DBShowErrors(DB_NONE, nullptr);
    // Silo checks nothing of this by itself; fixed offsets are those of the format.
    DBSetAllowLongStrComponents(1);
  }

  MeshFile run() {
    DBfile* const file = open(path_);
    const Choice choice = choose(file);
    for (const Block& block : choice.blocks) add_block(block, choice);
    if (file_.cell_ends.empty()) fail("{}: expected zones of a mesh, found none", name_);
    finish(choice);
    return std::move(file_);
  }

 private:
  /// A value per cell or point and per material: of several materials where the file tells them apart.
  struct Variable {
    std::string unit;
    Centering centering = Centering::kCells;
    int components = 1;
    std::vector<double> values;
    std::map<std::string, std::vector<double>> of_materials;  ///< cells that have none are those of `values`
    bool complete = true;                                     ///< whether all blocks have it
  };

  DBfile* open(const std::filesystem::path& path) {
    const auto known = files_.find(path);
    if (known != files_.end()) return known->second.get();
    File file(DBOpen(path.c_str(), DB_UNKNOWN, DB_READ));
    if (file == nullptr) fail("{}: expected a Silo file, found something else", path.string());
    return files_.emplace(path, std::move(file)).first->second.get();
  }

  /// Finds the file and the name in it of an object that is named "file:name" or "name".
  std::pair<DBfile*, std::string> locate(const std::string& name) {
    const std::size_t colon = name.find(':');
    if (colon == std::string::npos) return {open(path_), name};
    // Files are named as seen from the folder of this one or, if they lie in one of the same name, from that
    // above it.
    const std::filesystem::path other = name.substr(0, colon), folder = path_.parent_path();
    std::error_code code;
    const bool here = std::filesystem::exists(folder / other, code);
    return {open((here ? folder : folder.parent_path()) / other), name.substr(colon + 1)};
  }

  [[noreturn]] void fail_object(const std::string& object) const {
    fail("{}: expected a whole object '{}', found a damaged one or none", name_, object);
  }

  /// The names of the blocks of a multi-block object; empty for a block that is none.
  static std::vector<std::string> block_names(int count, char** names, const char* files, const char* blocks,
                                              const int* empty, int empty_count) {
    std::vector<std::string> result;
    const auto scheme = [](const char* format) {
      return format != nullptr ? DBMakeNamescheme(format) : nullptr;
    };
    DBnamescheme* const of_files = names == nullptr ? scheme(files) : nullptr;
    DBnamescheme* const of_blocks = names == nullptr ? scheme(blocks) : nullptr;
    for (int n = 0; n < count; ++n) {
      std::string name;
      if (names != nullptr) {
        name = text(names[n]);
      } else if (std::find(empty, empty + empty_count, n) == empty + empty_count) {
        // The two names are in one buffer of Silo's.
        const std::string file = of_files != nullptr ? text(DBGetName(of_files, n)) : "";
        name = of_blocks != nullptr ? text(DBGetName(of_blocks, n)) : "";
        if (!file.empty()) name = file + ":" + name;
      }
      result.push_back(last_part(name) == "EMPTY" ? "" : name);
    }
    if (of_files != nullptr) DBFreeNamescheme(of_files);
    if (of_blocks != nullptr) DBFreeNamescheme(of_blocks);
    return result;
  }

  Choice choose(DBfile* file) {
    DBtoc* const toc = DBGetToc(file);
    if (toc == nullptr) fail("{}: expected a table of contents, found none", name_);
    return toc->nmultimesh > 0 ? choose_blocks(file, *toc) : choose_single(file, *toc);
  }

  Choice choose_blocks(DBfile* file, const DBtoc& toc) {
    Choice choice;
    const std::string mesh = text(toc.multimesh_names[0]);
    std::vector<std::string> materials(toc.multimat_names, toc.multimat_names + toc.nmultimat),
        variables(toc.multivar_names, toc.multivar_names + toc.nmultivar);
    if (toc.nmultimesh > 1) choice.remark = fmt::format("of {} meshes '{}' is read", toc.nmultimesh, mesh);
    const Owned<DBmultimesh, DBFreeMultimesh> blocks(DBGetMultimesh(file, mesh.c_str()));
    if (blocks == nullptr) fail_object(mesh);
    for (const std::string& name : block_names(blocks->nblocks, blocks->meshnames, blocks->file_ns,
                                               blocks->block_ns, blocks->empty_list, blocks->empty_cnt))
      choice.blocks.push_back({name, {}, {}});
    for (const std::string& name : materials) {
      const Owned<DBmultimat, DBFreeMultimat> found(DBGetMultimat(file, name.c_str()));
      if (found == nullptr) fail_object(name);
      if (static_cast<std::size_t>(found->nmats) != choice.blocks.size()) continue;
      if (found->mmesh_name != nullptr && last_part(found->mmesh_name) != mesh) continue;
      const auto names = block_names(found->nmats, found->matnames, found->file_ns, found->block_ns,
                                     found->empty_list, found->empty_cnt);
      for (std::size_t n = 0; n < names.size(); ++n) choice.blocks[n].material = names[n];
      for (int m = 0; found->material_names != nullptr && found->matnos != nullptr && m < found->nmatnos; ++m)
        choice.materials[found->matnos[m]] = text(found->material_names[m]);
      break;
    }
    for (const std::string& name : variables) {
      const Owned<DBmultivar, DBFreeMultivar> found(DBGetMultivar(file, name.c_str()));
      if (found == nullptr) fail_object(name);
      if (static_cast<std::size_t>(found->nvars) != choice.blocks.size()) continue;
      if (found->mmesh_name != nullptr && last_part(found->mmesh_name) != mesh) continue;
      const auto names = block_names(found->nvars, found->varnames, found->file_ns, found->block_ns,
                                     found->empty_list, found->empty_cnt);
      choice.variables.push_back(name);
      for (std::size_t n = 0; n < names.size(); ++n) choice.blocks[n].variables.push_back(names[n]);
    }
    return choice;
  }

  Choice choose_single(DBfile* file, const DBtoc& toc) {
    std::vector<std::string> meshes(toc.qmesh_names, toc.qmesh_names + toc.nqmesh);
    meshes.insert(meshes.end(), toc.ucdmesh_names, toc.ucdmesh_names + toc.nucdmesh);
    const std::vector<std::string> materials(toc.mat_names, toc.mat_names + toc.nmat);
    std::vector<std::string> quads(toc.qvar_names, toc.qvar_names + toc.nqvar),
        ucds(toc.ucdvar_names, toc.ucdvar_names + toc.nucdvar);
    if (meshes.empty()) fail("{}: expected a quadrilateral or unstructured mesh, found none", name_);
    Choice choice;
    // The first mesh with materials, else the first.
    std::string mesh = meshes.front();
    Block block;
    for (const std::string& name : materials) {
      const Material found(DBGetMaterial(file, name.c_str()));
      if (found == nullptr) fail_object(name);
      const std::string of = last_part(text(found->meshname));
      if (std::find(meshes.begin(), meshes.end(), of) == meshes.end()) continue;
      mesh = of;
      block.material = name;
      break;
    }
    if (meshes.size() > 1) choice.remark = fmt::format("of {} meshes '{}' is read", meshes.size(), mesh);
    block.mesh = mesh;
    const auto add = [&](const std::string& name, const char* of) {
      if (last_part(text(of)) != mesh) return;
      choice.variables.push_back(name);
      block.variables.push_back(name);
    };
    for (const std::string& name : quads) {
      const QuadVariable found(DBGetQuadvar(file, name.c_str()));
      if (found == nullptr) fail_object(name);
      add(name, found->meshname);
    }
    for (const std::string& name : ucds) {
      const UcdVariable found(DBGetUcdvar(file, name.c_str()));
      if (found == nullptr) fail_object(name);
      add(name, found->meshname);
    }
    choice.blocks.push_back(std::move(block));
    return choice;
  }

  /// What is known of the zones and nodes of a block that are real.
  struct Taken {
    std::vector<std::size_t> zones, nodes;            ///< the places of those that are new cells and points
    std::array<std::size_t, 3> node_counts{1, 1, 1};  ///< of a quadrilateral mesh
    bool is_quad = false;
    std::size_t zone_count = 0, node_count = 0;
  };

  void set_dimensions(int dimensions) {
    if (dimensions != 2 && dimensions != 3)
      fail("{}: expected a mesh of two or three dimensions, found {}", name_, dimensions);
    if (!file_.cell_ends.empty() && file_.flat != (dimensions == 2))
      fail("{}: expected blocks of the same dimensions, found others", name_);
    file_.flat = dimensions == 2;
  }

  /// Makes room for the points of a block; the box of the first one decides which points are one.
  PointMerger& merger(const Box3& box) {
    if (!merger_) merger_.emplace(PointMerger::kCoincident * std::max(box.diagonal(), 1e-300), file_.points);
    return *merger_;
  }

  /// Adds points; returns their numbers.
  std::vector<Index> add_points(const std::vector<Vec3>& points, const std::vector<char>& used,
                                Taken& taken) {
    Box3 box;
    for (const Vec3& p : points) box.extend(p);
    PointMerger& numbers = merger(box);
    std::vector<Index> result(points.size(), 0);
    for (std::size_t n = 0; n < points.size(); ++n) {
      if (used[n] == 0) continue;
      if (!is_finite(points[n])) fail("{}: expected finite coordinates, found none at node {}", name_, n);
      const std::size_t before = file_.points.size();
      result[n] = numbers.number(points[n]);
      if (file_.points.size() > before) taken.nodes.push_back(n);
    }
    return result;
  }

  Taken add_quad_mesh(const DBquadmesh& mesh) {
    set_dimensions(mesh.ndims);
    Taken taken;
    taken.is_quad = true;
    std::array<std::size_t, 3> first{0, 0, 0}, last{1, 1, 1}, stride{0, 0, 0};
    const auto axes = static_cast<std::size_t>(mesh.ndims);
    for (std::size_t a = 0; a < axes; ++a) {
      if (mesh.dims[a] < 2)
        fail("{}: expected two nodes and more along each axis, found {}", name_, mesh.dims[a]);
      taken.node_counts[a] = static_cast<std::size_t>(mesh.dims[a]);
      first[a] = static_cast<std::size_t>(std::clamp(mesh.min_index[a], 0, mesh.dims[a] - 1));
      last[a] = static_cast<std::size_t>(std::clamp(mesh.max_index[a], 0, mesh.dims[a] - 1));
      stride[a] = static_cast<std::size_t>(std::max(mesh.stride[a], 0));
    }
    const auto [nx, ny, nz] = taken.node_counts;
    taken.node_count = nx * ny * nz;
    taken.zone_count = (nx - 1) * (ny - 1) * (axes == 3 ? nz - 1 : 1);
    x_fastest_ = mesh.major_order == DB_ROWMAJOR;
    const auto place = [&](std::size_t i, std::size_t j, std::size_t k) {
      return i * stride[0] + j * stride[1] + k * stride[2];
    };
    if (place(nx - 1, ny - 1, nz - 1) >= taken.node_count)
      fail("{}: expected strides within {} nodes, found others", name_, taken.node_count);
    std::vector<Vec3> points(taken.node_count);
    for (std::size_t k = 0; k < nz; ++k) {
      for (std::size_t j = 0; j < ny; ++j) {
        for (std::size_t i = 0; i < nx; ++i) {
          const std::array<std::size_t, 3> index{i, j, k};
          Vec3& p = points[place(i, j, k)];
          for (std::size_t a = 0; a < axes; ++a)
            p[static_cast<int>(a)] = number_at(mesh.coords[a], mesh.datatype,
                                               mesh.coordtype == DB_COLLINEAR ? index[a] : place(i, j, k));
        }
      }
    }
    const std::vector<Index> numbers = add_points(points, std::vector<char>(points.size(), 1), taken);
    constexpr std::array<std::array<std::array<std::size_t, 3>, 4>, 6> kFaces{
        {{{{0, 0, 0}, {0, 0, 1}, {0, 1, 1}, {0, 1, 0}}},
         {{{1, 0, 0}, {1, 1, 0}, {1, 1, 1}, {1, 0, 1}}},
         {{{0, 0, 0}, {1, 0, 0}, {1, 0, 1}, {0, 0, 1}}},
         {{{0, 1, 0}, {0, 1, 1}, {1, 1, 1}, {1, 1, 0}}},
         {{{0, 0, 0}, {0, 1, 0}, {1, 1, 0}, {1, 0, 0}}},
         {{{0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}}}}};
    std::vector<Index> face;
    const auto add_face = [&](const auto& corners, std::size_t i, std::size_t j, std::size_t k) {
      face.clear();
      for (const auto& [di, dj, dk] : corners) face.push_back(numbers[place(i + di, j + dj, k + dk)]);
      append_face(face, file_);
    };
    for (std::size_t k = first[2]; k < last[2]; ++k) {
      for (std::size_t j = first[1]; j < last[1]; ++j) {
        for (std::size_t i = first[0]; i < last[0]; ++i) {
          if (file_.flat) {
            add_face(kFaces[4], i, j, k);
          } else {
            for (const auto& corners : kFaces) add_face(corners, i, j, k);
          }
          end_cell(file_);
          taken.zones.push_back(zone_place({i, j, k}, taken));
        }
      }
    }
    return taken;
  }

  /// The place of a zone of a quadrilateral mesh in arrays of zones.
  [[nodiscard]] std::size_t zone_place(const std::array<std::size_t, 3>& zone, const Taken& taken) const {
    const auto& n = taken.node_counts;
    const std::size_t mx = n[0] - 1, my = n[1] - 1, mz = n[2] > 1 ? n[2] - 1 : 1;
    if (x_fastest_) return zone[0] + mx * (zone[1] + my * zone[2]);
    return zone[2] + mz * (zone[1] + my * zone[0]);
  }

  Taken add_ucd_mesh(const DBucdmesh& mesh) {
    Taken taken;
    taken.node_count = static_cast<std::size_t>(std::max(mesh.nnodes, 0));
    std::vector<Vec3> points(taken.node_count);
    for (int a = 0; a < std::min(mesh.ndims, 3); ++a) {
      for (std::size_t n = 0; n < points.size(); ++n)
        points[n][a] = number_at(mesh.coords[a], mesh.datatype, n);
    }
    if (mesh.phzones != nullptr) return add_polyhedra(*mesh.phzones, mesh.origin, points, std::move(taken));
    if (mesh.zones == nullptr) fail("{}: expected zones of mesh '{}', found none", name_, text(mesh.name));
    return add_zones(*mesh.zones, mesh.ndims, points, std::move(taken));
  }

  std::size_t checked_node(int node, int origin, std::size_t count) const {
    const auto n = static_cast<std::int64_t>(node) - origin;
    if (n < 0 || static_cast<std::size_t>(n) >= count)
      fail("{}: expected nodes below {}, found {}", name_, count, n);
    return static_cast<std::size_t>(n);
  }

  Taken add_zones(const DBzonelist& zones, int dimensions, const std::vector<Vec3>& points, Taken taken) {
    set_dimensions(zones.ndims > 0 ? zones.ndims : dimensions);
    taken.zone_count = static_cast<std::size_t>(std::max(zones.nzones, 0));
    const auto list = std::span(zones.nodelist, static_cast<std::size_t>(std::max(zones.lnodelist, 0)));
    // A real zone's faces, or its nodes alone if it has one of the common shapes.
    std::vector<std::vector<std::vector<std::size_t>>> real;
    std::vector<char> used(points.size(), 0);
    std::size_t at = 0, zone = 0;
    const auto next = [&] {
      if (at >= list.size()) fail("{}: expected more than {} nodes of zones", name_, list.size());
      return list[at++];
    };
    const auto next_nodes = [&](int count) {
      std::vector<std::size_t> nodes;
      for (int n = 0; n < count; ++n) nodes.push_back(checked_node(next(), zones.origin, points.size()));
      return nodes;
    };
    // Polygons may have their number of nodes before each, or be of one size.
    std::size_t nodes_by_size = 0;
    for (int s = 0; s < zones.nshapes; ++s)
      nodes_by_size += static_cast<std::size_t>(std::max(zones.shapecnt[s], 0)) *
                       static_cast<std::size_t>(std::max(zones.shapesize[s], 0));
    for (int s = 0; s < zones.nshapes; ++s) {
      const int type = zones.shapetype != nullptr ? zones.shapetype[s] : 0;
      for (int n = 0; n < zones.shapecnt[s]; ++n, ++zone) {
        std::vector<std::vector<std::size_t>> faces;
        if (type == DB_ZONETYPE_POLYHEDRON) {
          for (int f = next(); f > 0; --f) faces.push_back(next_nodes(next()));
        } else {
          faces.push_back(next_nodes(
              type == DB_ZONETYPE_POLYGON && nodes_by_size != list.size() ? next() : zones.shapesize[s]));
        }
        const bool ghost = (zones.ghost_zone_labels != nullptr && zone < taken.zone_count &&
                            zones.ghost_zone_labels[zone] != 0) ||
                           static_cast<int>(zone) < zones.min_index ||
                           static_cast<int>(zone) > zones.max_index;
        if (ghost) continue;
        for (const auto& face : faces) {
          for (const std::size_t node : face) used[node] = 1;
        }
        real.push_back(std::move(faces));
        taken.zones.push_back(zone);
      }
    }
    const std::vector<Index> numbers = add_points(points, used, taken);
    for (const auto& faces : real) {
      if (faces.size() == 1) {
        add_zone(faces.front(), numbers);
        continue;
      }
      std::vector<Index> face;
      for (const auto& nodes : faces) {
        face.clear();
        for (const std::size_t node : nodes) face.push_back(numbers[node]);
        append_face(face, file_);
      }
      end_cell(file_);
    }
    return taken;
  }

  void add_zone(const std::vector<std::size_t>& nodes, const std::vector<Index>& numbers) {
    using Faces = std::vector<std::vector<std::size_t>>;
    static const Faces kTetrahedron{{0, 1, 3}, {1, 2, 3}, {2, 0, 3}, {0, 2, 1}},
        kPyramid{{0, 3, 2, 1}, {0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}},
        kPrism{{0, 1, 2, 3}, {1, 2, 5}, {3, 0, 4}, {0, 1, 5, 4}, {2, 3, 4, 5}},
        kHexahedron{{0, 4, 7, 3}, {1, 2, 6, 5}, {0, 1, 5, 4}, {3, 7, 6, 2}, {0, 3, 2, 1}, {4, 5, 6, 7}};
    std::vector<Index> face;
    if (file_.flat) {
      for (const std::size_t n : nodes) face.push_back(numbers[n]);
      append_face(face, file_);
      return end_cell(file_);
    }
    const std::map<std::size_t, const Faces*> by_size{
        {4, &kTetrahedron}, {5, &kPyramid}, {6, &kPrism}, {8, &kHexahedron}};
    const auto found = by_size.find(nodes.size());
    if (found == by_size.end())
      fail("{}: expected zones of 4, 5, 6 or 8 nodes, found {}", name_, nodes.size());
    for (const auto& places : *found->second) {
      face.clear();
      for (const std::size_t place : places) face.push_back(numbers[nodes[place]]);
      append_face(face, file_);
    }
    end_cell(file_);
  }

  Taken add_polyhedra(const DBphzonelist& zones, int origin, const std::vector<Vec3>& points, Taken taken) {
    set_dimensions(3);
    taken.zone_count = static_cast<std::size_t>(std::max(zones.nzones, 0));
    std::vector<std::vector<std::size_t>> faces;
    std::size_t at = 0;
    for (int f = 0; f < zones.nfaces; ++f) {
      auto& nodes = faces.emplace_back();
      for (int n = 0; n < zones.nodecnt[f]; ++n, ++at) {
        if (at >= static_cast<std::size_t>(std::max(zones.lnodelist, 0)))
          fail("{}: expected more than {} nodes of faces", name_, zones.lnodelist);
        nodes.push_back(checked_node(zones.nodelist[at], origin, points.size()));
      }
    }
    const std::vector<Index> numbers = add_points(points, std::vector<char>(points.size(), 1), taken);
    at = 0;
    std::vector<Index> face;
    for (int z = 0; z < zones.nzones; ++z) {
      const bool real = z >= zones.lo_offset && z <= zones.hi_offset;
      for (int n = 0; n < zones.facecnt[z]; ++n, ++at) {
        if (at >= static_cast<std::size_t>(std::max(zones.lfacelist, 0)))
          fail("{}: expected more than {} faces of zones", name_, zones.lfacelist);
        // A face that is turned inwards is written as the complement of its number.
        const int f = zones.facelist[at] < 0 ? ~zones.facelist[at] : zones.facelist[at];
        if (f < 0 || static_cast<std::size_t>(f) >= faces.size())
          fail("{}: expected faces below {}, found {}", name_, faces.size(), f);
        if (!real) continue;
        face.clear();
        for (const std::size_t node : faces[static_cast<std::size_t>(f)]) face.push_back(numbers[node]);
        append_face(face, file_);
      }
      if (!real) continue;
      end_cell(file_);
      taken.zones.push_back(static_cast<std::size_t>(z));
    }
    return taken;
  }

  void add_block(const Block& block, const Choice& choice) {
    if (block.mesh.empty()) return;
    const auto [file, mesh] = locate(block.mesh);
    const std::size_t first_cell = file_.cell_ends.size(), first_point = file_.points.size();
    Taken taken;
    switch (DBInqMeshtype(file, mesh.c_str())) {
      case DB_QUADMESH:
      case DB_QUAD_RECT:
      case DB_QUAD_CURV: {
        const QuadMesh found(DBGetQuadmesh(file, mesh.c_str()));
        if (found == nullptr) fail_object(mesh);
        taken = add_quad_mesh(*found);
        break;
      }
      case DB_UCDMESH: {
        const UcdMesh found(DBGetUcdmesh(file, mesh.c_str()));
        if (found == nullptr) fail_object(mesh);
        taken = add_ucd_mesh(*found);
        break;
      }
      default:
        fail("{}: expected a quadrilateral or unstructured mesh, found '{}' of another kind", name_, mesh);
    }
    Material material;
    if (!block.material.empty()) {
      const auto [where, name] = locate(block.material);
      material.reset(DBGetMaterial(where, name.c_str()));
      if (material == nullptr) fail_object(name);
      add_material(*material, choice, taken, first_cell);
    }
    for (std::size_t v = 0; v < choice.variables.size(); ++v) {
      Variable& variable = variables_[choice.variables[v]];
      const std::string& name = v < block.variables.size() ? block.variables[v] : "";
      if (name.empty()) {
        variable.complete = false;
        continue;
      }
      add_variable(name, material.get(), choice, taken, first_cell, first_point, variable);
    }
  }

  [[nodiscard]] static std::string material_name(const DBmaterial& material, const Choice& choice,
                                                 int number) {
    for (int m = 0; m < material.nmat; ++m) {
      if (material.matnos[m] != number) continue;
      if (material.matnames != nullptr && !text(material.matnames[m]).empty())
        return text(material.matnames[m]);
    }
    const auto found = choice.materials.find(number);
    return found != choice.materials.end() && !found->second.empty() ? found->second : std::to_string(number);
  }

  /// Calls visit(material number, fraction, place among mixed values or -1) for the materials of a zone.
  template <class Visit>
  void for_each_material(const DBmaterial& material, std::size_t zone, Visit&& visit) const {
    const int first = material.matlist[zone];
    if (first >= 0) return visit(first, 1.0, -1);
    // Mixed zones begin a list of places, from 1, the last of which is followed by 0.
    int place = -first, count = 0;
    while (place != 0) {
      if (place < 0 || place > material.mixlen || ++count > material.mixlen)
        fail("{}: material '{}': expected places of mixed zones up to {}, found {}", name_,
             text(material.name), material.mixlen, place);
      visit(material.mix_mat[place - 1],
            number_at(material.mix_vf, material.datatype, static_cast<std::size_t>(place - 1)), place - 1);
      place = material.mix_next[place - 1];
    }
  }

  void check_zones(const DBmaterial& material, const Taken& taken) const {
    std::size_t count = 1;
    for (int a = 0; a < material.ndims; ++a) count *= static_cast<std::size_t>(std::max(material.dims[a], 0));
    if (count != taken.zone_count)
      fail("{}: material '{}': expected {} zones, found {}", name_, text(material.name), taken.zone_count,
           count);
  }

  void add_material(const DBmaterial& material, const Choice& choice, const Taken& taken,
                    std::size_t first_cell) {
    check_zones(material, taken);
    for (int m = 0; m < material.nmat; ++m)
      fractions_[material_name(material, choice, material.matnos[m])].resize(file_.cell_ends.size(), 0);
    for (std::size_t n = 0; n < taken.zones.size(); ++n) {
      for_each_material(material, taken.zones[n], [&](int number, double fraction, int) {
        std::vector<double>& own = fractions_[material_name(material, choice, number)];
        own.resize(file_.cell_ends.size(), 0);
        own[first_cell + n] += fraction;
      });
    }
  }

  /// A variable of either kind of mesh.
  struct Values {
    std::vector<void*> values, mixed;
    int type = DB_DOUBLE, mixed_length = 0;
    std::size_t count = 0;
    bool on_zones = true;
    std::string unit;
  };

  Values read_values(DBfile* file, const std::string& name, QuadVariable& quad, UcdVariable& ucd) const {
    Values result;
    const auto take = [&](const auto& found) {
      if (found == nullptr || found->vals == nullptr) fail_object(name);
      result.values.assign(found->vals, found->vals + found->nvals);
      if (found->mixvals != nullptr && found->mixlen > 0)
        result.mixed.assign(found->mixvals, found->mixvals + found->nvals);
      result.type = found->datatype;
      result.mixed_length = found->mixlen;
      result.count = static_cast<std::size_t>(std::max(found->nels, 0));
      result.unit = text(found->units);
      result.on_zones = found->centering == DB_ZONECENT;
    };
    if (DBInqVarType(file, name.c_str()) == DB_QUADVAR) {
      quad.reset(DBGetQuadvar(file, name.c_str()));
      take(quad);
      if (quad->centering != DB_ZONECENT && quad->centering != DB_NODECENT)
        result.on_zones = quad->align[0] != 0;
    } else {
      ucd.reset(DBGetUcdvar(file, name.c_str()));
      take(ucd);
    }
    return result;
  }

  void add_variable(const std::string& object, const DBmaterial* material, const Choice& choice,
                    const Taken& taken, std::size_t first_cell, std::size_t first_point, Variable& variable) {
    const auto [file, name] = locate(object);
    QuadVariable quad;
    UcdVariable ucd;
    const Values values = read_values(file, name, quad, ucd);
    const Centering centering = values.on_zones ? Centering::kCells : Centering::kPoints;
    const auto components = static_cast<int>(values.values.size());
    if (variable.values.empty()) {
      variable.unit = values.unit;
      variable.centering = centering;
      variable.components = components;
    }
    const std::size_t expected = values.on_zones ? taken.zone_count : taken.node_count;
    if (centering != variable.centering || components != variable.components || values.count != expected) {
      variable.complete = false;
      return;
    }
    const std::size_t items = values.on_zones ? file_.cell_ends.size() : file_.points.size(),
                      first = values.on_zones ? first_cell : first_point,
                      size = static_cast<std::size_t>(components);
    variable.values.resize(items * size, 0);
    const std::vector<std::size_t>& places = values.on_zones ? taken.zones : taken.nodes;
    for (std::size_t n = 0; n < places.size(); ++n) {
      for (std::size_t c = 0; c < size; ++c)
        variable.values[(first + n) * size + c] = number_at(values.values[c], values.type, places[n]);
    }
    if (material == nullptr || values.mixed.empty() || values.mixed_length != material->mixlen) return;
    for (std::size_t n = 0; n < places.size(); ++n) {
      for_each_material(*material, places[n], [&](int number, double, int mixed) {
        std::vector<double>& own = variable.of_materials[material_name(*material, choice, number)];
        own.resize(items * size, std::numeric_limits<double>::quiet_NaN());
        for (std::size_t c = 0; c < size; ++c)
          own[(first + n) * size + c] =
              mixed < 0 ? number_at(values.values[c], values.type, places[n])
                        : number_at(values.mixed[c], values.type, static_cast<std::size_t>(mixed));
      });
    }
  }

  void add_array(const std::string& name, Centering centering, int components, std::vector<double> values) {
    GridArray array;
    array.name = name;
    array.type = "float64";
    array.centering = centering;
    array.components = components;
    set_numbers(std::span<const double>(values), array);
    file_.arrays.push_back(std::move(array));
  }

  /// Turns what was collected of all blocks into arrays.
  void finish(const Choice& choice) {
    file_.kind = "Silo";
    file_.remark = choice.remark;
    const std::size_t cells = file_.cell_ends.size();
    for (auto& [name, own] : fractions_) {
      own.resize(cells, 0);
      add_array("Volume Fraction for " + name, Centering::kCells, 1, std::move(own));
    }
    for (auto& [object, variable] : variables_) {
      const std::string name = last_part(object),
                        unit = variable.unit.empty() ? "" : " [" + variable.unit + "]";
      const std::size_t items = (variable.centering == Centering::kCells ? cells : file_.points.size()) *
                                static_cast<std::size_t>(variable.components);
      if (!variable.complete || variable.values.size() > items) {
        file_.remark += fmt::format("{}variable '{}', which some blocks have not, is not read",
                                    file_.remark.empty() ? "" : "; ", name);
        continue;
      }
      variable.values.resize(items, 0);
      if (variable.of_materials.empty()) {
        add_array(name + unit, variable.centering, variable.components, std::move(variable.values));
        continue;
      }
      for (auto& [material, own] : variable.of_materials) {
        own.resize(items, std::numeric_limits<double>::quiet_NaN());
        for (std::size_t i = 0; i < items; ++i) own[i] = std::isnan(own[i]) ? variable.values[i] : own[i];
        add_array(name + " for " + material + unit, variable.centering, variable.components, std::move(own));
      }
    }
  }

  const std::filesystem::path& path_;
  std::string name_;
  std::map<std::filesystem::path, File> files_;
  bool x_fastest_ = true;
  std::optional<PointMerger> merger_;
  std::map<std::string, std::vector<double>> fractions_;  // by material
  std::map<std::string, Variable> variables_;
  MeshFile file_;
};

}  // namespace

MeshFile read_silo_mesh(const std::filesystem::path& path) { return SiloReader(path).run(); }

}  // namespace adamas::io
