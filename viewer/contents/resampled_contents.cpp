#include <cmath>
#include <limits>
#include <utility>

#include "core/base/assert.h"
#include "core/geometry/tetrahedron.h"
#include "interfaces/cross_section/cross_section.h"
#include "interfaces/cross_section/field_choice.h"
#include "interfaces/mesh/interface_extraction.h"
#include "interfaces/probe/cell_locator.h"
#include "viewer/contents/interface_places.h"
#include "viewer/contents/material_contents.h"
#include "viewer/contents/mesh_maker.h"
#include "viewer/contents/pair_surfaces.h"
#include "viewer/contents/section_meshes.h"

namespace adamas::viewer {

using namespace interfaces;
using namespace isosurface;

namespace {

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

/// The least and the greatest of the finite numbers that were added.
class Range {
 public:
  void add(double value) {
    if (!std::isfinite(value)) return;
    range_.first = range_.first <= value ? range_.first : value;
    range_.second = range_.second >= value ? range_.second : value;
  }
  [[nodiscard]] const std::pair<double, double>& ends() const { return range_; }

 private:
  std::pair<double, double> range_{kNothing, kNothing};
};

class ResampledContents final : public MaterialContents {
 public:
  ResampledContents(ResampledMesh mesh, Progress& progress)
      : mesh_(std::move(mesh)),
        locator_(mesh_),
        interfaces_(approximated_interfaces(mesh_, progress)),
        surfaces_(pair_surfaces(interfaces_.mesh)) {
    for (std::size_t f = 0; f < mesh_.fields.size(); ++f) {
      const FieldInfo& field = mesh_.fields[f];
      add_choice(field.name, {f, std::nullopt});
      for (int c = 0; field.components > 1 && c < field.components; ++c)
        add_choice(field.name + ":" + std::to_string(c), {f, static_cast<std::size_t>(c)});
    }
    if (choices_.empty()) return;
    progress.step("finding values on interfaces", -1);
    places_ = interface_places(mesh_, locator_, interfaces_, surfaces_);
    for (const FieldChoice& each : choices_) ranges_.push_back(find_range(each));
  }

  [[nodiscard]] const std::vector<std::string>& materials() const override { return mesh_.materials; }
  [[nodiscard]] const std::vector<std::string>& fields() const override { return names_; }
  [[nodiscard]] Box3 box() const override { return mesh_.box; }
  [[nodiscard]] std::string summary() const override {
    return counted(mesh_.cells.size(), "tetrahedron", "tetrahedra") + ", " +
           counted(mesh_.points.size(), "point", "points") + ", " +
           counted(mesh_.materials.size(), "material", "materials");
  }
  [[nodiscard]] std::pair<double, double> field_range(std::size_t field) const override {
    ADAMAS_ASSERT(field < ranges_.size());
    return ranges_[field];
  }
  [[nodiscard]] std::vector<Interface> interfaces(std::optional<std::size_t> field) const override;
  [[nodiscard]] Section section(const Plane& plane, std::optional<std::size_t> field) const override;
  [[nodiscard]] Reading at(const Vec3& p, std::optional<std::size_t> field) const override;

 private:
  void add_choice(std::string name, const FieldChoice& choice) {
    names_.push_back(std::move(name));
    choices_.push_back(choice);
  }
  [[nodiscard]] const FieldChoice& choice(std::size_t field) const {
    ADAMAS_ASSERT(field < choices_.size());
    return choices_[field];
  }
  /// The chosen number of a body's field.
  [[nodiscard]] double value(std::size_t cell, BodyId body, const Weights& weights,
                             const FieldChoice& chosen) const;
  /// The value on a side of an interface at one of its points.
  [[nodiscard]] double value(const InterfacePlace::Side& side, const Vec3& p,
                             const FieldChoice& chosen) const {
    if (side.cell == InterfacePlace::kNoCell) return kNothing;
    return value(side.cell, side.body, Tetrahedron(mesh_.corners(side.cell)).weights(p), chosen);
  }
  [[nodiscard]] std::pair<double, double> find_range(const FieldChoice& chosen) const;
  [[nodiscard]] SharedMesh drawn(std::size_t surface, std::optional<std::size_t> field) const;

