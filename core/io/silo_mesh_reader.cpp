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
#include "core/io/header_text.h"
#include "core/io/mesh_builder.h"
#include "core/io/mesh_file.h"
#include "core/io/rectilinear_levels.h"

namespace adamas::io {

namespace {

using Index = std::uint32_t;

/// The greatest number of characters of a name in a remark.
constexpr std::size_t kShown = 40;

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
  bool of_levels = false;                ///< whether the file says that blocks are levels of AMR
  std::string remark;
};

class SiloReader {
 public:
  explicit SiloReader(const std::filesystem::path& path) : path_(path), name_(path.string()) {
    DBShowErrors(DB_NONE, nullptr);
  }

  MeshFile run() {
    DBfile* const file = open(path_);
    const Choice choice = choose(file);
    if (!add_levels(choice)) {
      for (const Block& block : choice.blocks) {
        add_block(block, choice);
        close_others();
      }
    }
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
    bool complete = true;      ///< whether all blocks have it, on zones or nodes
    bool mixed_apart = false;  ///< whether it has values for mixed zones that are not those of the material
  };

  DBfile* open(const std::filesystem::path& path) {
    const auto known = files_.find(path);
    if (known != files_.end()) return known->second.get();
    File file(DBOpen(path.c_str(), DB_UNKNOWN, DB_READ));
    if (file == nullptr) fail("{}: expected a Silo file, found something else", path.string());
    return files_.emplace(path, std::move(file)).first->second.get();
  }

