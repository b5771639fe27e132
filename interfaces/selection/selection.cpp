#include "interfaces/selection/selection.h"

#include <algorithm>

#include "core/base/error.h"

namespace adamas {

namespace {

constexpr std::uint32_t kNone = 0xffffffffu;

}  // namespace

Selection::Selection(const SavedHierarchy& hierarchy)
    : hierarchy_(hierarchy),
      split_number_(hierarchy.tree.cells.size(), kNone),
      diamond_(hierarchy.diamonds_of_split_cells()),
      split_(hierarchy.diamond_count(), 0),
      size_(hierarchy.root_count) {
  for (std::uint32_t i = 0; i < hierarchy.split_cells.size(); ++i)
    split_number_[hierarchy.split_cells[i]] = i;
}

/// Which diamonds are split in the mesh for these targets; ancestors of each among them, since errors are
/// nested and ancestors come first.
std::vector<char> Selection::wanted(const SelectionTargets& targets) {
  const std::size_t count = hierarchy_.diamond_count();
  std::vector<double> ratios(count, 0.0);
  const auto weigh = [&](const std::vector<double>& errors, double target) {
    if (!(target > 0)) return;
    for (std::size_t d = 0; d < count; ++d) ratios[d] = std::max(ratios[d], errors[d] / target);
  };
  bool any = targets.interface_error.has_value();
  if (targets.interface_error) weigh(hierarchy_.interface_errors, *targets.interface_error);
  for (std::size_t f = 0; f < targets.field_errors.size(); ++f) {
    if (!targets.field_errors[f]) continue;
    any = true;
    weigh(hierarchy_.field_errors[f], *targets.field_errors[f]);
  }
  if (!any) {
    weigh(hierarchy_.interface_errors, hierarchy_.interface_target);
    for (std::size_t f = 0; f < hierarchy_.field_targets.size(); ++f)
      weigh(hierarchy_.field_errors[f], hierarchy_.field_targets[f].value_or(0));
  }
  std::vector<char> result(count, 0);
  std::size_t size = hierarchy_.root_count;
  for (std::size_t d = 0; d < count; ++d) {
    result[d] = !any || ratios[d] > 1 ? 1 : 0;
    if (result[d] != 0) size += hierarchy_.member_count(d);
  }
  budget_spent_ = targets.max_tetrahedra && size > *targets.max_tetrahedra;
  if (!budget_spent_) return result;
  std::vector<std::uint32_t> order;
  for (std::uint32_t d = 0; d < count; ++d) {
    if (result[d] != 0) order.push_back(d);
  }
  std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return ratios[a] > ratios[b]; });
  std::fill(result.begin(), result.end(), 0);
  size = hierarchy_.root_count;
  for (const std::uint32_t d : order) {
    if (size + hierarchy_.member_count(d) > *targets.max_tetrahedra) break;
    size += hierarchy_.member_count(d);
    result[d] = 1;
  }
  return result;
}

void Selection::select(const SelectionTargets& targets) {
  if (targets.max_tetrahedra && *targets.max_tetrahedra < hierarchy_.root_count) {
    fail("{}: expected room for at least {} tetrahedra, found a limit of {}", hierarchy_.tree.source,
         hierarchy_.root_count, *targets.max_tetrahedra);
  }
  const std::vector<char> next = wanted(targets);
  changed_ = 0;
  for (std::size_t d = 0; d < next.size(); ++d) {
    if (split_[d] == next[d]) continue;
    const std::size_t members = hierarchy_.member_count(d);
    if (next[d] != 0) {
      size_ += members, ++split_count_;
    } else {
      size_ -= members, --split_count_;
    }
    split_[d] = next[d], changed_ += 3 * members;
  }
}

std::vector<std::uint32_t> Selection::cells() const {
  std::vector<std::uint32_t> result, stack;
  result.reserve(size_);
  for (std::uint32_t root = 0; root < hierarchy_.root_count; ++root) {
    stack.push_back(root);
    while (!stack.empty()) {
      const std::uint32_t cell = stack.back();
      stack.pop_back();
      const std::uint32_t number = split_number_[cell];
      if (number == kNone || split_[diamond_[number]] == 0) {
        result.push_back(cell);
      } else {
        const std::uint32_t child = hierarchy_.first_child(number);
        stack.push_back(child + 1);
        stack.push_back(child);
      }
    }
  }
  return result;
}

/// Of a cell that was split when the hierarchy was saved its diamond's error, of others their own.
double Selection::greatest(const std::vector<double>& nested,
                           const std::function<double(std::uint32_t)>& of_cell) const {
  double result = 0;
  for (const std::uint32_t cell : cells()) {
    const std::uint32_t number = split_number_[cell];
    result = std::max(result, number == kNone ? of_cell(cell) : nested[diamond_[number]]);
  }
  return result;
}

double Selection::interface_error() const {
  return greatest(hierarchy_.interface_errors,
                  [this](std::uint32_t cell) { return hierarchy_.tree.cells[cell].interface_error; });
}

double Selection::field_error(std::size_t field) const {
  return greatest(hierarchy_.field_errors[field],
                  [&](std::uint32_t cell) { return hierarchy_.measured[field][cell].reducible; });
}

ResampledMesh Selection::mesh() const {
  const ResampledMesh& tree = hierarchy_.tree;
  ResampledMesh mesh;
  mesh.source = tree.source;
  mesh.box = tree.box;
  mesh.materials = tree.materials;
  mesh.table = tree.table;
  mesh.fields = tree.fields;
  mesh.field_errors.resize(mesh.fields.size());
  std::vector<std::uint32_t> number(tree.points.size(), kNone), original;
  for (const std::uint32_t chosen : cells()) {
    mesh.cells.push_back(tree.cells[chosen]);
    for (std::uint32_t& v : mesh.cells.back().vertices) {
      if (number[v] == kNone) {
        number[v] = static_cast<std::uint32_t>(mesh.points.size());
        mesh.points.push_back(tree.points[v]);
        mesh.vertices.push_back({tree.vertices[v].distances, {}, {}});
        original.push_back(v);
      }
      v = number[v];
    }
    for (std::size_t f = 0; f < mesh.fields.size(); ++f)
      mesh.field_errors[f].push_back(tree.field_errors[f][chosen]);
  }
  if (mesh.fields.empty()) return mesh;
  for (const auto& [v, body] : needed_rows(mesh)) {
    for (const auto& row : tree.vertices[original[v]].rows) {
      if (row.body == body) mesh.vertices[v].rows.push_back(row);
    }
  }
  return mesh;
}

ResampledMesh whole_mesh(const SavedHierarchy& hierarchy) {
  Selection selection(hierarchy);
  selection.select({});
  return selection.mesh();
}

}  // namespace adamas
