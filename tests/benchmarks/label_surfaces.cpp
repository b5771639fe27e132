// Times the surfaces of labels by VTK: discrete Flying Edges, and these smoothed by a windowed sinc.
//   bench_label_surfaces FILE
// Prints a line of JSON: processor seconds on one thread, and triangles.

#include <fmt/format.h>

#include <cstdio>
#include <exception>

#include "core/io/multi_material_reader.h"
#include "tests/benchmarks/peers/material_surfaces.h"

namespace adamas::bench {
namespace {

void run(const char* path) {
  MaterialDataOptions options;
  options.labels = path;
  const LabelSurfaceCost cost = label_flying_edges(io::read_multi_material_data(path, options));
  fmt::print(R"({{"seconds": {:.6g}, "smoothed_seconds": {:.6g}, "triangles": {}}})"
             "\n",
             cost.seconds, cost.smoothed_seconds, cost.triangles);
}

}  // namespace
}  // namespace adamas::bench

int main(int count, char** arguments) {
  if (count != 2) {
    std::fputs("usage: bench_label_surfaces FILE\n", stderr);
    return 2;
  }
  try {
    adamas::bench::run(arguments[1]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_label_surfaces: %s\n", error.what());
    return 1;
  }
  return 0;
}
