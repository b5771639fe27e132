#pragma once

#include <vector>

#include "interfaces/resampling/resampling_state.h"

namespace adamas::interfaces {

/// The distances at all vertices of a state, and the shifts that are in them, as they are when this is made.
/// What uses them needs the same vertices.
class KeptDistances {
 public:
  explicit KeptDistances(const ResamplingState& state);

  [[nodiscard]] const IdVector<InterfaceId, double>& shifts() const { return shifts_; }
  /// Calls visit(vertex, distance now, distance kept) for all distances of the state, which may change.
  template <class Visit>
  void for_each(ResamplingState& state, Visit&& visit) const {
    auto kept = distances_.begin();
    state.hierarchy.for_each_vertex([&](VertexId v) {
      for (NearDistance& near : state.hierarchy.payload(v).distances.near) visit(v, near, *kept++);
    });
  }
  /// Sets the distances and the shifts again, and forgets the contacts of leaves where this changes them.
  void restore(ResamplingState& state) const;

 private:
  IdVector<InterfaceId, double> shifts_;
  std::vector<double> distances_;
};

}  // namespace adamas::interfaces
