// Tests cross sections of stores as parts of a picture.

#include "viewer/contents/store_section.h"

#include <gtest/gtest.h>

#include <cmath>

#include "ball_store.h"
#include "core/geometry/plane.h"
#include "tests/support/scratch.h"
#include "viewer/contents/plane_mesh.h"
#include "viewer/session/view_session.h"

namespace adamas {

using namespace isosurface;
using namespace picture;
using namespace viewer;

namespace {

Vec3 place_of(const DrawnMesh& mesh, std::size_t vertex) {
  const auto& p = mesh.vertices[vertex].place;
  return mesh.origin + Vec3{p[0], p[1], p[2]};
}

double area_of(const DrawnMesh& mesh) {
  double area = 0;
  for (std::size_t t = 0; t + 2 < mesh.indices.size(); t += 3) {
    const Vec3 a = place_of(mesh, mesh.indices[t]), b = place_of(mesh, mesh.indices[t + 1]),
               c = place_of(mesh, mesh.indices[t + 2]);
    area += 0.5 * norm(cross(b - a, c - a));
  }
  return area;
}

TEST(PlaneMesh, FillsThePolygonOnceWithTheValuesOfItsPlaces) {
  const Box3 box{{-1, 2, 0.5}, {3, 5, 2.25}};
  const auto value = [](const Vec3& p) { return 3 * p.x - p.y + 2 * p.z; };
  for (const Vec3& normal : {Vec3{1, 0, 0}, {0, -2, 0}, {0, 0, 1}, {1, 2, -0.5}, {-1, 0.1, 3}}) {
    const std::vector<Vec3> polygon = clip_plane({box.center(), normal}, box);
    for (const double step : {0.07, 0.5, 10.0}) {
      const SharedMesh mesh = plane_mesh(polygon, normal, step, value);
      ASSERT_TRUE(mesh);
      EXPECT_NEAR(area_of(*mesh), polygon_area(polygon), 1e-5);
      for (std::size_t n = 0; n < mesh->vertices.size(); ++n) {
        const Vec3 p = place_of(*mesh, n);
        EXPECT_NEAR(dot(p - box.center(), normalized(normal)), 0, 1e-5);
        EXPECT_NEAR(mesh->vertices[n].front_value, value(p), 1e-4);
        EXPECT_EQ(mesh->vertices[n].front_value, mesh->vertices[n].back_value);
      }
      for (const std::uint32_t n : mesh->indices) ASSERT_LT(n, mesh->vertices.size());
    }
  }
  EXPECT_FALSE(plane_mesh({}, {1, 0, 0}, 1, value));
}

/// A session on a ball whose value is 200 in the middle, (16, 16, 16), and falls by 10 for each unit of
/// length.
class StoreSections : public testing::Test {
 protected:
  void SetUp() override {
    test::make_ball_store(folder / "ball.adm");
    open(session, "ball.adm");
  }
  void open(ViewSession& where, const std::string& name, const std::string& colours = "") const {
    DocumentOptions options;
    if (!colours.empty()) options.colour_by = (folder / colours).string();
    where.open((folder / name).string(), options, SilentProgress::instance());
    where.state().has_box = false;
    where.state().documents[0].surfaces[0].isovalue = 100;
    where.state().cut.is_on = true;
  }
  /// Returns the flat part that is not made of lines; null where there is none.
  static const DrawnPart* section_of(const std::vector<DrawnPart>& parts) {
    for (const DrawnPart& part : parts) {
      if (part.style.is_flat && !part.mesh->is_lines) return &part;
    }
    return nullptr;
  }
  /// Returns the greatest difference from the ball's own value at the vertices.
  static double worst_of(const DrawnMesh& mesh, const Vec3& middle) {
    double worst = 0;
    for (std::size_t n = 0; n < mesh.vertices.size(); ++n) {
      const double expected = std::max(0.0, 200 - 10 * distance(place_of(mesh, n), middle));
      worst = std::max(worst, std::abs(expected - static_cast<double>(mesh.vertices[n].front_value)));
    }
    return worst;
  }

