#include "interfaces/resampling/cell_evaluation.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/base/parallel.h"
#include "core/base/release_memory.h"
#include "core/base/sort_unique.h"

namespace adamas::interfaces {

namespace {

/// Signed distances are rounded to this many binary places below the radius, so that distances that differ
/// only by the order of a sum are equal, and ties are recognized.
constexpr int kPlaces = 40;

double rounded(double distance, double radius) {
  const double grain = std::ldexp(1.0, std::ilogb(radius) - kPlaces);
  return std::nearbyint(distance / grain) * grain;
}

/// The number of cells per task; it is small because a cell with many bodies takes long.
constexpr std::size_t kCellsPerTask = 32;

/// Keeps what a leaf shows.
void keep_contacts(ResamplingState& state, TetrahedronId t, const OwnershipProblem& owners,
                   const std::vector<ContactPolygon>& polygons) {
  CellRecord& cell = state.hierarchy.payload(t);
  cell.forget_contacts();
  cell.has_contacts = true;
  if (polygons.empty()) return;
  const auto v = state.hierarchy.vertices(t);
  cell.contacts = CellContacts({v[0].value, v[1].value, v[2].value, v[3].value}, state.frame(t).corners,
                               owners, polygons);
}

/// Sorts the native elements by the root that contains them.
void place_elements(ResamplingState& state) {
  const auto& roots = state.hierarchy.roots();
  const auto& elements = state.source.fields->native_elements();
  std::vector<TetrahedronId> root_of(elements.size());
  parallel_for(elements.size(), 4096,
               [&](std::size_t e) { root_of[e] = state.root_at(elements[e].position); });
  state.element_order.resize(elements.size());
  std::iota(state.element_order.begin(), state.element_order.end(), 0u);
  std::stable_sort(state.element_order.begin(), state.element_order.end(),
                   [&](auto a, auto b) { return root_of[a] < root_of[b]; });
  std::uint32_t e = 0;
  for (const TetrahedronId root : roots) {
    CellRecord& cell = state.hierarchy.payload(root);
    cell.first_element = e;
    while (e < state.element_order.size() && root_of[state.element_order[e]] == root) ++e;
    cell.last_element = e;
  }
}

}  // namespace

void evaluate_roots(ResamplingState& state) {
  std::vector<VertexId> vertices;
  state.hierarchy.for_each_vertex([&](VertexId v) { vertices.push_back(v); });
  evaluate_vertices(state, vertices);
  const auto& roots = state.hierarchy.roots();
  for (const TetrahedronId root : roots) state.root_frames.push_back(state.frame(root));
  if (state.source.fields) place_elements(state);
  std::vector<std::vector<std::uint32_t>> near(roots.size() / kRootsOfCube);
  parallel_for(near.size(), 1, [&](std::size_t cube) {
    Box3 box;
    for (const Vec3& corner : state.root_frames[kRootsOfCube * cube].corners) box.extend(corner);
    state.source.network->tree().overlapping(box, near[cube]);
  });
  parallel_for(roots.size(), 1, [&](std::size_t r) {
    const Tetrahedron& cell = state.root_frames[r];
    for (const std::uint32_t t : near[r / kRootsOfCube]) {
      const auto& corners = state.source.network->triangle_corners(t);
      if (meets(cell, corners[0], corners[1], corners[2]))
        state.hierarchy.payload(roots[r]).triangles.push_back(t);
    }
    state.hierarchy.payload(roots[r]).triangles.shrink_to_fit();
    evaluate_interface(state, roots[r]);
  });
}

void evaluate_vertices(ResamplingState& state, const std::vector<VertexId>& vertices) {
  parallel_for(vertices.size(), 64, [&](std::size_t i) {
    VertexRecord& record = state.hierarchy.payload(vertices[i]);
    const Vec3 position = state.hierarchy.position(vertices[i]);
    record.distances.radius = state.hierarchy.domain().diameter(state.hierarchy.lattice(vertices[i]));
    record.distances.body = state.source.body_at(position, &record.distances.flagged);
    std::vector<NearInterface> near;
    state.source.network->near_interfaces(position, record.distances.radius, record.distances.body, near,
                                          state.options.distance);
    record.distances.near.reserve(near.size());
    record.closest.reserve(near.size());
    for (const NearInterface& n : near) {
      const double d = rounded(n.signed_distance, record.distances.radius);
      record.distances.near.push_back({n.interface, d + state.shifts[n.interface]});
      record.closest.push_back(n.closest);
      record.distances.flagged = record.distances.flagged || n.flagged;
    }
    list_known_bodies(state.source.network->table(), record.distances);
  });
}

namespace {

/// With a budget, the cells with the greatest errors are split first; distances to vertices may leave errors
/// above the target.
bool estimates_may_end_early(const ResamplingState& state) {
  return !state.options.max_tetrahedra && state.options.distance == DistanceMode::kExact;
}

void evaluate_interface(ResamplingState& state, TetrahedronId t, bool may_be_partial) {
  CellRecord& cell = state.hierarchy.payload(t);
  cell.deferred = false;
  thread_local CellOwnership owners;
  thread_local ShownContacts shown;
  if (may_be_partial && holds_crowd(*state.source.network, cell.triangles)) {
    const double diameter = state.frame(t).diameter();
    if (diameter > state.estimate_target()) {
      cell.interface = {diameter, true, true};
      cell.evaluated = true;
      return;
    }
  }
  const std::vector<InterfaceId> interfaces = interfaces_of(*state.source.network, cell.triangles);
  state.ownership(t, owners, {.interfaces = interfaces});
  shown.polygons.clear();
  const InterfaceErrorOptions options{state.estimate_target(), cell.trusted, may_be_partial};
  cell.interface = estimate_interface_error(*state.source.network, state.frame(t), owners, cell.triangles,
                                            options, &shown);
  cell.evaluated = true;
  if (cell.interface.distance <= options.target) keep_contacts(state, t, shown.owners, shown.polygons);
}

}  // namespace

void evaluate_interface(ResamplingState& state, TetrahedronId t) {
  evaluate_interface(state, t, estimates_may_end_early(state));
}

bool parts_may_wait(const ResamplingState& state, const InterfaceError& error) {
  return estimates_may_end_early(state) && error.distance <= state.estimate_target();
}

void complete_estimates(ResamplingState& state) {
  std::vector<TetrahedronId> leaves = state.leaves();
  std::erase_if(leaves, [&](TetrahedronId t) { return !state.hierarchy.payload(t).interface.partial; });
  parallel_for(leaves.size(), kCellsPerTask,
               [&](std::size_t i) { evaluate_interface(state, leaves[i], false); });
}

void find_contacts(ResamplingState& state, const std::vector<TetrahedronId>& leaves) {
  parallel_chunks(leaves.size(), kCellsPerTask, [&](std::size_t begin, std::size_t end) {
    CellOwnership owners;
    std::vector<ContactPolygon> polygons;
    for (std::size_t i = begin; i < end; ++i) {
      if (state.hierarchy.payload(leaves[i]).has_contacts) continue;
      state.ownership(leaves[i], owners);
      polygons.clear();
      if (!owners.pure()) keep_owners(owners.problem, polygons);
      keep_contacts(state, leaves[i], owners.problem, polygons);
    }
  });
}

void distribute_to_children(ResamplingState& state, TetrahedronId parent) {
  const CellRecord& from = state.hierarchy.payload(parent);
  const SplitPlane plane = state.split_plane(parent);
  const auto children = state.hierarchy.children(parent);
  const auto begin = state.element_order.begin();
  std::uint32_t middle = from.first_element;
  if (state.source.fields) {
    const auto& elements = state.source.fields->native_elements();
    const auto at =
        std::stable_partition(begin + from.first_element, begin + from.last_element,
                              [&](std::uint32_t e) { return plane.side(elements[e].position) == 0; });
    middle = static_cast<std::uint32_t>(at - begin);
  }
  for (std::size_t side = 0; side < 2; ++side) {
    CellRecord& to = state.hierarchy.payload(children[side]);
    to.first_element = side == 0 ? from.first_element : middle;
    to.last_element = side == 0 ? middle : from.last_element;
    to.trusted = from.trusted;
    const Tetrahedron part = state.frame(children[side]);
    thread_local std::vector<std::uint32_t> found;
    found.clear();
    for (const std::uint32_t t : from.triangles) {
      const auto corners = state.source.network->triangle_corners(t);
      if (meets(part, corners[0], corners[1], corners[2])) found.push_back(t);
    }
    to.triangles = std::vector<std::uint32_t>(found.begin(), found.end());  // no larger than needed
  }
}

void evaluate_below(ResamplingState& state, TetrahedronId parent, bool inner) {
  distribute_to_children(state, parent);
  const CellRecord& from = state.hierarchy.payload(parent);
  const bool deferred =
      !inner && (from.deferred || (from.evaluated && parts_may_wait(state, from.interface)));
  for (const TetrahedronId child : state.hierarchy.children(parent)) {
    const bool leaf = state.hierarchy.is_leaf(child);
    CellRecord& cell = state.hierarchy.payload(child);
    cell.deferred = deferred;
    if (deferred) {
      cell.interface = {};
      cell.evaluated = true;
    } else if (leaf || inner) {
      evaluate_interface(state, child);
    }
    if (!leaf) evaluate_below(state, child, inner);
  }
  drop_leaf_data(state, parent);
}

void drop_leaf_data(ResamplingState& state, TetrahedronId t) {
  CellRecord& cell = state.hierarchy.payload(t);
  release_memory(cell.triangles);
  cell.evaluated = false;
  cell.forget_contacts();
}

void gather_triangles(ResamplingState& state, TetrahedronId parent) {
  CellRecord& to = state.hierarchy.payload(parent);
  if (to.evaluated) return;
  for (const TetrahedronId child : state.hierarchy.children(parent)) {
    const auto& from = state.hierarchy.payload(child).triangles;
    to.triangles.insert(to.triangles.end(), from.begin(), from.end());
  }
  sort_unique(to.triangles);
  to.triangles.shrink_to_fit();
}

}  // namespace adamas::interfaces
