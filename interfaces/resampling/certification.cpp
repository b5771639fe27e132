#include <algorithm>
#include <atomic>

#include "core/base/parallel.h"
#include "interfaces/resampling/resampler.h"

namespace adamas {

namespace {

/// Measuring and refining again usually ends after two or three rounds; the bound is for what cannot be
/// mended.
constexpr int kMostRounds = 12;
/// Cells this small, in relation to the target, are not split further: what is wrong there does not go away,
/// as where the input's interfaces have an open border and the approximation closes the gap.
constexpr double kFinestForInput = 1e-3;
constexpr double kFinestForApproximation = 0.25;
/// Relative slack of the measured bounds: to tell what is within the target, and for the figure that is
/// reported.
constexpr double kSharp = 0.005;
constexpr double kTight = 0.03;
/// Of a distance, in relation to the domain's diagonal.
constexpr double kRoundOff = 1e-15;

std::vector<ClosestPointTree::Triangle> indices(const InterfaceMesh& mesh) {
  std::vector<ClosestPointTree::Triangle> triangles;
  triangles.reserve(mesh.triangles.size());
  for (const InterfaceTriangle& t : mesh.triangles) triangles.push_back(t.points);
  return triangles;
}

}  // namespace

/// Measures both ways and returns the leaves where the distance is, or may be, greater than wanted.
std::vector<TetrahedronId> Resampler::measure_distance() {
  const InterfaceNetwork& network = *source_.network;
  const double target = options_.interface_error;
  const auto extracted = extract_interfaces(network.table(), cells(), source_.box, progress_);
  const auto triangles = indices(extracted.mesh);
  const ClosestPointTree approximation(extracted.mesh.points, triangles);
  HausdorffOptions options;
  options.domain = source_.box;
  options.accept = target;
  options.relative = kSharp;
  options.each = true;
  report("measuring interfaces");
  DistanceBound from =
      directed_distance_bound(network.points(), network.triangles(), approximation, options, progress_);
  DistanceBound to =
      directed_distance_bound(extracted.mesh.points, triangles, network.tree(), options, progress_);
  const auto set_distance = [&] {
    distance_ = InterfaceDistance{std::max(from.upper, to.upper), std::max(from.lower, to.lower),
                                  from.lower >= to.lower ? from.worst : to.worst, triangles.size()};
  };
  set_distance();
  if (distance_->upper <= target) {
    options.accept = 0.01 * target;
    options.relative = kTight;
    options.each = false;
    // One direction need not be known better than the other.
    from.lower = to.lower = distance_->lower;
    from.worst = to.worst = distance_->worst;
    tighten_distance_bound(network.points(), network.triangles(), approximation, options, from, progress_);
    to.lower = std::max(to.lower, from.lower);
    tighten_distance_bound(extracted.mesh.points, triangles, network.tree(), options, to, progress_);
    set_distance();
    // What was seen at any point may differ by round-off from what is seen at the same point otherwise.
    distance_->upper = std::min(distance_->upper + kRoundOff * source_.box.diagonal(), target);
    return {};
  }
  std::vector<TetrahedronId> result = leaves_far_from(approximation, from);
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    if (!(to.triangle_upper[t] > target)) continue;
    const auto& p = extracted.mesh.points;
    const TetrahedronId leaf =
        leaf_at((1.0 / 3) * (p[triangles[t][0]] + p[triangles[t][1]] + p[triangles[t][2]]));
    if (frame(leaf).diameter() > kFinestForApproximation * target) result.push_back(leaf);
  }
  std::sort(result.begin(), result.end());
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

/// Leaves with points of the input's interfaces that are farther from the approximation than wanted.
std::vector<TetrahedronId> Resampler::leaves_far_from(const ClosestPointTree& approximation,
                                                      const DistanceBound& from) const {
  const InterfaceNetwork& network = *source_.network;
  const double target = options_.interface_error;
  const std::vector<TetrahedronId> all = leaves();
  std::vector<char> bad(all.size(), 0);
  std::vector<std::atomic<bool>> explained(network.triangles().size());
  const auto too_far = [&](std::uint32_t t) { return from.triangle_upper[t] > target; };
  parallel_for(all.size(), 256, [&](std::size_t i) {
    for (const std::uint32_t t : hierarchy_.payload(all[i]).triangles) {
      if (!too_far(t)) continue;
      const auto& corners = network.triangle_corners(t);
      const Tetrahedron cell = frame(all[i]);
      Weights middle{};
      double count = 0;
      const auto check = [&](const Weights& w) {
        if (approximation.closest(cell.point(w), target)) return;
        bad[i] = 1;
        explained[t] = true;
      };
      for (const Weights& w : ClippedTriangle(cell, corners[0], corners[1], corners[2])) {
        check(w);
        for (std::size_t c = 0; c < 4; ++c) middle[c] += w[c];
        ++count;
      }
      for (double& w : middle) w /= count;
      if (count > 0) check(middle);
    }
  });
  // Too far somewhere between the points looked at: all cells of the triangle.
  parallel_for(all.size(), 256, [&](std::size_t i) {
    for (const std::uint32_t t : hierarchy_.payload(all[i]).triangles) {
      if (too_far(t) && !explained[t]) bad[i] = 1;
    }
  });
  std::vector<TetrahedronId> result;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (bad[i] != 0 && frame(all[i]).diameter() > kFinestForInput * target) result.push_back(all[i]);
  }
  return result;
}

RefinementEnd Resampler::refine_what_fails() {
  for (int round = 0; round < kMostRounds; ++round) {
    const std::vector<TetrahedronId> failing = measure_distance();
    if (distance_->upper <= options_.interface_error) return RefinementEnd::kReached;
    if (budget_spent_) return RefinementEnd::kBudget;
    if (failing.empty()) return RefinementEnd::kSmallestCells;
    std::vector<Split> splits;
    std::vector<TetrahedronId> created;
    for (const TetrahedronId t : failing) {
      if (!hierarchy_.is_leaf(t) || !hierarchy_.can_split(t)) continue;
      hierarchy_.payload(t).trusted = 0.25 * frame(t).diameter();
      const std::size_t before = splits.size();
      hierarchy_.split(t, splits);
      if (options_.max_tetrahedra && hierarchy_.leaf_count() > *options_.max_tetrahedra) {
        undo({splits.begin() + static_cast<std::ptrdiff_t>(before), splits.end()});
        splits.resize(before);
        budget_spent_ = true;
        break;
      }
    }
    if (splits.empty()) return budget_spent_ ? RefinementEnd::kBudget : RefinementEnd::kDepth;
    created = process(splits);
    refine_to_targets(std::move(created));
  }
  measure_distance();
  return distance_->upper <= options_.interface_error ? RefinementEnd::kReached : RefinementEnd::kRounds;
}

void Resampler::certify() {
  if (!source_.network->triangles().empty()) interface_end_ = refine_what_fails();
}

}  // namespace adamas
