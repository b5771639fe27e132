#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>

#include "core/base/error.h"
#include "core/geometry/plane_sides.h"
#include "interfaces/cross_section/cross_section.h"
#include "interfaces/resampling/resampler.h"
#include "tests/interfaces/cross_section_meshes.h"
#include "tests/interfaces/network_meshes.h"

namespace adamas {

using namespace datasets;
using namespace interfaces;

namespace {

using test::make_scene_mesh;
using test::SceneMesh;
using test::SceneMeshOptions;

/// Returns the value at p of the function that is linear over a piece; none where p lies outside by more than
/// `margin`.
std::optional<double> value_in_piece(const SectionPiece& piece, const Vec3& normal, const Vec3& p,
                                     double margin) {
  const auto& x = piece.corners;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const Vec3 edge = x[(i + 1) % x.size()] - x[i];
    if (dot(cross(edge, p - x[i]), normal) < -margin * norm(edge)) return std::nullopt;
  }
  // Of the triangles round corner 0, the one that contains p best gives the value.
  double best = -1e300, value = 0;
  for (std::size_t i = 2; i < x.size(); ++i) {
    const double area = dot(cross(x[i - 1] - x[0], x[i] - x[0]), normal);
    if (!(area > 1e-14)) continue;
    const double b = dot(cross(p - x[0], x[i] - x[0]), normal) / area;
    const double c = dot(cross(x[i - 1] - x[0], p - x[0]), normal) / area;
    const double least = std::min({1 - b - c, b, c});
    if (least <= best) continue;
    best = least;
    value = (1 - b - c) * piece.values[0] + b * piece.values[i - 1] + c * piece.values[i];
  }
  if (best < -1e-6) return std::nullopt;
  return value;
}

Vec3 random_point_of(const std::vector<Vec3>& polygon, std::mt19937_64& random) {
  std::exponential_distribution<double> share(1);
  Vec3 p;
  double sum = 0;
  for (const Vec3& corner : polygon) {
    const double w = share(random);
    p += w * corner;
    sum += w;
  }
  return (1 / sum) * p;
}

void expect_areas_add_up(const SceneMesh& scene, std::size_t random_planes) {
  for (const Plane& plane : test::trying_planes(random_planes)) {
    const CrossSection section = cross_section(scene.mesh, plane, std::nullopt);
    const double expected = polygon_area(clip_plane(plane, scene.mesh.box));
    EXPECT_NEAR(section.area, expected, 1e-12 * expected) << scene.scene.name() << ' ' << to_string(plane);
    double of_materials = 0;
    for (const double area : section.material_area) of_materials += area;
    EXPECT_NEAR(of_materials, expected, 1e-12 * expected);
    const PlaneSides sides(plane, scene.mesh.box, "");
    for (const SectionPiece& piece : section.pieces) {
      ASSERT_GE(piece.corners.size(), 3u);
      EXPECT_EQ(scene.mesh.table.material(piece.body), piece.material);
      EXPECT_TRUE(piece.values.empty());
      for (const Vec3& p : piece.corners) EXPECT_LE(std::abs(dot(p - plane.origin, sides.normal())), 1e-14);
    }
  }
}

TEST(CrossSection, AreasAddUpOnEveryPlane) {
  for (const char* name : {"sphere", "tjunction", "plate"}) expect_areas_add_up(make_scene_mesh(name), 50);
}

TEST(LongCrossSection, AreasAddUpOnEveryScene) {
  for (const std::string& name : scene_names()) {
    for (const bool given : {true, false}) {
      SceneMeshOptions options;
      options.given = given;
      options.most = 800;
      expect_areas_add_up(make_scene_mesh(name, options), 10);
    }
  }
}

TEST(CrossSection, ValuesAreThoseOfTheCellsAndOwners) {
  std::mt19937_64 random(5);
  for (const char* name : {"sphere", "tjunction"}) {
    SceneMeshOptions options;
    options.most = 1200;
    const SceneMesh scene = make_scene_mesh(name, options);
    const auto& fields = scene.mesh.fields;
    const FieldChoice choice = find_field(fields, "smooth", "scene");
    std::size_t compared = 0;
    for (const Plane& plane :
         {parse_plane("x=0.4"), parse_plane("z=0.5"), Plane{{0.5, 0.4, 0.5}, {1, 2, -1}}}) {
      const CrossSection section = cross_section(scene.mesh, plane, choice);
      const CrossSection plain = cross_section(scene.mesh, plane, choice, SectionMode::kPlain);
      EXPECT_EQ(section.material_area, plain.material_area);
      const Vec3 normal = PlaneSides(plane, scene.mesh.box, "").normal();
      const auto domain = clip_plane(plane, scene.mesh.box);
      for (int i = 0; i < 60; ++i) {
        const Vec3 p = random_point_of(domain, random);
        const auto at = test::find_cell(scene.mesh, p);
        const BodyId owner = test::owner_in(scene.mesh, at);
        std::size_t found = 0;
        for (std::size_t k = 0; k < section.pieces.size(); ++k) {
          const auto value = value_in_piece(section.pieces[k], normal, p, -1e-9);
          if (!value) continue;
          ++found;
          EXPECT_EQ(section.pieces[k].body, owner);
          EXPECT_NEAR(*value, scene.mesh.value(at.cell, owner, fields[choice.field].offset, at.weights),
                      1e-8);
          const auto without = value_in_piece(plain.pieces[k], normal, p, -1e-9);
          ASSERT_TRUE(without);
          EXPECT_NEAR(*without, scene.mesh.plain_value(at.cell, fields[choice.field].offset, at.weights),
                      1e-7);
        }
        EXPECT_LE(found, 1u);
        compared += found;
      }
    }
    EXPECT_GT(compared, 160u) << "of 180 points";
  }
}

TEST(CrossSection, LinearFieldsComeBackExactly) {
  for (const char* name : {"tjunction", "sphere", "reflex"}) {
    const SceneMesh scene = make_scene_mesh(name);
    const auto choice = [&](const char* text) { return find_field(scene.mesh.fields, text, "scene"); };
    for (const Plane& plane : test::trying_planes(10)) {
      const CrossSection linear = cross_section(scene.mesh, plane, choice("linear"));
      const CrossSection length = cross_section(scene.mesh, plane, choice("flow"));
      const CrossSection second = cross_section(scene.mesh, plane, choice("flow:1"));
      const CrossSection first = cross_section(scene.mesh, plane, choice("first"));
      for (std::size_t k = 0; k < linear.pieces.size(); ++k) {
        const SectionPiece& piece = linear.pieces[k];
        ASSERT_EQ(piece.values.size(), piece.corners.size());
        for (std::size_t i = 0; i < piece.corners.size(); ++i) {
          const double expected = scene.scene.field(SceneField::kLinear, piece.material, piece.corners[i]);
          EXPECT_NEAR(piece.values[i], expected, 1e-11);
          EXPECT_NEAR(length.pieces[k].values[i], 3 * std::abs(expected), 1e-10);
          EXPECT_NEAR(second.pieces[k].values[i], -2 * expected, 1e-10);
          if (piece.material == MaterialId(0)) {
            EXPECT_NEAR(first.pieces[k].values[i], expected, 1e-11);
          } else {
            EXPECT_TRUE(std::isnan(first.pieces[k].values[i]));
          }
        }
      }
    }
  }
}

TEST(CrossSection, DiscsOfTheSphereAreWithinTheMeshsError) {
  SceneMeshOptions options;
  options.error = 0.02;
  options.most = 20000;
  const SceneMesh scene = make_scene_mesh("sphere", options);
  ASSERT_EQ(scene.scene.spheres().size(), 1u);
  const SceneSphere& sphere = scene.scene.spheres()[0];
  // This is the greatest depth of the given triangles below the sphere that their corners lie on.
  double error = 0;
  for (std::uint32_t t = 0; t < scene.source.network->triangles().size(); ++t) {
    const auto& x = scene.source.network->triangle_corners(t);
    const Vec3 normal = normalized(cross(x[1] - x[0], x[2] - x[0]));
    error = std::max(error, sphere.radius - std::abs(dot(x[0] - sphere.center, normal)));
  }
  error += scene.distance;
  EXPECT_LT(error, 0.04);
  for (const Plane& plane : test::trying_planes(30)) {
    const Vec3 normal = PlaneSides(plane, scene.mesh.box, "").normal();
    const double offset = dot(plane.origin - sphere.center, normal);
    const auto disc = [&](double radius) {
      return std::max(0.0, M_PI * (radius * radius - offset * offset));
    };
    const double area = cross_section(scene.mesh, plane, std::nullopt).material_area[sphere.inside];
    EXPECT_GE(area, disc(sphere.radius - error) - 1e-12) << to_string(plane);
    EXPECT_LE(area, disc(sphere.radius + error) + 1e-12) << to_string(plane);
  }
}

/// Returns the part of a polygon where dot(normal, p - through) >= 0.
std::vector<Vec3> half(const std::vector<Vec3>& polygon, const Vec3& through, const Vec3& normal) {
  std::vector<Vec3> kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3 &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
    const double dp = dot(normal, p - through), dq = dot(normal, q - through);
    if (dp >= 0) kept.push_back(p);
    if ((dp >= 0) != (dq >= 0)) kept.push_back(p + (dp / (dp - dq)) * (q - p));
  }
  return kept;
}

