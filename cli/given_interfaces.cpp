#include "cli/given_interfaces.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "cli/figures.h"
#include "cli/input_options.h"
#include "cli/option_values.h"
#include "core/base/error.h"
#include "core/distance/closest_point_tree.h"
#include "core/geometry/length_limits.h"
#include "core/io/array_names.h"
#include "core/io/field_assembly.h"
#include "core/io/grid_axes.h"
#include "core/io/grid_centering.h"
#include "core/io/input_file.h"
#include "core/io/interface_mesh_io.h"
#include "interfaces/cross_section/field_choice.h"
#include "interfaces/network/check.h"
#include "interfaces/network/mending.h"
#include "interfaces/source/grid_source.h"

namespace adamas::cli {

using namespace interfaces;
using namespace io;

namespace {

/// By how much the domain extends beyond the interfaces on each side, where no domain is given.
constexpr double kMargin = 0.05;
/// Gaps that are wider than this part of the domain's diagonal are not closed.
constexpr double kWidestGap = 0.05;

InterfaceMesh read_surface_option(const std::string& text) {
  const auto [file, pair] = parse_assignment("--interface", text, true);
  const std::size_t comma = pair.find(',');
  const std::string front = pair.substr(0, comma);
  const std::string back = comma == std::string::npos ? "" : pair.substr(comma + 1);
  if (front.empty() || back.empty() || front == back) {
    wrong_usage("--interface: expected FILE=FRONT,BACK with two materials, found '{}'", text);
  }
  check_input_file(file);
  if (!is_surface_file(file)) {
    fail("{}: expected a surface (.obj, .off, .ply, .stl) for --interface, found something else", file);
  }
  return read_surface(file, front, back);
}

Box3 domain_of(const InterfaceMesh& mesh) {
  Box3 box;
  for (const Vec3& p : mesh.points) box.extend(p);
  const Vec3 size = box.size();
  for (int axis = 0; axis < 3; ++axis) {
    const double margin = kMargin * (size[axis] > 0 ? size[axis] : box.diagonal());
    box.min[axis] -= margin;
    box.max[axis] += margin;
  }
  return box;
}

/// Reads a grid without materials, whose arrays are all fields.
MultiMaterialData read_fields(const InputOptions& options) {
  if (!options.region.empty()) wrong_usage("--region: expected a grid with materials");
  GridFile file = read_grid_file(options.path);
  require_laid_out(options.path, file);
  choose_centering(options.path, options.centering(), Centering::kPoints, file);
  MultiMaterialData data;
  data.source = options.path;
  data.grid.nodes = file.nodes;
  if (!file.arrays.empty()) data.grid.centering = file.arrays.front().centering;
  add_fields(std::move(file.arrays), data);
  return data;
}

bool has_materials(const InputOptions& options) {
  if (!options.material_option().empty()) return true;
  const GridFile file = read_grid_file(options.path);
  return std::any_of(file.arrays.begin(), file.arrays.end(),
                     [](const GridArray& array) { return fraction_material(array.name).has_value(); });
}

/// Gives the mesh the materials of the data, in their order; those of the mesh alone come after them.
void adopt_materials(const MultiMaterialData& data, InterfaceMesh& mesh) {
  const auto renamed = material_numbers(mesh.materials, data.materials, mesh.source, data.source);
  for (InterfaceTriangle& t : mesh.triangles) t.front = renamed[t.front], t.back = renamed[t.back];
  mesh.materials = data.materials;
}

/// Throws where no interface is in the domain: all of it would be of one material, which is hardly intended.
void check_domain(const InterfaceMesh& mesh, const Box3& domain) {
  Box3 found;
  bool finite = true;
  for (const Vec3& p : mesh.points) {
    finite = finite && std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
    found.extend(p);
  }
  // The check of the mesh has better messages for other faults.
  if (!finite || mesh.triangles.empty()) return;
  const auto meets = [&](const InterfaceTriangle& t) {
    std::array<Vec3, 3> corners;
    for (std::size_t i = 0; i < 3; ++i) {
      if (t.points[i] >= mesh.points.size()) return true;
      corners[i] = mesh.points[t.points[i]];
    }
    return overlaps(corners, domain);
  };
  if (std::any_of(mesh.triangles.begin(), mesh.triangles.end(), meets)) return;
  fail("{}: expected interfaces inside the box {}, found them in {}", mesh.source, box_text(domain),
       box_text(found));
}

void print_report(const InterfaceMeshReport& report, const std::string& name, Console& console) {
  if (report.degenerate_triangles > 0) {
    console.note("{}: {} triangles without area are left out", name, report.degenerate_triangles);
  }
  if (report.open_border_edges > 0) {
    console.note("{}: {} edges are open borders; points beyond them may get a wrong material", name,
                 report.open_border_edges);
  }
  if (report.flipped_edges > 0) {
    console.note("{}: materials do not match round {} edges", name, report.flipped_edges);
  }
  if (report.intersections > 0) {
    console.note("{}: {} pairs of triangles intersect", name, report.intersections);
  }
}

/// Notes what was changed in the interfaces, and the first place.
void print_mending(const InterfaceMending& mending, const std::string& name, Console& console) {
  const auto tell = [&](const Mended& mended, const char* what) {
    if (mended.count == 0) return;
    console.note("{}: {}: {}, the first at {}", name, what, mended.count, place_text(mended.place));
  };
  tell(mending.gaps.points_on_faces, "points at the ends of sheets moved onto the domain's boundary");
  tell(mending.gaps.welded_points, "points welded to others close by");
  tell(mending.gaps.split_edges, "edges split at points that lie on them");
  tell(mending.coincident.duplicates, "triangles that are there twice, which count once");
  tell(mending.coincident.thin_layers, "triangles left out as the sides of layers without thickness");
  tell(mending.coincident.cancelled, "triangles left out as opposite faces, which cancel each other");
  tell(mending.coincident.contradictions, "triangles left out that contradict others on the same points");
  tell(mending.turned, "triangles turned that faced the other way than their neighbours");
}

/// The greatest width of the gaps that are closed.
ErrorTarget parse_weld(const InputOptions& options) {
  if (options.weld.empty()) return {InterfaceMendingOptions().gaps, ErrorTarget::Unit::kPart};
  if (options.weld == "0") return {};
  return parse_error_target("--weld", options.weld);
}

/// Repairs the interfaces as far as the options allow. Throws Error where they still cannot be used; the
/// message names an option that would allow what is needed.
void check_interfaces(InterfaceMesh& mesh, const Box3& box, const ErrorTarget& weld, bool tolerant,
                      Console& console) {
  const double gaps = weld.of(box.diagonal()) / box.diagonal();
  if (gaps > kWidestGap) {
    wrong_usage("--weld: expected at most {:g}% of the domain's diagonal {:.6g}, found {}", 100 * kWidestGap,
                box.diagonal(), weld.text());
  }
  try {
    print_mending(mend_interface_mesh(mesh, &box, {gaps, tolerant}), mesh.source, console);
    print_report(check_interface_mesh(mesh, &box, {tolerant, tolerant}), mesh.source, console);
  } catch (const TolerableFault& fault) {
    fail("{} (--tolerant takes such interfaces)", fault.what());
  }
}

}  // namespace

bool has_given_interfaces(const InputOptions& options) {
  return !options.interfaces.empty() ||
         (!options.path.empty() && input_kind(options.path) == InputKind::kNetwork);
}

InterfaceMesh read_given_interfaces(const InputOptions& options) {
  std::vector<InterfaceMesh> meshes;
  const bool network = !options.path.empty() && input_kind(options.path) == InputKind::kNetwork;
  const std::string extension = file_extension(options.path);
  const bool named = network && (extension == ".vtp" || extension == ".ply");
  if (!options.region_names.empty() && (!network || named)) {
    wrong_usage("--region-names: expected a labelled network (.arec, .txt) as INPUT");
  }
  if (network) {
    check_input_file(options.path);
    meshes.push_back(named ? read_interface_mesh(options.path)
                           : read_labelled_network(options.path, options.region_names));
  }
  for (const std::string& text : options.interfaces) meshes.push_back(read_surface_option(text));
  if (meshes.size() == 1) return std::move(meshes.front());
  InterfaceMesh merged = merge(meshes);
  if (merged.source.empty()) merged.source = meshes.front().source;
  return merged;
}

ResamplingSource load_given_interfaces(const InputOptions& options, std::unique_ptr<MultiMaterialData>& data,
                                       Console& console, const InputCheck& check) {
  const bool gridded = !options.path.empty() && input_kind(options.path) == InputKind::kGrid;
  if (!options.path.empty() && !gridded && input_kind(options.path) != InputKind::kNetwork) {
    fail("{}: expected a grid or a labelled network beside --interface, found a mesh", options.path);
  }
  if (!gridded && !options.grid_option().empty()) {
    wrong_usage("{}: expected data on a grid as INPUT", options.grid_option());
  }
  const ErrorTarget weld = parse_weld(options);
  std::optional<Box3> box;
  if (!options.box.empty()) box = to_box(parse_bounds("--box", options.box));
  console.step("reading interfaces", -1);
  InterfaceMesh mesh = read_given_interfaces(options);
  if (gridded && has_materials(options)) {
    data = std::make_unique<MultiMaterialData>(load_data(options, console));
    adopt_materials(*data, mesh);
  } else if (gridded) {
    data = std::make_unique<MultiMaterialData>(read_fields(options));
    data->materials = mesh.materials;
    data->labels.assign(data->grid.site_count(), 0);
    data->check();
    data->labels.clear();
  }
  if (!box && !mesh.triangles.empty()) box = data ? data->grid.domain() : domain_of(mesh);
  if (box) check_lengths(mesh.source, *box);
  if (box) check_domain(mesh, *box);
  if (check && box) {
    check({mesh.source, *box, data ? field_infos(*data) : std::vector<FieldInfo>(),
           data ? data->grid.least_spacing() : 0});
  }
  console.step("checking interfaces", -1);
  if (!box) check_interface_arrays(mesh);
  check_interfaces(mesh, *box, weld, options.tolerant, console);
  return make_mesh_source(mesh, *box, data.get(), console);
}

}  // namespace adamas::cli
