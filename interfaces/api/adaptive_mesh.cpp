#include "interfaces/api/adaptive_mesh.h"

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "core/base/error.h"
#include "core/base/loop_progress.h"
#include "core/base/release_memory.h"
#include "interfaces/cutting/cut_mesh.h"
#include "interfaces/mesh/interface_extraction.h"
#include "interfaces/mesh/resampled_mesh_file.h"
#include "interfaces/network/interface_network.h"

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

AdaptiveMesh::Contents::Contents(std::unique_ptr<Run> its_run)
    : run(std::move(its_run)),
      materials(run->source.materials.begin(), run->source.materials.end()),
      domain(run->source.box) {
  if (run->source.fields) fields = describe(run->source.fields->fields());
}

AdaptiveMesh::Contents::Contents(ResampledMesh its_mesh)
    : materials(its_mesh.materials.begin(), its_mesh.materials.end()),
      fields(describe(its_mesh.fields)),
      domain(its_mesh.box),
      mesh_(std::move(its_mesh)) {
  std::call_once(once_mesh_, [] {});
  report.input = mesh_.source;
  report.tetrahedra = mesh_.cells.size();
  report.vertices = mesh_.points.size();
}

const ResampledMesh& AdaptiveMesh::Contents::mesh() const {
  std::call_once(once_mesh_, [this] { mesh_ = resampled_mesh(*run->resampler); });
  return mesh_;
}

const std::vector<std::array<std::uint32_t, 4>>& AdaptiveMesh::Contents::tetrahedra() const {
  std::call_once(once_tetrahedra_, [this] {
    tetrahedra_.reserve(mesh().cells.size());
    for (const auto& cell : mesh().cells) tetrahedra_.push_back(cell.vertices);
  });
  return tetrahedra_;
}

const TetrahedraView& AdaptiveMesh::Contents::view() const {
  std::call_once(once_view_, [this] {
    arrays_ = to_unstructured_mesh(mesh());
    // The mesh has these already.
    release_memory(arrays_.points);
    release_memory(arrays_.connectivity);
    release_memory(arrays_.offsets);
    view_ = {mesh().points, tetrahedra(), views(arrays_.point_arrays), views(arrays_.cell_arrays),
             views(arrays_.field_arrays)};
  });
  return view_;
}

AdaptiveMesh::Contents::Run& AdaptiveMesh::Contents::kept_run(const char* wanted) const {
  if (!run) fail("{}: {}: expected a mesh that keeps its input, found one without", report.input, wanted);
  return *run;
}

AdaptiveMesh::AdaptiveMesh(std::unique_ptr<Contents> contents) : contents_(std::move(contents)) {}
AdaptiveMesh::AdaptiveMesh(AdaptiveMesh&&) noexcept = default;
AdaptiveMesh& AdaptiveMesh::operator=(AdaptiveMesh&&) noexcept = default;
AdaptiveMesh::~AdaptiveMesh() = default;

std::span<const Vec3> AdaptiveMesh::points() const { return contents_->mesh().points; }
std::span<const std::array<std::uint32_t, 4>> AdaptiveMesh::tetrahedra() const {
  return contents_->tetrahedra();
}
std::span<const std::string> AdaptiveMesh::materials() const { return contents_->materials; }
const std::vector<FieldDescription>& AdaptiveMesh::fields() const { return contents_->fields; }
const Box3& AdaptiveMesh::domain() const { return contents_->domain; }
const ResampleReport& AdaptiveMesh::report() const { return contents_->report; }
const TetrahedraView& AdaptiveMesh::view() const { return contents_->view(); }

const ArrayView& AdaptiveMesh::point_array(std::string_view name) const {
  return find(view().point_arrays, name, contents_->report.input);
}

const ArrayView& AdaptiveMesh::cell_array(std::string_view name) const {
  return find(view().cell_arrays, name, contents_->report.input);
}

InterfaceTriangles AdaptiveMesh::interfaces(Progress& progress) const {
  const LoopProgress loops(progress);
  ExtractedInterfaces shown = contents_->run ? approximated_interfaces(*contents_->run->resampler, progress)
                                             : approximated_interfaces(contents_->mesh(), progress);
  return to_interface_triangles(std::move(shown.mesh), shown.bodies);
}

InterfaceTriangles AdaptiveMesh::input_interfaces() const {
  const ResamplingSource& source = contents_->kept_run("the interfaces of the input").source;
  return to_interface_triangles(network_mesh(*source.network, source.materials, source.name),
                                triangle_bodies(*source.network));
}

MaterialTetrahedra AdaptiveMesh::cut_mesh(std::optional<double> tolerance, Progress& progress) const {
  const LoopProgress loops(progress);
  const ResampledMesh& mesh = contents_->mesh();
  if (!tolerance) tolerance = default_cut_tolerance(mesh, contents_->report.interface_error_target);
  if (!(*tolerance > 0) || !std::isfinite(*tolerance))
    fail("{}: expected a positive tolerance of a cut mesh, found {}", mesh.source, *tolerance);
  ConformingMesh cut = interfaces::cut_mesh(mesh, *tolerance, progress);
  MaterialTetrahedra result{std::move(cut.points), std::move(cut.tetrahedra), {}, contents_->materials};
  result.tetrahedron_materials.reserve(cut.bodies.size());
  for (const BodyId body : cut.bodies)
    result.tetrahedron_materials.push_back(mesh.table.material(body).value);
  return result;
}

bool AdaptiveMesh::has_input() const { return contents_->run != nullptr; }

void AdaptiveMesh::release_input() {
  if (!contents_->run) return;
  static_cast<void>(contents_->mesh());
  contents_->run.reset();
}

namespace interfaces {

namespace {

CertifiedDistance to_distance(const InterfaceDistance& distance) {
  return {distance.upper, distance.lower, distance.worst};
}

}  // namespace

InterfaceDistances to_distances(const InterfaceCertificate& certificate) {
  InterfaceDistances result{to_distance(certificate.networks), to_distance(certificate.materials),
                            certificate.worst_material.value, std::nullopt};
  if (certificate.junctions) result.junctions = to_distance(*certificate.junctions);
  return result;
}

}  // namespace interfaces

}  // namespace adamas
