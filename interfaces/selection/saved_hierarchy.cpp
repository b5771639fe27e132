#include "interfaces/selection/saved_hierarchy.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/base/release_memory.h"
#include "interfaces/resampling/nested_errors.h"
#include "interfaces/selection/certified_selections.h"

namespace adamas::interfaces {

namespace {

constexpr std::uint32_t kNone = 0xffffffffu;

/// Numbers the tree of a resampler and collects its data.
class Collector {
 public:
  Collector(const Resampler& resampler, Progress& progress)
      : resampler_(resampler),
        hierarchy_(resampler.hierarchy()),
        source_(resampler.source()),
        progress_(progress) {}

  SavedHierarchy run() {
    result_.tree.source = source_.name;
    result_.tree.box = source_.box;
    result_.tree.materials = source_.materials;
    result_.tree.table = source_.network->table();
    if (source_.fields) result_.tree.fields = source_.fields->fields();
    result_.interface_target = resampler_.options().interface_error;
    result_.field_targets = resampler_.options().field_errors;
    result_.voxel = source_.voxel;
    result_.input_volumes = source_.volumes;
    number_cells();
    collect_vertices();
    collect_errors();
    certify_selections(result_, source_, progress_);
    return std::move(result_);
  }

 private:
  void number_cells() {
    for (const TetrahedronId root : hierarchy_.roots()) add(root);
    result_.root_count = static_cast<std::uint32_t>(cells_.size());
    std::vector<std::uint32_t> number(hierarchy_.tetrahedron_slots(), kNone);
    for (std::uint32_t c = 0; c < cells_.size(); ++c) number[cells_[c].value] = c;
    diamonds_ = diamonds_in_order(hierarchy_);
    std::erase_if(diamonds_, [&](DiamondId d) { return !hierarchy_.is_split(d); });
    for (const DiamondId d : diamonds_) {
      std::vector<std::uint32_t> members;
      for (const TetrahedronId t : hierarchy_.tetrahedra(d)) members.push_back(number[t.value]);
      std::sort(members.begin(), members.end());
      for (const std::uint32_t member : members) {
        result_.split_cells.push_back(member);
        for (const TetrahedronId child : hierarchy_.children(cells_[member])) {
          number[child.value] = static_cast<std::uint32_t>(cells_.size());
          add(child);
        }
      }
      result_.first_cells.push_back(static_cast<std::uint32_t>(result_.split_cells.size()));
      result_.new_vertices.push_back(vertex_number(hierarchy_.split_vertex(d)));
    }
  }

  void add(TetrahedronId t) {
    ResampledMesh::Cell cell{{},
                             static_cast<std::uint8_t>(hierarchy_.level(t)),
                             static_cast<std::uint8_t>(hierarchy_.phase(t)),
                             0};
    const auto v = hierarchy_.vertices(t);
    for (std::size_t i = 0; i < 4; ++i) cell.vertices[i] = vertex_number(v[i]);
    result_.tree.cells.push_back(cell);
    cells_.push_back(t);
  }

  std::uint32_t vertex_number(VertexId v) {
    if (numbers_.empty()) numbers_.assign(hierarchy_.vertex_slots(), kNone);
    std::uint32_t& n = numbers_[v.value];
    if (n == kNone) {
      n = static_cast<std::uint32_t>(vertices_.size());
      vertices_.push_back(v);
    }
    return n;
  }

  /// Collects the distances of all vertices, and the rows of their own bodies and of those that own a part of
  /// any cell round them.
  void collect_vertices() {
    ResampledMesh& tree = result_.tree;
    for (const VertexId v : vertices_) {
      tree.points.push_back(hierarchy_.position(v));
      tree.vertices.push_back(hierarchy_.payload(v));
      tree.vertices.back().rows.clear();
    }
    if (source_.fields) {
      std::vector<std::pair<std::uint32_t, BodyId>> needs = needed_rows(tree);
      std::vector<std::vector<double>> rows(needs.size());
      parallel_for(needs.size(), 32, [&](std::size_t i) {
        rows[i] = resampler_.row(vertices_[needs[i].first], needs[i].second);
      });
      for (std::size_t i = 0; i < needs.size(); ++i)
        tree.vertices[needs[i].first].rows.push_back({needs[i].second, std::move(rows[i])});
    }
    for (VertexRecord& vertex : tree.vertices) release_memory(vertex.closest);
  }

