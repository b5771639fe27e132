#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/base/error.h"
#include "core/geometry/plane_sides.h"
#include "interfaces/cross_section/cross_section.h"
#include "tests/interfaces/cross_section_meshes.h"

namespace adamas {

using namespace datasets;
using namespace interfaces;

namespace {

/// Returns a grid of uneven nodes from 0 to 1.
RectilinearGrid grid(Centering centering) {
  RectilinearGrid g;
  g.nodes = {{{0, 0.1, 0.25, 0.5, 0.9, 1}, {0, 0.5, 0.75, 1}, {0, 0.3, 0.4, 0.6, 1}}};
  g.centering = centering;
  return g;
}

/// Returns data with two materials, a mixed field "mixed", which is linear where `linear` holds, and a vector
/// field "flow" per material, which "b" does not have.
MultiMaterialData sample(Centering centering, bool labels) {
  MultiMaterialData data;
  data.source = "sample";
  data.grid = grid(centering);
  data.materials = {"a", "b"};
  const std::size_t count = data.grid.site_count();
  Field mixed{"mixed", "K", 1, {}, {}}, flow{"flow", "", 3, {}, {}};
  flow.material_values.resize(2);
  std::vector<float> mixed_values;
  std::vector<double> flow_values;
  if (!labels) data.fractions.resize(2);
  for (std::size_t site = 0; site < count; ++site) {
    const std::size_t nx = data.grid.sites(0), ny = data.grid.sites(1);
    const Vec3 p = data.grid.site(site % nx, site / nx % ny, site / (nx * ny));
    const float fraction = static_cast<float>(site % 5) / 4;
    if (labels) {
      data.labels.push_back(static_cast<std::uint16_t>(site % 2));
    } else {
      data.fractions[MaterialId(0)].push_back(fraction);
      data.fractions[MaterialId(1)].push_back(1 - fraction);
    }
    mixed_values.push_back(static_cast<float>(1 + 2 * p.x - 3 * p.y + p.z));
    flow_values.insert(flow_values.end(), {p.x, p.y, p.z});
  }
  mixed.values = std::move(mixed_values);
  flow.material_values[MaterialId(0)] = std::move(flow_values);
  data.fields = {mixed, flow};
  data.check();
  return data;
}

/// Returns the site whose cell holds p.
std::array<std::size_t, 3> site_of(const RectilinearGrid& g, const Vec3& p) {
  std::array<std::size_t, 3> site{};
  for (int axis = 0; axis < 3; ++axis) {
    const auto& x = g.nodes[static_cast<std::size_t>(axis)];
    double nearest = 1e300;
    for (std::size_t i = 0; i < g.sites(axis); ++i) {
      const bool holds = g.centering == Centering::kCells && p[axis] >= x[i] && p[axis] <= x[i + 1];
      const double d = holds ? -1 : std::abs(p[axis] - g.site_coordinate(axis, i));
      if ((g.centering == Centering::kPoints || holds) && d < nearest)
        nearest = d, site[static_cast<std::size_t>(axis)] = i;
    }
  }
  return site;
}

TEST(CrossSectionGrid, PiecesFillThePlaneAndBelongToTheirSites) {
  for (const Centering centering : {Centering::kCells, Centering::kPoints}) {
    for (const bool labels : {false, true}) {
      const MultiMaterialData data = sample(centering, labels);
      for (const Plane& plane : test::trying_planes(50)) {
        const CrossSection section = cross_section(data, plane, std::nullopt);
        const double expected = polygon_area(clip_plane(plane, data.grid.domain()));
        EXPECT_NEAR(section.area, expected, 1e-12 * expected) << to_string(plane);
        EXPECT_NEAR(section.material_area[MaterialId(0)] + section.material_area[MaterialId(1)], expected,
                    1e-7 * expected);
        IdVector<MaterialId, double> areas(2, 0.0);
        for (const SectionPiece& piece : section.pieces) {
          EXPECT_FALSE(piece.body.valid());
          Vec3 middle;
          for (const Vec3& p : piece.corners) middle += (1 / static_cast<double>(piece.corners.size())) * p;
          const auto at = site_of(data.grid, middle);
          const std::size_t site = data.grid.site_index(at[0], at[1], at[2]);
          // Pieces in a face between two cells may belong to either cell.
          if (!plane.axis()) {
            EXPECT_EQ(piece.cell, site);
          }
          const float a = data.fraction(MaterialId(0), piece.cell);
          EXPECT_EQ(piece.material, MaterialId(a >= 0.5f ? 0 : 1));
          areas[MaterialId(0)] += polygon_area(piece.corners) * static_cast<double>(a);
        }
        EXPECT_NEAR(section.material_area[MaterialId(0)], areas[MaterialId(0)], 1e-12);
      }
    }
  }
}

TEST(CrossSectionGrid, CellsHaveOneValue) {
  const MultiMaterialData data = sample(Centering::kCells, false);
  const auto infos = field_infos(data);
  const Plane plane{{0.4, 0.45, 0.5}, {1, 2, -1}};
  for (const SectionPiece& piece : cross_section(data, plane, find_field(infos, "mixed", "")).pieces) {
    ASSERT_EQ(piece.values.size(), piece.corners.size());
    for (const double v : piece.values) EXPECT_EQ(v, data.fields[0].values[piece.cell]);
  }
  std::size_t missing = 0, y_differs = 0;
  const CrossSection lengths = cross_section(data, plane, find_field(infos, "flow", ""));
  const CrossSection y = cross_section(data, plane, find_field(infos, "flow:1", ""));
  for (std::size_t k = 0; k < lengths.pieces.size(); ++k) {
    const SectionPiece& piece = lengths.pieces[k];
    if (piece.material == MaterialId(1)) {
      EXPECT_TRUE(std::isnan(piece.values[0]));
      ++missing;
      continue;
    }
    const FieldValues& v = data.fields[1].material_values[MaterialId(0)];
    const Vec3 flow{v[3 * piece.cell], v[3 * piece.cell + 1], v[3 * piece.cell + 2]};
    EXPECT_NEAR(piece.values[0], norm(flow), 1e-12);
    EXPECT_EQ(y.pieces[k].values[0], flow.y);
    y_differs += y.pieces[k].values[0] != piece.values[0] ? 1 : 0;
  }
  EXPECT_GT(missing, 0u);
  EXPECT_GT(y_differs, 0u);
}

TEST(CrossSectionGrid, PointsAreInterpolatedBetween) {
  const MultiMaterialData data = sample(Centering::kPoints, true);
  const FieldChoice mixed = find_field(field_infos(data), "mixed", "");
  for (const Plane& plane : test::trying_planes(20)) {
    for (const SectionPiece& piece : cross_section(data, plane, mixed).pieces) {
      for (std::size_t i = 0; i < piece.corners.size(); ++i) {
        const Vec3& p = piece.corners[i];
        EXPECT_NEAR(piece.values[i], 1 + 2 * p.x - 3 * p.y + p.z, 1e-6);
      }
    }
  }
}

TEST(CrossSectionGrid, EdgesAreThoseOfTheSites) {
  for (const Centering centering : {Centering::kCells, Centering::kPoints}) {
    const MultiMaterialData data = sample(centering, true);
    const CrossSection section = cross_section(data, parse_plane("z=0.35"), std::nullopt);
    double length = 0;
    for (const Segment& s : section.cell_edges) length += distance(s[0], s[1]);
    // There is a line along x for each border between sites in y, and the other way round.
    const auto borders = [&](int axis) { return static_cast<double>(data.grid.sites(axis) + 1); };
    EXPECT_NEAR(length, borders(0) + borders(1), 1e-12);
  }
}

TEST(CrossSectionGrid, WholeSidesOfTheDomainCanBeCut) {
  const MultiMaterialData data = sample(Centering::kCells, true);
  for (const char* text : {"x=0", "x=1", "y=0", "y=1", "z=0", "z=1", "x=0.5", "z=0.4"})
    EXPECT_NEAR(cross_section(data, parse_plane(text), std::nullopt).area, 1, 1e-12) << text;
  EXPECT_THROW(cross_section(data, parse_plane("x=1.0001"), std::nullopt), Error);
  EXPECT_THROW(cross_section(data, parse_plane("x=0.5"), FieldChoice{2, std::nullopt}), Error);
  EXPECT_THROW(cross_section(data, parse_plane("x=0.5"), FieldChoice{1, 3}), Error);
}

TEST(CrossSectionEdges, OfAClosedSurfaceAreClosedLoops) {
  const Scene scene = make_scene("sphere");
  const InterfaceMesh mesh = scene_interfaces(scene, 0.05);
  const SceneSphere& sphere = scene.spheres()[0];
  for (const Plane& plane : test::trying_planes(30)) {
    const auto edges = section_edges(mesh, plane, scene.box());
    std::vector<Vec3> ends;
    double length = 0;
    for (const Segment& s : edges) {
      ends.insert(ends.end(), {s[0], s[1]});
      length += distance(s[0], s[1]);
    }
    for (const Vec3& p : ends) {
      EXPECT_EQ(std::count(ends.begin(), ends.end(), p) % 2, 0);
      EXPECT_NEAR(dot(p - plane.origin, normalized(plane.normal)), 0, 1e-14);
    }
    const double offset = dot(sphere.center - plane.origin, normalized(plane.normal));
    const double square = sphere.radius * sphere.radius - offset * offset;
    if (square > 0.01) {
      EXPECT_NEAR(length, 2 * M_PI * std::sqrt(square), 0.02 * length);
    }
  }
}

TEST(CrossSectionEdges, APlaneThroughEdgesGivesThemOnce) {
  InterfaceMesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (const std::array<std::uint32_t, 3>& t :
       {std::array<std::uint32_t, 3>{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}})
    mesh.triangles.push_back({t, MaterialId(0), MaterialId(1)});
  const Box3 box{{-1, -1, -1}, {1, 1, 1}};
  EXPECT_TRUE(section_edges(mesh, parse_plane("z=1"), box).empty());
  EXPECT_EQ(section_edges(mesh, parse_plane("z=0.5"), box).size(), 3u);
  // The plane passes through one edge and the middle of the opposite one.
  const auto edges = section_edges(mesh, {{0, 0, 0}, {1, -1, 0}}, box);
  ASSERT_EQ(edges.size(), 3u);
  EXPECT_EQ(edges[0], (Segment{Vec3{0, 0, 0}, Vec3{0, 0, 1}}));
}

}  // namespace
}  // namespace adamas
