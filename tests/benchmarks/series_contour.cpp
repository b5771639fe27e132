// Measures what a step of a series costs without a store: its samples are read from a file that has nothing
// else, and all of them are contoured by Flying Edges, with normals. Prints a line of JSON for each step.

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>

#include "tests/benchmarks/peers/flying_edges.h"
#include "tests/benchmarks/support/measurement.h"
#include "timevarying/restore_steps.h"

namespace adamas::bench {

using namespace isosurface;
using namespace timevarying;

namespace {

constexpr std::size_t kMemory = std::size_t{256} << 20;

/// Writes the samples of a step without any header.
void write_samples(StoreFile& file, std::uint32_t step, const std::filesystem::path& path) {
  std::ofstream out(path, std::ios::binary);
  const RestoredPart all = restored_part(file.header().grid, 0, {}, file.name());
  const auto put = [&](std::span<const std::byte> plane) {
    out.write(reinterpret_cast<const char*>(plane.data()), static_cast<std::streamsize>(plane.size()));
  };
  restore_step(file, step, all, kMemory, put, SilentProgress::instance());
}

void contour_step(const FlyingEdges& peer, std::uint32_t step) {
  const auto before = std::chrono::steady_clock::now();
  const double processor_before = thread_seconds();
  const std::uint64_t triangles = peer.count();
  const double processor = thread_seconds() - processor_before;
  const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - before;
  std::printf("{\"step\": %u, \"triangles\": %llu, \"seconds\": %.6f, \"processor_seconds\": %.6f}\n", step,
              static_cast<unsigned long long>(triangles), passed.count(), processor);
}

void run(StoreFile& file, double isovalue, const std::filesystem::path& raw) {
  FlyingEdges peer;
  peer.raw = raw;
  peer.dimensions = file.header().grid.dimensions;
  peer.type = file.header().grid.type;
  peer.isovalue = file.header().grid.sample(isovalue);
  peer.normals = true;
  for (std::uint32_t step = 0; step < file.steps(); ++step) {
    write_samples(file, step, raw);
    contour_step(peer, step);
  }
}

}  // namespace
}  // namespace adamas::bench

/// Usage: bench_series_contour STORE ISOVALUE RAW. RAW is a file that each step's samples are written to
/// before they are read.
int main(int argc, char** argv) {
  if (argc != 4) return 2;
  adamas::isosurface::StoreFile file(argv[1]);
  adamas::bench::run(file, std::atof(argv[2]), argv[3]);
}