  void collect_errors() {
    const std::vector<double> direct = interface_errors_of_tree(resampler_);
    for (std::size_t c = 0; c < cells_.size(); ++c)
      result_.tree.cells[c].interface_error = direct[cells_[c].value];
    result_.interface_estimates =
        diamond_errors(nest_errors(hierarchy_, [&](TetrahedronId t) { return direct[t.value]; }));
    if (!source_.fields) return;
    auto errors = field_errors_of_tree(resampler_);
    for (std::size_t f = 0; f < result_.tree.fields.size(); ++f) {
      result_.field_errors.push_back(diamond_errors(
          nest_errors(hierarchy_, [&](TetrahedronId t) { return errors[t.value][f].reducible; })));
      result_.measured.emplace_back();
      result_.tree.field_errors.emplace_back();
      for (const TetrahedronId t : cells_) {
        result_.measured[f].push_back(errors[t.value][f]);
        result_.measured[f].back().worst = FieldError::kNowhere;
        result_.tree.field_errors[f].push_back(errors[t.value][f].max);
      }
    }
  }

  [[nodiscard]] std::vector<double> diamond_errors(const NestedErrors& nested) const {
    std::vector<double> result;
    for (const DiamondId d : diamonds_) result.push_back(nested[d]);
    return result;
  }

