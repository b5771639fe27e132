// Tests the output of write_surface, read back by other readers: VTK's, CGAL's, and small ones of the tests'
// own.

#include "core/io/surface_writer.h"

#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <random>

#include "core/io/interface_mesh_io.h"
#include "core/io/polygon_soup.h"
#include "tests/io/surface_files.h"
#include "tests/support/file_size_limit.h"
#include "tests/support/scratch.h"

namespace adamas {

using namespace io;

namespace {

using test::error_of;
using test::says;
using test::Scratch;

const std::vector<std::string> kNames = {"a.ply", "a.stl", "a.obj", "a.vtp", "a.glb", "a.gltf"};

/// Returns a patch of triangles over a square in space, with n by n points at distances of about 1.
TriangleSurface patch(std::uint32_t n, bool normals, bool values, const Vec3& offset = {}) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> number(-0.3, 0.3);
  TriangleSurface surface;
  surface.value_name = "a <b> & \"c\"";
  for (std::uint32_t i = 0; i < n * n; ++i) {
    surface.points.push_back(
        offset + Vec3{i % n + number(random), static_cast<double>(i / n) + number(random), number(random)});
    if (normals) surface.normals.push_back(normalized({number(random), number(random), 1}));
    if (values) surface.values.push_back(static_cast<float>(number(random)));
  }
  for (std::uint32_t j = 0; j + 1 < n; ++j) {
    for (std::uint32_t i = 0; i + 1 < n; ++i) {
      const std::uint32_t p = j * n + i;
      surface.triangles.push_back({p, p + 1, p + n + 1});
      surface.triangles.push_back({p, p + n + 1, p + n});
    }
  }
  return surface;
}

TriangleSurface one_triangle() {
  TriangleSurface surface;
  surface.points = {{0, 0, 0}, {1, 0, 0}, {0, 0.1, 0}};
  surface.triangles = {{0, 1, 2}};
  return surface;
}

std::vector<TriangleSurface> surfaces() {
  return {{},
          one_triangle(),
          patch(9, false, false),
          patch(40, true, false),
          patch(9, false, true),
          patch(301, true, true),
          patch(9, true, true, {1e7, -3e6, 0.25})};
}

Vec3 rounded(const Vec3& v) {
  Vec3 result;
  for (int axis = 0; axis < 3; ++axis) {
    // The variable is volatile, since g++ 12 leaves out the rounding when it vectorises this loop.
    const volatile float number = static_cast<float>(v[axis]);
    result[axis] = number;
  }
  return result;
}

std::vector<Vec3> rounded(std::vector<Vec3> vectors) {
  for (Vec3& v : vectors) v = rounded(v);
  return vectors;
}

/// Expects the same surface; points agree to the last bit of their type in the file.
void expect_same(const test::SurfaceFile& file, const TriangleSurface& surface) {
  EXPECT_EQ(file.single, single_precision_suffices(surface));
  EXPECT_EQ(file.surface.points, file.single ? rounded(surface.points) : surface.points);
  EXPECT_EQ(file.surface.triangles, surface.triangles);
  EXPECT_EQ(file.surface.normals, rounded(surface.normals));
}

TEST(SurfaceWriter, PlyComesBack) {
  const Scratch scratch;
  for (const TriangleSurface& surface : surfaces()) {
    write_surface(scratch / "a.ply", surface);
    const auto file = test::read_ply_surface(scratch / "a.ply");
    expect_same(file, surface);
    EXPECT_EQ(file.surface.values, surface.values);
  }
}

TEST(SurfaceWriter, VtpComesBack) {
  const Scratch scratch;
  for (const TriangleSurface& surface : surfaces()) {
    write_surface(scratch / "a.vtp", surface);
    const auto file = test::read_vtp_surface(scratch / "a.vtp");
    expect_same(file, surface);
    EXPECT_EQ(file.surface.values, surface.values);
    if (!surface.values.empty()) {
      EXPECT_EQ(file.surface.value_name, surface.value_name);
    }
  }
}

TEST(SurfaceWriter, ObjComesBack) {
  const Scratch scratch;
  for (const TriangleSurface& surface : surfaces()) {
    write_surface(scratch / "a.obj", surface);
    auto file = test::read_obj_surface(scratch / "a.obj");
    file.single = single_precision_suffices(surface);
    if (file.single) file.surface.points = rounded(file.surface.points);
    file.surface.normals = rounded(file.surface.normals);
    expect_same(file, surface);
  }
}

TEST(SurfaceWriter, GltfComesBack) {
  const Scratch scratch;
  for (const TriangleSurface& surface : surfaces()) {
    for (const char* name : {"a.glb", "a.gltf"}) {
      write_surface(scratch / name, surface);
      const auto file = test::read_gltf_surface(scratch / name);
      EXPECT_EQ(file.surface.triangles, surface.triangles);
      EXPECT_EQ(file.surface.normals, rounded(surface.normals));
      EXPECT_EQ(file.surface.values, surface.values);
      ASSERT_EQ(file.surface.points.size(), surface.points.size());
      EXPECT_EQ(norm(file.translation) == 0, single_precision_suffices(surface));
      for (std::size_t i = 0; i < surface.points.size(); ++i) {
        const Vec3 at = file.translation;
        EXPECT_EQ(file.surface.points[i], at + rounded(surface.points[i] - at));
      }
    }
  }
}

TEST(SurfaceWriter, StlHasEachTriangle) {
  const Scratch scratch;
  for (const TriangleSurface& surface : surfaces()) {
    write_surface(scratch / "a.stl", surface);
    const std::string bytes = test::bytes_of(scratch / "a.stl");
    ASSERT_EQ(bytes.size(), 84 + 50 * surface.triangles.size());
    EXPECT_FALSE(bytes.starts_with("solid"));
    std::uint32_t count = 0;
    std::memcpy(&count, bytes.data() + 80, sizeof(count));
    EXPECT_EQ(count, surface.triangles.size());
    for (std::size_t t = 0; t < count; ++t) {
      std::array<float, 12> numbers;
      std::memcpy(numbers.data(), bytes.data() + 84 + 50 * t, sizeof(numbers));
      const auto vector = [&](std::size_t at) {
        return Vec3{numbers[3 * at], numbers[3 * at + 1], numbers[3 * at + 2]};
      };
      const auto [a, b, c] = surface.triangles[t];
      const Vec3 &p = surface.points[a], &q = surface.points[b], &r = surface.points[c];
      EXPECT_EQ(vector(1), rounded(p));
      EXPECT_EQ(vector(2), rounded(q));
      EXPECT_EQ(vector(3), rounded(r));
      EXPECT_LT(norm(vector(0) - normalized(cross(q - p, r - p))), 1e-6);
    }
  }
}

TEST(SurfaceWriter, OtherReadersFindTheSame) {
  const Scratch scratch;
  for (const TriangleSurface& surface : {one_triangle(), patch(12, true, true), patch(7, false, true)}) {
    for (const char* name : {"a.ply", "a.obj", "a.stl"}) {
      write_surface(scratch / name, surface);
      const PolygonSoup soup = read_polygon_soup(scratch / name);
      ASSERT_EQ(soup.corners.size(), 3 * surface.triangles.size()) << name;
      for (std::size_t i = 0; i < soup.corners.size(); ++i) {
        const Vec3 expected = surface.points[surface.triangles[i / 3][i % 3]];
        EXPECT_LT(distance(soup.points[soup.corners[i]], expected), 1e-5) << name;
      }
    }
  }
  // The project's own reader finds the same points.
  const TriangleSurface far = patch(5, false, true, {1e7, 1e7, 0});
  for (const char* name : {"b.ply", "b.obj"}) {
    write_surface(scratch / name, far);
    EXPECT_EQ(read_surface(scratch / name, "out", "in").points, far.points) << name;
  }
}

TEST(SurfaceWriter, DoublesAreForWhatFloatsCannotTellApart) {
  EXPECT_TRUE(single_precision_suffices({}));
  EXPECT_TRUE(single_precision_suffices(patch(9, false, false)));
  EXPECT_TRUE(single_precision_suffices(patch(9, false, false, {4000, 0, -4000})));
  EXPECT_FALSE(single_precision_suffices(patch(9, false, false, {0, 0, -6000})));
  TriangleSurface surface = one_triangle();
  for (Vec3& p : surface.points) p *= 1e39;
  EXPECT_FALSE(single_precision_suffices(surface));
  for (Vec3& p : surface.points) p *= 1e-80;
  EXPECT_FALSE(single_precision_suffices(surface));
  surface.points.assign(3, {2, 2, 2});
  EXPECT_FALSE(single_precision_suffices(surface));
}

TEST(SurfaceWriter, GltfHasANormalWhereThereIsNone) {
  const Scratch scratch;
  TriangleSurface surface = one_triangle();
  surface.points.push_back({3, 3, 3});
  surface.normals = {{1, 0, 0}, {}, {0, 1, 0}, {}};
  write_surface(scratch / "a.glb", surface);
  const auto file = test::read_gltf_surface(scratch / "a.glb");
  EXPECT_EQ(file.surface.normals, (std::vector<Vec3>{{1, 0, 0}, {0, 0, 1}, {0, 1, 0}, {0, 0, 1}}));
  write_surface(scratch / "a.ply", surface);
  EXPECT_EQ(test::read_ply_surface(scratch / "a.ply").surface.normals, surface.normals);
}

TEST(SurfaceWriter, PointsWithoutTrianglesAreAFileToo) {
  const Scratch scratch;
  TriangleSurface surface;
  surface.points = {{0.1, 0.2, 0.3}};
  for (const std::string& name : kNames) write_surface(scratch / name, surface);
  EXPECT_EQ(test::read_ply_surface(scratch / "a.ply").surface.points, surface.points);
  EXPECT_EQ(test::read_vtp_surface(scratch / "a.vtp").surface.points, surface.points);
  EXPECT_EQ(test::read_obj_surface(scratch / "a.obj").surface.points, surface.points);
  EXPECT_TRUE(test::read_gltf_surface(scratch / "a.glb").surface.points.empty());
}

TEST(SurfaceWriter, EqualSurfacesGiveEqualBytes) {
  const Scratch scratch;
  for (const std::string& name : kNames) {
    write_surface(scratch / name, patch(20, true, true));
    const std::string first = test::bytes_of(scratch / name);
    write_surface(scratch / name, patch(20, true, true));
    EXPECT_EQ(test::bytes_of(scratch / name), first) << name;
  }
  EXPECT_EQ(scratch.entries(), static_cast<std::ptrdiff_t>(kNames.size()));
}

TEST(SurfaceWriter, FullDiskIsAnErrorAndLeavesNothing) {
  const Scratch scratch, empty;
  const TriangleSurface surface = patch(120, true, true);
  for (const std::string& name : kNames) {
    write_surface(scratch / name, surface);
    const auto size = std::filesystem::file_size(scratch / name);
    for (const std::uintmax_t room : {std::uintmax_t{0}, size / 2, size - 1}) {
      const test::FileSizeLimit limit(room);
      const auto message = error_of([&] { write_surface(empty / name, surface); });
      EXPECT_TRUE(says(message, name + ": could not be written"));
    }
    EXPECT_EQ(empty.entries(), 0) << name;
  }
}

TEST(SurfaceWriter, RefusesWhatIsNoSurface) {
  const Scratch scratch;
  const auto message = [&](const std::function<void(TriangleSurface&)>& spoil,
                           const std::string& name = "a.ply") {
    TriangleSurface surface = patch(3, true, true);
    spoil(surface);
    return error_of([&] { write_surface(scratch / name, surface); });
  };
  EXPECT_TRUE(says(message([](auto& s) { s.triangles[1][2] = 9; }),
                   "a.ply: expected triangles on 9 points, found one with point 9"));
  EXPECT_TRUE(says(message([](auto& s) { s.normals.pop_back(); }), "expected none or 9 normals"));
  EXPECT_TRUE(says(message([](auto& s) { s.values.pop_back(); }), "expected none or 9 values"));
  EXPECT_TRUE(says(message([](auto& s) { s.points[4].y = std::nan(""); }), "expected finite coordinates"));
  EXPECT_TRUE(says(message([](auto& s) { s.normals[4].y = INFINITY; }), "expected finite normals"));
  EXPECT_TRUE(says(message([](auto& s) { s.values[8] = INFINITY; }), "found inf at point 8"));
  EXPECT_TRUE(says(message([](auto&) {}, "a.xyz"), "expected .ply, .stl, .obj, .vtp, .glb or .gltf"));
  for (const char* name : {"a.stl", "a.glb", "a.gltf"}) {
    EXPECT_TRUE(says(message([](auto& s) { s.points[4].y = 1e39; }, name), "single precision can hold"));
  }
  EXPECT_EQ(scratch.entries(), 0);
}

/// Stops the work after the first report, or never.
class Impatient final : public Progress {
 public:
  void report(std::string_view, double fraction) override {
    EXPECT_GT(fraction, 0);
    EXPECT_LE(fraction, 1);
    last = fraction;
    ++reports;
  }
  [[nodiscard]] bool cancelled() const override { return stops && reports > 0; }
  bool stops = true;
  int reports = 0;
  double last = 0;
};

TEST(SurfaceWriter, ReportsAndCanBeStopped) {
  const Scratch scratch;
  const TriangleSurface surface = patch(301, true, true);
  for (const std::string& name : kNames) {
    Impatient progress;
    EXPECT_THROW(write_surface(scratch / name, surface, progress), Cancelled) << name;
    EXPECT_EQ(progress.reports, 1) << name;
    EXPECT_EQ(scratch.entries(), 0) << name;
  }
  for (const std::string& name : kNames) {
    Impatient progress;
    progress.stops = false;
    write_surface(scratch / name, surface, progress);
    EXPECT_EQ(progress.last, 1) << name;
  }
}

}  // namespace
}  // namespace adamas