  ResampledMesh mesh_;
  CellLocator locator_;
  ExtractedInterfaces interfaces_;
  std::vector<PairSurface> surfaces_;
  std::vector<std::string> names_;
  std::vector<FieldChoice> choices_;
  /// Places of the surfaces' vertices; empty without fields.
  std::vector<std::vector<InterfacePlace>> places_;
  std::vector<std::pair<double, double>> ranges_;  ///< ranges of the choices
};

double ResampledContents::value(std::size_t cell, BodyId body, const Weights& weights,
                                const FieldChoice& chosen) const {
  const FieldInfo& info = mesh_.fields[chosen.field];
  if (chosen.component) return mesh_.value(cell, body, info.offset + *chosen.component, weights);
  std::vector<double> components;
  for (std::size_t c = 0; c < static_cast<std::size_t>(info.components); ++c)
    components.push_back(mesh_.value(cell, body, info.offset + c, weights));
  return chosen.scalar(components);
}

// Fields are linear in the parts of cells, whose corners are the mesh's vertices and those of the interfaces.
std::pair<double, double> ResampledContents::find_range(const FieldChoice& chosen) const {
  const FieldInfo& info = mesh_.fields[chosen.field];
  Range range;
  for (const VertexRecord& vertex : mesh_.vertices) {
    const auto row = vertex.row(vertex.distances.body);
    range.add(chosen.scalar(row.subspan(info.offset, static_cast<std::size_t>(info.components))));
  }
  for (std::size_t s = 0; s < surfaces_.size(); ++s) {
    for (std::size_t v = 0; v < places_[s].size(); ++v) {
      const Vec3& p = interfaces_.mesh.points[surfaces_[s].vertices[v].point];
      for (const InterfacePlace::Side& side : places_[s][v].sides) range.add(value(side, p, chosen));
    }
  }
  return range.ends();
}

SharedMesh ResampledContents::drawn(std::size_t surface, std::optional<std::size_t> field) const {
  MeshMaker maker(mesh_.box.center(), MeshMaker::Kind::kTriangles);
  const PairSurface& shown = surfaces_[surface];
  for (std::size_t v = 0; v < shown.vertices.size(); ++v) {
    const Vec3& p = interfaces_.mesh.points[shown.vertices[v].point];
    MeshMaker::Values values;
    if (field) {
      const auto& [front, back] = places_[surface][v].sides;
      // From the front one sees what is behind the interface.
      values = {value(back, p, choice(*field)), value(front, p, choice(*field))};
    }
    maker.add_vertex(p, shown.vertices[v].normal, values);
  }
  for (const std::uint32_t vertex : shown.indices) maker.add_index(vertex);
  return maker.finish();
}

std::vector<MaterialContents::Interface> ResampledContents::interfaces(
    std::optional<std::size_t> field) const {
  std::vector<Interface> result;
  for (std::size_t s = 0; s < surfaces_.size(); ++s) {
    const PairSurface& surface = surfaces_[s];
    result.push_back({surface.front.value, surface.back.value, drawn(s, field), surface.area});
  }
  return result;
}

MaterialContents::Section ResampledContents::section(const Plane& plane,
                                                     std::optional<std::size_t> field) const {
  if (!cuts(plane, mesh_.box)) return {std::vector<SharedMesh>(mesh_.materials.size()), {}, {}};
  std::optional<FieldChoice> chosen;
  if (field) chosen = choice(*field);
  return section_meshes(cross_section(mesh_, plane, chosen), plane, mesh_.box.center());
}

MaterialContents::Reading ResampledContents::at(const Vec3& p, std::optional<std::size_t> field) const {
  Reading reading;
  const auto found = locator_.locate(p);
  if (!found) return reading;
  CellOwnership ownership;
  mesh_.ownership(found->cell, ownership);
  const BodyId body(ownership.pure() ? ownership.problem.candidates[0].owner
                                     : ownership.problem.owner(found->weights));
  reading.material = mesh_.table.material(body).value;
  reading.interface_error = mesh_.cells[found->cell].interface_error;
  if (!field) return reading;
  reading.value = value(found->cell, body, found->weights, choice(*field));
  reading.field_error = mesh_.field_errors[choice(*field).field][found->cell];
  return reading;
}

}  // namespace

std::unique_ptr<MaterialContents> make_resampled_contents(ResampledMesh mesh, Progress& progress) {
  return std::make_unique<ResampledContents>(std::move(mesh), progress);
}

}  // namespace adamas::viewer
