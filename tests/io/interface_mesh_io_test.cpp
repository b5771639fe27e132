#include "core/io/interface_mesh_io.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <random>

#include "core/io/input_file.h"
#include "core/io/labelled_network.h"
#include "core/io/network_ply.h"
#include "core/io/polygon_soup.h"
#include "sample_data.h"
#include "tests/support/scratch.h"

namespace adamas {

using namespace io;

namespace {

using test::cube;
using test::error_of;
using test::says;

const MaterialId kOutside(0), kInside(1);

InterfaceMesh two_cubes() {
  InterfaceMesh a = cube({0.1, 0.2, 0.3}, 1, "air", "steel"), b = cube({1.1, 0.2, 0.3}, 1, "air", "brass");
  // The common face becomes an interface between the two solids.
  const auto on_face = [](const InterfaceMesh& m, const InterfaceTriangle& t) {
    return std::all_of(t.points.begin(), t.points.end(),
                       [&](std::uint32_t p) { return m.points[p].x == 1.1; });
  };
  std::erase_if(b.triangles, [&](const auto& t) { return on_face(b, t); });
  InterfaceMesh both = merge(std::array{a, b});
  for (InterfaceTriangle& t : both.triangles) {
    if (on_face(both, t)) t.front = MaterialId(2);
  }
  return both;
}

TEST(InterfaceMeshIo, MergeWeldsPointsAndMaterials) {
  const InterfaceMesh both = two_cubes();
  EXPECT_EQ(both.points.size(), 12u);
  EXPECT_EQ(both.triangles.size(), 22u);
  EXPECT_EQ(both.materials, (IdVector<MaterialId, std::string>{"air", "steel", "brass"}));
  EXPECT_NEAR(test::enclosed_volume(both, MaterialId(1)), 1, 1e-12);
  EXPECT_NEAR(test::enclosed_volume(both, MaterialId(2)), 1, 1e-12);
  EXPECT_NEAR(test::enclosed_volume(both, MaterialId(0)), -2, 1e-12);
}

TEST(InterfaceMeshIo, VtpComesBackBitForBit) {
  const test::Scratch scratch;
  const InterfaceMesh both = two_cubes();
  write_interface_mesh(scratch / "a.vtp", both);
  const InterfaceMesh read = read_interface_mesh(scratch / "a.vtp");
  EXPECT_EQ(read.points, both.points);
  EXPECT_EQ(read.triangles, both.triangles);
  EXPECT_EQ(read.materials, both.materials);
}

TEST(InterfaceMeshIo, NetworkComesBack) {
  const test::Scratch scratch;
  for (const InterfaceMesh& mesh : {cube({0, 0, 0}, 2, "a", "b"), two_cubes()}) {
    write_interface_mesh(scratch / "a.arec", mesh);
    const InterfaceMesh read = read_interface_mesh(scratch / "a.arec");
    EXPECT_EQ(read.points, mesh.points);
    EXPECT_EQ(read.triangles, mesh.triangles);
  }
}

TEST(InterfaceMeshIo, NetworkKeepsItsSidesWhateverTheOrderOfMaterials) {
  const test::Scratch scratch;
  InterfaceMesh mesh = cube({0, 0, 0}, 2, "a", "b");
  for (InterfaceTriangle& t : mesh.triangles) std::swap(t.front, t.back);
  for (const bool inside_out : {false, true}) {
    if (inside_out) {
      for (InterfaceTriangle& t : mesh.triangles) {
        std::swap(t.front, t.back);
        std::swap(t.points[0], t.points[1]);
      }
    }
    write_interface_mesh(scratch / "a.arec", mesh);
    const InterfaceMesh read = read_interface_mesh(scratch / "a.arec");
    ASSERT_EQ(read.triangles.size(), mesh.triangles.size());
    const auto inside = std::find(read.materials.begin(), read.materials.end(), "0");
    ASSERT_NE(inside, read.materials.end());
    EXPECT_NEAR(
        test::enclosed_volume(read, MaterialId(static_cast<std::size_t>(inside - read.materials.begin()))), 8,
        1e-12);
  }
}

TEST(InterfaceMeshIo, NetworkColumnsAreToldApartByVolumes) {
  for (const bool first_is_front : {false, true}) {
    const InterfaceMesh both = two_cubes();
    LabelledNetwork network;
    network.points = both.points;
    for (const InterfaceTriangle& t : both.triangles) {
      const auto front = static_cast<std::int32_t>(t.front.value),
                 back = static_cast<std::int32_t>(t.back.value);
      network.triangles.push_back(t.points);
      network.labels.push_back({first_is_front ? front : back, first_is_front ? back : front});
    }
    EXPECT_EQ(first_label_is_front(network), first_is_front);
    EXPECT_EQ(to_interface_mesh(network, {}, "test").triangles, both.triangles);
  }
}

TEST(InterfaceMeshIo, PlyKeepsNetworks) {
  const test::Scratch scratch;
  InterfaceMesh mesh = two_cubes();
  mesh.materials[MaterialId(0)] = "name with blanks";
  write_interface_mesh(scratch / "a.ply", mesh);
  EXPECT_TRUE(is_network_ply(scratch / "a.ply"));
  const InterfaceMesh read = read_interface_mesh(scratch / "a.ply");
  EXPECT_EQ(read.points, mesh.points);
  EXPECT_EQ(read.triangles, mesh.triangles);
  EXPECT_EQ(read.materials, mesh.materials);

  const std::string bytes = read_file(scratch / "a.ply");
  const auto refusal = [&](const std::string& changed) {
    std::ofstream(scratch / "b.ply", std::ios::binary) << changed;
    return error_of([&] { read_interface_mesh(scratch / "b.ply"); });
  };
  EXPECT_TRUE(says(refusal(bytes.substr(0, bytes.size() - 1)), "b.ply: expected "));
  EXPECT_TRUE(says(refusal(bytes + "x"), "b.ply: expected "));
  // The changed bytes of the last triangle are the material behind it, a point, and the number of corners.
  for (const auto& [place, what] : {std::pair{4, "material"}, {12, "point"}, {21, "corners"}}) {
    std::string changed = bytes;
    changed[bytes.size() - static_cast<std::size_t>(place)] = 100;
    EXPECT_TRUE(says(refusal(changed), what)) << what;
  }
  std::ofstream(scratch / "s.ply", std::ios::binary)
      << "ply\nformat ascii 1.0\nelement vertex 0\nend_header\n";
  EXPECT_FALSE(is_network_ply(scratch / "s.ply"));
  EXPECT_TRUE(says(error_of([&] { read_interface_mesh(scratch / "s.ply"); }), "s.ply: expected a network"));
  EXPECT_FALSE(is_network_ply(scratch / "none.ply"));
}

TEST(InterfaceMeshIo, SurfaceFormatsKeepPointsAndVolume) {
  const test::Scratch scratch;
  const InterfaceMesh mesh = cube({0.1, 1.0 / 3, 1e-3}, 0.7, "out", "in");
  for (const char* name : {"a.ply", "a.obj", "a.off", "a.stl"}) {
    write_interface_mesh(scratch / name, mesh);
    const InterfaceMesh read = read_surface(scratch / name, "out", "in");
    ASSERT_EQ(read.points.size(), 8u) << name;
    ASSERT_EQ(read.triangles.size(), 12u) << name;
    EXPECT_EQ(read.materials, mesh.materials);
    if (name != std::string("a.stl")) {
      EXPECT_EQ(read.points, mesh.points) << name;
      EXPECT_EQ(read.triangles, mesh.triangles) << name;
    }
    EXPECT_NEAR(test::enclosed_volume(read, kInside), 0.343, 1e-6) << name;
    EXPECT_NEAR(test::enclosed_volume(read, kOutside), -0.343, 1e-6) << name;
  }
  EXPECT_TRUE(says(error_of([&] { write_interface_mesh(scratch / "a.xyz", mesh); }), "found '.xyz'"));
  EXPECT_TRUE(says(error_of([&] { read_surface(scratch / "a.ply", "x", "x"); }), "two different materials"));
}

TEST(InterfaceMeshIo, PolygonsKeepTheirAreaWhateverTheirShape) {
  // The polygons are an L and a star, in three planes and both orientations.
  const std::vector<std::array<double, 2>> l{{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 2}, {0, 2}};
  const std::vector<std::array<double, 2>> star{{0, 3},  {-0.5, 0.5}, {-3, 0}, {-0.5, -0.5},
                                                {0, -3}, {0.5, -0.5}, {3, 0},  {0.5, 0.5}};
  for (const auto& shape : {l, star}) {
    double expected = 0;
    for (std::size_t i = 0; i < shape.size(); ++i) {
      const auto &a = shape[i], &b = shape[(i + 1) % shape.size()];
      expected += 0.5 * (a[0] * b[1] - a[1] * b[0]);
    }
    for (int plane = 0; plane < 3; ++plane) {
      for (const bool reversed : {false, true}) {
        std::vector<Vec3> points;
        std::vector<std::uint32_t> corners;
        for (const auto& p : shape) {
          Vec3 q;
          q[plane] = p[0];
          q[(plane + 1) % 3] = p[1];
          q[(plane + 2) % 3] = 5;
          corners.push_back(static_cast<std::uint32_t>(points.size()));
          points.push_back(q);
        }
        if (reversed) std::reverse(corners.begin(), corners.end());
        const auto triangles = triangulate_polygon(points, corners.data(), corners.size());
        EXPECT_EQ(triangles.size(), shape.size() - 2);
        double signed_sum = 0, sum = 0;
        for (const auto& t : triangles) {
          const Vec3 area = 0.5 * cross(points[t[1]] - points[t[0]], points[t[2]] - points[t[0]]);
          signed_sum += area[(plane + 2) % 3];
          sum += norm(area);
        }
        EXPECT_NEAR(signed_sum, reversed ? -expected : expected, 1e-12);
        EXPECT_NEAR(sum, expected, 1e-12) << "no triangle lies outside";
      }
    }
  }
}

struct BadNetwork {
  const char* text;
  const char* message;
};

TEST(NetworkText, BadTextIsNamedWithItsLine) {
  const std::vector<BadNetwork> cases{
      {"", "line 1: expected the number of points, found the file's end"},
      {"x", "line 1: expected the number of points, found 'x'"},
      {"-1\n", "line 1: expected the number of points, found -1"},
      {"99999999999999999999\n", "line 1: expected the number of points, found '99999999999999999999'"},
      {"4000000000\n0 0 0\n", "expected 4000000000 points"},
      {"3\n0 0 0\n1 0 0\n", "line 4: expected the coordinate of a point, found the file's end"},
      {"3\n0 0 0\n1 0 0\n0 1 x 1\n", "line 4: expected the coordinate of a point, found 'x'"},
      {"3\n0 0 0\n1 nan 0\n0 1 0\n1\n0 1 2 0 1\n", "line 3: expected a finite coordinate"},
      {"3\n0 0 0\n1 inf 0\n0 1 0\n1\n0 1 2 0 1\n", "line 3: expected a finite coordinate"},
      {"3\n0 0 0\n1 1e999 0\n0 1 0\n1\n0 1 2 0 1\n",
       "line 3: expected the coordinate of a point, found '1e999'"},
      {"3\n0 0 0\n1 0 0\n0 1 0\n", "expected the number of triangles, found the file's end"},
      {"3\n0 0 0\n1 0 0\n0 1 0\n-2\n", "line 5: expected the number of triangles, found -2"},
      {"3\n0 0 0\n1 0 0\n0 1 0\n5\n0 1 2 0 1\n", "expected 5 triangles"},
      {"3\n0 0 0\n1 0 0\n0 1 0\n1\n0 1 3 0 1\n", "line 6: expected the index of one of 3 points, found 3"},
      {"3\n0 0 0\n1 0 0\n0 1 0\n1\n0 1 -1 0 1\n", "line 6: expected the index of one of 3 points, found -1"},
      {"3\n0 0 0\n1 0 0\n0 1 0\n1\n0 1 1 0 1\n", "line 6: expected three different points"},
      {"3\n0 0 0\n1 0 0\n0 1 0\n1\n0 1 2 0 1.5\n", "line 6: expected the label of a region, found '1.5'"},
      {"3\n0 0 0\n1 0 0\n0 1 0\n1\n0 1 2 0\n",
       "line 7: expected the label of a region, found the file's end"},
      {"3\n0 0 0\n1 0 0\n0 1 0\n1\n0 1 2 0 1\nmore\n", "line 7: expected the file's end, found 'more'"},
      {"3\n0 0 0\n1 0 0\n0 1 0\n1\n0 1 2 0 1\n\x01\x02",
       "found '?"
       "?'"},
  };
  for (const BadNetwork& each : cases) {
    const auto message = error_of([&] { parse_labelled_network(each.text, "net.arec"); });
    EXPECT_TRUE(says(message, "net.arec: line ")) << each.text;
    EXPECT_TRUE(says(message, each.message)) << each.text;
  }
}

TEST(NetworkText, EveryTruncationIsAnErrorOrTheWholeNetwork) {
  const test::Scratch scratch;
  write_interface_mesh(scratch / "a.arec", two_cubes());
  const std::string text = test::bytes_of(scratch / "a.arec");
  const LabelledNetwork whole = parse_labelled_network(text, "whole");
  std::size_t complete = 0;
  for (std::size_t length = 0; length < text.size(); ++length) {
    try {
      const LabelledNetwork read = parse_labelled_network(std::string_view(text).substr(0, length), "cut");
      EXPECT_EQ(read.triangles, whole.triangles);
      EXPECT_EQ(read.labels, whole.labels);
      ++complete;
    } catch (const Error&) {
    }
  }
  EXPECT_EQ(complete, 1u) << "only the last line's end can be missed";
}

TEST(NetworkText, RegionNames) {
  const auto names =
      parse_region_table("0 Universe\n 12  The Region \n\n# note\n(note)\n-1 out\n", "names").names;
  EXPECT_EQ(names, (std::map<std::int64_t, std::string>{{-1, "out"}, {0, "Universe"}, {12, "The Region"}}));
  EXPECT_TRUE(
      says(error_of([] { parse_region_table("0 a\nb c\n", "names"); }), "names: line 2: expected a label"));
  EXPECT_TRUE(
      says(error_of([] { parse_region_table("0 a\n0 c\n", "names"); }), "names: line 2: expected one name"));
  EXPECT_TRUE(says(error_of([] { parse_region_table("7\n", "names"); }), "names: line 1"));
  const auto table =
      parse_region_table(
          "# ITK-SnAP Label Description File\n    0     0    0    0        0  0  0    \"Clear Label\"\n"
          "   12   255  128   0        0.5  1  1    \"Left Hippocampus\"\n   13   \"quoted\" name\n",
          "table")
          .names;
  EXPECT_EQ(table.at(0), "Clear Label");
  EXPECT_EQ(table.at(12), "Left Hippocampus");
  EXPECT_EQ(table.at(13), "\"quoted\" name");
}

}  // namespace
}  // namespace adamas
