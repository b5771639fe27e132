#include "interfaces/hierarchy/hierarchy.h"

#include <benchmark/benchmark.h>

#include <cmath>
#include <random>
#include <vector>

namespace adamas {

using namespace interfaces;

namespace {

Domain unit_cube() { return {{{0, 0, 0}, {1, 1, 1}}, {1, 1, 1}}; }

std::vector<TetrahedronId> leaves(const HierarchyTopology& h) {
  std::vector<TetrahedronId> result;
  h.for_each_leaf([&](TetrahedronId t) { result.push_back(t); });
  return result;
}

/// Returns requests that refine towards a sphere until there are `count` leaves. Ids are the same in every
/// hierarchy with the same history, so the requests can be replayed.
std::vector<TetrahedronId> sphere_requests(std::size_t count) {
  Hierarchy<> h(unit_cube());
  std::vector<TetrahedronId> requests;
  std::vector<Split> done;
  const auto meets_sphere = [&](TetrahedronId t) {
    const auto [a, b] = h.split_edge(t);
    const Vec3 middle = 0.5 * (h.position(a) + h.position(b));
    return std::abs(distance(middle, {0.5, 0.5, 0.5}) - 0.4) <= distance(h.position(a), h.position(b)) / 2;
  };
  while (h.leaf_count() < count) {
    for (const TetrahedronId t : leaves(h)) {
      if (h.leaf_count() >= count || !h.is_leaf(t) || !meets_sphere(t)) continue;
      h.split(t, done);
      requests.push_back(t);
    }
  }
  return requests;
}

/// Returns requests for leaves from all over the mesh, so that successive ones are hardly ever near each
/// other.
std::vector<TetrahedronId> random_requests(std::size_t count) {
  Hierarchy<> h(unit_cube());
  std::mt19937 random(1);
  std::vector<TetrahedronId> requests, candidates = h.roots();
  std::vector<Split> done;
  while (h.leaf_count() < count) {
    const std::size_t at = random() % candidates.size();
    const TetrahedronId t = candidates[at];
    candidates[at] = candidates.back();
    candidates.pop_back();
    if (!h.is_leaf(t) || !h.can_split(t)) continue;
    done.clear();
    h.split(t, done);
    requests.push_back(t);
    for (const Split& split : done)
      candidates.insert(candidates.end(), split.children.begin(), split.children.end());
  }
  return requests;
}

using MakeRequests = std::vector<TetrahedronId> (*)(std::size_t);

void splits(benchmark::State& state, MakeRequests make_requests) {
  const std::vector<TetrahedronId> requests = make_requests(static_cast<std::size_t>(state.range(0)));
  std::size_t diamonds = 0;
  double bytes_per_tetrahedron = 0, diamonds_per_tetrahedron = 0;
  std::vector<Split> done;
  for (auto _ : state) {
    Hierarchy<> h(unit_cube());
    for (const TetrahedronId t : requests) {
      done.clear();
      h.split(t, done);
    }
    diamonds += h.vertex_count() - 8;
    bytes_per_tetrahedron = static_cast<double>(h.bytes()) / static_cast<double>(h.leaf_count());
    diamonds_per_tetrahedron = static_cast<double>(h.diamond_count()) / static_cast<double>(h.leaf_count());
  }
  state.counters["splits"] = benchmark::Counter(static_cast<double>(diamonds), benchmark::Counter::kIsRate);
  state.counters["bytes_per_tetrahedron"] = bytes_per_tetrahedron;
  state.counters["diamonds_per_tetrahedron"] = diamonds_per_tetrahedron;
}

/// Merges everything in the reverse order of the splits. Making the mesh is not measured.
void merges(benchmark::State& state, MakeRequests make_requests) {
  const std::vector<TetrahedronId> requests = make_requests(static_cast<std::size_t>(state.range(0)));
  std::size_t diamonds = 0;
  for (auto _ : state) {
    state.PauseTiming();
    Hierarchy<> h(unit_cube());
    std::vector<DiamondId> order;
    std::vector<Split> done;
    for (const TetrahedronId t : requests) {
      done.clear();
      h.split(t, done);
      VertexId last;
      for (const Split& split : done) {
        if (split.vertex != last) order.push_back(h.diamond(split.parent));
        last = split.vertex;
      }
    }
    std::vector<TetrahedronId> restored;
    state.ResumeTiming();
    for (auto d = order.rbegin(); d != order.rend(); ++d) {
      restored.clear();
      h.merge(*d, restored);
    }
    diamonds += order.size();
    if (h.leaf_count() != 6) state.SkipWithError("not all was merged");
  }
  state.counters["merges"] = benchmark::Counter(static_cast<double>(diamonds), benchmark::Counter::kIsRate);
}

BENCHMARK_CAPTURE(splits, sphere, sphere_requests)->Arg(20000)->Arg(1000000)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(splits, random, random_requests)->Arg(20000)->Arg(1000000)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(merges, sphere, sphere_requests)->Arg(20000)->Arg(1000000)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(merges, random, random_requests)->Arg(20000)->Arg(1000000)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace adamas

BENCHMARK_MAIN();
