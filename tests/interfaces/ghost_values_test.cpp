#include <cmath>
#include <cstdio>

#include "datasets/random_numbers.h"
#include "interfaces/mesh/resampled_mesh.h"
#include "tests/interfaces/resampler_scenes.h"

namespace adamas {
namespace {

/// A field of a scene, by its formula, for each material in all of space.
class AnalyticField final : public FieldSource {
 public:
  AnalyticField(const Scene& scene, SceneField field) : scene_(scene), field_(field) {
    info_.push_back({"field", "", 1, 0, 0, 100});
  }
  [[nodiscard]] const std::vector<FieldInfo>& fields() const override { return info_; }
  [[nodiscard]] std::size_t row_size() const override { return 1; }
  void values(MaterialId material, const Vec3& p, std::span<double> row) const override {
    row[0] = scene_.field(field_, material, p);
  }
  void values_and_gradients(MaterialId material, const Vec3& p, std::span<double> row,
                            std::span<Vec3> gradients) const override {
    row[0] = scene_.field(field_, material, p);
    gradients[0] = scene_.field_gradient(field_, material, p);
  }
  [[nodiscard]] const std::vector<NativeElement>& native_elements() const override { return elements_; }
  void native_values(const NativeElement&, std::span<double>) const override {}

 private:
  const Scene& scene_;
  SceneField field_;
  std::vector<FieldInfo> info_;
  std::vector<NativeElement> elements_;
};

/// A scene from meshes with an analytic field, resampled.
struct WithField {
  WithField(const std::string& name, SceneField field, GhostMode mode, double error, double resolution)
      : scene(make_scene(name)),
        mesh(scene_interfaces(scene, resolution)),
        source(make_mesh_source(mesh, scene.box())) {
    source.fields = std::make_shared<AnalyticField>(scene, field);
    ResamplingOptions options;
    options.interface_error = error;
    options.certify = false;
    options.ghost = mode;
    Resampler resampler(source, options);
    resampler.refine();
    result = take_mesh(resampler);
  }
  Scene scene;
  InterfaceMesh mesh;
  ResamplingSource source;
  ResampledMesh result;
};

TEST(GhostValues, LinearFieldsComeBackExactly) {
  for (const std::string name : {"sphere", "tjunction", "plate", "reflex"}) {
    SCOPED_TRACE(name);
    const WithField with(name, SceneField::kLinear, GhostMode::kLinear, 0.08, 1.0 / 10);
    RandomNumbers random(1);
    double worst = 0;
    std::size_t mixed = 0;
    for (std::size_t c = 0; c < with.result.cells.size(); ++c) {
      const Tetrahedron cell(with.result.corners(c));
      CellOwnership ownership;
      with.result.ownership(c, ownership);
      mixed += ownership.pure() ? 0 : 1;
      const Vec3 inside{random.uniform(), random.uniform(), random.uniform()};
      Weights w{inside.x, inside.y, inside.z, 1};
      for (double& x : w) x /= inside.x + inside.y + inside.z + 1;
      for (const auto& candidate : ownership.problem.candidates) {
        const BodyId body(candidate.owner);
        const double value = with.result.value(c, body, 0, w);
        const double truth =
            with.scene.field(SceneField::kLinear, with.result.table.material(body), cell.point(w));
        worst = std::max(worst, std::abs(value - truth));
      }
    }
    EXPECT_GT(mixed, 0u);
    EXPECT_LT(worst, 1e-10);
  }
}

struct AtJump {
  double error = 0;  ///< mean over both sides
  double size = 0;   ///< mean diameter of the cells at the interface
};

/// The one-sided error of the smooth field where the approximation's interface is.
AtJump error_at_jump(GhostMode mode, double error) {
  const WithField with("sphere", SceneField::kSmooth, mode, error, 1.0 / 48);
  AtJump result;
  double count = 0;
  for (std::size_t c = 0; c < with.result.cells.size(); ++c) {
    CellOwnership ownership;
    with.result.ownership(c, ownership);
    if (ownership.pure()) continue;
    std::vector<ContactPolygon> contacts;
    contact_polygons(ownership.problem, contacts);
    const Tetrahedron cell(with.result.corners(c));
    for (const ContactPolygon& contact : contacts) {
      Weights w{};
      for (const auto& corner : contact.corners) {
        for (std::size_t v = 0; v < 4; ++v)
          w[v] += corner.weights[v] / static_cast<double>(contact.corners.size());
      }
      for (const std::uint32_t side : {contact.front, contact.back}) {
        const BodyId body(side);
        const double truth =
            with.scene.field(SceneField::kSmooth, with.result.table.material(body), cell.point(w));
        result.error += std::abs(with.result.value(c, body, 0, w) - truth);
        result.size += cell.diameter();
        count += 1;
      }
    }
  }
  result.error /= count;
  result.size /= count;
  return result;
}

double measured_order(GhostMode mode) {
  // Each step makes the cells at the interface half as large.
  const AtJump coarse = error_at_jump(mode, 0.012), fine = error_at_jump(mode, 0.00075);
  EXPECT_GT(coarse.size / fine.size, 3);
  return std::log(coarse.error / fine.error) / std::log(coarse.size / fine.size);
}

TEST(LongGhostValues, OrderOfTheErrorAtTheJump) {
  const double constant = measured_order(GhostMode::kConstant), linear = measured_order(GhostMode::kLinear);
  std::printf("order of the field's error at the jump: constant %.2f, linear %.2f\n", constant, linear);
  EXPECT_NEAR(constant, 1, 0.25);
  EXPECT_NEAR(linear, 2, 0.35);
}

}  // namespace
}  // namespace adamas
