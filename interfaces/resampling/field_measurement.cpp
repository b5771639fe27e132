#include <algorithm>

#include "core/base/parallel.h"
#include "interfaces/errors/view_cache.h"
#include "interfaces/resampling/resampler.h"

namespace adamas::interfaces {

void Resampler::compute_rows(std::vector<std::pair<VertexId, BodyId>> needs) {
  std::sort(needs.begin(), needs.end());
  needs.erase(std::unique(needs.begin(), needs.end()), needs.end());
  std::erase_if(needs, [&](const auto& need) {
    const auto& rows = hierarchy_.payload(need.first).rows;
    return std::any_of(rows.begin(), rows.end(), [&](const auto& row) { return row.body == need.second; });
  });
  std::vector<std::vector<double>> computed(needs.size());
  parallel_for(needs.size(), 32, [&](std::size_t i) {
    computed[i] = fields_at_vertex(source_, options_.ghost, hierarchy_.position(needs[i].first),
                                   hierarchy_.payload(needs[i].first), needs[i].second);
  });
  for (std::size_t i = 0; i < needs.size(); ++i) {
    auto& rows = hierarchy_.payload(needs[i].first).rows;
    const auto at = std::lower_bound(rows.begin(), rows.end(), needs[i].second,
                                     [](const VertexRecord::BodyRow& r, BodyId b) { return r.body < b; });
    rows.insert(at, {needs[i].second, std::move(computed[i])});
  }
}

std::vector<double> Resampler::row(VertexId v, BodyId body) const {
  const VertexRecord& vertex = hierarchy_.payload(v);
  const auto known = std::find_if(vertex.rows.begin(), vertex.rows.end(),
                                  [body](const auto& row) { return row.body == body; });
  if (known != vertex.rows.end()) return known->row;
  return fields_at_vertex(source_, options_.ghost, hierarchy_.position(v), vertex, body);
}

void Resampler::measure_fields(const std::vector<TetrahedronId>& cells, DisplacedErrors wanted) {
  constexpr std::size_t kChunk = 512;
  std::vector<std::vector<std::pair<VertexId, BodyId>>> needs((cells.size() + kChunk - 1) / kChunk);
  parallel_chunks(cells.size(), kChunk, [&](std::size_t first, std::size_t last) {
    CellOwnership owners;
    for (std::size_t i = first; i < last; ++i) {
      ownership(cells[i], owners);
      if (!owners.pure()) keep_owners(owners.problem);
      for (const VertexId v : hierarchy_.vertices(cells[i])) {
        for (const auto& candidate : owners.problem.candidates)
          needs[first / kChunk].emplace_back(v, BodyId(candidate.owner));
      }
    }
  });
  std::vector<std::pair<VertexId, BodyId>> all;
  for (const auto& part : needs) all.insert(all.end(), part.begin(), part.end());
  compute_rows(std::move(all));
  const std::size_t fields = source_.fields->fields().size();
  std::vector<std::vector<std::uint32_t>> displaced(cells.size());
  parallel_for(cells.size(), 64, [&](std::size_t i) {
    CellRecord& cell = hierarchy_.payload(cells[i]);
    cell.fields.assign(fields, {});
    const auto contained = elements(cells[i]);
    if (contained.empty()) return;
    displaced[i] = measure_field_errors(source_, view(cells[i]), contained, cell.fields);
  });
  if (std::all_of(displaced.begin(), displaced.end(), [](const auto& d) { return d.empty(); })) return;
  std::vector<double> limits(fields, 0.0);
  for (std::size_t f = 0; f < fields && wanted == DisplacedErrors::kWithinTargets; ++f) {
    // No more is asked than the target, or what the others have anyway.
    for (const TetrahedronId t : cells) limits[f] = std::max(limits[f], hierarchy_.payload(t).fields[f].max);
    if (options_.field_errors[f]) limits[f] = *options_.field_errors[f];
  }
  ViewCache cache(hierarchy_.tetrahedron_slots());
  const CellsInBox nearby = [&](const Box3& box, MaterialId material, const auto& visit) {
    cells_in_box(box, material,
                 [&](TetrahedronId t) { visit(cache.get(t.value, [&] { return view_with_parts(t); })); });
  };
  parallel_for(cells.size(), 16, [&](std::size_t i) {
    if (displaced[i].empty()) return;
    measure_displaced_errors(source_, view(cells[i]), displaced[i], displacement(), nearby, limits,
                             hierarchy_.payload(cells[i]).fields);
  });
}

std::span<const std::uint32_t> Resampler::elements(TetrahedronId t) const {
  const CellRecord& cell = hierarchy_.payload(t);
  return std::span(element_order_).subspan(cell.first_element, cell.last_element - cell.first_element);
}

CellView Resampler::view(TetrahedronId t) const {
  const auto v = hierarchy_.vertices(t);
  CellView result{frame(t),
                  {},
                  {&hierarchy_.payload(v[0]), &hierarchy_.payload(v[1]), &hierarchy_.payload(v[2]),
                   &hierarchy_.payload(v[3])},
                  {}};
  ownership(t, result.owners);
  if (!result.owners.pure()) keep_owners(result.owners.problem);
  return result;
}

CellView Resampler::view_with_parts(TetrahedronId t) const {
  CellView result = view(t);
  partition_cell(result.owners, result.parts);
  return result;
}

bool Resampler::may_hold(TetrahedronId t, MaterialId material) const {
  const InterfaceTable& table = source_.network->table();
  for (const VertexId v : hierarchy_.vertices(t)) {
    for (const BodyId body : hierarchy_.payload(v).distances.bodies) {
      if (table.material(body) == material) return true;
    }
  }
  return false;
}

void Resampler::cells_in_box(const Box3& box, MaterialId material,
                             const std::function<void(TetrahedronId)>& visit) const {
  std::vector<TetrahedronId> stack(hierarchy_.roots().rbegin(), hierarchy_.roots().rend());
  while (!stack.empty()) {
    const TetrahedronId t = stack.back();
    stack.pop_back();
    Box3 bounds;
    for (const VertexId v : hierarchy_.vertices(t)) bounds.extend(hierarchy_.position(v));
    if (!bounds.touches(box)) continue;
    if (hierarchy_.is_leaf(t)) {
      if (may_hold(t, material)) visit(t);
    } else {
      for (const TetrahedronId child : hierarchy_.children(t)) stack.push_back(child);
    }
  }
}

}  // namespace adamas::interfaces