TEST(CrossSection, PlaneJunctionsHaveExactAreas) {
  const SceneMesh scene = make_scene_mesh("tjunction");
  const Vec3 center{0.5, 0.5, 0.5}, first{0.5, 0.5, 0}, second{0.5, 0.025, -0.375};
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int i = 0; i < 40; ++i) {
    const Plane plane{{0.5 + 0.4 * unit(random), 0.5, 0.5}, {unit(random), unit(random), unit(random)}};
    IdVector<MaterialId, double> expected(scene.mesh.materials.size(), 0.0);
    for (const double a : {1.0, -1.0}) {
      for (const double b : {1.0, -1.0}) {
        const auto part =
            half(half(clip_plane(plane, scene.mesh.box), center, a * first), center, b * second);
        if (polygon_area(part) < 1e-12) continue;
        Vec3 middle;
        for (const Vec3& p : part) middle += (1 / static_cast<double>(part.size())) * p;
        expected[scene.scene.owner(middle)] += polygon_area(part);
      }
    }
    const CrossSection section = cross_section(scene.mesh, plane, std::nullopt);
    for (MaterialId m(0); m.value < expected.size(); ++m.value)
      EXPECT_NEAR(section.material_area[m], expected[m], 1e-9) << to_string(plane);
  }
}

