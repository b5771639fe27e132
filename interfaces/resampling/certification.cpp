#include <algorithm>
#include <atomic>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>

#include "core/base/parallel.h"
#include "core/base/sort_unique.h"
#include "interfaces/resampling/resampler.h"

namespace adamas::interfaces {

namespace {

/// Measuring and refining again usually ends after two or three rounds; the bound is for what cannot be
/// mended.
constexpr int kMostRounds = 20;
/// So many rounds for the sake of bodies may make nothing better before they end.
constexpr int kMostPatience = 3;
/// Once the mesh has become so many times larger since interfaces were first moved for the sake of volumes,
/// they move less rather than that cells become smaller.
constexpr std::size_t kMostGrowth = 3;
/// Torn bodies are mended before cells are split for them where that leaves one fault of so many, and
/// in the end where it leaves one of fewer.
constexpr std::size_t kMendedPart = 6, kMendedPartAtEnd = 2;
/// Cells this small, in relation to the target, are not split further: what is wrong there does not go away,
/// as where the input's interfaces have an open border and the approximation closes the gap.
constexpr double kFinestForInput = 1e-3;
constexpr double kFinestForApproximation = 0.25;
constexpr double kFinestForJunctions = 0.0625;
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
    add_leaf_at(shown.centroid(t), kFinestForApproximation * target, result);
  for (const auto& points : comparison_->far_junctions()) {
    for (const Vec3& p : points) add_leaf_at(p, kFinestForJunctions * target, result);
  }
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

/// Splits leaves where something was found wrong, whatever their estimates say, as far as the number of
/// tetrahedra allows; returns those that this made.
std::vector<TetrahedronId> Resampler::split_all(std::vector<TetrahedronId> failing) {
  sort_unique(failing);
  return split_in_order(failing, true);
}

/// Splits leaves, the first ones first, as far as the number of tetrahedra allows; returns those that this
/// made. What distances say of interfaces that the cells do not show is `doubted` from then on.
std::vector<TetrahedronId> Resampler::split_in_order(const std::vector<TetrahedronId>& cells, bool doubted) {
  std::vector<Split> splits;
  for (const TetrahedronId t : cells) {
    if (!hierarchy_.is_leaf(t) || !hierarchy_.can_split(t)) continue;
    if (doubted) {
      if (recorded_ != nullptr) recorded_->trusted.emplace_back(t, hierarchy_.payload(t).trusted);
      hierarchy_.payload(t).trusted = 0.25 * frame(t).diameter();
    }
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

/// Measures interfaces as the leaves show them now, once volumes agree.
ExtractedInterfaces Resampler::measure_shown(bool each) {
  if (conserves_) conserve_volumes();
  ExtractedInterfaces extracted =
      extract_interfaces(source_.network->table(), cells(), source_.box, progress_);
  report("measuring interfaces");
  // Which triangles are too far matters only where cells may be split for it, or interfaces move less.
  comparison_->measure(extracted.mesh, progress_, each || !budget_spent_ || options_.conserve);
  return extracted;
}

RefinementEnd Resampler::refine_what_fails() {
  // What has been split since bodies were most like the input's.
  Record since_best;
  std::optional<ShownBodies> best;
  int rounds_since_best = 0;
  bool mended = false;
  std::size_t first_moved = 0;  // leaves by then
  for (int round = 0;; ++round) {
    ExtractedInterfaces shown = measure_shown();
    if (conserves_ && first_moved == 0) first_moved = hierarchy_.leaf_count();
    const bool grown = conserves_ && hierarchy_.leaf_count() > kMostGrowth * first_moved;
    const auto end = [&](RefinementEnd reason) {
      if (!since_best.splits.empty()) {
        take_back(since_best);
        budget_spent_ = false;
        shown = measure_shown();
      }
      if (options_.conserve && !conserves_) {
        conserves_ = true;
        shown = measure_shown();
      }
      bodies_->measure(shown);
      mend_bodies(shown, kMendedPartAtEnd);
      certificate_ = comparison_->finish(shown.mesh, progress_);
      return comparison_->within() ? RefinementEnd::kReached : reason;
    };
    std::vector<TetrahedronId> failing;
    if (comparison_->within()) {
      if (!grown) failing = leaves_of_wanting_bodies();
    } else if (budget_spent_ && !options_.conserve) {
      return end(RefinementEnd::kBudget);
    } else {
      failing = failing_leaves(shown.mesh);
    }
    const bool settled = failing.empty();
    if ((settled || grown) && !comparison_->within() && round < kMostRounds && allow_smaller_shifts(shown))
      continue;
    if (settled && round < kMostRounds && refine_for_volumes()) continue;
    if (settled) {
      bodies_->measure(shown);
      // Once before splitting: twice half the error would leave cells that are never within the target.
      if (!mended) mended = mend_bodies(shown, kMendedPart);
      const ShownBodies now{bodies_->faults(options_.interface_error), hierarchy_.leaf_count(), {}};
      if (!best || now.are_better_than(*best)) {
        best = now;
        since_best = {};
        rounds_since_best = 0;
      } else if (++rounds_since_best == kMostPatience || now.leaves > best->most_leaves()) {
        return end(RefinementEnd::kSmallestCells);
      }
    }
    if (budget_spent_) return end(RefinementEnd::kBudget);
    if (round >= kMostRounds) return end(RefinementEnd::kRounds);
    if (settled) {
      recorded_ = &since_best;
      if (const auto reason = refine_for_bodies(shown.mesh, *best)) return end(*reason);
    } else {
      std::vector<TetrahedronId> created = split_all(std::move(failing));
      if (created.empty()) return end(budget_spent_ ? RefinementEnd::kBudget : RefinementEnd::kDepth);
      refine_to_targets(std::move(created));
    }
  }
}

/// Makes volumes agree and certifies distances, as far as either is wanted.
void Resampler::finish_interfaces() {
  if (source_.network->triangles().empty()) return;
  if (!options_.certify) {
    do {
      if (conserves_) conserve_volumes();
    } while (refine_for_volumes() && options_.conserve);
    return;
  }
  if (!comparison_) comparison_ = std::make_unique<InterfaceComparison>(source_, options_.interface_error);
  if (!bodies_) bodies_ = std::make_unique<BodyComparison>(source_);
  interface_end_ = refine_what_fails();
  recorded_ = nullptr;
}

}  // namespace adamas::interfaces
