#include "interfaces/errors/nested_errors.h"

#include <algorithm>

namespace adamas {

namespace {

/// All diamonds, ancestors first: by level, then by phase.
std::vector<DiamondId> in_order(const HierarchyTopology& hierarchy) {
  std::vector<std::pair<int, DiamondId>> ranked;
  hierarchy.for_each_diamond([&](DiamondId d) {
    const TetrahedronId t = *hierarchy.tetrahedra(d).begin();
    ranked.emplace_back(3 * hierarchy.level(t) + hierarchy.phase(t), d);
  });
  std::sort(ranked.begin(), ranked.end());
  std::vector<DiamondId> order;
  for (const auto& [rank, d] : ranked) order.push_back(d);
  return order;
}

}  // namespace

NestedErrors nest_errors(const HierarchyTopology& hierarchy,
                         const std::function<double(TetrahedronId)>& direct) {
  const std::vector<DiamondId> order = in_order(hierarchy);
  NestedErrors nested;
  nested.of_tetrahedra.assign(hierarchy.tetrahedron_slots(), 0.0);
  std::size_t slots = 0;
  for (const DiamondId d : order) slots = std::max<std::size_t>(slots, d.value + std::size_t{1});
  nested.of_diamonds.assign(slots, 0.0);
  for (auto d = order.rbegin(); d != order.rend(); ++d) {
    double& whole = nested.of_diamonds[d->value];
    for (const TetrahedronId t : hierarchy.tetrahedra(*d)) {
      double& error = nested.of_tetrahedra[t.value];
      error = direct(t);
      if (!hierarchy.is_leaf(t)) {
        for (const TetrahedronId child : hierarchy.children(t)) {
          error = std::max(error, nested[child]);
          whole = std::max(whole, nested[hierarchy.diamond(child)]);
        }
      }
      whole = std::max(whole, error);
    }
  }
  return nested;
}

NestedErrors nest_interface_errors(const Resampler& resampler) {
  return nest_errors(resampler.hierarchy(),
                     [&](TetrahedronId t) { return resampler.hierarchy().payload(t).interface.distance; });
}

NestedErrors nest_field_errors(const Resampler& resampler, std::size_t field) {
  return nest_errors(resampler.hierarchy(), [&](TetrahedronId t) {
    const auto& fields = resampler.hierarchy().payload(t).fields;
    return field < fields.size() ? fields[field].max : 0.0;
  });
}

}  // namespace adamas