TEST(CrossSection, APlaneInAnInterfaceShowsOneSide) {
  const SceneMesh scene = make_scene_mesh("tjunction");
  const Vec3 center{0.5, 0.5, 0.5}, first{0.5, 0.5, 0}, second{0.5, 0.025, -0.375};
  for (const double sign : {1.0, -1.0}) {
    const Plane plane{center, sign * first};
    const CrossSection section = cross_section(scene.mesh, plane, std::nullopt);
    IdVector<MaterialId, double> expected(scene.mesh.materials.size(), 0.0);
    for (const double side : {1.0, -1.0}) {
      const auto part = half(clip_plane(plane, scene.mesh.box), center, side * second);
      Vec3 middle;
      for (const Vec3& p : part) middle += (1 / static_cast<double>(part.size())) * p;
      expected[scene.scene.owner(middle - 1e-6 * plane.normal)] += polygon_area(part);
    }
    for (MaterialId m(0); m.value < expected.size(); ++m.value)
      EXPECT_NEAR(section.material_area[m], expected[m], 1e-9) << to_string(plane);
  }
  // The sheet passes through the middle of cells, where only interpolation finds the interface.
  InterfaceMesh mesh = test::mesh_with_materials(2);
  test::add_patch(mesh, {0.3712, 0, 0}, {0, 1, 0}, {0, 0, 1}, MaterialId(0), MaterialId(1));
  const ResamplingSource source = make_mesh_source(mesh, scene.mesh.box);
  ResamplingOptions options;
  options.interface_error = 0.1;
  Resampler resampler(source, options);
  resampler.refine();
  const ResampledMesh resampled = resampled_mesh(resampler);
  EXPECT_NEAR(
      cross_section(resampled, {{0.3712, 0, 0}, {1, 0, 0}}, std::nullopt).material_area[MaterialId(1)], 1,
      1e-12);
  EXPECT_NEAR(
      cross_section(resampled, {{0.3712, 0, 0}, {-1, 0, 0}}, std::nullopt).material_area[MaterialId(0)], 1,
      1e-12);
}

