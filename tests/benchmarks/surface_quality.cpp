// Compares surfaces of a store with others of as many triangles: Flying Edges of every second, third, ...
// sample, and decimations of that of all samples. Distances are measured from and to Flying Edges of all
// samples, in voxels, at all corners and 100,000 random points. Prints a line of JSON for each surface.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <string>
#include <vector>

#include "adamas/volume_store.h"
#include "core/base/parallel.h"
#include "core/distance/closest_point_tree.h"
#include "tests/benchmarks/peers/volume_surfaces.h"
#include "tests/benchmarks/support/measurement.h"
#include "tests/support/surface_distance.h"

namespace adamas::bench {
namespace {

struct Distances {
  double mean = 0, most = 0, greatest = 0;  ///< `most` is the 99.9th percentile
};

Distances distances(const PeerSurface& from, const ClosestPointTree& to) {
  constexpr std::size_t kSamples = 100'000;
  const Box3 everywhere{{-1e9, -1e9, -1e9}, {1e9, 1e9, 1e9}};
  // Corners are denser where triangles are small, so the mean is taken over the random points, which come
  // after them.
  std::vector<double> found;
  const auto points = test::sample_surface(from.points, from.triangles, everywhere, kSamples, 1);
  for (const Vec3& p : points) found.push_back(std::sqrt(to.closest(p)->squared_distance));
  double sum = 0;
  const std::size_t first = found.size() - std::min(found.size(), kSamples);
  for (std::size_t n = first; n < found.size(); ++n) sum += found[n];
  return {sum / static_cast<double>(found.size() - first), quantile(found, 0.999), quantile(found, 1)};
}

/// Returns the mean of the triangles' least angles, in degrees, and the share of those below 10 degrees.
std::array<double, 2> least_angles(const PeerSurface& surface) {
  double sum = 0, narrow = 0;
  for (const auto& triangle : surface.triangles) {
    double least = 180;
    for (std::size_t c = 0; c < 3; ++c) {
      const Vec3 &p = surface.points[triangle[c]], &q = surface.points[triangle[(c + 1) % 3]],
                 &r = surface.points[triangle[(c + 2) % 3]];
      least =
          std::min(least, std::atan2(norm(cross(q - p, r - p)), dot(q - p, r - p)) * 180 / std::numbers::pi);
    }
    sum += least;
    narrow += least < 10 ? 1 : 0;
  }
  const auto count = static_cast<double>(surface.triangles.size());
  return {sum / count, narrow / count};
}

class Comparison {
 public:
  explicit Comparison(PeerSurface full) : full_(std::move(full)), tree_(full_.points, full_.triangles) {}

  [[nodiscard]] const PeerSurface& full() const { return full_; }

  void print(const std::string& name, const PeerSurface& surface, double seconds) const {
    if (surface.triangles.empty()) return;
    const Distances there = distances(surface, tree_);
    const Distances back = distances(full_, ClosestPointTree(surface.points, surface.triangles));
    const auto [angle, narrow] = least_angles(surface);
    std::printf(
        "{\"surface\": \"%s\", \"triangles\": %zu, \"seconds\": %.3f, \"to\": [%.4f, %.4f, %.4f], "
        "\"from\": [%.4f, %.4f, %.4f], \"angle\": %.1f, \"narrow\": %.4f}\n",
        name.c_str(), surface.triangles.size(), seconds, there.mean, there.most, there.greatest, back.mean,
        back.most, back.greatest, angle, narrow);
    std::fflush(stdout);
  }

 private:
  PeerSurface full_;
  ClosestPointTree tree_;
};

template <class Make>
void compare(const Comparison& comparison, const std::string& name, const Make& make) {
  const double before = thread_seconds();
  const PeerSurface surface = make();
  comparison.print(name, surface, thread_seconds() - before);
}

PeerSurface ours(const std::string& path, IsosurfaceRequest request) {
  VolumeStore store = VolumeStore::open(path);
  request.normals = false;
  Isosurface found = store.isosurface(request);
  // Places are in voxels, relative to the first sample.
  const VolumeGrid& grid = store.grid();
  for (Vec3& p : found.surface.points) p = 1 / grid.spacing.x * (p - grid.origin);
  return {std::move(found.surface.points), std::move(found.surface.triangles)};
}

void run(const std::string& path, double isovalue, const std::vector<int>& strides, bool decimations) {
  const Volume volume = VolumeStore::open(path).restore();
  const Comparison comparison(flying_edges_of(volume.grid, volume.samples, isovalue, 1));
  IsosurfaceRequest request;
  request.isovalue = isovalue;
  compare(comparison, "adamas, error 0", [&] { return ours(path, request); });
  request.plain = true;
  compare(comparison, "adamas, error 0, plain", [&] { return ours(path, request); });
  for (const int stride : strides) {
    const double before = thread_seconds();
    const PeerSurface coarse = flying_edges_of(volume.grid, volume.samples, isovalue, stride);
    comparison.print("Flying Edges, stride " + std::to_string(stride), coarse, thread_seconds() - before);
    request.max_triangles = coarse.triangles.size();
    for (const bool plain : {false, true}) {
      request.plain = plain;
      compare(comparison, plain ? "adamas, plain" : "adamas", [&] { return ours(path, request); });
    }
    if (!decimations) continue;
    compare(comparison, "vtkQuadricDecimation",
            [&] { return quadric_decimation(comparison.full(), coarse.triangles.size()); });
    compare(comparison, "vtkDecimatePro",
            [&] { return decimate_pro(comparison.full(), coarse.triangles.size()); });
  }
}

}  // namespace
}  // namespace adamas::bench

/// Usage: bench_surface_quality STORE ISOVALUE STRIDE... [--decimate]. The axes of the data have to be those
/// of space.
int main(int argc, char** argv) {
  if (argc < 4) return 2;
  adamas::set_thread_limit(1);
  std::vector<int> strides;
  bool decimations = false;
  for (int n = 3; n < argc; ++n) {
    if (std::string(argv[n]) == "--decimate") {
      decimations = true;
    } else {
      strides.push_back(std::atoi(argv[n]));
    }
  }
  adamas::bench::run(argv[1], std::atof(argv[2]), strides, decimations);
}
