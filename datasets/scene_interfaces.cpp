#include "datasets/scene_interfaces.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/data/contact_mesh.h"
#include "datasets/local_scene.h"
#include "datasets/scene_integral.h"

namespace adamas::datasets {

namespace {

constexpr std::size_t kBlocksPerStep = 512;
constexpr double kMostCells = 4096;
// Points that are closer than this fraction of the box's diagonal are merged.
constexpr double kWeld = 1e-12;

using Cell = CellBlocks::Cell;

class Extraction {
 public:
  Extraction(const Scene& scene, const Cell& cells)
      : scene_(scene), grid_(uniform_grid(scene.box(), cells)), blocks_(grid_) {}

  InterfaceMesh run(Progress& progress) {
    ContactMeshBuilder builder(kWeld * scene_.box().diagonal());
    const std::size_t count = blocks_.count();
    for (std::size_t begin = 0; begin < count; begin += kBlocksPerStep) {
      progress.step("extracting interfaces", static_cast<double>(begin) / static_cast<double>(count));
      std::vector<ContactBuffer> buffers(std::min(kBlocksPerStep, count - begin));
      parallel_for(buffers.size(), 1, [&](std::size_t b) { run_block(begin + b, buffers[b]); });
      std::vector<const ContactBuffer*> found;
      for (const ContactBuffer& buffer : buffers) found.push_back(&buffer);
      builder.append(found);
    }
    InterfaceMesh mesh = builder.finish();
    mesh.source = "scene " + scene_.name();
    mesh.materials = scene_.materials();
    progress.step("extracting interfaces", 1);
    return mesh;
  }

 private:
  [[nodiscard]] Vec3 node(std::size_t i, std::size_t j, std::size_t k) const {
    return {grid_.nodes[0][i], grid_.nodes[1][j], grid_.nodes[2][k]};
  }

  void run_block(std::size_t block, ContactBuffer& buffer) const {
    const auto [first, last] = blocks_.cells(block);
    const LocalScene whole(scene_);
    LocalScene around(scene_), local(scene_);
    around.restrict_to(whole, {node(first[0], first[1], first[2]), node(last[0], last[1], last[2])});
    if (around.sole_owner()) return;
    CubeValues values;
    OwnershipProblem problem;
    for (std::size_t k = first[2]; k < last[2]; ++k) {
      for (std::size_t j = first[1]; j < last[1]; ++j) {
        for (std::size_t i = first[0]; i < last[0]; ++i) {
          local.restrict_to(around, {node(i, j, k), node(i + 1, j + 1, k + 1)});
          if (!local.sole_owner()) add_cube({i, j, k}, local, values, problem, buffer);
        }
      }
    }
  }

  void add_cube(const Cell& cell, const LocalScene& local, CubeValues& values, OwnershipProblem& problem,
                ContactBuffer& buffer) const {
    std::array<Vec3, 8> corners;
    std::array<std::uint64_t, 8> ids;
    const std::uint64_t nx = grid_.nodes[0].size(), ny = grid_.nodes[1].size();
    for (unsigned c = 0; c < 8; ++c) {
      const Cell n{cell[0] + (c & 1u), cell[1] + (c >> 1 & 1u), cell[2] + (c >> 2)};
      corners[c] = node(n[0], n[1], n[2]);
      ids[c] = n[0] + nx * (n[1] + ny * n[2]);
    }
    values.sample(local, corners);
    for (std::size_t t = 0; t < kCubeTetrahedra.size(); ++t) {
      const auto& v = kCubeTetrahedra[t];
      values.problem(local, t, problem);
      buffer.add({ids[v[0]], ids[v[1]], ids[v[2]], ids[v[3]]},
                 {corners[v[0]], corners[v[1]], corners[v[2]], corners[v[3]]}, problem);
    }
  }

  const Scene& scene_;
  RectilinearGrid grid_;
  CellBlocks blocks_;
};

/// Removes triangles between two candidates of one material, triangles that welding has collapsed, and the
/// points that only they use.
void keep_interfaces(InterfaceMesh& mesh) {
  std::erase_if(mesh.triangles, [](const InterfaceTriangle& t) {
    const auto& p = t.points;
    return t.front == t.back || p[0] == p[1] || p[1] == p[2] || p[2] == p[0];
  });
  constexpr std::uint32_t kUnused = 0xffffffffu;
  std::vector<std::uint32_t> number(mesh.points.size(), kUnused);
  std::vector<Vec3> points;
  for (InterfaceTriangle& t : mesh.triangles) {
    for (std::uint32_t& p : t.points) {
      if (number[p] == kUnused) {
        number[p] = static_cast<std::uint32_t>(points.size());
        points.push_back(mesh.points[p]);
      }
      p = number[p];
    }
  }
  mesh.points = std::move(points);
}

/// Moves every point onto the sphere whose triangles use it. A sphere is identified by its materials and the
/// sides on which they lie; each point goes to the sphere with most of its triangles' area.
void project_to_spheres(const std::vector<SceneSphere>& spheres, InterfaceMesh& mesh) {
  std::vector<double> votes(mesh.points.size() * spheres.size());
  for (const InterfaceTriangle& t : mesh.triangles) {
    const Vec3 &a = mesh.points[t.points[0]], &b = mesh.points[t.points[1]], &c = mesh.points[t.points[2]];
    const Vec3 area = cross(b - a, c - a);
    for (std::size_t s = 0; s < spheres.size(); ++s) {
      const SceneSphere& sphere = spheres[s];
      const double outwards = dot(area, a - sphere.center);
      const bool front_out = t.front == sphere.outside && t.back == sphere.inside;
      const bool front_in = t.front == sphere.inside && t.back == sphere.outside;
      const double vote = front_out ? outwards : front_in ? -outwards : 0;
      for (const std::uint32_t p : t.points) votes[p * spheres.size() + s] += vote;
    }
  }
  for (std::size_t p = 0; p < mesh.points.size(); ++p) {
    const auto first = votes.begin() + static_cast<std::ptrdiff_t>(p * spheres.size());
    const auto best = std::max_element(first, first + static_cast<std::ptrdiff_t>(spheres.size())) - first;
    const SceneSphere& sphere = spheres[static_cast<std::size_t>(best)];
    mesh.points[p] = sphere.center + sphere.radius * normalized(mesh.points[p] - sphere.center);
  }
}

}  // namespace

InterfaceMesh scene_interfaces(const Scene& scene, double resolution, Progress& progress) {
  if (!(resolution > 0) || !std::isfinite(resolution)) {
    fail("scene {}: expected a positive resolution, found {}", scene.name(), resolution);
  }
  Cell cells{1, 1, 1};
  if (!scene.planar()) {
    for (int axis = 0; axis < 3; ++axis) {
      const double n = std::ceil(scene.box().size()[axis] / resolution);
      if (!(n <= kMostCells)) {
        fail("scene {}: expected a resolution that gives at most {} cells along each axis, found {}",
             scene.name(), kMostCells, resolution);
      }
      cells[static_cast<std::size_t>(axis)] = static_cast<std::size_t>(std::max(n, 1.0));
    }
  }
  InterfaceMesh mesh = Extraction(scene, cells).run(progress);
  keep_interfaces(mesh);
  if (!scene.spheres().empty()) project_to_spheres(scene.spheres(), mesh);
  return mesh;
}

}  // namespace adamas::datasets
