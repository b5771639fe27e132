#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/base/parallel.h"
#include "interfaces/resampling/resampler.h"

namespace adamas::interfaces {

namespace {

/// Signed distances are rounded to this many binary places below the radius, so that those that differ only
/// by the order of a sum are equal, and ties are told from the rest.
constexpr int kPlaces = 40;
/// The roots of a cube follow each other round its diagonal, so that each has the cube's bounding box.
constexpr std::size_t kRootsOfCube = 6;

double rounded(double distance, double radius) {
  const double grain = std::ldexp(1.0, std::ilogb(radius) - kPlaces);
  return std::nearbyint(distance / grain) * grain;
}

}  // namespace

void Resampler::place_roots() {
  std::vector<VertexId> vertices;
  hierarchy_.for_each_vertex([&](VertexId v) { vertices.push_back(v); });
  evaluate_vertices(vertices);
  const auto& roots = hierarchy_.roots();
  for (const TetrahedronId root : roots) root_frames_.push_back(frame(root));
  if (source_.fields) place_elements();
  std::vector<std::vector<std::uint32_t>> near(roots.size() / kRootsOfCube);
  parallel_for(near.size(), 1, [&](std::size_t cube) {
    Box3 box;
    for (const Vec3& corner : root_frames_[kRootsOfCube * cube].corners) box.extend(corner);
    source_.network->tree().overlapping(box, near[cube]);
  });
  parallel_for(roots.size(), 1, [&](std::size_t r) {
    const Tetrahedron& cell = root_frames_[r];
    for (const std::uint32_t t : near[r / kRootsOfCube]) {
      const auto& corners = source_.network->triangle_corners(t);
      if (meets(cell, corners[0], corners[1], corners[2]))
        hierarchy_.payload(roots[r]).triangles.push_back(t);
    }
    evaluate_interface(roots[r]);
  });
}

/// The root that holds a point, or is closest to it.
TetrahedronId Resampler::root_at(const Vec3& p) const {
  const Domain& domain = hierarchy_.domain();
  const auto counts = domain.roots();
  std::array<std::size_t, 3> cube{};
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    const double part = (p[axis] - domain.box().min[axis]) / domain.box().size()[axis];
    cube[a] = static_cast<std::size_t>(std::clamp(part * counts[a], 0.0, counts[a] - 1.0));
  }
  const std::size_t first =
      kRootsOfCube * (cube[0] + static_cast<std::size_t>(counts[0]) *
                                    (cube[1] + static_cast<std::size_t>(counts[1]) * cube[2]));
  std::size_t best = first;
  double greatest = -1e300;
  for (std::size_t r = first; r < first + kRootsOfCube; ++r) {
    const Weights w = root_frames_[r].weights(p);
    const double least = std::min({w[0], w[1], w[2], w[3]});
    if (least > greatest) greatest = least, best = r;
  }
  return hierarchy_.roots()[best];
}

/// Sorts the native elements by the root they are in.
void Resampler::place_elements() {
  const auto& roots = hierarchy_.roots();
  const auto& elements = source_.fields->native_elements();
  std::vector<TetrahedronId> root_of(elements.size());
  parallel_for(elements.size(), 4096, [&](std::size_t e) { root_of[e] = root_at(elements[e].position); });
  element_order_.resize(elements.size());
  std::iota(element_order_.begin(), element_order_.end(), 0u);
  std::stable_sort(element_order_.begin(), element_order_.end(),
                   [&](auto a, auto b) { return root_of[a] < root_of[b]; });
  std::uint32_t e = 0;
  for (const TetrahedronId root : roots) {
    CellRecord& cell = hierarchy_.payload(root);
    cell.first_element = e;
    while (e < element_order_.size() && root_of[element_order_[e]] == root) ++e;
    cell.last_element = e;
  }
}

void Resampler::evaluate_vertices(const std::vector<VertexId>& vertices) {
  parallel_for(vertices.size(), 64, [&](std::size_t i) {
    VertexRecord& record = hierarchy_.payload(vertices[i]);
    const Vec3 position = hierarchy_.position(vertices[i]);
    record.distances.radius = hierarchy_.domain().diameter(hierarchy_.lattice(vertices[i]));
    record.distances.body = source_.body_at(position, &record.distances.flagged);
    std::vector<NearInterface> near;
    source_.network->near_interfaces(position, record.distances.radius, record.distances.body, near,
                                     options_.distance);
    record.distances.near.reserve(near.size());
    record.closest.reserve(near.size());
    for (const NearInterface& n : near) {
      const double d = rounded(n.signed_distance, record.distances.radius);
      record.distances.near.push_back({n.interface, d + shifts_[n.interface]});
      record.closest.push_back(n.closest);
      record.distances.flagged = record.distances.flagged || n.flagged;
    }
    list_known_bodies(source_.network->table(), record.distances);
  });
}

