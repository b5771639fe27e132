// Measures the way from a file to a surface: from a store to a surface of some error or number of triangles,
// beside reading the same samples raw and contouring all of them with Flying Edges. Each run has one thread
// and a process of its own. Prints a line of JSON for each row.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/parallel.h"
#include "core/distance/closest_point_tree.h"
#include "isosurface/extraction/surface_extractor.h"
#include "isosurface/extraction/surface_normals.h"
#include "tests/benchmarks/peers/flying_edges.h"
#include "tests/benchmarks/support/measurement.h"
#include "tests/support/surface_distance.h"

namespace adamas::bench {

using namespace isosurface;

namespace {

struct Inputs {
  std::filesystem::path store;
  FlyingEdges raw;
  std::size_t memory = std::size_t{256} << 20;  ///< for decoded pages; the default of `adamas isosurface`
  int runs = 5;
};

struct Wanted {
  std::string name;
  SurfaceRequest request;
};

ExtractedSurface extract(const Inputs& inputs, const SurfaceRequest& request, bool normals) {
  StoreFile file(inputs.store);
  return with_sample_type(file.header().grid.type, [&](auto sample) {
    using Sample = decltype(sample);
    StoredPages<OrderedWord<Sample>> pages(file, 0, inputs.memory);
    ExtractedSurface found = SurfaceExtractor<Sample>(pages).extract(request);
    if (normals &&
        surface_normals<Sample>(pages, found.contour).normals.size() != found.contour.points.size())
      throw std::runtime_error("normals are missing");
    return found;
  });
}

Cost measure_ours(const Inputs& inputs, const SurfaceRequest& request, bool normals) {
  return measure_in_child([&] {
    const ExtractedSurface found = extract(inputs, request, normals);
    return Outcome{found.contour.triangles.size(), found.max_error};
  });
}

Cost measure_theirs(const FlyingEdges& peer) {
  return measure_in_child([&] { return Outcome{peer.count(), 0}; });
}

void print_cost(const char* who, const Cost& cost) {
  std::printf(
      ", \"%s\": {\"seconds\": %.4f, \"processor_seconds\": %.4f, \"peak_bytes\": %llu, \"triangles\": %llu}",
      who, cost.seconds, cost.processor_seconds, static_cast<unsigned long long>(cost.peak_bytes),
      static_cast<unsigned long long>(cost.outcome.triangles));
}

/// Prints the costs of both, measured in runs that alternate.
void time_both(const Inputs& inputs, const Wanted& wanted, bool cold, bool normals) {
  FlyingEdges peer = inputs.raw;
  peer.normals = normals;
  std::vector<Cost> ours, theirs;
  for (int run = 0; run < inputs.runs; ++run) {
    if (cold) forget_pages(inputs.store);
    ours.push_back(measure_ours(inputs, wanted.request, normals));
    if (cold) forget_pages(peer.raw);
    theirs.push_back(measure_theirs(peer));
  }
  std::printf("{\"row\": \"time\", \"wanted\": \"%s\", \"cold\": %s, \"normals\": %s", wanted.name.c_str(),
              cold ? "true" : "false", normals ? "true" : "false");
  print_cost("adamas", median(ours));
  print_cost("peer", median(theirs));
  std::printf(", \"error\": %.4f}\n", ours.front().outcome.error);
  std::fflush(stdout);
}

struct Distances {
  double greatest = 0, most = 0;  ///< `most` is the 99.9th percentile
};

template <class Surface>
Distances distances(const Surface& from, const ClosestPointTree& to) {
  constexpr std::size_t kSamples = 100'000;
  const Box3 everywhere{{-1e9, -1e9, -1e9}, {1e9, 1e9, 1e9}};
  std::vector<double> found;
  for (const Vec3& p : test::sample_surface(from.points, from.triangles, everywhere, kSamples, 1))
    found.push_back(std::sqrt(to.closest(p)->squared_distance));
  return {quantile(found, 1), quantile(found, 0.999)};
}

template <class Surface>
void print_distances(const std::string& name, const Surface& surface, const PeerSurface& full,
                     const ClosestPointTree& full_tree) {
  const Distances there = distances(surface, full_tree);
  const Distances back = distances(full, ClosestPointTree(surface.points, surface.triangles));
  std::printf(
      "{\"row\": \"distance\", \"wanted\": \"%s\", \"triangles\": %zu, \"to\": %.4f, \"to_999\": %.4f, "
      "\"from\": %.4f, \"from_999\": %.4f}\n",
      name.c_str(), surface.triangles.size(), there.greatest, there.most, back.greatest, back.most);
  std::fflush(stdout);
}

/// Prints the distances of surfaces from that of Flying Edges at full resolution and back, in voxels.
void measure_distances(const Inputs& inputs, const std::vector<Wanted>& wanted) {
  const PeerSurface full = inputs.raw.surface();
  const ClosestPointTree tree(full.points, full.triangles);
  for (const Wanted& w : wanted)
    print_distances(w.name, extract(inputs, w.request, false).contour, full, tree);
  FlyingEdges coarse = inputs.raw;
  coarse.stride = 2;
  print_distances("Flying Edges, every 2nd sample", coarse.surface(), full, tree);
}

void time_coarse(const Inputs& inputs) {
  FlyingEdges coarse = inputs.raw;
  coarse.stride = 2;
  coarse.normals = true;
  std::vector<Cost> costs;
  for (int run = 0; run < inputs.runs; ++run) costs.push_back(measure_theirs(coarse));
  std::printf("{\"row\": \"coarse\"");
  print_cost("peer", median(costs));
  std::printf("}\n");
}

/// Measures surfaces with normals where the file is in memory: without error, joined and plain, and with an
/// error of 0.7 voxel.
void run_measured(const Inputs& inputs, double voxel) {
  std::vector<Wanted> all{{"error 0", {}}, {"error 0, plain", {}}, {"error 0.7 voxel", {}}};
  all[2].request.error = 0.7 * voxel;
  for (std::size_t n = 0; n < all.size(); ++n) {
    all[n].request.isovalue = inputs.raw.isovalue;
    all[n].request.strict = true;
    all[n].request.join = n != 1;
    time_both(inputs, all[n], false, true);
  }
}

void run(const Inputs& inputs, std::uint64_t triangles) {
  Wanted by_count{std::to_string(triangles) + " triangles", {}}, by_error{"error 0.7 voxel", {}};
  by_count.request.max_triangles = triangles;
  by_error.request.error = 0.7;
  std::vector<Wanted> both{by_count, by_error};
  for (Wanted& wanted : both) {
    wanted.request.isovalue = inputs.raw.isovalue;
    // A store that cannot be read would lead to a coarse surface, and that quickly.
    wanted.request.strict = true;
    wanted.request.join = true;
  }
  for (const Wanted& wanted : both)
    for (const bool normals : {true, false})
      for (const bool cold : {true, false}) time_both(inputs, wanted, cold, normals);
  time_coarse(inputs);
  measure_distances(inputs, both);
}

}  // namespace
}  // namespace adamas::bench

/// Usage: bench_disk_to_surface STORE RAW ISOVALUE TRIANGLES [RUNS [MEMORY]]. STORE is a store with a spacing
/// of 1, RAW has the same samples, and the others describe the surfaces. With 0 triangles only the rows of
/// run_measured are printed, and the spacing may be any.
int main(int argc, char** argv) {
  if (argc < 5) return 2;
  adamas::set_thread_limit(1);
  adamas::bench::Inputs inputs;
  inputs.store = argv[1];
  inputs.raw.raw = argv[2];
  inputs.raw.isovalue = std::atof(argv[3]);
  if (argc > 5) inputs.runs = std::atoi(argv[5]);
  if (argc > 6) inputs.memory = static_cast<std::size_t>(std::atoi(argv[6])) << 20;
  const adamas::VolumeGrid grid = adamas::isosurface::StoreFile(inputs.store).header().grid;
  inputs.raw.type = grid.type;
  inputs.raw.dimensions = grid.dimensions;
  const std::uint64_t triangles = std::stoull(argv[4]);
  if (triangles == 0) {
    adamas::bench::run_measured(inputs, std::min({grid.spacing.x, grid.spacing.y, grid.spacing.z}));
  } else {
    adamas::bench::run(inputs, triangles);
  }
}
