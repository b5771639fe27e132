#include "interfaces/resampling/refinement.h"

#include <fmt/format.h>

#include <algorithm>
#include <queue>

#include "core/base/loop_progress.h"
#include "core/base/parallel.h"
#include "core/base/sort_unique.h"
#include "interfaces/resampling/cell_evaluation.h"
#include "interfaces/resampling/field_measurement.h"
#include "interfaces/resampling/refinement_forecast.h"
#include "interfaces/resampling/refinement_rounds.h"

namespace adamas::interfaces {

namespace {

/// Rounds split all cells above a falling threshold while the mesh is below this part of the budget; after
/// that, one diamond is split at a time. Both lead to the same mesh.
constexpr std::size_t kRoundsPart = 16;
/// When a cell has been split because of a fault, only parts smaller than this part of its diameter are
/// trusted: those of two more splits. With a quarter, meshes had a tenth to a third more cells.
constexpr double kTrustedPart = 0.65;

}  // namespace

Refinement::Priority Refinement::priority(TetrahedronId t) const {
  const CellRecord& cell = state_.hierarchy.payload(t);
  // Near a corner of a small cell there may be no vertex of the input's triangles. Interfaces lost by
  // distances to vertices there would be lost in smaller cells too.
  const bool too_small = state_.options.distance == DistanceMode::kNearestVertex &&
                         state_.frame(t).diameter() <= state_.options.interface_error;
  const double ratio = cell.interface.distance / state_.estimate_target();
  if (ratio > 1 && !too_small) return {cell.interface.lost ? 2 : 1, ratio};
  Priority result;
  for (std::size_t f = 0; f < cell.fields.size(); ++f) {
    if (!state_.options.field_errors[f] || !(cell.fields[f].reducible > *state_.options.field_errors[f]))
      continue;
    result = std::max(result, Priority{0, cell.fields[f].reducible / *state_.options.field_errors[f]});
  }
  return result;
}

bool Refinement::demands_split(TetrahedronId t) const {
  return state_.hierarchy.can_split(t) && priority(t).rank >= 0;
}

bool Refinement::wants_split(TetrahedronId t) const {
  return state_.hierarchy.is_leaf(t) && demands_split(t);
}

/// Splits in rounds; if the number of tetrahedra is limited, only up to a part of the limit. Returns the
/// leaves that are left to split.
std::vector<TetrahedronId> Refinement::refine_in_rounds(const std::vector<TetrahedronId>& cells) {
  RefinementRounds rounds;
  RefinementForecast forecast;
  const auto add = [&](const std::vector<TetrahedronId>& list) {
    for (const TetrahedronId t : list) rounds.add(t, state_.hierarchy.payload(t).deferred);
  };
  const auto next = [&] {
    return rounds.next([&](TetrahedronId t) { return wants_split(t); },
                       [&](TetrahedronId t) { return state_.hierarchy.is_leaf(t); },
                       [&](const std::vector<TetrahedronId>& leaves) { evaluate_waiting(leaves, forecast); });
  };
  add(cells);
  while (true) {
    const std::vector<TetrahedronId> failing = next();
    if (failing.empty()) return failing;
    std::vector<TetrahedronId> now = failing;
    if (state_.options.max_tetrahedra) {
      if (state_.hierarchy.leaf_count() > *state_.options.max_tetrahedra / kRoundsPart) return failing;
      Priority threshold;
      for (const TetrahedronId t : failing) threshold = std::max(threshold, priority(t));
      threshold.ratio = std::max(1.0, 0.5 * threshold.ratio);
      std::erase_if(now, [&](TetrahedronId t) { return priority(t) < threshold; });
      add(failing);
    }
    std::vector<Split> splits;
    for (const TetrahedronId t : now) {
      if (state_.hierarchy.is_leaf(t)) state_.hierarchy.split(t, splits);
    }
    std::optional<Parts> parts;
    if (is_foretold()) {
      parts = forecast.begin_round({now.size(), splits.size(), diameter_of(now), rounds.deferred_count()});
    }
    if (!parts) report();
    add(evaluate_splits(splits, parts));
  }
}

/// Begins a step of refinement with loops of so many items.
void Refinement::begin_step(const Parts& parts, std::size_t items, std::optional<LoopProgress>& stage) const {
  stage.emplace(state_.progress, stage_name(),
                StageWork{.items = static_cast<double>(items), .begin = parts[0], .end = parts[1]});
}

/// Estimates the errors of leaves that have waited until no other failed.
void Refinement::evaluate_waiting(const std::vector<TetrahedronId>& leaves, RefinementForecast& forecast) {
  std::optional<LoopProgress> stage;
  if (is_foretold() && !leaves.empty()) begin_step(forecast.begin_waiting(), leaves.size(), stage);
  parallel_for(leaves.size(), 16, [&](std::size_t i) { evaluate_interface(state_, leaves[i]); });
}

/// Splits one diamond after another, always that with the greatest error, until the budget is spent.
void Refinement::refine_greedily(const std::vector<TetrahedronId>& cells) {
  using Entry = std::pair<Priority, std::uint32_t>;
  // Among equal priorities the smaller id comes first.
  const auto later = [](const Entry& a, const Entry& b) {
    return a.first != b.first ? a.first < b.first : a.second > b.second;
  };
  std::priority_queue<Entry, std::vector<Entry>, decltype(later)> queue(later);
  const auto add = [&](const std::vector<TetrahedronId>& list) {
    for (const TetrahedronId t : list) {
      if (wants_split(t)) queue.emplace(priority(t), t.value);
    }
  };
  add(cells);
  for (std::size_t step = 0; !queue.empty(); ++step) {
    const TetrahedronId t(queue.top().second);
    queue.pop();
    if (!wants_split(t)) continue;
    if (step % 256 == 0) report();
    std::vector<Split> splits;
    state_.hierarchy.split(t, splits);
    if (state_.hierarchy.leaf_count() > *state_.options.max_tetrahedra) {
      merge_splits(splits);
      state_.budget_spent = true;
      return;
    }
    add(evaluate_splits(splits));
  }
}

void Refinement::refine_to_targets(std::vector<TetrahedronId> cells) {
  if (state_.budget_spent) return;
  cells = refine_in_rounds(cells);
  if (state_.options.max_tetrahedra && !cells.empty()) refine_greedily(cells);
}

std::vector<TetrahedronId> Refinement::split_failing(std::vector<TetrahedronId> failing) {
  sort_unique(failing);
  return split_cells(failing, true);
}

std::vector<TetrahedronId> Refinement::split_in_order(const std::vector<TetrahedronId>& cells) {
  return split_cells(cells, false);
}

/// Splits leaves in their order. `failing`: whether these cells have a fault.
std::vector<TetrahedronId> Refinement::split_cells(const std::vector<TetrahedronId>& cells, bool failing) {
  std::vector<Split> splits;
  for (const TetrahedronId t : cells) {
    if (!state_.hierarchy.is_leaf(t) || !state_.hierarchy.can_split(t)) continue;
    if (failing) {
      if (record_ != nullptr) record_->trusted.emplace_back(t, state_.hierarchy.payload(t).trusted);
      state_.hierarchy.payload(t).trusted = kTrustedPart * state_.frame(t).diameter();
    }
    const std::size_t before = splits.size();
    state_.hierarchy.split(t, splits);
    if (state_.options.max_tetrahedra && state_.hierarchy.leaf_count() > *state_.options.max_tetrahedra) {
      merge_splits({splits.begin() + static_cast<std::ptrdiff_t>(before), splits.end()});
      splits.resize(before);
      state_.budget_spent = true;
      break;
    }
  }
  return evaluate_splits(splits);
}

/// Evaluates the new vertices and leaves, and informs the observer and the record; returns the leaves
/// created. `parts`: those of the refinement that are done before and after, where they are foretold.
std::vector<TetrahedronId> Refinement::evaluate_splits(const std::vector<Split>& splits,
                                                       const std::optional<Parts>& parts) {
  std::vector<VertexId> vertices;
  std::vector<TetrahedronId> parents, created;
  for (const Split& split : splits) {
    if (!state_.hierarchy.payload(split.vertex).distances.body.valid()) vertices.push_back(split.vertex);
    if (state_.hierarchy.payload(split.parent).evaluated) parents.push_back(split.parent);
    for (const TetrahedronId child : split.children) {
      if (state_.hierarchy.is_leaf(child)) created.push_back(child);
    }
  }
  sort_unique(vertices);
  std::optional<LoopProgress> stage;
  if (parts) begin_step(*parts, vertices.size() + parents.size(), stage);
  evaluate_vertices(state_, vertices);
  parallel_for(parents.size(), 16, [&](std::size_t i) { evaluate_below(state_, parents[i], inner_); });
  if (observer_) observer_(parents, created);
  if (with_fields_) measure_fields(state_, created, DisplacedErrors::kWithinTargets);
  if (record_ != nullptr) record_->splits.insert(record_->splits.end(), splits.begin(), splits.end());
  return created;
}

/// Merges the splits, the last ones first.
void Refinement::merge_splits(const std::vector<Split>& splits) {
  std::vector<TetrahedronId> restored;
  for (auto split = splits.rbegin(); split != splits.rend(); ++split) {
    const DiamondId diamond = state_.hierarchy.diamond(split->parent);
    if (!state_.hierarchy.is_split(diamond)) continue;
    for (const TetrahedronId t : state_.hierarchy.tetrahedra(diamond)) gather_triangles(state_, t);
    state_.hierarchy.merge(diamond, restored);
  }
  // Some of the restored leaves have been merged again. Leaves of splits that stay may have vertices that are
  // evaluated later, with these leaves.
  restored = state_.leaves();
  std::erase_if(restored, [&](TetrahedronId t) {
    return state_.hierarchy.payload(t).evaluated ||
           std::ranges::any_of(state_.hierarchy.vertices(t), [&](VertexId v) {
             return !state_.hierarchy.payload(v).distances.body.valid();
           });
  });
  parallel_for(restored.size(), 16, [&](std::size_t i) { evaluate_interface(state_, restored[i]); });
}

void Refinement::undo_splits(const SplitRecord& record) {
  for (const auto& [t, trusted] : record.trusted) state_.hierarchy.payload(t).trusted = trusted;
  merge_splits(record.splits);
}

/// Returns the mean diameter of cells that fail, relative to the target for estimates.
double Refinement::diameter_of(const std::vector<TetrahedronId>& failing) const {
  double sum = 0;
  for (const TetrahedronId t : failing) sum += state_.frame(t).diameter();
  return sum / (static_cast<double>(failing.size()) * state_.estimate_target());
}

std::string Refinement::stage_name() const {
  return state_.stage(with_fields_ ? "refining fields" : "refining interfaces");
}

/// Reports the stage, and with a budget the part of its tetrahedra that are there.
void Refinement::report() const {
  if (!state_.options.max_tetrahedra) return state_.progress.step(stage_name(), -1);
  const std::size_t most = *state_.options.max_tetrahedra;
  state_.progress.step(fmt::format("{} of at most {}", stage_name(), most),
                       static_cast<double>(state_.hierarchy.leaf_count()) / static_cast<double>(most));
}

}  // namespace adamas::interfaces