TEST(CrossSection, InterfaceEdgesPartOwnersAndRoundTheirBodies) {
  SceneMeshOptions options;
  options.most = 1500;
  const SceneMesh scene = make_scene_mesh("sphere", options);
  const Plane plane{{0.5, 0.45, 0.5}, {1, 2, -1}};
  const CrossSection section = cross_section(scene.mesh, plane, std::nullopt);
  ASSERT_GT(section.interface_edges.size(), 8u);
  const PlaneFrame frame = plane_frame(plane);
  double twice_area = 0;
  const Vec3 inside = scene.scene.spheres()[0].center;
  const Vec3 normal = normalized(plane.normal);
  const Vec3 foot = inside - dot(inside - plane.origin, normal) * normal;
  for (const Segment& s : section.interface_edges) {
    const Vec3 middle = 0.5 * (s[0] + s[1]), across = cross(normal, s[1] - s[0]);
    const double step = 1e-6 / norm(across);
    if (norm(s[1] - s[0]) > 1e-4) {
      const BodyId left = test::owner_in(scene.mesh, test::find_cell(scene.mesh, middle + step * across));
      const BodyId right = test::owner_in(scene.mesh, test::find_cell(scene.mesh, middle - step * across));
      EXPECT_NE(left, right);
    }
    const auto a = frame.coordinates(s[0] - foot + plane.origin),
               b = frame.coordinates(s[1] - foot + plane.origin);
    twice_area += std::abs(a[0] * b[1] - a[1] * b[0]);
  }
  // The ball's section is star-shaped about its middle, so each edge makes one triangle with the middle.
  EXPECT_NEAR(0.5 * twice_area, section.material_area[scene.scene.spheres()[0].inside], 1e-9);
}

TEST(CrossSection, EdgesOfCellsRoundThem) {
  const SceneMesh scene = make_scene_mesh("sphere");
  for (const Plane& plane : test::trying_planes(10)) {
    // This plane is so near to a side that the section has slivers of cells there.
    if (plane.axis() && plane.origin[*plane.axis()] == 1e-15) continue;
    const CrossSection section = cross_section(scene.mesh, plane, std::nullopt);
    const auto on_boundary = [&](const Segment& s) {
      for (int axis = 0; axis < 3; ++axis) {
        for (const double x : {scene.mesh.box.min[axis], scene.mesh.box.max[axis]}) {
          if (plane.axis() != axis && std::abs(s[0][axis] - x) < 1e-14 && std::abs(s[1][axis] - x) < 1e-14)
            return true;
        }
      }
      return false;
    };
    double boundary = 0, inner = 0;
    for (const Segment& s : section.cell_edges) (on_boundary(s) ? boundary : inner) += distance(s[0], s[1]);
    const auto domain = clip_plane(plane, scene.mesh.box);
    double expected = 0;
    for (std::size_t i = 0; i < domain.size(); ++i)
      expected += distance(domain[i], domain[(i + 1) % domain.size()]);
    EXPECT_NEAR(boundary, expected, 1e-12) << to_string(plane);
    EXPECT_GT(inner, 0);
  }
}

