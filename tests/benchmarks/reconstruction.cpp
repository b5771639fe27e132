// Compares interfaces from volume fractions: ours with planes in cells (PLIC), with discrete Flying Edges on
// the material with the greatest fraction, with these after smoothing, and with the contours at one half of
// each material's fractions.
//   bench_reconstruction DATA.vtr [SCENE]
// SCENE is the scene of the data, for distances from the truth. Prints a line of JSON for each method;
// lengths are in cells of the grid, volumes in parts of a cell or of a material.

#include "interfaces/reconstruction/reconstruction.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <limits>
#include <map>
#include <optional>
#include <string>

#include "core/base/parallel.h"
#include "core/io/multi_material_reader.h"
#include "datasets/scene.h"
#include "datasets/scene_interfaces.h"
#include "tests/benchmarks/peers/material_surfaces.h"
#include "tests/benchmarks/support/measurement.h"
#include "tests/support/surface_distance.h"

namespace adamas::bench {

using namespace datasets;
using namespace interfaces;
using namespace io;

namespace {

constexpr std::size_t kSamples = 10000;
/// The number of cells of the truth along an axis. Where the truth consists of spheres its vertices lie on
/// them.
constexpr double kTruthCells = 96;
/// A cell is mixed where a material has more than this part of it, and less than the rest.
constexpr double kMixed = 1e-3;

struct Row {
  std::string method;
  double volume_mean = 0, volume_max = 0;  ///< over mixed cells, of the greatest difference of a material
  double total_max = 0;                    ///< greatest relative difference of a material's volume
  double unfilled = 0;                     ///< gaps and overlaps, as a part of the domain
  std::size_t open_edges = 0;
  std::optional<double> distance_mean, distance_max;
  std::size_t triangles = 0;
  double seconds = 0;
};

double cell_volume(const RectilinearGrid& grid, std::size_t cell) {
  const std::size_t nx = grid.sites(0), ny = grid.sites(1);
  return grid.site_volume(cell % nx, cell / nx % ny, cell / nx / ny);
}

/// Compares the volumes that a method leaves to each material with those of the data.
void compare_volumes(const MultiMaterialData& data, const MaterialSurfaces& found, Row& row) {
  const std::size_t materials = data.materials.size();
  std::vector<double> wanted(materials, 0), made(materials, 0);
  std::size_t mixed = 0;
  for (std::size_t cell = 0; cell < data.grid.site_count(); ++cell) {
    const double volume = cell_volume(data.grid, cell);
    double worst = 0, sum = 0;
    bool is_mixed = false;
    for (std::size_t m = 0; m < materials; ++m) {
      const double f = data.fraction(MaterialId(m), cell), g = found.fractions[m][cell];
      wanted[m] += f * volume;
      made[m] += g * volume;
      sum += g;
      worst = std::max(worst, std::abs(f - g));
      is_mixed = is_mixed || (f > kMixed && f < 1 - kMixed);
    }
    row.unfilled += std::abs(1 - sum) * volume / data.grid.domain().volume();
    if (!is_mixed) continue;
    ++mixed;
    row.volume_mean += worst;
    row.volume_max = std::max(row.volume_max, worst);
  }
  row.volume_mean /= static_cast<double>(std::max<std::size_t>(mixed, 1));
  for (std::size_t m = 0; m < materials; ++m) {
    if (wanted[m] > 0) row.total_max = std::max(row.total_max, std::abs(made[m] - wanted[m]) / wanted[m]);
  }
}

/// Returns the number of edges of a single triangle inside the domain. Corners that coincide up to round-off
/// are the same.
std::size_t count_open_edges(const std::vector<Vec3>& points,
                             const std::vector<test::TriangleIndices>& triangles, const Box3& box) {
  const double grain = 1e-7 * box.diagonal();
  std::map<std::array<long long, 3>, std::uint32_t> numbers;
  std::vector<std::uint32_t> welded;
  std::vector<unsigned> sides;
  for (const Vec3& p : points) {
    const auto place = [&](double x) { return std::llround(x / grain); };
    welded.push_back(
        numbers.try_emplace({place(p.x), place(p.y), place(p.z)}, static_cast<std::uint32_t>(numbers.size()))
            .first->second);
    unsigned on = 0;
    for (int axis = 0; axis < 3; ++axis) {
      if (p[axis] <= box.min[axis] + grain) on |= 1u << (2 * axis);
      if (p[axis] >= box.max[axis] - grain) on |= 2u << (2 * axis);
    }
    sides.push_back(on);
  }
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> count;
  for (const auto& t : triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t a = t[i], b = t[(i + 1) % 3];
      if (welded[a] != welded[b] && (sides[a] & sides[b]) == 0) ++count[std::minmax(welded[a], welded[b])];
    }
  }
  return static_cast<std::size_t>(
      std::count_if(count.begin(), count.end(), [](const auto& edge) { return edge.second == 1; }));
}

/// Measures distances of random points of the surface from the truth. The greatest distance includes that of
/// the truth from the surface.
void compare_distances(const std::vector<Vec3>& points, const std::vector<test::TriangleIndices>& triangles,
                       const InterfaceMesh& truth, const MultiMaterialData& data, Row& row) {
  std::vector<test::TriangleIndices> true_triangles;
  for (const InterfaceTriangle& t : truth.triangles) true_triangles.push_back(t.points);
  const Box3 box = data.grid.domain();
  const double h = data.grid.least_spacing();
  const test::SurfaceGrid to_truth(truth.points, true_triangles), to_surface(points, triangles);
  double sum = 0, greatest = 0;
  const auto samples = test::sample_surface(points, triangles, box, kSamples, 1);
  for (const Vec3& p : samples) {
    const double d = to_truth.distance(p) / h;
    sum += d;
    greatest = std::max(greatest, d);
  }
  for (const Vec3& p : test::sample_surface(truth.points, true_triangles, box, kSamples, 2))
    greatest = std::max(greatest, to_surface.distance(p) / h);
  row.distance_mean = sum / static_cast<double>(std::max<std::size_t>(samples.size(), 1));
  row.distance_max = greatest;
}

void compare_surfaces(const std::vector<Vec3>& points, const std::vector<test::TriangleIndices>& triangles,
                      const MultiMaterialData& data, const std::optional<InterfaceMesh>& truth, Row& row) {
  row.triangles = triangles.size();
  row.open_edges = count_open_edges(points, triangles, data.grid.domain());
  if (truth) compare_distances(points, triangles, *truth, data, row);
}

Row measure_ours(const MultiMaterialData& data, const std::optional<InterfaceMesh>& truth) {
  Row row;
  row.method = "adamas";
  const double start = thread_seconds();
  const Reconstruction found(data);
  row.seconds = thread_seconds() - start;
  row.volume_mean = found.agreement().mean_difference;
  row.volume_max = found.agreement().greatest_difference;
  double sum = 0;
  for (MaterialId m(0); m.value < data.materials.size(); ++m.value) {
    const double wanted = found.volume_input()[m], made = found.volume_reconstructed()[m];
    sum += made;
    if (wanted > 0) row.total_max = std::max(row.total_max, std::abs(made - wanted) / wanted);
  }
  row.unfilled = std::abs(1 - sum / data.grid.domain().volume());
  std::vector<test::TriangleIndices> triangles;
  for (const InterfaceTriangle& t : found.mesh().triangles) triangles.push_back(t.points);
  compare_surfaces(found.mesh().points, triangles, data, truth, row);
  return row;
}

Row measure_peer(const std::string& method, const MaterialSurfaces& found, const MultiMaterialData& data,
                 const std::optional<InterfaceMesh>& truth) {
  Row row;
  row.method = method;
  row.seconds = found.seconds;
  compare_volumes(data, found, row);
  compare_surfaces(found.points, found.triangles, data, truth, row);
  return row;
}

void print(const Row& row) {
  const auto known = [](const std::optional<double>& x) {
    return x ? fmt::format("{:.6g}", *x) : std::string("null");
  };
  std::puts(
      fmt::format(R"({{"method": "{}", "volume_mean": {:.6g}, "volume_max": {:.6g}, "total_max": {:.6g}, )"
                  R"("unfilled": {:.6g}, "open_edges": {}, "distance_mean": {}, "distance_max": {}, )"
                  R"("triangles": {}, "seconds": {:.6g}}})",
                  row.method, row.volume_mean, row.volume_max, row.total_max, row.unfilled, row.open_edges,
                  known(row.distance_mean), known(row.distance_max), row.triangles, row.seconds)
          .c_str());
  std::fflush(stdout);
}

void run(const std::string& path, const std::string& scene) {
  set_thread_limit(1);
  MultiMaterialData data = read_multi_material_data(path);
  data.fields.clear();
  std::optional<InterfaceMesh> truth;
  if (!scene.empty()) truth = scene_interfaces(make_scene(scene), 1 / kTruthCells);
  print(measure_ours(data, truth));
  print(measure_peer("PLIC", youngs_interfaces(data), data, truth));
  print(measure_peer("discrete Flying Edges", discrete_flying_edges(data, 0), data, truth));
  constexpr int kIterations = 20;
  print(measure_peer("the same smoothed", discrete_flying_edges(data, kIterations), data, truth));
  print(measure_peer("contours at one half", fraction_contours(data), data, truth));
}

}  // namespace
}  // namespace adamas::bench

int main(int count, char** arguments) {
  if (count < 2 || count > 3) {
    std::fputs("usage: bench_reconstruction DATA.vtr [SCENE]\n", stderr);
    return 2;
  }
  try {
    adamas::bench::run(arguments[1], count > 2 ? arguments[2] : "");
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_reconstruction: %s\n", error.what());
    return 1;
  }
  return 0;
}
