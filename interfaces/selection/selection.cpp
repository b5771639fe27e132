#include "interfaces/selection/selection.h"

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

#include "core/base/error.h"

namespace adamas::interfaces {

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

/// Returns the diamonds that are split in the mesh for these targets. Their ancestors are among them, since
/// errors are nested and ancestors come first.
std::vector<char> Selection::diamonds_for(const SelectionTargets& targets) {
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
  // Many diamonds have the same certified error, so estimates decide. These are nested too, so that ancestors
  // stay first.
  const std::vector<double>& estimates = hierarchy_.interface_estimates;
  std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) {
    return std::pair(ratios[a], estimates[a]) > std::pair(ratios[b], estimates[b]);
  });
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
  choose(diamonds_for(targets));
}

void Selection::choose(const std::vector<char>& split) {
  changed_ = 0;
  for (std::size_t d = 0; d < split.size(); ++d) {
    if (split_[d] == split[d]) continue;
    const std::size_t members = hierarchy_.member_count(d);
    if (split[d] != 0) {
      size_ += members, ++split_count_;
    } else {
      size_ -= members, --split_count_;
    }
    split_[d] = split[d], changed_ += 3 * members;
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

const InterfaceCertificate* Selection::certificate() const {
  if (hierarchy_.certificates.empty()) return nullptr;
  if (is_whole()) return &hierarchy_.certificates.back();
  double greatest_merged = 0, least_split = std::numeric_limits<double>::infinity();
  for (std::size_t d = 0; d < split_.size(); ++d) {
    const double error = hierarchy_.interface_errors[d];
    if (split_[d] == 0) greatest_merged = std::max(greatest_merged, error);
    if (split_[d] != 0) least_split = std::min(least_split, error);
  }
  const auto end = std::prev(hierarchy_.certificates.end());
  const auto found = std::find_if(hierarchy_.certificates.begin(), end, [&](const auto& certificate) {
    return greatest_merged <= certificate.upper() && certificate.upper() < least_split;
  });
  return found == end ? nullptr : &*found;
}

double Selection::interface_error() const {
  if (const InterfaceCertificate* known = certificate()) return known->upper();
  return std::max(0.0, hierarchy_.tree.cells[worst_interface_cell()].interface_error);
}

/// Returns a cell's error of a field: that of its diamond if it is split in the saved hierarchy, else its
/// own.
double Selection::error_of(std::uint32_t cell, std::size_t field) const {
  const std::uint32_t number = split_number_[cell];
  return number == kNone ? hierarchy_.measured[field][cell].reducible
                         : hierarchy_.field_errors[field][diamond_[number]];
}

double Selection::field_error(std::size_t field) const {
  return std::max(0.0, error_of(worst_field_cell(field), field));
}

std::uint32_t Selection::worst_interface_cell() const {
  const std::vector<std::uint32_t> all = cells();
  return *std::ranges::max_element(
      all, {}, [this](std::uint32_t cell) { return hierarchy_.tree.cells[cell].interface_error; });
}

std::uint32_t Selection::worst_field_cell(std::size_t field) const {
  const std::vector<std::uint32_t> all = cells();
  return *std::ranges::max_element(all, {},
                                   [this, field](std::uint32_t cell) { return error_of(cell, field); });
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
  selection.choose(std::vector<char>(hierarchy.diamond_count(), 1));
  return selection.mesh();
}

}  // namespace adamas::interfaces