  test::Scratch folder;
  ViewSession session{640, 480};
};

TEST_F(StoreSections, ShowTheValuesOfTheSamples) {
  for (const Plane& plane :
       {Plane{{16, 9, 16}, {0, 1, 0}}, {{16, 16, 16}, {1, 2, 3}}, {{5, 5, 5}, {-1, -1, -1}}}) {
    session.state().cut.plane = plane;
    session.finish();
    const auto parts = session.parts();
    const DrawnPart* const section = section_of(parts);
    ASSERT_TRUE(section);
    EXPECT_TRUE(section->style.is_coloured_by_value);
    EXPECT_FALSE(section->style.is_clipped);
    EXPECT_EQ(section->style.high, 200);
    EXPECT_NEAR(area_of(*section->mesh), polygon_area(clip_plane(plane, session.box())), 1e-3);
    // Between samples, which are whole numbers, the tip of the cone is blunt.
    EXPECT_LT(worst_of(*section->mesh, {16, 16, 16}), 3.5);
  }
  const auto field = session.shown_field();
  ASSERT_TRUE(field);
  EXPECT_EQ(field->name, "value");
  EXPECT_EQ(field->range, (std::array<double, 2>{0, 200}));
  session.state().documents[0].range = {{50, 60}};
  EXPECT_EQ(section_of(session.parts())->style.low, 50);
  session.state().cut.shows_section = false;
  EXPECT_FALSE(section_of(session.parts()));
  EXPECT_FALSE(session.shown_field());
  session.state().cut = {true, {{16, 90, 16}, {0, 1, 0}}};
  session.finish();
  EXPECT_FALSE(section_of(session.parts())) << "the plane lies outside";
}

TEST_F(StoreSections, AreAsFineAsThePictureShows) {
  session.state().cut.plane = {{16, 16, 16}, {0, 1, 0}};
  session.act(Action::kViewFront);
  const Viewpoint first = session.state().viewpoint;
  std::size_t before = 1'000'000;
  for (const double farther : {1.0, 40.0, 400.0}) {
    session.state().viewpoint.eye = first.target + farther * (first.eye - first.target);
    session.finish();
    const auto parts = session.parts();
    const DrawnPart* const section = section_of(parts);
    ASSERT_TRUE(section);
    EXPECT_LT(section->mesh->vertices.size(), before);
    before = section->mesh->vertices.size();
    EXPECT_NEAR(area_of(*section->mesh), 32 * 32, 1e-2);
  }
  EXPECT_LT(before, 200u);
}

TEST_F(StoreSections, ComeToTheLastPlaneAndNothingIsMadeAnewForIt) {
  for (int n = 0; n < 200; ++n) {
    session.state().cut.plane = {{16, 1 + 0.15 * n, 16}, {0.01 * n, 1, 0}};
    session.parts();
    if (n % 20 != 19) continue;
    session.finish();
    EXPECT_TRUE(session.report().is_current);
    const SharedMesh mesh = section_of(session.parts())->mesh;
    EXPECT_LT(worst_of(*mesh, {16, 16, 16}), 3.5);
    EXPECT_NEAR(dot(place_of(*mesh, 0) - session.state().cut.plane.origin,
                    normalized(session.state().cut.plane.normal)),
                0, 1e-4);
    // The eye moves so little that the same detail will do.
    session.state().viewpoint.eye += Vec3{1e-3, 0, 0};
    session.finish();
    EXPECT_EQ(section_of(session.parts())->mesh, mesh);
  }
}

TEST_F(StoreSections, ShowTheEdgesOfTheMeshsCells) {
  session.state().cut.plane = {{16, 16, 16}, {0, 1, 0}};
  const auto lines = [&]() -> SharedMesh {
    session.finish();
    for (const DrawnPart& part : session.parts()) {
      if (part.mesh->is_lines) return part.mesh;
    }
    return nullptr;
  };
  EXPECT_FALSE(lines());
  session.state().has_edges = true;
  const SharedMesh fine = lines();
  ASSERT_TRUE(fine);
  for (std::size_t n = 0; n < fine->vertices.size(); ++n) EXPECT_NEAR(place_of(*fine, n).y, 16, 1e-5);
  session.state().pixels = 30;
  EXPECT_LT(lines()->indices.size(), fine->indices.size() / 2);
  session.state().cut.shows_section = false;
  EXPECT_FALSE(lines());
}

TEST_F(StoreSections, OfObliqueGridsLieInSpace) {
  VolumeGrid grid;
  grid.origin = {100, 0, 0};
  const double h = std::sqrt(0.5);
  grid.directions = {{{h, h, 0}, {-h, h, 0}, {0, 0, -1}}};
  test::make_ball_store(folder / "turned.adm", grid);
  ViewSession turned(320, 240);
  open(turned, "turned.adm");
  const Vec3 middle{100, 32 * h, -16};
  turned.state().cut.plane = {middle, {0, 0, 1}};
  turned.finish();
  const auto parts = turned.parts();
  ASSERT_TRUE(section_of(parts));
  EXPECT_NEAR(area_of(*section_of(parts)->mesh), 32 * 32, 1e-2);
  EXPECT_LT(worst_of(*section_of(parts)->mesh, middle), 3.5);
}

TEST_F(StoreSections, ShowTheVolumeThatColours) {
  VolumeGrid grid;
  grid.origin = {4, 0, 0};
  test::make_ball_store(folder / "moved.adm", grid);
  ViewSession coloured(320, 240);
  open(coloured, "ball.adm", "moved.adm");
  coloured.state().cut.plane = {{16, 16, 16}, {0, 0, 1}};
  coloured.finish();
  const auto parts = coloured.parts();
  const DrawnMesh& mesh = *section_of(parts)->mesh;
  std::size_t without = 0;
  for (std::size_t n = 0; n < mesh.vertices.size(); ++n) {
    const Vec3 p = place_of(mesh, n);
    if (p.x < 3.99) {
      EXPECT_TRUE(std::isnan(mesh.vertices[n].front_value)) << "beyond that volume there is nothing";
      ++without;
    } else {
      EXPECT_NEAR(mesh.vertices[n].front_value, std::max(0.0, 200 - 10 * distance(p, {20, 16, 16})), 3.5);
    }
  }
  EXPECT_GT(without, 100u);
}

TEST_F(StoreSections, OfStoresThatAreCutOffAreAProblemNotACrash) {
  std::filesystem::resize_file(folder / "ball.adm", 200);
  session.state().cut.plane = {{16, 9, 16}, {0, 1, 0}};
  session.finish();
  EXPECT_TRUE(session.report().is_current);
}

TEST_F(StoreSections, ArePickedWithTheirValue) {
  session.act(Action::kViewFront);
  session.state().cut.plane = {{16, 16, 16}, {0, -1, 0}};
  session.state().documents[0].surfaces[0].isovalue = 150;
  session.finish();
  const auto picked = session.pick(320, 240);
  ASSERT_TRUE(picked);
  EXPECT_NEAR(picked->place.y, 16, 1e-4);
  Picked later = *picked;
  while (later.reading.is_pending) session.complete(later);
  ASSERT_TRUE(later.reading.value);
  EXPECT_GT(*later.reading.value, 190);
  EXPECT_FALSE(later.reading.error) << "it is on no surface";
}

}  // namespace
}  // namespace adamas
