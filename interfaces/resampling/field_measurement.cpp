#include "interfaces/resampling/field_measurement.h"

#include <algorithm>
#include <optional>
#include <string_view>
#include <utility>

#include "core/base/loop_progress.h"
#include "core/base/parallel.h"
#include "core/base/sort_unique.h"
#include "interfaces/cell_errors/field_error.h"

namespace adamas::interfaces {

namespace {

/// A stage that is one loop over all leaves, or over what they need. Fewer leaves are measured as a part of
/// another stage.
class LeavesStage {
 public:
  LeavesStage(const ResamplingState& state, std::size_t leaves, std::string_view name, std::size_t items) {
    if (leaves == state.hierarchy.leaf_count())
      stage_.emplace(state.progress, state.stage(name), StageWork{.items = static_cast<double>(items)});
  }

 private:
  std::optional<LoopProgress> stage_;
};

/// Returns the rows at the vertices of leaves from which their fields are interpolated; some occur more than
/// once.
std::vector<std::pair<VertexId, BodyId>> needed_rows(const ResamplingState& state,
                                                     const std::vector<TetrahedronId>& cells) {
  using Row = std::pair<VertexId, BodyId>;
  return parallel_collect<Row>(cells.size(), 512, [&](std::size_t first, std::size_t last, auto& rows) {
    CellOwnership owners;
    for (std::size_t i = first; i < last; ++i) {
      state.ownership(cells[i], owners);
      if (!owners.pure()) keep_owners(owners.problem);
      for (const VertexId v : state.hierarchy.vertices(cells[i])) {
        for (const auto& candidate : owners.problem.candidates) rows.emplace_back(v, BodyId(candidate.owner));
      }
    }
  });
}

/// Computes those of the rows of these leaves that are not known yet.
void compute_rows(ResamplingState& state, const std::vector<TetrahedronId>& cells) {
  std::vector<std::pair<VertexId, BodyId>> needs = needed_rows(state, cells);
  sort_unique(needs);
  std::erase_if(needs, [&](const auto& need) {
    return state.hierarchy.payload(need.first).find(need.second) != nullptr;
  });
  const LeavesStage stage(state, cells.size(), "finding fields at vertices", needs.size());
  std::vector<std::vector<double>> computed(needs.size());
  parallel_for(needs.size(), 32, [&](std::size_t i) {
    computed[i] = fields_at_vertex(*state.source.fields, *state.source.network, state.options.ghost,
                                   state.hierarchy.position(needs[i].first),
                                   state.hierarchy.payload(needs[i].first), needs[i].second);
  });
  for (std::size_t i = 0; i < needs.size(); ++i)
    state.hierarchy.payload(needs[i].first).add_row(needs[i].second) = std::move(computed[i]);
}

/// Returns a leaf as a cell in which fields are measured, without its parts.
CellView view(const ResamplingState& state, TetrahedronId t) {
  const auto v = state.hierarchy.vertices(t);
  CellView result{state.frame(t),
                  {},
                  {&state.hierarchy.payload(v[0]), &state.hierarchy.payload(v[1]),
                   &state.hierarchy.payload(v[2]), &state.hierarchy.payload(v[3])},
                  {}};
  state.ownership(t, result.owners);
  if (!result.owners.pure()) keep_owners(result.owners.problem);
  return result;
}

CellView view_with_parts(const ResamplingState& state, TetrahedronId t) {
  CellView result = view(state, t);
  partition_cell(result.owners, result.parts);
  return result;
}

/// Returns whether a vertex of a leaf knows a body of the material.
bool may_hold(const ResamplingState& state, TetrahedronId t, MaterialId material) {
  const InterfaceTable& table = state.source.network->table();
  for (const VertexId v : state.hierarchy.vertices(t)) {
    for (const BodyId body : state.hierarchy.payload(v).distances.bodies) {
      if (table.material(body) == material) return true;
    }
  }
  return false;
}

/// Calls visit(leaf) for every leaf that may meet the box and hold the material.
void cells_in_box(const ResamplingState& state, const Box3& box, MaterialId material,
                  const std::function<void(TetrahedronId)>& visit) {
  std::vector<TetrahedronId> stack(state.hierarchy.roots().rbegin(), state.hierarchy.roots().rend());
  while (!stack.empty()) {
    const TetrahedronId t = stack.back();
    stack.pop_back();
    Box3 bounds;
    for (const VertexId v : state.hierarchy.vertices(t)) bounds.extend(state.hierarchy.position(v));
    if (!bounds.touches(box)) continue;
    if (state.hierarchy.is_leaf(t)) {
      if (may_hold(state, t, material)) visit(t);
    } else {
      for (const TetrahedronId child : state.hierarchy.children(t)) stack.push_back(child);
    }
  }
}

/// Adds the errors of the displaced elements of each leaf; errors below the fields' limits are not reduced
/// further.
void measure_displaced(ResamplingState& state, const std::vector<TetrahedronId>& cells,
                       const std::vector<std::vector<std::uint32_t>>& displaced,
                       const std::vector<double>& limits) {
  ViewCache cache(state.hierarchy.tetrahedron_slots());
  const CellsInBox nearby = [&](const Box3& box, MaterialId material, const auto& visit) {
    cells_in_box(state, box, material, [&](TetrahedronId t) {
      visit(cache.get(t.value, [&] { return view_with_parts(state, t); }));
    });
  };
  std::vector<std::size_t> concerned;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (!displaced[i].empty()) concerned.push_back(i);
  }
  const LeavesStage stage(state, cells.size(), "measuring displaced elements", concerned.size());
  parallel_for(concerned.size(), 4, [&](std::size_t n) {
    const std::size_t i = concerned[n];
    measure_displaced_errors(state.source, view(state, cells[i]), displaced[i], state.displacement, nearby,
                             limits, state.hierarchy.payload(cells[i]).fields);
  });
}

}  // namespace

