#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/loop_progress.h"
#include "interfaces/resampling/refinement_forecast.h"
#include "interfaces/resampling/resampling_state.h"

namespace adamas::interfaces {

/// The changes that have to be undone to take splits back.
struct SplitRecord {
  std::vector<Split> splits;
  /// Cells whose `trusted` was changed, with the previous values.
  std::vector<std::pair<TetrahedronId, double>> trusted;
};

/// Splits the hierarchy of a state and keeps its payload up to date. It always splits the diamond with the
/// greatest error relative to its target, until all errors are within their targets or the number of
/// tetrahedra would be exceeded.
class Refinement {
 public:
  /// A function that receives the evaluated tetrahedra that were split, and the leaves that were created.
  using SplitObserver = std::function<void(const std::vector<TetrahedronId>& parents,
                                           const std::vector<TetrahedronId>& created)>;

  /// The state must outlive this object.
  explicit Refinement(ResamplingState& state) : state_(state) {}

  /// Splits these leaves and those created by that until all are within their targets or the budget is spent.
  void refine_to_targets(std::vector<TetrahedronId> cells);
  /// Splits leaves with a fault, independent of their estimates, as far as the number of tetrahedra allows;
  /// returns the leaves created. From then on, estimates from distances are not trusted for interfaces that
  /// these cells do not show.
  std::vector<TetrahedronId> split_failing(std::vector<TetrahedronId> failing);
  /// Splits leaves in their order, as far as the number of tetrahedra allows; returns the leaves created.
  std::vector<TetrahedronId> split_in_order(const std::vector<TetrahedronId>& cells);
  /// Undoes the recorded splits.
  void undo_splits(const SplitRecord& record);
  /// Returns whether a tetrahedron would be split if it were a leaf.
  [[nodiscard]] bool demands_split(TetrahedronId t) const;

  /// From now on, the errors of fields are measured in new leaves, and reports say so.
  void include_fields() { with_fields_ = true; }
  /// Sets whether the errors of tetrahedra that are no leaves are estimated too.
  void evaluate_inner(bool inner) { inner_ = inner; }
  /// Sets the record that receives later splits; null for none.
  void record_in(SplitRecord* record) { record_ = record; }
  /// Sets the observer of later splits, which may be empty.
  void set_observer(SplitObserver observer) { observer_ = std::move(observer); }

 private:
  /// The place of a tetrahedron in the priority queue of refinement, the greatest first.
  struct Priority {
    int rank = -1;  ///< 2: a lost interface, 1: an interface, 0: a field, -1: within all targets
    double ratio = 0;
    auto operator<=>(const Priority&) const = default;
  };

  [[nodiscard]] Priority priority(TetrahedronId t) const;
  [[nodiscard]] bool wants_split(TetrahedronId t) const;
  std::vector<TetrahedronId> refine_in_rounds(const std::vector<TetrahedronId>& cells);
  using Parts = RefinementForecast::Parts;
  void begin_step(const Parts& parts, std::size_t items, std::optional<LoopProgress>& stage) const;
  void evaluate_waiting(const std::vector<TetrahedronId>& leaves, RefinementForecast& forecast);
  void refine_greedily(const std::vector<TetrahedronId>& cells);
  std::vector<TetrahedronId> split_cells(const std::vector<TetrahedronId>& cells, bool failing);
  std::vector<TetrahedronId> evaluate_splits(const std::vector<Split>& splits,
                                             const std::optional<Parts>& parts = {});
  void merge_splits(const std::vector<Split>& splits);
  /// Whether a forecast holds: it is one of interfaces, without a budget.
  [[nodiscard]] bool is_foretold() const { return !with_fields_ && !state_.options.max_tetrahedra; }
  [[nodiscard]] double diameter_of(const std::vector<TetrahedronId>& failing) const;
  [[nodiscard]] std::string stage_name() const;
  void report() const;

  ResamplingState& state_;
  bool with_fields_ = false;
  bool inner_ = false;
  SplitRecord* record_ = nullptr;
  SplitObserver observer_;
};

}  // namespace adamas::interfaces
