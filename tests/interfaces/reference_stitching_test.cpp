#include <cmath>
#include <numbers>
#include <random>

#include "interfaces/comparison/box_stitching.h"
#include "interfaces/reference_client/program_messages.h"
#include "tests/interfaces/complex_volumes.h"
#include "tests/interfaces/resampler_scenes.h"
#include "tests/support/scratch.h"

namespace adamas {

using namespace datasets;
using namespace interfaces;

namespace {

using test::error_of;
using test::says;

BodyId nobody(const Vec3&) { return BodyId(0); }

/// A scene's true interfaces, or those of its resampled mesh, stitched to its box.
struct Stitched {
  explicit Stitched(const test::ResampledScene& resampled, bool extracted) {
    std::vector<BodyTriangle> triangles;
    std::vector<Vec3> points;
    if (extracted) {
      const auto found = resampled.extracted();
      points = found.mesh.points;
      for (std::size_t t = 0; t < found.bodies.size(); ++t)
        triangles.push_back({found.mesh.triangles[t].points, found.bodies[t][0], found.bodies[t][1]});
    } else {
      const InterfaceNetwork& network = *resampled.source.network;
      points.assign(network.points().begin(), network.points().end());
      for (std::uint32_t t = 0; t < network.triangles().size(); ++t) {
        const auto& interface = network.interface(network.interface_of(t));
        triangles.push_back({network.triangles()[t], interface.a, interface.b});
      }
    }
    complex = stitch_to_box(
        "scene", points, triangles, resampled.source.box, 1e-10,
        [&](const Vec3& p) { return resampled.source.body_at(p, nullptr); }, ADAMAS_REFERENCE_PROGRAM);
  }
  PiecewiseLinearComplex complex;
};

/// Returns how often the boundary of a body winds round a point, from the solid angles of its triangles (van
/// Oosterom and Strackee 1983).
double winding_number(const PiecewiseLinearComplex& complex, BodyId body, const Vec3& p) {
  double angle = 0;
  for (const auto& t : complex.triangles) {
    const auto& patch = complex.patches[t.patch];
    if (patch.front != body && patch.back != body) continue;
    const Vec3 a = complex.points[t.points[0]] - p, b = complex.points[t.points[1]] - p,
               c = complex.points[t.points[2]] - p;
    const double up = dot(a, cross(b, c));
    const double down =
        norm(a) * norm(b) * norm(c) + dot(a, b) * norm(c) + dot(b, c) * norm(a) + dot(c, a) * norm(b);
    angle += (patch.back == body ? 2 : -2) * std::atan2(up, down);
  }
  return angle / (4 * std::numbers::pi);
}

class StitchedScenes : public ::testing::TestWithParam<std::tuple<std::string, bool>> {};

TEST_P(StitchedScenes, AreClosedAndEncloseTheBodies) {
  const auto& [name, extracted] = GetParam();
  test::SceneCase c;
  c.name = name;
  c.meshes = true;
  c.options.interface_error = 0.12;
  const test::ResampledScene resampled(c);
  const PiecewiseLinearComplex complex = Stitched(resampled, extracted).complex;
  ASSERT_NO_THROW(complex.check_closed());
  const std::size_t bodies = resampled.table().body_count();
  const auto enclosed = enclosed_volumes(complex, bodies);
  double sum = 0;
  for (const double volume : enclosed) sum += volume;
  EXPECT_NEAR(sum, resampled.source.box.volume(), 1e-12);
  if (extracted) {
    const auto known = body_volumes(resampled.table(), resampled.resampler->cells());
    for (BodyId b(0); b.value < bodies; ++b.value) EXPECT_NEAR(enclosed[b], known[b], 1e-9);
    return;
  }
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> uniform(0.01, 0.99);
  for (int i = 0; i < 60; ++i) {
    const Vec3 p{uniform(random), uniform(random), uniform(random)};
    const BodyId owner = resampled.source.body_at(p, nullptr);
    for (BodyId b(0); b.value < bodies; ++b.value)
      EXPECT_NEAR(winding_number(complex, b, p), b == owner ? 1 : 0, 1e-6) << "body " << b.value;
  }
  if (!resampled.scene.planar()) return;
  IdVector<MaterialId, double> volumes(resampled.source.materials.size(), 0.0);
  for (BodyId b(0); b.value < bodies; ++b.value) volumes[resampled.table().material(b)] += enclosed[b];
  for (MaterialId m(0); m.value < volumes.size(); ++m.value)
    EXPECT_NEAR(volumes[m], resampled.scene.volume(m), 1e-9);
}

INSTANTIATE_TEST_SUITE_P(Reference, StitchedScenes,
                         ::testing::Combine(::testing::Values("sphere", "tjunction", "voronoi10", "plate",
                                                              "reflex"),
                                            ::testing::Bool()));

struct Sheets {
  std::vector<Vec3> points;
  std::vector<BodyTriangle> triangles;
  void add(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, std::uint32_t front,
           std::uint32_t back) {
    const auto first = static_cast<std::uint32_t>(points.size());
    points.insert(points.end(), {a, b, c, d});
    triangles.push_back({{first, first + 1, first + 2}, BodyId(front), BodyId(back)});
    triangles.push_back({{first, first + 2, first + 3}, BodyId(front), BodyId(back)});
  }
  PiecewiseLinearComplex stitch() const {
    return stitch_to_box("sheets", points, triangles, {{0, 0, 0}, {1, 1, 1}}, 1e-9, nobody,
                         ADAMAS_REFERENCE_PROGRAM);
  }
};

TEST(Stitching, LeavesOutWhatLiesInASideOfTheBox) {
  Sheets sheets;
  // The first sheet faces upwards, with body 1 above and 0 below. The second one is a lid on the bottom,
  // between body 0 and the outside.
  sheets.add({0, 0, 0.3}, {1, 0, 0.3}, {1, 1, 0.3}, {0, 1, 0.3}, 1, 0);
  sheets.add({0, 0, 1e-12}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, 0, 2);
  const auto complex = sheets.stitch();
  const auto volumes = enclosed_volumes(complex, 3);
  EXPECT_NEAR(volumes[BodyId(0)], 0.3, 1e-15);
  EXPECT_NEAR(volumes[BodyId(1)], 0.7, 1e-15);
  EXPECT_EQ(volumes[BodyId(2)], 0);
}

TEST(Stitching, KnowsAWedgeThatTouchesASideAlongAnEdge) {
  Sheets sheets;
  // The lowest edge of a trough lies in the bottom; body 1 is inside the trough.
  sheets.add({0, 0.5, 0}, {1, 0.5, 0}, {1, 0.2, 1}, {0, 0.2, 1}, 0, 1);
  sheets.add({1, 0.5, 0}, {0, 0.5, 0}, {0, 0.8, 1}, {1, 0.8, 1}, 0, 1);
  const auto volumes = enclosed_volumes(sheets.stitch(), 2);
  EXPECT_NEAR(volumes[BodyId(1)], 0.3, 1e-15);
  EXPECT_NEAR(volumes[BodyId(0)], 0.7, 1e-15);
}

TEST(Stitching, RefusesWhatIsNoComplex) {
  Sheets open;
  open.add({0, 0, 0.3}, {0.5, 0, 0.3}, {0.5, 1, 0.3}, {0, 1, 0.3}, 1, 0);
  EXPECT_TRUE(says(error_of([&] { open.stitch(); }), "sheets: expected interfaces that close"));
  Sheets beyond;
  beyond.add({0, 0, 0.3}, {2, 0, 0.3}, {2, 1, 0.3}, {0, 1, 0.3}, 1, 0);
  EXPECT_TRUE(says(error_of([&] { beyond.stitch(); }), "within the box"));
  Sheets crossing;
  crossing.add({0, 0, 0.3}, {1, 0, 0.6}, {1, 1, 0.6}, {0, 1, 0.3}, 1, 0);
  crossing.add({0, 0, 0.6}, {1, 0, 0.3}, {1, 1, 0.3}, {0, 1, 0.6}, 1, 0);
  EXPECT_TRUE(says(error_of([&] { crossing.stitch(); }), "sheets: expected interfaces that do not cross"));
}

TEST(Stitching, BelievesNoProgramThatFails) {
  const auto stitch = [](const std::filesystem::path& program) {
    return error_of([&] { stitch_to_box("box", {}, {}, {{0, 0, 0}, {1, 1, 1}}, 1e-9, nobody, program); });
  };
  const test::Scratch scratch;
  EXPECT_EQ(stitch(scratch / "none"), "could not be started");
  const auto answers = [&](const PlanarReply& reply) {
    const auto bytes = encode(reply);
    test::put_bytes(scratch / "reply", {bytes.begin(), bytes.end()});
    test::put_bytes(scratch / "program", "#!/bin/sh\ncat " + (scratch / "reply").string() + "\n");
    std::filesystem::permissions(scratch / "program", std::filesystem::perms::owner_all);
    return stitch(scratch / "program");
  };
  PlanarReply reply;
  EXPECT_TRUE(says(answers(reply), "not there"));
  reply.triangle_ends = {0, 0, 0, 0, 0, 1};
  EXPECT_TRUE(says(answers(reply), "not there"));
  reply.triangles = {{0, 1, 24}};
  EXPECT_TRUE(says(answers(reply), "not there"));
  // This message can be read, but its triangles leave the box open.
  reply.triangles = {{0, 1, 2}};
  EXPECT_TRUE(says(answers(reply), "box: expected interfaces that close"));
}

TEST(Stitching, AsksForTheBodyWhereNothingEndsAtTheBox) {
  const PiecewiseLinearComplex complex = stitch_to_box(
      "box", {}, {}, {{0, 0, 0}, {1, 2, 3}}, 1e-9, [](const Vec3&) { return BodyId(4); },
      ADAMAS_REFERENCE_PROGRAM);
  EXPECT_EQ(complex.triangles.size(), 12u);
  EXPECT_NEAR(enclosed_volumes(complex, 5)[BodyId(4)], 6, 1e-14);
}

}  // namespace
}  // namespace adamas
