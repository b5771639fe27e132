#include "tests/support/indexed_hierarchy.h"

#include <benchmark/benchmark.h>

#include <bit>
#include <cmath>
#include <random>
#include <vector>

namespace adamas {

using test::IndexedHierarchy;

namespace {

constexpr int kLevels = 16;

Domain unit_cube() { return {{{0, 0, 0}, {1, 1, 1}}, {1, 1, 1}}; }

/// Returns diamonds to split, in order, until there are `count` tetrahedra: those that meet a sphere, all of
/// one level before the next.
std::vector<LatticePoint> sphere_splits(std::size_t count) {
  IndexedHierarchy h(unit_cube(), kLevels);
  std::vector<LatticePoint> splits, wanted;
  while (h.tetrahedron_count() < count) {
    wanted.clear();
    h.for_each_tetrahedron([&](const Diamond& diamond, int) {
      const auto [a, b] = diamond.split_edge();
      const double radius = distance(h.domain().position(a), h.domain().position(b)) / 2;
      const double from_sphere = distance(h.domain().position(diamond.point()), {0.5, 0.5, 0.5}) - 0.4;
      if (std::abs(from_sphere) <= radius) wanted.push_back(diamond.point());
    });
    for (const LatticePoint p : wanted) {
      if (h.tetrahedron_count() < count) h.split(p, splits);
    }
  }
  return splits;
}

/// Returns diamonds to split, in order, from all over the mesh, so that successive ones are hardly ever near
/// each other.
std::vector<LatticePoint> random_splits(std::size_t count) {
  IndexedHierarchy h(unit_cube(), kLevels);
  std::mt19937 random(1);
  std::vector<LatticePoint> splits, candidates;
  h.for_each_tetrahedron([&](const Diamond& diamond, int) { candidates.push_back(diamond.point()); });
  while (h.tetrahedron_count() < count) {
    const std::size_t at = random() % candidates.size();
    const LatticePoint p = candidates[at];
    candidates[at] = candidates.back();
    candidates.pop_back();
    if (h.is_split(p) || !h.can_split(p)) continue;
    const std::size_t before = splits.size();
    h.split(p, splits);
    for (std::size_t s = before; s < splits.size(); ++s) {
      for (const LatticePoint child : Diamond(splits[s]).children(h.domain())) candidates.push_back(child);
    }
  }
  return splits;
}

using MakeSplits = std::vector<LatticePoint> (*)(std::size_t);

void splits(benchmark::State& state, MakeSplits make_splits) {
  const std::vector<LatticePoint> points = make_splits(static_cast<std::size_t>(state.range(0)));
  std::vector<LatticePoint> done;
  double bytes_per_diamond = 0, diamonds_per_tetrahedron = 0;
  for (auto _ : state) {
    IndexedHierarchy h(unit_cube(), kLevels);
    for (const LatticePoint p : points) {
      done.clear();
      h.split(p, done);
    }
    bytes_per_diamond = static_cast<double>(h.bytes()) / static_cast<double>(h.diamond_count());
    diamonds_per_tetrahedron =
        static_cast<double>(h.diamond_count()) / static_cast<double>(h.tetrahedron_count());
  }
  const double count = static_cast<double>(points.size() * state.iterations());
  state.counters["splits"] = benchmark::Counter(count, benchmark::Counter::kIsRate);
  state.counters["bytes_per_diamond"] = bytes_per_diamond;
  state.counters["diamonds_per_tetrahedron"] = diamonds_per_tetrahedron;
}

/// Merges everything in the reverse order of the splits. Making the mesh is not measured.
void merges(benchmark::State& state, MakeSplits make_splits) {
  const std::vector<LatticePoint> points = make_splits(static_cast<std::size_t>(state.range(0)));
  std::vector<LatticePoint> done;
  for (auto _ : state) {
    state.PauseTiming();
    IndexedHierarchy h(unit_cube(), kLevels);
    for (const LatticePoint p : points) h.split(p, done);
    state.ResumeTiming();
    for (auto p = points.rbegin(); p != points.rend(); ++p) h.merge(*p);
    if (h.tetrahedron_count() != 6) state.SkipWithError("not all was merged");
  }
  const double count = static_cast<double>(points.size() * state.iterations());
  state.counters["merges"] = benchmark::Counter(count, benchmark::Counter::kIsRate);
}

BENCHMARK_CAPTURE(splits, sphere, sphere_splits)->Arg(20000)->Arg(1000000)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(splits, random, random_splits)->Arg(20000)->Arg(1000000)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(merges, sphere, sphere_splits)->Arg(20000)->Arg(1000000)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(merges, random, random_splits)->Arg(20000)->Arg(1000000)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace adamas

BENCHMARK_MAIN();