  /// Closes all files but the first, since Silo holds a limited number of files open.
  void close_others() {
    std::erase_if(files_, [this](const auto& other) { return other.first != path_; });
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
  static std::vector<std::string> block_names(DBfile* file, int count, char** names, const char* files,
                                              const char* blocks, const int* empty, int empty_count) {
    std::vector<std::string> result;
    // Arrays that a scheme refers to are objects of the file.
    const auto scheme = [file](const char* format) {
      return format != nullptr ? DBMakeNamescheme(format, nullptr, file, nullptr) : nullptr;
    };
    DBnamescheme* const of_files = names == nullptr ? scheme(files) : nullptr;
    DBnamescheme* const of_blocks = names == nullptr ? scheme(blocks) : nullptr;
    for (int n = 0; n < count; ++n) {
      std::string name;
      if (names != nullptr) {
        name = text(names[n]);
      } else if (std::find(empty, empty + empty_count, n) == empty + empty_count) {
        // The two names are in one buffer of Silo's.
        const std::string other = of_files != nullptr ? text(DBGetName(of_files, n)) : "";
        name = of_blocks != nullptr ? text(DBGetName(of_blocks, n)) : "";
        if (!other.empty()) name = other + ":" + name;
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
    add_objects_left_out(*toc);
    return toc->nmultimesh > 0 ? choose_blocks(file, *toc) : choose_single(file, *toc);
  }

  /// Names objects of kinds that are not read.
  void add_objects_left_out(const DBtoc& toc) {
    const auto add = [this](const char* kind, int count, char** names) {
      std::vector<std::string> quoted;
      for (int n = 0; n < count; ++n) quoted.push_back("'" + printable(text(names[n]), kShown) + "'");
      if (count > 0) file_.add_remark(fmt::format("{} not read: {}", kind, fmt::join(quoted, ", ")));
    };
    add("meshes of points", toc.nptmesh, toc.ptmesh_names);
    add("meshes of solid geometry", toc.ncsgmesh, toc.csgmesh_names);
    add("species of materials", toc.nmatspecies, toc.matspecies_names);
    add("species of materials of blocks", toc.nmultimatspecies, toc.multimatspecies_names);
    add("curves", toc.ncurve, toc.curve_names);
  }

  /// Finds the first multi-block mesh that is not one of points or of solid geometry.
  std::string first_volume_mesh(DBfile* file, const DBtoc& toc) const {
    const std::vector<std::string> names(toc.multimesh_names, toc.multimesh_names + toc.nmultimesh);
    for (const std::string& name : names) {
      const Owned<DBmultimesh, DBFreeMultimesh> blocks(DBGetMultimesh(file, name.c_str()));
      if (blocks == nullptr) fail_object(name);
      const int type =
          blocks->meshtypes != nullptr && blocks->nblocks > 0 ? blocks->meshtypes[0] : blocks->block_type;
      if (type != DB_POINTMESH && type != DB_CSGMESH) return name;
    }
    fail("{}: expected a quadrilateral or unstructured mesh, found others", name_);
  }

  /// Whether a tree of mesh regions tells the levels of adaptive refinement.
  static bool has_levels(DBfile* file, const std::string& tree) {
    if (tree.empty()) return false;
    const Owned<DBmrgtree, [](DBmrgtree* found) { DBFreeMrgtree(found); }> found(
        DBGetMrgtree(file, tree.c_str()));
    if (found == nullptr || found->root == nullptr) return false;
    // The decomposition is a child of the root.
    for (int n = 0; n < found->root->num_children; ++n) {
      const DBmrgtnode* const region = found->root->children[n];
      if (region != nullptr && text(region->name) == "amr_decomp") return true;
    }
    return false;
  }

  Choice choose_blocks(DBfile* file, const DBtoc& toc) {
    Choice choice;
    const std::string mesh = first_volume_mesh(file, toc);
    std::vector<std::string> materials(toc.multimat_names, toc.multimat_names + toc.nmultimat),
        variables(toc.multivar_names, toc.multivar_names + toc.nmultivar);
    if (toc.nmultimesh > 1) choice.remark = fmt::format("of {} meshes '{}' is read", toc.nmultimesh, mesh);
    const Owned<DBmultimesh, DBFreeMultimesh> blocks(DBGetMultimesh(file, mesh.c_str()));
    if (blocks == nullptr) fail_object(mesh);
    choice.of_levels = has_levels(file, text(blocks->mrgtree_name));
    for (const std::string& name : block_names(file, blocks->nblocks, blocks->meshnames, blocks->file_ns,
                                               blocks->block_ns, blocks->empty_list, blocks->empty_cnt))
      choice.blocks.push_back({name, {}, {}});
    for (const std::string& name : materials) {
      const Owned<DBmultimat, DBFreeMultimat> found(DBGetMultimat(file, name.c_str()));
      if (found == nullptr) fail_object(name);
      if (static_cast<std::size_t>(found->nmats) != choice.blocks.size()) continue;
      if (found->mmesh_name != nullptr && last_part(found->mmesh_name) != mesh) continue;
      const auto names = block_names(file, found->nmats, found->matnames, found->file_ns, found->block_ns,
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
      const auto names = block_names(file, found->nvars, found->varnames, found->file_ns, found->block_ns,
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
    /// The places of those that are new cells and points; of a quadrilateral mesh with the first index as the
    /// fastest.
    std::vector<std::size_t> zones, nodes;
    std::array<std::size_t, 3> node_counts{1, 1, 1};  ///< of a quadrilateral mesh
    std::size_t zone_count = 0, node_count = 0;
    [[nodiscard]] std::array<std::size_t, 3> zone_counts() const {
      const auto& [nx, ny, nz] = node_counts;
      return {nx - 1, ny - 1, nz > 1 ? nz - 1 : 1};
    }
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

  /// Sets the numbers of nodes and zones of a quadrilateral mesh.
  void count_items(const DBquadmesh& mesh, Taken& taken) const {
    for (std::size_t a = 0; a < static_cast<std::size_t>(mesh.ndims); ++a) {
      if (mesh.dims[a] < 2)
        fail("{}: expected two nodes and more along each axis, found {}", name_, mesh.dims[a]);
      taken.node_counts[a] = static_cast<std::size_t>(mesh.dims[a]);
    }
    const auto [nx, ny, nz] = taken.node_counts;
    taken.node_count = nx * ny * nz;
    taken.zone_count = (nx - 1) * (ny - 1) * (mesh.ndims == 3 ? nz - 1 : 1);
    // What is not checked here is read beyond its end by no one but this process.
    if (taken.node_count > kMostNodes)
      fail("{}: expected at most {} nodes, found {}", name_, kMostNodes, taken.node_count);
  }

  /// Whether a zone is labelled as a ghost.
  static bool is_ghost(const DBquadmesh& mesh, const Taken& taken, std::size_t zone) {
    return mesh.ghost_zone_labels != nullptr &&
           mesh.ghost_zone_labels[reordered(zone, taken.zone_counts(), mesh.major_order)] != 0;
  }

  Taken add_quad_mesh(const DBquadmesh& mesh) {
    set_dimensions(mesh.ndims);
    note_coordinates(mesh.coord_sys);
    Taken taken;
    std::array<std::size_t, 3> first{0, 0, 0}, last{1, 1, 1};
    const auto axes = static_cast<std::size_t>(mesh.ndims);
    count_items(mesh, taken);
    for (std::size_t a = 0; a < axes; ++a) {
      first[a] = static_cast<std::size_t>(std::clamp(mesh.min_index[a], 0, mesh.dims[a] - 1));
      last[a] = static_cast<std::size_t>(std::clamp(mesh.max_index[a], 0, mesh.dims[a] - 1));
    }
    const auto [nx, ny, nz] = taken.node_counts;
    const auto place = [&](std::size_t i, std::size_t j, std::size_t k) {
      return place_in({i, j, k}, taken.node_counts, mesh.major_order);
    };
    std::vector<Vec3> points(taken.node_count);
    for (std::size_t k = 0; k < nz; ++k) {
      for (std::size_t j = 0; j < ny; ++j) {
        for (std::size_t i = 0; i < nx; ++i) {
          const std::array<std::size_t, 3> index{i, j, k};
          Vec3& p = points[place_in(index, taken.node_counts, DB_ROWMAJOR)];
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
      for (const auto& [di, dj, dk] : corners)
        face.push_back(numbers[place_in({i + di, j + dj, k + dk}, taken.node_counts, DB_ROWMAJOR)]);
      append_face(face, file_);
    };
    for (std::size_t k = first[2]; k < last[2]; ++k) {
      for (std::size_t j = first[1]; j < last[1]; ++j) {
        for (std::size_t i = first[0]; i < last[0]; ++i) {
          const std::size_t zone = place_in({i, j, k}, taken.zone_counts(), DB_ROWMAJOR);
          if (is_ghost(mesh, taken, zone)) continue;
          if (file_.flat) {
            add_face(kFaces[4], i, j, k);
          } else {
            for (const auto& corners : kFaces) add_face(corners, i, j, k);
          }
          const bool stays = end_cell(file_);
          if (stays) taken.zones.push_back(zone);
        }
      }
    }
    return taken;
  }

  /// The place of a node or zone in an array whose first index is the fastest (row-major, as Silo calls it)
  /// or the slowest.
  static std::size_t place_in(const std::array<std::size_t, 3>& index,
                              const std::array<std::size_t, 3>& counts, int major_order) {
    if (major_order == DB_ROWMAJOR) return index[0] + counts[0] * (index[1] + counts[1] * index[2]);
    return index[2] + counts[2] * (index[1] + counts[1] * index[0]);
  }
  /// The place in an array of this order of what has this place in one whose first index is the fastest.
  static std::size_t reordered(std::size_t place, const std::array<std::size_t, 3>& counts, int major_order) {
    if (major_order == DB_ROWMAJOR) return place;
    return place_in({place % counts[0], place / counts[0] % counts[1], place / (counts[0] * counts[1])},
                    counts, major_order);
  }

  /// Notes coordinates that are not those of straight axes: they are taken as if they were.
  void note_coordinates(int system) {
    if ((system == DB_CYLINDRICAL || system == DB_SPHERICAL) &&
        file_.remark.find("coordinates") == std::string::npos)
      file_.add_remark("its coordinates are not Cartesian, and are taken as if they were");
  }

  Taken add_ucd_mesh(const DBucdmesh& mesh) {
    note_coordinates(mesh.coord_sys);
    Taken taken;
    taken.node_count = static_cast<std::size_t>(std::max(mesh.nnodes, 0));
    std::vector<Vec3> points(taken.node_count);
    for (int a = 0; a < std::min(mesh.ndims, 3); ++a) {
      for (std::size_t n = 0; n < points.size(); ++n)
        points[n][a] = number_at(mesh.coords[a], mesh.datatype, n);
    }
    if (mesh.phzones != nullptr) return add_polyhedra(*mesh.phzones, points, std::move(taken));
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
    struct Zone {
      std::vector<std::vector<std::size_t>> faces;
      std::size_t place;
    };
    std::vector<Zone> real;
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
        const bool solid = type == 0 || type >= DB_ZONETYPE_POLYHEDRON;
        if (!file_.flat && !solid) {
          ++left_out_;
          continue;
        }
        for (const auto& face : faces) {
          for (const std::size_t node : face) used[node] = 1;
        }
        real.push_back({std::move(faces), zone});
      }
    }
    const std::vector<Index> numbers = add_points(points, used, taken);
    for (const auto& [faces, place] : real) {
      if (faces.size() == 1) {
        append_zone(faces.front(), numbers);
      } else {
        std::vector<Index> face;
        for (const auto& nodes : faces) {
          face.clear();
          for (const std::size_t node : nodes) face.push_back(numbers[node]);
          append_face(face, file_);
        }
      }
      if (end_cell(file_)) taken.zones.push_back(place);
    }
    return taken;
  }

  /// Appends the faces of a zone of a common shape.
  void append_zone(const std::vector<std::size_t>& nodes, const std::vector<Index>& numbers) {
    // Silo's wedge has a side of four nodes first, and then the edge opposite to it.
    static const CellFaces kSiloWedgeFaces{{0, 1, 2, 3}, {1, 2, 5}, {3, 0, 4}, {0, 1, 5, 4}, {2, 3, 4, 5}};
    std::vector<Index> face;
    if (file_.flat) {
      for (const std::size_t n : nodes) face.push_back(numbers[n]);
      return append_face(face, file_);
    }
    const CellFaces* faces = nodes.size() == 4   ? &kTetrahedronFaces
                             : nodes.size() == 5 ? &kPyramidFaces
                             : nodes.size() == 6 ? &kSiloWedgeFaces
                             : nodes.size() == 8 ? &kHexahedronFaces
                                                 : nullptr;
    if (faces == nullptr) fail("{}: expected zones of 4, 5, 6 or 8 nodes, found {}", name_, nodes.size());
    for (const auto& places : *faces) {
      face.clear();
      for (const std::size_t place : places) face.push_back(numbers[nodes[place]]);
      append_face(face, file_);
    }
  }

  Taken add_polyhedra(const DBphzonelist& zones, const std::vector<Vec3>& points, Taken taken) {
    set_dimensions(3);
    taken.zone_count = static_cast<std::size_t>(std::max(zones.nzones, 0));
    std::vector<std::vector<std::size_t>> faces;
    std::size_t at = 0;
    for (int f = 0; f < zones.nfaces; ++f) {
      auto& nodes = faces.emplace_back();
      for (int n = 0; n < zones.nodecnt[f]; ++n, ++at) {
        if (at >= static_cast<std::size_t>(std::max(zones.lnodelist, 0)))
          fail("{}: expected more than {} nodes of faces", name_, zones.lnodelist);
        nodes.push_back(checked_node(zones.nodelist[at], zones.origin, points.size()));
      }
    }
    const std::vector<Index> numbers = add_points(points, std::vector<char>(points.size(), 1), taken);
    at = 0;
    std::vector<Index> face;
    for (int z = 0; z < zones.nzones; ++z) {
      const bool real = z >= zones.lo_offset && z <= zones.hi_offset &&
                        (zones.ghost_zone_labels == nullptr || zones.ghost_zone_labels[z] == 0);
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
      if (real && end_cell(file_)) taken.zones.push_back(static_cast<std::size_t>(z));
    }
    return taken;
  }

  /// Reads a block whose nodes are given along its axes; none for blocks of other kinds.
  std::optional<RectilinearBlock> rectilinear_block(const std::string& object, Taken& taken) {
    const auto [file, name] = locate(object);
    const int type = DBInqMeshtype(file, name.c_str());
    if (type != DB_QUADMESH && type != DB_QUAD_RECT) return {};
    const QuadMesh mesh(DBGetQuadmesh(file, name.c_str()));
    if (mesh == nullptr) fail_object(name);
    if (mesh->coordtype != DB_COLLINEAR || mesh->ndims < 2 || mesh->ndims > 3) return {};
    note_coordinates(mesh->coord_sys);
    count_items(*mesh, taken);
    RectilinearBlock block;
    for (std::size_t a = 0; a < static_cast<std::size_t>(mesh->ndims); ++a) {
      for (std::size_t i = 0; i < taken.node_counts[a]; ++i)
        block.nodes[a].push_back(number_at(mesh->coords[a], mesh->datatype, i));
    }
    const std::array<std::size_t, 3> zones = taken.zone_counts();
    for (std::size_t zone = 0; zone < taken.zone_count; ++zone) {
      const std::array<std::size_t, 3> at{zone % zones[0], zone / zones[0] % zones[1],
                                          zone / (zones[0] * zones[1])};
      bool is_real = !is_ghost(*mesh, taken, zone);
      Vec3 low, high;
      for (std::size_t a = 0; a < static_cast<std::size_t>(mesh->ndims); ++a) {
        is_real = is_real && static_cast<int>(at[a]) >= mesh->min_index[a] &&
                  static_cast<int>(at[a]) < mesh->max_index[a];
        low[static_cast<int>(a)] = block.nodes[a][at[a]];
        high[static_cast<int>(a)] = block.nodes[a][at[a] + 1];
      }
      block.left_out.push_back(!is_real);
      if (!is_real) continue;
      block.taken.extend(low);
      block.taken.extend(high);
    }
    return block;
  }

  /// Adds all blocks where they are levels of adaptive refinement; returns whether they are.
  bool add_levels(const Choice& choice) {
    std::vector<RectilinearBlock> blocks;
    std::vector<std::pair<const Block*, Taken>> taken;
    for (const Block& block : choice.blocks) {
      if (block.mesh.empty() || choice.blocks.size() < 2) continue;
      Taken own;
      auto found = rectilinear_block(block.mesh, own);
      close_others();
      if (!found && choice.of_levels)
        fail("{}: expected rectilinear blocks of levels, found '{}' of another kind", name_, block.mesh);
      if (!found) return false;
      blocks.push_back(std::move(*found));
      taken.emplace_back(&block, std::move(own));
    }
    if (blocks.size() < 2) return false;
    const bool flat = blocks.front().nodes[2].empty();
    for (const RectilinearBlock& block : blocks) {
      if (block.nodes[2].empty() != flat) return false;
    }
    const auto levels = find_rectilinear_levels(name_, blocks, flat, choice.of_levels);
    if (!levels) return false;
    const AmrSources sources = add_amr_cells(name_, *levels, file_);
    std::size_t first_cell = 0, first_point = 0;
    for (std::size_t b = 0; b < taken.size(); ++b) {
      auto& [block, own] = taken[b];
      own.zones.assign(sources.cells[b].begin(), sources.cells[b].end());
      own.nodes.assign(sources.points[b].begin(), sources.points[b].end());
      add_values(*block, choice, own, first_cell, first_point);
      first_cell += own.zones.size();
      first_point += own.nodes.size();
      close_others();
    }
    return true;
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
    add_values(block, choice, taken, first_cell, first_point);
  }

  /// Adds the material and the variables of a block whose cells and points have been added.
  void add_values(const Block& block, const Choice& choice, const Taken& taken, std::size_t first_cell,
                  std::size_t first_point) {
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
  void for_each_material(const DBmaterial& material, std::size_t zone, const Taken& taken,
                         Visit&& visit) const {
    const bool ordered = material.ndims > 1;
    const int first =
        material.matlist[ordered ? reordered(zone, taken.zone_counts(), material.major_order) : zone];
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
      for_each_material(material, taken.zones[n], taken, [&](int number, double fraction, int) {
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
    int centering = DB_ZONECENT;
    int major_order = DB_ROWMAJOR;
    std::string unit;
    [[nodiscard]] bool on_zones() const { return centering == DB_ZONECENT; }
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
      result.centering = found->centering;
    };
    if (DBInqVarType(file, name.c_str()) == DB_QUADVAR) {
      quad.reset(DBGetQuadvar(file, name.c_str()));
      take(quad);
      result.major_order = quad->major_order;
      // Old files state the place in a zone instead: its lowest node or its middle.
      if (quad->centering != DB_ZONECENT && quad->centering != DB_NODECENT)
        result.centering = quad->align[0] != 0 ? DB_ZONECENT : DB_NODECENT;
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
    const bool on_zones = values.on_zones();
    const Centering centering = on_zones ? Centering::kCells : Centering::kPoints;
    const auto components = static_cast<int>(values.values.size());
    if (variable.values.empty()) {
      variable.unit = values.unit;
      variable.centering = centering;
      variable.components = components;
    }
    const std::size_t expected = on_zones ? taken.zone_count : taken.node_count;
    if ((!on_zones && values.centering != DB_NODECENT) || centering != variable.centering ||
        components != variable.components || values.count != expected) {
      variable.complete = false;
      return;
    }
    const std::size_t items = on_zones ? file_.cell_ends.size() : file_.points.size(),
                      first = on_zones ? first_cell : first_point,
                      size = static_cast<std::size_t>(components);
    variable.values.resize(items * size, 0);
    const std::vector<std::size_t>& places = on_zones ? taken.zones : taken.nodes;
    const auto value = [&](std::size_t c, std::size_t place) {
      const bool ordered = taken.node_counts[0] > 1;
      return number_at(
          values.values[c], values.type,
          ordered ? reordered(place, on_zones ? taken.zone_counts() : taken.node_counts, values.major_order)
                  : place);
    };
    for (std::size_t n = 0; n < places.size(); ++n) {
      for (std::size_t c = 0; c < size; ++c) variable.values[(first + n) * size + c] = value(c, places[n]);
    }
    if (material == nullptr || values.mixed.empty() || !on_zones) return;
    if (values.mixed_length != material->mixlen) {
      variable.mixed_apart = true;
      return;
    }
    for (std::size_t n = 0; n < places.size(); ++n) {
      for_each_material(*material, places[n], taken, [&](int number, double, int mixed) {
        std::vector<double>& own = variable.of_materials[material_name(*material, choice, number)];
        own.resize(items * size, std::numeric_limits<double>::quiet_NaN());
        for (std::size_t c = 0; c < size; ++c)
          own[(first + n) * size + c] =
              mixed < 0 ? value(c, places[n])
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
    if (!choice.remark.empty()) file_.add_remark(choice.remark);
    if (left_out_ > 0)
      file_.add_remark(fmt::format("{} zones of surfaces and lines are not read", left_out_));
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
        file_.add_remark(
            fmt::format("variable '{}' is not read: not all blocks have it on zones or nodes", name));
        continue;
      }
      if (variable.mixed_apart)
        file_.add_remark(fmt::format(
            "the values of '{}' for mixed zones do not fit the materials and are not read", name));
      variable.values.resize(items, 0);
      if (variable.of_materials.empty()) {
        add_array(name + unit, variable.centering, variable.components, std::move(variable.values));
        continue;
      }
      // A block without mixed zones has one value for whatever is in them.
      for (const auto& [material, own] : fractions_) variable.of_materials[material];
      for (auto& [material, own] : variable.of_materials) {
        own.resize(items, std::numeric_limits<double>::quiet_NaN());
        for (std::size_t i = 0; i < items; ++i) own[i] = std::isnan(own[i]) ? variable.values[i] : own[i];
        add_array(name + " for " + material + unit, variable.centering, variable.components, std::move(own));
      }
    }
  }

  static constexpr std::size_t kMostNodes = std::numeric_limits<Index>::max() - 1;

  const std::filesystem::path& path_;
  std::string name_;
  std::map<std::filesystem::path, File> files_;
  std::size_t left_out_ = 0;
  std::optional<PointMerger> merger_;
  std::map<std::string, std::vector<double>> fractions_;  // by material
  std::map<std::string, Variable> variables_;
  MeshFile file_;
};

}  // namespace

MeshFile read_silo_mesh(const std::filesystem::path& path) { return SiloReader(path).run(); }

}  // namespace adamas::io
