#include <cmath>

#include "interfaces/mesh/resampled_mesh.h"
#include "interfaces/reference/element_errors.h"
#include "tests/interfaces/resampler_scenes.h"
#include "tests/support/ownership_problems.h"

namespace adamas {
namespace {

/// Errors at the native elements, from the mesh alone: of one field, by looking at every cell.
class Remeasured {
 public:
  Remeasured(const test::ResampledScene& resampled, const ResampledMesh& mesh)
      : source_(resampled.source), mesh_(mesh) {
    for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
      frames_.emplace_back(mesh.corners(c));
      owners_.emplace_back();
      mesh.ownership(c, owners_.back());
    }
  }

  /// Greatest error over elements whose place belongs to their own material, and the others.
  void measure(std::vector<double>& greatest, std::vector<std::size_t>& others) const {
    std::vector<double> native(source_.fields->row_size());
    greatest.assign(mesh_.fields.size(), 0);
    others.clear();
    for (std::size_t e = 0; e < source_.fields->native_elements().size(); ++e) {
      const NativeElement& element = source_.fields->native_elements()[e];
      source_.fields->native_values(element, native);
      const std::size_t cell = find(element.position);
      const Weights w = frames_[cell].weights(element.position);
      const auto& problem = owners_[cell].problem;
      const BodyId body(owners_[cell].pure() ? problem.candidates[0].owner
                                             : test::brute_owner(problem, w, 0).owner);
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
  [[nodiscard]] std::size_t find(const Vec3& p) const {
    std::size_t best = 0;
    double inside = -1e300;
    for (std::size_t c = 0; c < frames_.size(); ++c) {
      const Weights w = frames_[c].weights(p);
      const double least = std::min({w[0], w[1], w[2], w[3]});
      if (least > inside) inside = least, best = c;
    }
    return best;
  }

  const ResamplingSource& source_;
  const ResampledMesh& mesh_;
  std::vector<Tetrahedron> frames_;
  std::vector<CellOwnership> owners_;
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
  const ResampledMesh mesh = take_mesh(*resampled.resampler);
  std::vector<double> measured;
  std::vector<std::size_t> displaced;
  Remeasured(resampled, mesh).measure(measured, displaced);
  // What the others have is another test's: DisplacedElements.
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
