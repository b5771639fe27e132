#include "interfaces/resampling/kept_distances.h"

namespace adamas::interfaces {

KeptDistances::KeptDistances(const ResamplingState& state) : shifts_(state.shifts) {
  state.hierarchy.for_each_vertex([&](VertexId v) {
    for (const NearDistance& near : state.hierarchy.payload(v).distances.near)
      distances_.push_back(near.distance);
  });
}

void KeptDistances::restore(ResamplingState& state) const {
  std::vector<VertexId> changed;
  for_each(state, [&](VertexId v, NearDistance& near, double kept) {
    if (near.distance != kept && (changed.empty() || changed.back() != v)) changed.push_back(v);
    near.distance = kept;
  });
  state.shifts = shifts_;
  state.forget_contacts(changed);
}

}  // namespace adamas::interfaces