TEST(CrossSection, SameOnAnyNumberOfThreads) {
  const SceneMesh scene = make_scene_mesh("tjunction");
  const FieldChoice choice = find_field(scene.mesh.fields, "smooth", "scene");
  const Plane plane{{0.5, 0.45, 0.5}, {1, 2, -1}};
  set_thread_limit(1);
  const CrossSection one = cross_section(scene.mesh, plane, choice);
  set_thread_limit(2);
  const CrossSection two = cross_section(scene.mesh, plane, choice);
  set_thread_limit(0);
  ASSERT_EQ(one.pieces.size(), two.pieces.size());
  for (std::size_t i = 0; i < one.pieces.size(); ++i) {
    EXPECT_EQ(one.pieces[i].corners, two.pieces[i].corners);
    EXPECT_EQ(one.pieces[i].values, two.pieces[i].values);
    EXPECT_EQ(one.pieces[i].body, two.pieces[i].body);
  }
  EXPECT_EQ(one.cell_edges, two.cell_edges);
  EXPECT_EQ(one.interface_edges, two.interface_edges);
  EXPECT_EQ(one.area, two.area);
  EXPECT_EQ(one.material_area, two.material_area);
}

TEST(CrossSection, FieldsAreFoundByNameAndComponent) {
  const std::vector<FieldInfo> fields{
      {"density", "g", 1, 0, 0, 0}, {"velocity", "m/s", 3, 1, 0, 0}, {"a:b", "", 1, 4, 0, 0}};
  EXPECT_EQ(find_field(fields, "velocity", "f").field, 1u);
  EXPECT_FALSE(find_field(fields, "velocity", "f").component);
  EXPECT_EQ(find_field(fields, "velocity:2", "f").component, 2u);
  EXPECT_EQ(find_field(fields, "a:b", "f").field, 2u);
  EXPECT_EQ(field_label(fields, find_field(fields, "velocity:1", "f")), "velocity y [m/s]");
  EXPECT_EQ(field_label(fields, find_field(fields, "velocity", "f")), "|velocity| [m/s]");
  EXPECT_EQ(field_label(fields, find_field(fields, "a:b", "f")), "a:b");
  const std::vector<double> v{2, 3, 6};
  EXPECT_DOUBLE_EQ((FieldChoice{1, std::nullopt}.scalar(v)), 7);
  EXPECT_EQ((FieldChoice{1, 2}.scalar(v)), 6);
  EXPECT_EQ((FieldChoice{0, std::nullopt}.scalar(std::vector<double>{-4})), -4);
  for (const char* text : {"", "densit", "velocity:3", "velocity:-1", "velocity:", "density:1", ":0"}) {
    try {
      find_field(fields, text, "file.vtu");
      ADD_FAILURE() << text;
    } catch (const Error& error) {
      EXPECT_EQ(std::string(error.what()).rfind("file.vtu: ", 0), 0u) << error.what();
    }
  }
  const SceneMesh scene = make_scene_mesh("sphere");
  EXPECT_THROW(cross_section(scene.mesh, parse_plane("x=0.5"), FieldChoice{99, std::nullopt}), Error);
  EXPECT_THROW(cross_section(scene.mesh, parse_plane("x=0.5"), FieldChoice{0, 1}), Error);
  EXPECT_THROW(cross_section(scene.mesh, parse_plane("x=1.5"), std::nullopt), Error);
}

}  // namespace
}  // namespace adamas
