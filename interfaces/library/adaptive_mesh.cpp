#include "interfaces/library/adaptive_mesh.h"

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "core/base/error.h"
#include "interfaces/cutting/cut_mesh.h"
#include "interfaces/mesh/extraction.h"
#include "interfaces/mesh/resampled_mesh_file.h"

namespace adamas {

using namespace interfaces;

namespace {

std::vector<ArrayView> views(const std::vector<NamedArray>& arrays) {
  std::vector<ArrayView> result;
  for (const NamedArray& array : arrays) {
    ArrayView& view = result.emplace_back(ArrayView{array.name, array.components, {}});
    std::visit([&view](const auto& values) { view.values = std::span(values); }, array.values);
  }
  return result;
}

const ArrayView& find(const std::vector<ArrayView>& arrays, std::string_view name,
                      const std::string& source) {
  const auto found =
      std::find_if(arrays.begin(), arrays.end(), [name](const auto& a) { return a.name == name; });
  if (found != arrays.end()) return *found;
  std::string known;
  for (const ArrayView& array : arrays) known += fmt::format("{}'{}'", known.empty() ? "" : ", ", array.name);
  fail("{}: expected an array of the mesh ({}), found '{}'", source, known, name);
}

}  // namespace

AdaptiveMesh::AdaptiveMesh(std::unique_ptr<Contents> contents) : contents_(std::move(contents)) {}
AdaptiveMesh::AdaptiveMesh(AdaptiveMesh&&) noexcept = default;
AdaptiveMesh& AdaptiveMesh::operator=(AdaptiveMesh&&) noexcept = default;
AdaptiveMesh::~AdaptiveMesh() = default;

std::span<const Vec3> AdaptiveMesh::points() const { return contents_->mesh.points; }
std::span<const std::array<std::uint32_t, 4>> AdaptiveMesh::tetrahedra() const {
  return contents_->tetrahedra;
}
std::span<const std::string> AdaptiveMesh::materials() const { return contents_->mesh.materials; }
const ResampleReport& AdaptiveMesh::report() const { return contents_->report; }

const TetrahedraView& AdaptiveMesh::view() const {
  const Contents& c = *contents_;
  std::call_once(c.once, [&c] {
    c.arrays = to_unstructured_mesh(c.mesh);
    // These are there already.
    c.arrays.points = {};
    c.arrays.connectivity = {};
    c.arrays.offsets = {};
    c.view = {c.mesh.points, c.tetrahedra, views(c.arrays.point_arrays), views(c.arrays.cell_arrays),
              views(c.arrays.field_arrays)};
  });
  return c.view;
}

const ArrayView& AdaptiveMesh::point_array(std::string_view name) const {
  return find(view().point_arrays, name, contents_->mesh.source);
}

const ArrayView& AdaptiveMesh::cell_array(std::string_view name) const {
  return find(view().cell_arrays, name, contents_->mesh.source);
}

InterfaceTriangles AdaptiveMesh::interfaces(Progress& progress) const {
  const ResampledMesh& mesh = contents_->mesh;
  InterfaceMesh found = extract_interfaces(mesh.table, mesh.cell_set(), mesh.box, progress).mesh;
  found.materials = mesh.materials;
  return to_interface_triangles(std::move(found));
}

MaterialTetrahedra AdaptiveMesh::cut_mesh(std::optional<double> tolerance, Progress& progress) const {
  const ResampledMesh& mesh = contents_->mesh;
  if (!tolerance) tolerance = default_cut_tolerance(mesh, contents_->report.interface_error_target);
  if (!(*tolerance > 0) || !std::isfinite(*tolerance))
    fail("{}: expected a positive tolerance of a cut mesh, found {}", mesh.source, *tolerance);
  ConformingMesh cut = interfaces::cut_mesh(mesh, *tolerance, progress);
  MaterialTetrahedra result{std::move(cut.points), std::move(cut.tetrahedra), {}, mesh.materials};
  result.tetrahedron_materials.reserve(cut.bodies.size());
  for (const BodyId body : cut.bodies)
    result.tetrahedron_materials.push_back(mesh.table.material(body).value);
  return result;
}

}  // namespace adamas