void Resampler::evaluate_interface(TetrahedronId t) {
  CellRecord& cell = hierarchy_.payload(t);
  CellOwnership owners;
  ownership(t, owners);
  cell.interface = estimate_interface_error(*source_.network, frame(t), owners, cell.triangles,
                                            estimate_target(), cell.trusted);
  cell.evaluated = true;
}

/// Gives the children of a tetrahedron what it has.
void Resampler::hand_down(TetrahedronId parent) {
  const CellRecord& from = hierarchy_.payload(parent);
  const SplitPlane plane = split_plane(parent);
  const auto children = hierarchy_.children(parent);
  const auto begin = element_order_.begin();
  std::uint32_t middle = from.first_element;
  if (source_.fields) {
    const auto& elements = source_.fields->native_elements();
    const auto at =
        std::stable_partition(begin + from.first_element, begin + from.last_element,
                              [&](std::uint32_t e) { return plane.side(elements[e].position) == 0; });
    middle = static_cast<std::uint32_t>(at - begin);
  }
  for (std::size_t side = 0; side < 2; ++side) {
    CellRecord& to = hierarchy_.payload(children[side]);
    to.first_element = side == 0 ? from.first_element : middle;
    to.last_element = side == 0 ? middle : from.last_element;
    to.trusted = from.trusted;
    const Tetrahedron part = frame(children[side]);
    for (const std::uint32_t t : from.triangles) {
      const auto& corners = source_.network->triangle_corners(t);
      if (meets(part, corners[0], corners[1], corners[2])) to.triangles.push_back(t);
    }
  }
}

void Resampler::distribute(TetrahedronId parent) {
  hand_down(parent);
  for (const TetrahedronId child : hierarchy_.children(parent)) {
    const bool leaf = hierarchy_.is_leaf(child);
    if (leaf || adapting_) evaluate_interface(child);
    if (!leaf) distribute(child);
  }
  close_cell(parent);
}

/// Takes from a tetrahedron that is split what leaves alone have.
void Resampler::close_cell(TetrahedronId t) {
  CellRecord& cell = hierarchy_.payload(t);
  cell.triangles = {};
  cell.evaluated = false;
}

std::vector<TetrahedronId> Resampler::process(const std::vector<Split>& splits) {
  std::vector<VertexId> vertices;
  std::vector<TetrahedronId> parents, created;
  for (const Split& split : splits) {
    if (!hierarchy_.payload(split.vertex).distances.body.valid()) vertices.push_back(split.vertex);
    if (hierarchy_.payload(split.parent).evaluated) parents.push_back(split.parent);
    for (const TetrahedronId child : split.children) {
      if (hierarchy_.is_leaf(child)) created.push_back(child);
    }
  }
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  evaluate_vertices(vertices);
  parallel_for(parents.size(), 16, [&](std::size_t i) { distribute(parents[i]); });
  if (watch_ != nullptr) watch_split(parents, created);
  if (fields_active_) measure_fields(created, DisplacedErrors::kWithinTargets);
  if (recorded_ != nullptr) recorded_->splits.insert(recorded_->splits.end(), splits.begin(), splits.end());
  return created;
}

/// Gives a tetrahedron back what its children have, before they go.
void Resampler::collect(TetrahedronId parent) {
  CellRecord& to = hierarchy_.payload(parent);
  if (to.evaluated) return;
  for (const TetrahedronId child : hierarchy_.children(parent)) {
    const auto& from = hierarchy_.payload(child).triangles;
    to.triangles.insert(to.triangles.end(), from.begin(), from.end());
  }
  std::sort(to.triangles.begin(), to.triangles.end());
  to.triangles.erase(std::unique(to.triangles.begin(), to.triangles.end()), to.triangles.end());
}

/// Merges what the splits have made, the last ones first.
void Resampler::undo(const std::vector<Split>& splits) {
  std::vector<TetrahedronId> restored;
  for (auto split = splits.rbegin(); split != splits.rend(); ++split) {
    const DiamondId diamond = hierarchy_.diamond(split->parent);
    if (!hierarchy_.is_split(diamond)) continue;
    for (const TetrahedronId t : hierarchy_.tetrahedra(diamond)) collect(t);
    hierarchy_.merge(diamond, restored);
  }
  // Some of the leaves that came back are gone again by now.
  restored = leaves();
  std::erase_if(restored, [&](TetrahedronId t) { return hierarchy_.payload(t).evaluated; });
  parallel_for(restored.size(), 16, [&](std::size_t i) { evaluate_interface(restored[i]); });
}

/// Undoes what was recorded, with what splitting has changed in the cells.
void Resampler::take_back(const Record& record) {
  for (const auto& [t, trusted] : record.trusted) hierarchy_.payload(t).trusted = trusted;
  undo(record.splits);
}

}  // namespace adamas::interfaces
