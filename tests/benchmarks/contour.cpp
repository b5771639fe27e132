// Measures contours of a mesh of tetrahedra: tetrahedra a second of extract_contour beside
// vtkContour3DLinearGrid on the same tetrahedra and values, on one thread and with shared points. Prints a
// line of JSON for each row.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "core/base/parallel.h"
#include "datasets/buckyball.h"
#include "tests/benchmarks/peers/linear_grid_contour.h"
#include "tests/benchmarks/support/measurement.h"
#include "tests/support/table_contour.h"

namespace adamas::bench {

using namespace datasets;
using test::IndexedHierarchy;

namespace {

/// A buckyball whose samples lie at the points of a lattice with this many levels.
class LatticeVolume {
 public:
  explicit LatticeVolume(int levels) : shift_(kRootBits - levels), side_((std::size_t{1} << levels) + 1) {
    const Buckyball ball({side_, side_, side_}, SampleType::kUint8);
    samples_.resize(ball.grid().samples());
    for (std::size_t k = 0; k < side_; ++k)
      ball.plane(k, std::as_writable_bytes(std::span(samples_)).subspan(k * side_ * side_, side_ * side_));
  }

  double operator()(LatticePoint p) const { return samples_[index(p)]; }
  [[nodiscard]] std::size_t index(LatticePoint p) const {
    const auto at = [this](std::int32_t x) { return static_cast<std::size_t>(x >> shift_); };
    return at(p.i) + side_ * (at(p.j) + side_ * at(p.k));
  }

