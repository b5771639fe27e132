#include <cmath>
#include <cstdio>

#include "datasets/random_numbers.h"
#include "interfaces/mesh/resampled_mesh.h"
#include "interfaces/resampling/resampler.h"
#include "tests/interfaces/resampler_scenes.h"

namespace adamas {

using namespace datasets;
using namespace interfaces;

namespace {

constexpr std::array<GhostMode, 3> kModes{GhostMode::kConstant, GhostMode::kLinear, GhostMode::kLeastSquares};
constexpr std::array<const char*, 3> kNames{"constant", "linear", "least-squares"};

/// The true interfaces of a scene, with its fields stated on a grid.
struct GivenScene {
  GivenScene(const std::string& name, double resolution, std::size_t cells)
      : scene(make_scene(name)),
        mesh(scene_interfaces(scene, resolution)),
        data(sample_scene(scene, {cells, cells, cells}, {.depth = 1})),
        source(make_mesh_source(mesh, scene.box(), &data)) {}
  GivenScene(const GivenScene&) = delete;

  Scene scene;
  InterfaceMesh mesh;
  MultiMaterialData data;
  ResamplingSource source;
};

struct WithField {
  WithField(const GivenScene& given, GhostMode mode, double error) : scene(given.scene) {
    ResamplingOptions options;
    options.interface_error = error;
    options.certify = false;
    options.ghost = mode;
    Resampler resampler(given.source, options);
    resampler.refine();
    result = resampled_mesh(resampler);
  }
  WithField(const WithField&) = delete;

  [[nodiscard]] std::size_t offset(SceneField field) const {
    const auto& all = result.fields;
    const char* name = field == SceneField::kLinear ? "linear" : "smooth";
    const auto found = std::find_if(all.begin(), all.end(), [&](const auto& f) { return f.name == name; });
    return found->offset;
  }
  /// Returns the difference between the mesh's field and the scene's in a body, at a point of a cell.
  [[nodiscard]] double error(SceneField field, std::size_t cell, BodyId body, const Weights& w) const {
    const Vec3 p = Tetrahedron(result.corners(cell)).point(w);
    const double truth = scene.field(field, result.table.material(body), p);
    return std::abs(result.value(cell, body, offset(field), w) - truth);
  }

  const Scene& scene;
  ResampledMesh result;
};

/// Returns the greatest error of the linear field, at a random point of each cell and for each body that the
/// cell knows.
double linear_field_error(const GivenScene& given, GhostMode mode) {
  const WithField with(given, mode, 0.08);
  RandomNumbers random(1);
  double worst = 0;
  std::size_t mixed = 0;
  for (std::size_t c = 0; c < with.result.cells.size(); ++c) {
    CellOwnership ownership;
    with.result.ownership(c, ownership);
    mixed += ownership.pure() ? 0 : 1;
    const Vec3 inside{random.uniform(), random.uniform(), random.uniform()};
    Weights w{inside.x, inside.y, inside.z, 1};
    for (double& x : w) x /= inside.x + inside.y + inside.z + 1;
    for (const auto& candidate : ownership.problem.candidates)
      worst = std::max(worst, with.error(SceneField::kLinear, c, BodyId(candidate.owner), w));
  }
  EXPECT_GT(mixed, 0u);
  return worst;
}

TEST(GhostValues, LinearFieldsComeBackExactly) {
  for (const std::string name : {"sphere", "tjunction", "plate", "reflex"}) {
    SCOPED_TRACE(name);
    const GivenScene given(name, 1.0 / 10, 20);
    // Values are stated as floats, whose rounding errors grow in cells that are larger than the grid's.
    EXPECT_LT(linear_field_error(given, GhostMode::kLinear), 1e-4);
    EXPECT_LT(linear_field_error(given, GhostMode::kLeastSquares), 1e-4);
    EXPECT_GT(linear_field_error(given, GhostMode::kConstant), 1e-2);
  }
}

struct AtJump {
  double error = 0;  ///< mean over both sides
  double size = 0;   ///< mean diameter of the cells at the interface
};

/// Returns the one-sided error of the smooth field at the interface of the approximation.
AtJump error_at_jump(const GivenScene& given, GhostMode mode, double error) {
  const WithField with(given, mode, error);
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
        result.error += with.error(SceneField::kSmooth, c, BodyId(side), w);
        result.size += cell.diameter();
        count += 1;
      }
    }
  }
  result.error /= count;
  result.size /= count;
  return result;
}

/// Prints the table of docs/method.md and returns the order between the coarsest and the finest mesh.
double measured_order(const GivenScene& given, std::size_t mode) {
  std::vector<AtJump> steps;
  std::printf("%s\n", kNames[mode]);
  // Each step halves the size of the cells at the interface.
  for (const double error : {0.012, 0.003, 0.0012}) {
    steps.push_back(error_at_jump(given, kModes[mode], error));
    std::printf("  cells %.4f  error %.3g\n", steps.back().size, steps.back().error);
  }
  const AtJump &coarse = steps.front(), &fine = steps.back();
  EXPECT_GT(coarse.size / fine.size, 3);
  return std::log(coarse.error / fine.error) / std::log(coarse.size / fine.size);
}

TEST(LongGhostValues, OrderOfTheErrorAtTheJump) {
  const GivenScene given("sphere", 1.0 / 32, 64);
  EXPECT_NEAR(measured_order(given, 0), 1, 0.25);
  EXPECT_NEAR(measured_order(given, 1), 2, 0.35);
  EXPECT_NEAR(measured_order(given, 2), 2, 0.35);
}

}  // namespace
}  // namespace adamas