  const Resampler& resampler_;
  const Resampler::MeshHierarchy& hierarchy_;
  const ResamplingSource& source_;
  Progress& progress_;
  SavedHierarchy result_;
  std::vector<TetrahedronId> cells_;
  std::vector<VertexId> vertices_;
  std::vector<std::uint32_t> numbers_;
  std::vector<DiamondId> diamonds_;
};

}  // namespace

std::vector<std::uint32_t> SavedHierarchy::diamonds_of_split_cells() const {
  std::vector<std::uint32_t> result(split_cells.size());
  for (std::uint32_t d = 0; d < diamond_count(); ++d)
    std::fill(result.begin() + first_cells[d], result.begin() + first_cells[d + 1], d);
  return result;
}

SavedHierarchy take_hierarchy(const Resampler& resampler, Progress& progress) {
  return Collector(resampler, progress).run();
}

void SavedHierarchy::validate_tree(const std::string& name) const {
  tree.validate(name);
  const auto broken = [&](const std::string& law) { fail("{}: expected {}, found otherwise", name, law); };
  const std::size_t diamonds = diamond_count(), cells = tree.cells.size();
  if (first_cells.size() != diamonds + 1 || first_cells.front() != 0 ||
      first_cells.back() != split_cells.size() || root_count + 2 * split_cells.size() != cells)
    broken("two children for each split tetrahedron, as many as diamonds split");
  std::vector<std::uint32_t> diamond_of(cells, kNone);
  for (std::uint32_t d = 0; d < diamonds; ++d) {
    if (first_cells[d] >= first_cells[d + 1]) broken("diamonds with tetrahedra, one after the other");
    for (std::uint32_t i = first_cells[d]; i < first_cells[d + 1]; ++i) {
      const std::uint32_t cell = split_cells[i];
      if (cell >= first_child(first_cells[d]) || diamond_of[cell] != kNone)
        broken("parents before their children, each split once");
      diamond_of[cell] = d;
    }
  }
  const std::vector<std::uint32_t> owners = diamonds_of_split_cells();
  for (std::size_t i = 0; i < split_cells.size(); ++i) {
    // Each half has the new vertex instead of one end of the split edge.
    const auto& parent = tree.cells[split_cells[i]].vertices;
    for (std::uint32_t side = 0; side < 2; ++side) {
      auto half = tree.cells[first_child(i) + side].vertices, whole = parent;
      whole[1 - side] = new_vertices[owners[i]];
      std::sort(half.begin(), half.end());
      std::sort(whole.begin(), whole.end());
      if (half != whole) broken("children that are halves of their parents");
    }
  }
  if (interface_target <= 0 || !std::isfinite(interface_target))
    fail("{}: expected an interface error above 0, found {}", name, interface_target);
}

void SavedHierarchy::validate(const std::string& name) const {
  validate_tree(name);
  const auto broken = [&](const std::string& law) { fail("{}: expected {}, found otherwise", name, law); };
  const std::size_t diamonds = diamond_count();
  const std::vector<std::uint32_t> owners = diamonds_of_split_cells();
  std::vector<std::uint32_t> diamond_of(tree.cells.size(), kNone);
  for (std::size_t i = 0; i < split_cells.size(); ++i) diamond_of[split_cells[i]] = owners[i];
  const auto check_nested = [&](const std::vector<double>& errors) {
    if (errors.size() != diamonds) broken("as many errors as diamonds");
    for (std::size_t i = 0; i < split_cells.size(); ++i) {
      const double whole = errors[owners[i]];
      for (std::uint32_t side = 0; side < 2; ++side) {
        const std::uint32_t inner = diamond_of[first_child(i) + side];
        if (inner != kNone && !(errors[inner] <= whole))
          broken("errors that do not grow from a diamond to its children");
      }
    }
  };
  check_nested(interface_errors);
  check_nested(interface_estimates);
  for (const auto& errors : field_errors) check_nested(errors);
  check_numbers(name);
}

/// Checks each number by itself, and the lengths of arrays; this is a part of validate().
void SavedHierarchy::check_numbers(const std::string& name) const {
  const auto check = [&](const std::string& what, double value, bool sound) {
    if (!sound || !std::isfinite(value)) fail("{}: expected {}, found {}", name, what, value);
  };
  const auto not_below_0 = [&](const std::string& what, const std::vector<double>& values) {
    for (const double value : values) check(what + " of 0 or more", value, value >= 0);
  };
  const std::size_t fields = tree.fields.size();
  if (field_errors.size() != fields || measured.size() != fields || field_targets.size() != fields)
    fail("{}: expected errors of each of {} fields, found others", name, fields);
  not_below_0("errors of the interfaces", interface_errors);
  not_below_0("estimates of the interfaces' errors", interface_estimates);
  for (std::size_t f = 0; f < fields; ++f) {
    not_below_0("errors of a field", field_errors[f]);
    if (measured[f].size() != tree.cells.size())
      fail("{}: expected errors of {} tetrahedra, found {}", name, tree.cells.size(), measured[f].size());
    for (const FieldError& e : measured[f]) not_below_0("errors of a field", {e.max, e.reducible, e.sum});
    if (field_targets[f]) check("a field's error above 0", *field_targets[f], *field_targets[f] > 0);
  }
  not_below_0("a spacing", {voxel});
  not_below_0("volumes of materials", {input_volumes.begin(), input_volumes.end()});
  for (std::size_t c = 0; c < certificates.size(); ++c) {
    const InterfaceCertificate& certificate = certificates[c];
    std::vector<InterfaceDistance> distances{certificate.networks, certificate.materials};
    if (certificate.junctions) distances.push_back(*certificate.junctions);
    const bool last = c + 1 == certificates.size();
    for (const InterfaceDistance& d : distances) {
      // Distances are infinite if the mesh shows no interfaces.
      if (!(d.lower >= 0 && d.lower <= d.upper) || (std::isinf(d.upper) && !last))
        fail("{}: expected certified errors of 0 or more, found {} to {}", name, d.lower, d.upper);
    }
    if (c > 0 && !last && !(certificate.upper() < certificates[c - 1].upper()))
      fail("{}: expected certified errors that fall, found {} after {}", name, certificate.upper(),
           certificates[c - 1].upper());
  }
}

}  // namespace adamas::interfaces
