// Tests the smoothing of labels' staircases: what may not change, and how near the result is to the truth.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "core/base/error.h"
#include "core/distance/hausdorff.h"
#include "core/geometry/plane.h"
#include "datasets/random_numbers.h"
#include "datasets/scene.h"
#include "datasets/scene_sampling.h"
#include "interfaces/reconstruction/reconstruction.h"
#include "tests/support/closed_surface.h"

namespace adamas {

using namespace datasets;
using namespace interfaces;

namespace {

MultiMaterialData labelled(std::size_t materials, const std::array<std::size_t, 3>& n,
                           bool stretched = false) {
  MultiMaterialData data;
  data.source = "labels";
  for (std::size_t a = 0; a < 3; ++a) {
    for (std::size_t i = 0; i <= n[a]; ++i) {
      const auto x = static_cast<double>(i);
      data.grid.nodes[a].push_back(stretched ? x + 0.04 * x * x + 0.3 * static_cast<double>(a) * x : x);
    }
  }
  for (std::size_t m = 0; m < materials; ++m)
    data.materials.push_back(std::string(1, static_cast<char>('a' + m)));
  data.labels.resize(data.grid.site_count());
  return data;
}

template <class Label>
void set_labels(MultiMaterialData& data, const Label& label) {
  const auto& grid = data.grid;
  for (std::size_t k = 0; k < grid.sites(2); ++k) {
    for (std::size_t j = 0; j < grid.sites(1); ++j) {
      for (std::size_t i = 0; i < grid.sites(0); ++i)
        data.labels[grid.site_index(i, j, k)] = static_cast<std::uint16_t>(label(grid.site(i, j, k)));
    }
  }
}

MultiMaterialData labels_of(const std::string& name, std::size_t n) {
  const Scene scene = make_scene(name, 2);
  MultiMaterialData data = sample_scene(scene, {n, n, n}, {1, false});
  data.fractions.clear();
  data.fields.clear();
  data.labels.resize(data.grid.site_count());
  set_labels(data, [&](const Vec3& p) { return scene.owner(p).value; });
  return data;
}

/// Returns labels with a sheet of one voxel's thickness along a wavy surface between two materials, a rod and
/// a single voxel.
MultiMaterialData thin_things() {
  MultiMaterialData data = labelled(4, {14, 13, 12});
  set_labels(data, [](const Vec3& p) {
    const auto height = static_cast<int>(5 + std::floor(p.x / 4) - std::floor(p.y / 5));
    const auto k = static_cast<int>(p.z);
    if (k == height) return 1;
    if (k == 10 && static_cast<int>(p.y) == 6 && p.x > 3) return 3;
    if (k == 1 && static_cast<int>(p.x) == 8 && static_cast<int>(p.y) == 3) return 3;
    return k < height ? 0 : 2;
  });
  return data;
}

MultiMaterialData noise(std::uint64_t seed, bool stretched) {
  MultiMaterialData data = labelled(3, {7, 6, 8}, stretched);
  RandomNumbers random(seed);
  for (auto& label : data.labels)
    label = static_cast<std::uint16_t>(random.below(8) < 5 ? 0 : random.below(3));
  return data;
}

std::vector<MultiMaterialData> cases() {
  std::vector<MultiMaterialData> all{thin_things(), noise(1, false), noise(2, true)};
  for (const char* name : {"sphere", "voronoi10", "shell2", "plate"}) all.push_back(labels_of(name, 13));
  return all;
}

/// The faces between voxels of different labels.
struct Staircase {
  std::vector<Box3> faces;  ///< flat boxes
  std::vector<Vec3> points;
  std::vector<ClosestPointTree::Triangle> triangles;
};

Staircase staircase(const MultiMaterialData& data) {
  Staircase result;
  const RectilinearGrid& grid = data.grid;
  for (std::size_t k = 0; k < grid.sites(2); ++k) {
    for (std::size_t j = 0; j < grid.sites(1); ++j) {
      for (std::size_t i = 0; i < grid.sites(0); ++i) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
          std::array<std::size_t, 3> p{i, j, k}, q = p;
          if (++q[axis] >= grid.sites(static_cast<int>(axis))) continue;
          if (data.labels[grid.site_index(i, j, k)] == data.labels[grid.site_index(q[0], q[1], q[2])])
            continue;
          Box3 face;
          for (std::size_t a = 0; a < 3; ++a) {
            face.min[static_cast<int>(a)] = grid.nodes[a][q[a]];
            face.max[static_cast<int>(a)] = grid.nodes[a][p[a] + 1];
          }
          result.faces.push_back(face);
          const auto first = static_cast<std::uint32_t>(result.points.size());
          const int u = static_cast<int>(axis + 1) % 3;
          Vec3 one = face.min, two = face.min;
          one[u] = face.max[u];
          two[3 - static_cast<int>(axis) - u] = face.max[3 - static_cast<int>(axis) - u];
          result.points.insert(result.points.end(), {face.min, one, face.max, two});
          result.triangles.push_back({first, first + 1, first + 2});
          result.triangles.push_back({first, first + 2, first + 3});
        }
      }
    }
  }
  return result;
}