 private:
  int shift_;
  std::size_t side_;
  std::vector<std::uint8_t> samples_;
};

/// Returns a mesh in which diamonds are split for which `wanted` returns true, until there are `count`
/// tetrahedra or no such diamond can be split.
template <class Wanted>
IndexedHierarchy make_mesh(int levels, std::size_t count, Wanted&& wanted) {
  const double side = std::ldexp(1, levels);
  IndexedHierarchy mesh({{{0, 0, 0}, {side, side, side}}, {1, 1, 1}}, levels);
  std::vector<LatticePoint> points, done;
  do {
    points.clear();
    done.clear();
    mesh.for_each_diamond([&](const Diamond& diamond, std::uint8_t) {
      if (wanted(diamond)) points.push_back(diamond.point());
    });
    for (const LatticePoint p : points) mesh.split(p, done);
  } while (!done.empty() && mesh.tetrahedron_count() < count);
  return mesh;
}

/// Returns whether the isosurface may pass through the diamond, since values at its vertices are on both
/// sides.
bool is_crossed(const Diamond& diamond, const LatticeVolume& volume, double isovalue, const Domain& domain) {
  bool above = false, below = false;
  const auto look = [&](LatticePoint p) {
    if (!domain.contains(p)) return;
    (volume(p) >= isovalue ? above : below) = true;
  };
  const auto [a, b] = diamond.split_edge();
  look(a);
  look(b);
  for (int r = 0; r < diamond.tetrahedron_count(); ++r) look(diamond.ring(r));
  return above && below;
}

/// Returns the key of a point in z-order at the lattice's finest levels.
std::uint64_t z_order(LatticePoint p, int levels) {
  std::uint64_t key = 0;
  for (int bit = kRootBits; bit >= kRootBits - levels; --bit)
    for (int axis = 2; axis >= 0; --axis) key = key << 1 | (static_cast<std::uint64_t>(p[axis]) >> bit & 1);
  return key;
}

/// Returns the same tetrahedra with numbered points. Tetrahedra and points are in z-order; in the hierarchy's
/// own order, which is arbitrary, the peer would wait for memory.
LinearGridContour peer_of(const IndexedHierarchy& mesh, const LatticeVolume& volume) {
  std::vector<std::pair<std::uint64_t, std::array<LatticePoint, 4>>> corners;
  mesh.for_each_tetrahedron([&](const Diamond& diamond, int slot) {
    const auto [a, b] = diamond.split_edge();
    const LatticePoint c = diamond.ring(slot), d = diamond.ring((slot + 1) % diamond.tetrahedron_count());
    corners.push_back({z_order(diamond.point(), mesh.levels() + 1), {a, b, c, d}});
  });
  std::sort(corners.begin(), corners.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<Vec3> points;
  std::vector<float> values;
  std::vector<LinearGridContour::Tetrahedron> tetrahedra;
  std::unordered_map<LatticePoint, std::uint32_t> numbers;
  for (const auto& [key, tetrahedron] : corners) {
    LinearGridContour::Tetrahedron& numbered = tetrahedra.emplace_back();
    for (std::size_t n = 0; n < 4; ++n) {
      const LatticePoint p = tetrahedron[n];
      const auto [found, is_new] = numbers.try_emplace(p, static_cast<std::uint32_t>(points.size()));
      numbered[n] = found->second;
      if (!is_new) continue;
      points.push_back(mesh.domain().position(p));
      values.push_back(static_cast<float>(volume(p)));
    }
  }
  return {points, values, tetrahedra};
}

/// The options of the peer: whether triangles share their points, and whether normals are computed.
struct Comparison {
  const char* name;
  bool shared, normals;
};

/// Prints processor seconds of runs that alternate; the ratio is the median of the ratios of single runs.
void compare(const Comparison& what, const IndexedHierarchy& mesh, const LatticeVolume& volume,
             LinearGridContour& peer, int runs) {
  constexpr double kIsovalue = 80.5;
  std::vector<double> ours, theirs, ratios;
  std::size_t triangles = 0;
  LinearGridContour::Size size;
  for (int run = 0; run < runs; ++run) {
    double begin = thread_seconds();
    triangles = extract_contour(mesh, volume, kIsovalue).triangles.size();
    ours.push_back(thread_seconds() - begin);
    begin = thread_seconds();
    size = peer.contour(kIsovalue, what.shared, what.normals);
    theirs.push_back(thread_seconds() - begin);
    ratios.push_back(theirs.back() / ours.back());
  }
  const auto count = static_cast<double>(mesh.tetrahedron_count());
  std::printf(
      "{\"mesh\": \"%s\", \"tetrahedra\": %zu, \"triangles\": %zu, \"peer_triangles\": %llu, \"shared\": %s, "
      "\"normals\": %s, \"adamas\": %.0f, \"peer\": %.0f, \"ratio\": %.3f}\n",
      what.name, mesh.tetrahedron_count(), triangles, static_cast<unsigned long long>(size.triangles),
      what.shared ? "true" : "false", what.normals ? "true" : "false", count / quantile(ours, 0.5),
      count / quantile(theirs, 0.5), quantile(ratios, 0.5));
  std::fflush(stdout);
}

void compare_all(const char* name, const IndexedHierarchy& mesh, const LatticeVolume& volume, int runs) {
  LinearGridContour peer = peer_of(mesh, volume);
  compare({name, true, false}, mesh, volume, peer, runs);
  compare({name, true, true}, mesh, volume, peer, runs);
  compare({name, false, false}, mesh, volume, peer, runs);
}

void run(bool quick) {
  constexpr double kIsovalue = 80.5;
  const int levels = quick ? 6 : 8;
  const std::size_t count = quick ? 300'000 : 3'000'000;
  const int runs = quick ? 3 : 5;
  const LatticeVolume volume(levels);
  const IndexedHierarchy even = make_mesh(levels, count, [](const Diamond&) { return true; });
  compare_all("all of one size", even, volume, runs);
  // Coarser diamonds are split even where the values at their vertices do not show that they contain a part
  // of the surface.
  const IndexedHierarchy fine = make_mesh(levels, count, [&](const Diamond& diamond) {
    return trailing_zeros(diamond.point()) > kRootBits - 5 ||
           is_crossed(diamond, volume, kIsovalue, even.domain());
  });
  compare_all("fine at the surface", fine, volume, runs);
}

}  // namespace
}  // namespace adamas::bench

/// Usage: bench_contour [--quick]. With --quick meshes are smaller.
int main(int argc, char** argv) {
  adamas::set_thread_limit(1);
  adamas::bench::run(argc > 1 && std::string_view(argv[1]) == "--quick");
}
