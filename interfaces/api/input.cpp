#include "interfaces/api/input.h"

#include <algorithm>
#include <array>

#include "adamas/text.h"
#include "core/base/notes.h"
#include "core/data/grid_data.h"
#include "core/distance/closest_point_tree.h"
#include "core/geometry/length_limits.h"
#include "interfaces/cross_section/field_choice.h"
#include "interfaces/input/grid_source.h"
#include "interfaces/input/mesh_source.h"
#include "interfaces/mesh_reconstruction/mesh_interfaces.h"
#include "interfaces/network/interface_mesh_check.h"
#include "interfaces/network/mending.h"

namespace adamas {

using namespace interfaces;

namespace {

/// Gaps that are wider than this part of the domain's diagonal are not closed.
constexpr double kWidestGap = 0.05;
/// Gaps up to this width are closed where no other one is given.
constexpr ErrorTarget kGaps{1e-6, ErrorTarget::Unit::kPart};

/// Throws Error if no interface is in the domain: all of it would be one material, which is hardly intended.
void check_domain(const InterfaceMesh& mesh, const Box3& domain) {
  Box3 found;
  bool finite = true;
  for (const Vec3& p : mesh.points) {
    finite = finite && is_finite(p);
    found.extend(p);
  }
  // check_interface_mesh() has better messages for other faults.
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

/// Notes the faults of interfaces that are used in spite of them.
void note_report(const InterfaceMeshReport& report, const std::string& name, Progress& progress) {
  if (report.degenerate_triangles > 0)
    note(progress, "{}: {} triangles without area are left out", name, report.degenerate_triangles);
  if (report.open_border_edges > 0)
    note(progress, "{}: {} edges are open borders; points beyond them may get a wrong material", name,
         report.open_border_edges);
  if (report.flipped_edges > 0)
    note(progress, "{}: materials do not match round {} edges", name, report.flipped_edges);
  if (report.intersections > 0)
    note(progress, "{}: {} pairs of triangles intersect", name, report.intersections);
}

/// Notes the changes of the interfaces and the first place of each kind.
void note_mending(const InterfaceMending& mending, const std::string& name, Progress& progress) {
  const auto add = [&](const Mended& mended, const char* what) {
    if (mended.count == 0) return;
    note(progress, "{}: {}: {}, the first at {}", name, what, mended.count, place_text(mended.place));
  };
  add(mending.gaps.points_on_faces, "points at the ends of sheets moved onto the domain's boundary");
  add(mending.gaps.welded_points, "points welded to others close by");
  add(mending.gaps.split_edges, "edges split at points that lie on them");
  add(mending.coincident.duplicates, "triangles that are there twice, which count once");
  add(mending.coincident.thin_layers, "triangles left out as the sides of layers without thickness");
  add(mending.coincident.cancelled, "triangles left out as opposite faces, which cancel each other");
  add(mending.coincident.contradictions, "triangles left out that contradict others on the same points");
  add(mending.turned, "triangles turned that faced the other way than their neighbours");
}

/// Repairs the interfaces as far as the options allow. Throws Error if they still cannot be used; the message
/// names an option that would allow it.
void mend(InterfaceMesh& mesh, const Box3& box, const MendingOptions& options, Progress& progress) {
  const ErrorTarget widest = options.gaps.value_or(kGaps);
  const double gaps = widest.absolute(box.diagonal()) / box.diagonal();
  if (gaps > kWidestGap) {
    wrong_usage("--weld: expected at most {:g}% of the domain's diagonal {:.6g}, found {}", 100 * kWidestGap,
                box.diagonal(), widest.text());
  }
  try {
    note_mending(mend_interface_mesh(mesh, &box, {gaps, options.tolerant}), mesh.source, progress);
    note_report(check_interface_mesh(mesh, &box, {options.tolerant, options.tolerant}), mesh.source,
                progress);
  } catch (const TolerableFault& fault) {
    fail("{} (--tolerant takes such interfaces)", fault.what());
  }
}

ResamplingSource source_of_given(InterfaceMesh&& mesh, const Input::Contents& input, Progress& progress) {
  mend(mesh, input.facts.box, input.mending, progress);
  return make_mesh_source(mesh, input.facts.box, input.data.get(), progress);
}

}  // namespace

namespace interfaces {

std::vector<FieldDescription> describe(const std::vector<FieldInfo>& fields) {
  std::vector<FieldDescription> result;
  for (const FieldInfo& field : fields) result.push_back({field.name, field.unit, field.components});
  return result;
}

void check_reconstruction(const ReconstructionOptions& options, const MultiMaterialData& data) {
  if (options.smooth_labels && data.labels.empty())
    wrong_usage("--smooth-labels: expected labels, found volume fractions in {}", data.source);
  if (const std::string option = options.fractions.option(); !option.empty() && !data.labels.empty())
    wrong_usage("{}: expected volume fractions, found labels in {}", option, data.source);
  check_range(options.fractions);
}

void check_reconstruction(const ReconstructionOptions& options, const MeshData& data) {
  if (options.smooth_labels)
    wrong_usage("--smooth-labels: expected labels on a grid as INPUT, found data on a mesh");
  if (const std::string option = options.fractions.option(); !option.empty() && !data.labels.empty())
    wrong_usage("{}: expected volume fractions, found labels in {}", option, data.source);
  check_range(options.fractions);
}

void refuse_reconstruction(const ReconstructionOptions& options) {
  if (options.smooth_labels)
    wrong_usage("--smooth-labels: expected labels on a grid as INPUT, found given interfaces");
  if (const std::string option = options.fractions.option(); !option.empty())
    wrong_usage("{}: expected volume fractions as INPUT, found given interfaces", option);
}

}  // namespace interfaces

std::string FractionOptions::option() const {
  if (blur) return "--blur";
  if (error) return "--fraction-error";
  return keep_dispersed ? "--keep-dispersed" : "";
}

Input::Contents::Contents(std::unique_ptr<MultiMaterialData> taken)
    : data(std::move(taken)),
      facts{data->source, data->grid.domain(), field_infos(*data), data->grid.least_spacing(),
            !data->labels.empty()},
      materials(data->materials.begin(), data->materials.end()),
      fields(describe(facts.fields)) {}

Input::Contents::Contents(std::unique_ptr<MeshData> taken)
    : cells(std::move(taken)),
      facts{cells->source, cells->mesh.box(), field_infos(*cells), 0, !cells->labels.empty()} {
  fields = describe(facts.fields);
  const IdVector<MaterialId, std::string> names = materials_with_outside(*cells);
  materials.assign(names.begin(), names.end());
  facts.voxel = cells->mesh.typical_size();
}

Input::Contents::Contents(InterfaceMesh given, const Box3& domain, const MendingOptions& how,
                          std::unique_ptr<MultiMaterialData> with)
    : data(std::move(with)),
      mesh(std::move(given)),
      mending(how),
      facts{mesh->source, domain, data ? field_infos(*data) : std::vector<FieldInfo>(),
            data ? data->grid.least_spacing() : 0},
      materials(mesh->materials.begin(), mesh->materials.end()),
      fields(describe(facts.fields)) {
  check_lengths(mesh->source, domain);
  check_domain(*mesh, domain);
}

ResamplingSource Input::Contents::source(const ReconstructionOptions& options, Progress& progress) const {
  if (cells) {
    check_reconstruction(options, *cells);
    return make_cells_source(*cells, options.fractions, progress);
  }
  if (!mesh) {
    check_reconstruction(options, *data);
    return make_grid_source(*data, options, progress);
  }
  refuse_reconstruction(options);
  progress.step("checking interfaces", -1);
  check_interface_arrays(*mesh);
  return source_of_given(InterfaceMesh(*mesh), *this, progress);
}

ResamplingSource Input::Contents::take_source(const ReconstructionOptions& options, Progress& progress) {
  if (cells) return source(options, progress);
  if (!mesh) {
    ResamplingSource made = source(options, progress);
    if (data->labels.empty() && data->fields.empty()) {
      integrals = interfaces::material_integrals(*data);
      data->fractions.clear();
    }
    return made;
  }
  refuse_reconstruction(options);
  progress.step("checking interfaces", -1);
  check_interface_arrays(*mesh);
  InterfaceMesh taken = std::move(*mesh);
  mesh.reset();
  return source_of_given(std::move(taken), *this, progress);
}

Input::Input(const GridData& data)
    : contents_(
          std::make_shared<Contents>(std::make_unique<MultiMaterialData>(to_multi_material_data(data)))) {}

Input::Input(OwnedGridData data) : contents_(std::make_shared<Contents>(std::move(data).release())) {}

Input::Input(const InterfaceTriangles& interfaces, const Box3& domain, const MendingOptions& mending,
             const GridData* fields)
    : contents_(std::make_shared<Contents>(
          to_interface_mesh(interfaces, "interfaces"), domain, mending,
          fields == nullptr ? nullptr
                            : std::make_unique<MultiMaterialData>(to_multi_material_data(*fields)))) {}

Input::Input(std::shared_ptr<Contents> contents) : contents_(std::move(contents)) {}

std::shared_ptr<Input::Contents> Input::release() && { return std::move(contents_); }

const std::string& Input::name() const { return contents_->facts.name; }
const Box3& Input::domain() const { return contents_->facts.box; }
const std::vector<std::string>& Input::materials() const { return contents_->materials; }
const std::vector<FieldDescription>& Input::fields() const { return contents_->fields; }
double Input::voxel() const { return contents_->facts.voxel; }
const std::string& Input::source() const {
  if (contents_->mesh) return contents_->mesh->source;
  return contents_->cells ? contents_->cells->source : contents_->data->source;
}
bool Input::has_labels() const { return contents_->facts.has_labels; }
bool Input::has_given_interfaces() const { return contents_->mesh.has_value(); }

}  // namespace adamas
