#include "interfaces/resampling/nested_errors.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "core/base/parallel.h"

namespace adamas::interfaces {

namespace {

/// Returns all tetrahedra of the tree.
std::vector<TetrahedronId> all_tetrahedra(const HierarchyTopology& hierarchy) {
  std::vector<TetrahedronId> result = hierarchy.roots();
  for (std::size_t i = 0; i < result.size(); ++i) {
    if (hierarchy.is_leaf(result[i])) continue;
    for (const TetrahedronId child : hierarchy.children(result[i])) result.push_back(child);
  }
  return result;
}

/// Returns the errors of all fields in one tetrahedron by itself.
std::vector<FieldError> field_errors(const Resampler& resampler, TetrahedronId t) {
  const ResamplingSource& source = resampler.source();
  std::vector<FieldError> errors(source.fields->fields().size());
  const auto elements = resampler.elements(t);
  if (elements.empty()) return errors;
  const auto cell = make_tree_cell(resampler, t);
  const auto displaced = measure_field_errors(source, cell->view, elements, errors);
  const std::vector<double> limits(errors.size(), 0.0);
  measure_displaced_errors(
      source, cell->view, displaced, resampler.displacement(),
      [&](const Box3&, MaterialId, const auto& visit) { visit(cell->view); }, limits, errors,
      NoPartNear::kHasNoValue);
  return errors;
}

}  // namespace

std::unique_ptr<TreeCell> make_tree_cell(const Resampler& resampler, TetrahedronId t) {
  CellOwnership owners;
  resampler.ownership(t, owners);
  if (!owners.pure()) keep_owners(owners.problem);
  auto cell = std::make_unique<TreeCell>(TreeCell{{}, {resampler.frame(t), owners, {}, {}}});
  const auto v = resampler.hierarchy().vertices(t);
  for (std::size_t i = 0; i < 4; ++i) {
    cell->view.vertices[i] = &cell->vertices[i];
    for (const auto& candidate : owners.problem.candidates) {
      const BodyId body(candidate.owner);
      cell->vertices[i].rows.push_back({body, resampler.row(v[i], body)});
    }
  }
  partition_cell(cell->view.owners, cell->view.parts);
  return cell;
}

std::vector<double> interface_errors_of_tree(const Resampler& resampler) {
  const auto& hierarchy = resampler.hierarchy();
  const InterfaceNetwork& network = *resampler.source().network;
  const std::vector<TetrahedronId> all = all_tetrahedra(hierarchy);
  std::vector<double> errors(hierarchy.tetrahedron_slots(), 0.0);
  parallel_for(all.size(), 16, [&](std::size_t i) {
    const Tetrahedron cell = resampler.frame(all[i]);
    Box3 box;
    for (const Vec3& corner : cell.corners) box.extend(corner);
    std::vector<std::uint32_t> triangles;
    network.tree().overlapping(box, triangles);
    std::erase_if(triangles, [&](std::uint32_t t) {
      const auto& corners = network.triangle_corners(t);
      return !meets(cell, corners[0], corners[1], corners[2]);
    });
    CellOwnership owners;
    const std::vector<InterfaceId> interfaces = interfaces_of(network, triangles);
    resampler.ownership(all[i], owners, {.interfaces = interfaces});
    const InterfaceErrorOptions all_of_them{.target = std::numeric_limits<double>::max()};
    const InterfaceError error = estimate_interface_error(network, cell, owners, triangles, all_of_them);
    errors[all[i].value] = std::min(error.distance, cell.diameter());
  });
  return errors;
}

std::vector<std::vector<FieldError>> field_errors_of_tree(const Resampler& resampler) {
  const std::vector<TetrahedronId> all = all_tetrahedra(resampler.hierarchy());
  std::vector<std::vector<FieldError>> errors(resampler.hierarchy().tetrahedron_slots());
  parallel_for(all.size(), 16,
               [&](std::size_t i) { errors[all[i].value] = field_errors(resampler, all[i]); });
  return errors;
}

NestedErrors nest_errors(const HierarchyTopology& hierarchy,
                         const std::function<double(TetrahedronId)>& direct) {
  const std::vector<DiamondId> order = diamonds_in_order(hierarchy);
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

NestedErrors nest_field_errors(const Resampler& resampler, std::size_t field) {
  const auto direct = field_errors_of_tree(resampler);
  return nest_errors(resampler.hierarchy(),
                     [&](TetrahedronId t) { return direct[t.value][field].reducible; });
}

namespace {

/// Returns |z(v_c) - z_T(v_c)| for the body in which v_c lies; vectors are compared by the length of the
/// difference.
std::optional<double> vertex_correction(const Resampler& resampler, TetrahedronId t, const FieldInfo& field) {
  const auto& hierarchy = resampler.hierarchy();
  const VertexRecord& middle = hierarchy.payload(hierarchy.split_vertex(hierarchy.diamond(t)));
  const BodyId body = middle.distances.body;
  const auto [first, second] = hierarchy.split_edge(t);
  const auto *row = middle.find(body), *a = hierarchy.payload(first).find(body),
             *b = hierarchy.payload(second).find(body);
  if (row == nullptr || a == nullptr || b == nullptr) return {};
  double squared = 0;
  for (std::size_t c = field.offset; c < field.end(); ++c) {
    const double missed = (*row)[c] - 0.5 * ((*a)[c] + (*b)[c]);
    squared += missed * missed;
  }
  return std::isnan(squared) ? std::nullopt : std::optional(std::sqrt(squared));
}

}  // namespace

CorrectedErrors correct_field_errors(const Resampler& resampler, std::size_t field) {
  const auto& hierarchy = resampler.hierarchy();
  const FieldInfo& info = resampler.source().fields->fields()[field];
  CorrectedErrors result;
  result.of_tetrahedra.assign(hierarchy.tetrahedron_slots(), 0.0);
  const std::vector<DiamondId> order = diamonds_in_order(hierarchy);
  for (auto d = order.rbegin(); d != order.rend(); ++d) {
    for (const TetrahedronId t : hierarchy.tetrahedra(*d)) {
      double& error = result.of_tetrahedra[t.value];
      if (hierarchy.is_leaf(t)) {
        const auto& measured = hierarchy.payload(t).fields;
        error = field < measured.size() ? measured[field].max : 0;
        continue;
      }
      for (const TetrahedronId child : hierarchy.children(t))
        error = std::max(error, result.of_tetrahedra[child.value]);
      const auto correction = vertex_correction(resampler, t, info);
      if (correction) error += *correction;
      if (!correction) ++result.undefined;
    }
  }
  return result;
}

}  // namespace adamas::interfaces
