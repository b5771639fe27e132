#include <cmath>

#include "interfaces/comparison/element_errors.h"
#include "interfaces/mesh/resampled_mesh.h"
#include "interfaces/resampling/resampler.h"
#include "tests/interfaces/mesh_cells.h"
#include "tests/interfaces/resampler_scenes.h"

namespace adamas {

using namespace interfaces;

namespace {

/// Errors of fields at the native elements, found from the mesh alone by a search of all cells.
class Remeasured {
 public:
  Remeasured(const test::ResampledScene& resampled, const ResampledMesh& mesh)
      : source_(resampled.source), mesh_(mesh), cells_(mesh) {}

  /// Finds, for each field, the greatest error over elements whose place belongs to their own material, and
  /// lists the other elements.
  void measure(std::vector<double>& greatest, std::vector<std::size_t>& others) const {
    std::vector<double> native(source_.fields->row_size());
    greatest.assign(mesh_.fields.size(), 0);
    others.clear();
    for (std::size_t e = 0; e < source_.fields->native_elements().size(); ++e) {
      const NativeElement& element = source_.fields->native_elements()[e];
      source_.fields->native_values(element, native);
      const std::size_t cell = cells_.find(element.position);
      const Weights w = cells_.frames[cell].weights(element.position);
      const BodyId body = cells_.owner(cell, w);
      if (mesh_.table.material(body) != element.material) {
        others.push_back(e);
        continue;
      }
      for (std::size_t f = 0; f < mesh_.fields.size(); ++f) {
        const std::size_t at = mesh_.fields[f].offset;
        if (std::isnan(native[at])) continue;
        greatest[f] = std::max(greatest[f], std::abs(mesh_.value(cell, body, at, w) - native[at]));
      }
    }
  }

 private:
  const ResamplingSource& source_;
  const ResampledMesh& mesh_;
  const test::MeshCells cells_;
};

void expect_honest(const std::string& name, bool meshes, double interface_error, double field_error) {
  SCOPED_TRACE(name + (meshes ? " from meshes" : " from fractions"));
  test::SceneCase c;
  c.name = name;
  c.meshes = meshes;
  c.fields = true;
  c.options.interface_error = interface_error;
  c.options.certify = false;
  c.options.field_errors.resize(6);
  c.options.field_errors[2] = field_error;
  test::ResampledScene resampled(c);
  const ResampledMesh mesh = resampled_mesh(*resampled.resampler);
  std::vector<double> measured;
  std::vector<std::size_t> displaced;
  Remeasured(resampled, mesh).measure(measured, displaced);
  // The other elements are the subject of the DisplacedElements tests.
  const ElementErrors errors =
      measure_element_errors(resampled.source, measured_cells(mesh), c.options.interface_error);
  std::size_t own_places = 0;
  for (std::size_t f = 0; f < mesh.fields.size(); ++f) {
    const double reported = *std::max_element(mesh.field_errors[f].begin(), mesh.field_errors[f].end());
    EXPECT_GE(reported, measured[f] * (1 - 1e-9) - 1e-12) << mesh.fields[f].name;
    if (measured[f] > 1e-5) {
      double greatest = measured[f];
      for (const std::size_t e : displaced)
        greatest = std::max(greatest, errors.errors[e * errors.fields + f].max);
      EXPECT_LE(reported, 1.5 * greatest) << mesh.fields[f].name;
    }
  }
  for (const std::size_t e : displaced)
    own_places += resampled.source.fields->native_elements()[e].kind != ElementKind::kMinority ? 1 : 0;
  EXPECT_LE(measured[2], field_error);
  EXPECT_LT(own_places, resampled.data.grid.site_count() / 4);
}

TEST(FieldErrors, AreThoseMeasuredAtEveryNativeElement) {
  expect_honest("sphere", false, 0.05, 0.5);
  expect_honest("tjunction", true, 0.05, 0.5);
  expect_honest("plate", true, 0.05, 0.7);
  expect_honest("reflex", false, 0.1, 0.5);
}

}  // namespace
}  // namespace adamas