std::vector<ClosestPointTree::Triangle> triangles_of(const InterfaceMesh& mesh) {
  std::vector<ClosestPointTree::Triangle> triangles;
  for (const InterfaceTriangle& t : mesh.triangles) triangles.push_back(t.points);
  return triangles;
}

/// Sites keep their labels, and those of one body stay in one body. Bodies that touch may become one, joined
/// by slivers that hold no site.
TEST(LabelSmoothing, KeepsSitesAndBodies) {
  for (const MultiMaterialData& data : cases()) {
    SCOPED_TRACE(data.source);
    const Reconstruction plain(data), smooth(data, {.smooth_labels = true});
    const auto& grid = data.grid;
    std::map<std::size_t, std::size_t> there;
    for (std::size_t site = 0; site < grid.site_count(); ++site) {
      const std::size_t nx = grid.sites(0), ny = grid.sites(1);
      const Vec3 p = grid.site(site % nx, site / nx % ny, site / (nx * ny));
      const BodyId before = plain.body_at(p), after = smooth.body_at(p);
      ASSERT_EQ(smooth.body_materials()[after].value, data.labels[site]);
      ASSERT_EQ(there.try_emplace(before.value, after.value).first->second, after.value);
    }
  }
}

TEST(LabelSmoothing, KeepsVolumesAndCloses) {
  for (const MultiMaterialData& data : cases()) {
    SCOPED_TRACE(data.source);
    const Reconstruction smooth(data, {.smooth_labels = true});
    const Box3 box = data.grid.domain();
    for (MaterialId m(0); m.value < data.materials.size(); ++m.value)
      EXPECT_NEAR(smooth.volume_reconstructed()[m], smooth.volume_input()[m], 1e-9 * box.volume());
    const auto triangles = test::sided_by_material(smooth.mesh());
    const auto edges = test::check_edges(smooth.mesh().points, triangles, box, 1e-11 * box.diagonal());
    EXPECT_EQ(edges.open, 0u) << edges.first;
    EXPECT_EQ(edges.lonely, 0u) << edges.first;
  }
}

/// Along each axis no point is farther than half a voxel from the voxel faces, which are tried one by one. So
/// the distance, both ways, is at most half the diagonal of a voxel, as bounds of it confirm.
TEST(LabelSmoothing, StaysWithinHalfAVoxelOfTheFaces) {
  for (const MultiMaterialData& data : {thin_things(), noise(3, false), labels_of("voronoi10", 9)}) {
    SCOPED_TRACE(data.source);
    const Reconstruction smooth(data, {.smooth_labels = true});
    const Staircase faces = staircase(data);
    const double voxel = data.grid.least_spacing();
    for (const Vec3& p : smooth.mesh().points) {
      double nearest = 1e300;
      for (const Box3& face : faces.faces) {
        double farthest = 0;
        for (int axis = 0; axis < 3; ++axis)
          farthest = std::max({farthest, face.min[axis] - p[axis], p[axis] - face.max[axis]});
        nearest = std::min(nearest, farthest);
      }
      ASSERT_LE(nearest, (0.5 + 1e-9) * voxel);
    }
    const auto triangles = triangles_of(smooth.mesh());
    const double half_diagonal = 0.5 * std::sqrt(3.0) * voxel;
    HausdorffOptions options;
    options.relative = 0.01;
    const ClosestPointTree to_faces(faces.points, faces.triangles),
        to_smooth(smooth.mesh().points, triangles);
    EXPECT_LE(directed_distance_bound({smooth.mesh().points, triangles}, to_faces, options).upper,
              1.01 * half_diagonal);
    EXPECT_LE(directed_distance_bound({faces.points, faces.triangles}, to_smooth, options).upper,
              1.01 * half_diagonal);
  }
}

