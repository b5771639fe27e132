#pragma once

#include <cstddef>
#include <functional>
#include <utility>
#include <vector>

#include "interfaces/resampling/resampling_state.h"

namespace adamas::interfaces {

/// What has to be undone to take splitting back.
struct SplitRecord {
  std::vector<Split> splits;
  /// Cells whose `trusted` was changed, with the value before.
  std::vector<std::pair<TetrahedronId, double>> trusted;
};

/// Splits the hierarchy of a state and keeps its payload up to date: always the diamond with the greatest
/// error in relation to its target, until all are within it or the number of tetrahedra would be exceeded.
class Refinement {
 public:
  /// Receives the evaluated tetrahedra that were split, and the leaves that this made.
  using SplitObserver = std::function<void(const std::vector<TetrahedronId>& parents,
                                           const std::vector<TetrahedronId>& created)>;

  /// The state must outlive this object.
  explicit Refinement(ResamplingState& state) : state_(state) {}

  /// Splits these leaves and those that this makes until all are within their targets, or the budget is
  /// spent.
  void refine_to_targets(std::vector<TetrahedronId> cells);
  /// Splits leaves where something was found wrong, whatever their estimates say, as far as the number of
  /// tetrahedra allows; returns those that this made. What distances say of interfaces that these cells do
  /// not show is not trusted from then on.
  std::vector<TetrahedronId> split_failing(std::vector<TetrahedronId> failing);
  /// Splits leaves, the first ones first, as far as the number of tetrahedra allows; returns those that this
  /// made.
  std::vector<TetrahedronId> split_in_order(const std::vector<TetrahedronId>& cells);
  /// Undoes what was recorded.
  void take_back(const SplitRecord& record);
  /// Whether a tetrahedron would be split if it were a leaf.
  [[nodiscard]] bool demands_split(TetrahedronId t) const;

  /// From now on the errors of fields are measured in leaves that splitting makes, and reports say so.
  void include_fields() { with_fields_ = true; }
  /// Whether the errors of tetrahedra that are no leaves are worked out too.
  void evaluate_inner(bool inner) { inner_ = inner; }
  /// The record that receives what is split from now on; null for none.
  void record_in(SplitRecord* record) { record_ = record; }
  /// The observer of what is split from now on; may be empty.
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
  std::vector<TetrahedronId> refine_in_rounds(std::vector<TetrahedronId> cells);
  void refine_greedily(const std::vector<TetrahedronId>& cells);
  std::vector<TetrahedronId> split_cells(const std::vector<TetrahedronId>& cells, bool failing);
  std::vector<TetrahedronId> evaluate_splits(const std::vector<Split>& splits);
  void merge_splits(const std::vector<Split>& splits);
  void report() const;

  ResamplingState& state_;
  bool with_fields_ = false;
  bool inner_ = false;
  SplitRecord* record_ = nullptr;
  SplitObserver observer_;
};

}  // namespace adamas::interfaces
