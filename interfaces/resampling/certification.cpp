#include <algorithm>
#include <atomic>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>

#include "core/base/parallel.h"
#include "interfaces/resampling/resampler.h"

namespace adamas {

namespace {

/// Measuring and refining again usually ends after two or three rounds; the bound is for what cannot be
/// mended.
constexpr int kMostRounds = 20;
/// Cells this small, in relation to the target, are not split further: what is wrong there does not go away,
/// as where the input's interfaces have an open border and the approximation closes the gap.
constexpr double kFinestForInput = 1e-3;
constexpr double kFinestForApproximation = 0.25;
constexpr double kFinestForJunctions = 0.0625;
constexpr double kFinestForContacts = 0.0625;
/// Cells much smaller than the thickness of a body show it, if any do.
constexpr double kFinestForThickness = 0.25;
/// Splitting for the sake of bodies is taken back where it has brought nothing by the time that the mesh has
/// grown so much, unless it is still small.
constexpr std::size_t kMostGrowth = 2, kHopeForBodies = 20'000;
/// What has to be left of all tears at most, for it to be worth more cells.
constexpr double kTornPart = 0.7;
/// Of the cells that tear bodies those are split that are at least so large, in relation to the largest.
constexpr double kLargeCells = 0.7;
/// How thick a body may be where it is looked at whether it is torn, in relation to the target.
constexpr double kMostTornThickness = 4;

/// Whether fewer bodies are lost or joined, or so many fewer torn that the cells which that takes are worth
/// it.
bool is_better(const BodyFaults& now, const BodyFaults& before) {
  if (now.lost_or_joined != before.lost_or_joined) return now.lost_or_joined < before.lost_or_joined;
  return static_cast<double>(now.torn) <= kTornPart * static_cast<double>(before.torn);
}

Vec3 middle_of(const InterfaceMesh& mesh, std::uint32_t triangle) {
  const auto& p = mesh.triangles[triangle].points;
  return (1.0 / 3) * (mesh.points[p[0]] + mesh.points[p[1]] + mesh.points[p[2]]);
}

}  // namespace

/// Adds the leaf that holds a point, unless its diameter is no more than `finest`.
void Resampler::add_leaf_at(const Vec3& p, double finest, std::vector<TetrahedronId>& leaves) const {
  const TetrahedronId leaf = leaf_at(p);
  if (frame(leaf).diameter() > finest) leaves.push_back(leaf);
}

/// The leaves where what was measured is, or may be, farther away than wanted.
std::vector<TetrahedronId> Resampler::failing_leaves(const InterfaceMesh& shown) const {
  const double target = options_.interface_error;
  std::vector<TetrahedronId> result = leaves_far_from_shown();
  for (const std::uint32_t t : comparison_->far_shown())
    add_leaf_at(middle_of(shown, t), kFinestForApproximation * target, result);
  for (const auto& points : comparison_->far_junctions()) {
    for (const Vec3& p : points) add_leaf_at(p, kFinestForJunctions * target, result);
  }
  std::sort(result.begin(), result.end());
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

/// Leaves with points of a material's boundary in the input that are farther from the one shown than wanted.
std::vector<TetrahedronId> Resampler::leaves_far_from_shown() const {
  const InterfaceNetwork& network = *source_.network;
  const double target = options_.interface_error;
  const std::vector<TetrahedronId> all = leaves();
  std::vector<char> bad(all.size(), 0);
  std::vector<std::atomic<bool>> explained(network.triangles().size());
  parallel_for(all.size(), 256, [&](std::size_t i) {
    for (const std::uint32_t t : hierarchy_.payload(all[i]).triangles) {
      const auto& corners = network.triangle_corners(t);
      for (std::size_t side = 0; side < 2; ++side) {
        if (!comparison_->too_far(t, side)) continue;
        const ClosestPointTree& boundary = comparison_->shown_boundary(t, side);
        const Tetrahedron cell = frame(all[i]);
        Weights middle{};
        double count = 0;
        const auto check = [&](const Weights& w) {
          if (boundary.closest(cell.point(w), target)) return;
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
    }
  });
  // Too far somewhere between the points looked at: all cells of the triangle.
  parallel_for(all.size(), 256, [&](std::size_t i) {
    for (const std::uint32_t t : hierarchy_.payload(all[i]).triangles) {
      if ((comparison_->too_far(t, 0) || comparison_->too_far(t, 1)) && !explained[t]) bad[i] = 1;
    }
  });
  std::vector<TetrahedronId> result;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (bad[i] != 0 && frame(all[i]).diameter() > kFinestForInput * target) result.push_back(all[i]);
  }
  return result;
}

/// Splits leaves whatever their estimates say, as far as the number of tetrahedra allows; returns those that
/// this made.
std::vector<TetrahedronId> Resampler::split_all(const std::vector<TetrahedronId>& failing) {
  std::vector<Split> splits;
  for (const TetrahedronId t : failing) {
    if (!hierarchy_.is_leaf(t) || !hierarchy_.can_split(t)) continue;
    if (recorded_ != nullptr) recorded_->trusted.emplace_back(t, hierarchy_.payload(t).trusted);
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
  return process(splits);
}

/// Leaves where the mesh tears bodies that are larger than the target, or joins bodies that do not touch in
/// the input.
std::vector<TetrahedronId> Resampler::leaves_with_wrong_bodies(const InterfaceMesh& shown) const {
  const double target = options_.interface_error;
  std::vector<TetrahedronId> result;
  for (const std::uint32_t t : bodies_->contact_triangles())
    add_leaf_at(middle_of(shown, t), kFinestForContacts * target, result);
  const InterfaceTable& table = source_.network->table();
  IdVector<BodyId, char> wrong(table.body_count(), 0);
  for (BodyId b(0); b.value < wrong.size(); ++b.value)
    wrong[b] = !bodies_->report().kept(b) && bodies_->size(b) > target ? 1 : 0;
  const std::vector<TetrahedronId> all = leaves();
  std::vector<std::vector<TetrahedronId>> torn(all.size());
  parallel_for(all.size(), 256, [&](std::size_t i) { find_torn_leaves(all[i], wrong, torn[i]); });
  // Larger cells first: what they tear is often all there is.
  double largest = 0;
  for (const auto& part : torn) {
    for (const TetrahedronId t : part) largest = std::max(largest, frame(t).diameter());
  }
  for (const auto& part : torn) {
    std::copy_if(part.begin(), part.end(), std::back_inserter(result),
                 [&](TetrahedronId t) { return frame(t).diameter() >= kLargeCells * largest; });
  }
  std::sort(result.begin(), result.end());
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

/// Adds the leaves that hold the middle between a triangle of a leaf and what is opposite to it within one of
/// the bodies, where the mesh gives that place to another body.
void Resampler::find_torn_leaves(TetrahedronId leaf, const IdVector<BodyId, char>& bodies,
                                 std::vector<TetrahedronId>& torn) const {
  const InterfaceNetwork& network = *source_.network;
  const InterfaceTable& table = network.table();
  const Tetrahedron cell = frame(leaf);
  for (const std::uint32_t triangle : hierarchy_.payload(leaf).triangles) {
    const auto& sides = table.sides(network.interface_of(triangle));
    if (bodies[sides[0]] == 0 && bodies[sides[1]] == 0) continue;
    const auto& corners = network.triangle_corners(triangle);
    Vec3 p;
    double count = 0;
    for (const Weights& w : ClippedTriangle(cell, corners[0], corners[1], corners[2]))
      p += cell.point(w), ++count;
    if (count == 0) continue;
    p = (1 / count) * p;
    for (std::size_t side = 0; side < 2; ++side) {
      const BodyId body = sides[side];
      if (bodies[body] == 0) continue;
      const Vec3 inwards = (side == 0 ? 1.0 : -1.0) * network.normal(triangle);
      const auto hit =
          network.tree().first_hit(p, inwards, kMostTornThickness * options_.interface_error, triangle);
      if (!hit) continue;
      const auto& opposite = table.sides(network.interface_of(hit->triangle));
      if (opposite[0] != body && opposite[1] != body) continue;
      const Vec3 middle = p + 0.5 * hit->t * inwards;
      if (!source_.box.contains(middle) || owner_at(middle) == body) continue;
      add_leaf_at(middle, kFinestForThickness * hit->t, torn);
    }
  }
}

/// Measures interfaces as the leaves show them now, once volumes agree; bodies too, where distances are good.
ExtractedInterfaces Resampler::measure_shown() {
  if (options_.conserve) conserve_volumes();
  ExtractedInterfaces extracted =
      extract_interfaces(source_.network->table(), cells(), source_.box, progress_);
  report("measuring interfaces");
  comparison_->measure(extracted.mesh, progress_);
  if (comparison_->within()) bodies_->measure(extracted);
  return extracted;
}

RefinementEnd Resampler::refine_what_fails() {
  // What has been split for the sake of bodies since they were most like the input's.
  Record for_bodies;
  std::size_t leaves_then = 0;
  std::optional<BodyFaults> fewest;
  for (int round = 0;; ++round) {
    ExtractedInterfaces shown = measure_shown();
    const bool within = comparison_->within();
    const auto end = [&](RefinementEnd reason) {
      if (!for_bodies.splits.empty()) {
        take_back(for_bodies);
        budget_spent_ = false;
        shown = measure_shown();
      }
      if (!comparison_->within()) bodies_->measure(shown);
      certificate_ = comparison_->finish(shown.mesh, progress_);
      return comparison_->within() ? RefinementEnd::kReached : reason;
    };
    if (within && (!fewest || is_better(bodies_->faults(options_.interface_error), *fewest))) {
      fewest = bodies_->faults(options_.interface_error);
      for_bodies = {};
      leaves_then = hierarchy_.leaf_count();
    } else if (within && hierarchy_.leaf_count() > std::max(kHopeForBodies, kMostGrowth * leaves_then)) {
      return end(RefinementEnd::kReached);
    }
    if (budget_spent_) return end(RefinementEnd::kBudget);
    if (round >= kMostRounds) return end(RefinementEnd::kRounds);
    std::vector<TetrahedronId> failing = within ? leaves_of_wanting_bodies() : failing_leaves(shown.mesh);
    if (failing.empty() && within) {
      failing = leaves_with_wrong_bodies(shown.mesh);
      recorded_ = &for_bodies;
    }
    if (failing.empty() && !within && allow_smaller_shifts(shown)) continue;
    if (failing.empty()) return end(RefinementEnd::kSmallestCells);
    std::vector<TetrahedronId> created = split_all(failing);
    if (created.empty()) return end(budget_spent_ ? RefinementEnd::kBudget : RefinementEnd::kDepth);
    refine_to_targets(std::move(created));
  }
}

/// Makes volumes agree and certifies distances, as far as either is wanted.
void Resampler::finish_interfaces() {
  if (source_.network->triangles().empty()) return;
  if (!options_.certify) {
    if (options_.conserve) conserve_volumes();
    return;
  }
  if (!comparison_) comparison_ = std::make_unique<InterfaceComparison>(source_, options_.interface_error);
  if (!bodies_) bodies_ = std::make_unique<BodyComparison>(source_);
  interface_end_ = refine_what_fails();
  recorded_ = nullptr;
}

}  // namespace adamas