struct Roughness {
  double greatest = 0, mean = 0;  ///< distance of points from the truth
  double area = 0;
};

double area_of(const std::vector<Vec3>& polygon) {
  double area = 0;
  for (std::size_t i = 2; i < polygon.size(); ++i)
    area += 0.5 * norm(cross(polygon[i - 1] - polygon[0], polygon[i] - polygon[0]));
  return area;
}

template <class Distance>
Roughness roughness(const InterfaceMesh& mesh, const Distance& distance_of) {
  Roughness result;
  for (const Vec3& p : mesh.points) {
    const double d = std::abs(distance_of(p));
    result.greatest = std::max(result.greatest, d);
    result.mean += d / static_cast<double>(mesh.points.size());
  }
  for (const InterfaceTriangle& t : mesh.triangles) {
    const auto& [a, b, c] = t.points;
    result.area += 0.5 * norm(cross(mesh.points[b] - mesh.points[a], mesh.points[c] - mesh.points[a]));
  }
  return result;
}

/// The mean distance from the true sphere is about a third of that of the labels, and the area is that of the
/// sphere.
TEST(LabelSmoothing, MakesSpheresRound) {
  MultiMaterialData data = labelled(2, {32, 32, 32});
  const Vec3 centre{16.13, 16.27, 15.79};
  const double radius = 10, area = 4 * M_PI * radius * radius;
  set_labels(data, [&](const Vec3& p) { return distance(p, centre) < radius ? 1 : 0; });
  const auto from_truth = [&](const Vec3& p) { return distance(p, centre) - radius; };
  const Reconstruction labels(data), smoothed(data, {.smooth_labels = true});
  const Roughness plain = roughness(labels.mesh(), from_truth),
                  smooth = roughness(smoothed.mesh(), from_truth);
  std::printf("labelled sphere, voxels: greatest %.3f, mean %.3f, area by %.2f%%; plain %.3f, %.3f, %.1f%%\n",
              smooth.greatest, smooth.mean, 100 * (smooth.area / area - 1), plain.greatest, plain.mean,
              100 * (plain.area / area - 1));
  EXPECT_LT(smooth.mean, 0.35 * plain.mean);
  EXPECT_LT(smooth.greatest, 0.5);
  EXPECT_NEAR(smooth.area, area, 0.01 * area);
}

/// The area of a slope is that of the plane. Labels determine the plane only as far as it separates the
/// sites.
TEST(LabelSmoothing, MakesSlopesFlat) {
  MultiMaterialData data = labelled(2, {24, 24, 24});
  for (const Vec3& way : {Vec3{0.6, 0.64, 0.48}, Vec3{1, 1, 0}, Vec3{0.3, 0.1, 0.9}}) {
    const Vec3 normal = normalized(way), middle{12.1, 11.8, 12.3};
    set_labels(data, [&](const Vec3& p) { return dot(normal, p - middle) < 0 ? 1 : 0; });
    const auto from_truth = [&](const Vec3& p) { return dot(normal, p - middle); };
    const Reconstruction labels(data), smoothed(data, {.smooth_labels = true});
    const Roughness plain = roughness(labels.mesh(), from_truth),
                    smooth = roughness(smoothed.mesh(), from_truth);
    const double truth = area_of(clip_plane({middle, normal}, data.grid.domain()));
    std::printf("labelled slope: area by %.2f%%; plain %.1f%%\n", 100 * (smooth.area / truth - 1),
                100 * (plain.area / truth - 1));
    EXPECT_NEAR(smooth.area, truth, 0.03 * truth);
    EXPECT_GT(plain.area, 1.1 * truth);
    EXPECT_LT(smooth.greatest, 0.7);
  }
}

TEST(LabelSmoothing, RefusesFractions) {
  const MultiMaterialData data = sample_scene(make_scene("sphere"), {4, 4, 4}, {2, false});
  EXPECT_THROW(Reconstruction(data, {.smooth_labels = true}), Error);
}

}  // namespace
}  // namespace adamas