void measure_fields(ResamplingState& state, const std::vector<TetrahedronId>& cells, DisplacedErrors wanted) {
  compute_rows(state, cells);
  const std::size_t fields = state.source.fields->fields().size();
  std::vector<std::vector<std::uint32_t>> displaced(cells.size());
  std::optional<LeavesStage> stage(std::in_place, state, cells.size(), "measuring fields", cells.size());
  parallel_for(cells.size(), 64, [&](std::size_t i) {
    CellRecord& cell = state.hierarchy.payload(cells[i]);
    cell.fields.assign(fields, {});
    const auto contained = elements_in(state, cells[i]);
    if (contained.empty()) return;
    displaced[i] = measure_field_errors(state.source, view(state, cells[i]), contained, cell.fields);
  });
  if (std::all_of(displaced.begin(), displaced.end(), [](const auto& d) { return d.empty(); })) return;
  std::vector<double> limits(fields, 0.0);
  for (std::size_t f = 0; f < fields && wanted == DisplacedErrors::kWithinTargets; ++f) {
    // The limit is the target or, without one, the greatest error of the other elements.
    for (const TetrahedronId t : cells)
      limits[f] = std::max(limits[f], state.hierarchy.payload(t).fields[f].max);
    if (state.options.field_errors[f]) limits[f] = *state.options.field_errors[f];
  }
  stage.reset();
  measure_displaced(state, cells, displaced, limits);
}

std::vector<double> row_at(const ResamplingState& state, VertexId v, BodyId body) {
  const VertexRecord& vertex = state.hierarchy.payload(v);
  if (const std::vector<double>* known = vertex.find(body)) return *known;
  return fields_at_vertex(*state.source.fields, *state.source.network, state.options.ghost,
                          state.hierarchy.position(v), vertex, body);
}

std::span<const std::uint32_t> elements_in(const ResamplingState& state, TetrahedronId t) {
  const CellRecord& cell = state.hierarchy.payload(t);
  return std::span(state.element_order).subspan(cell.first_element, cell.last_element - cell.first_element);
}

}  // namespace adamas::interfaces
