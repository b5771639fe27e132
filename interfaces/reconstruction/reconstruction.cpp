#include "interfaces/reconstruction/reconstruction.h"

#include <algorithm>
#include <numeric>
#include <unordered_map>

#include "core/base/parallel.h"
#include "core/geometry/contact_mesh.h"
#include "interfaces/network/edge_fans.h"

namespace adamas {

namespace {

std::uint64_t edge_key(std::uint32_t a, std::uint32_t b) {
  return static_cast<std::uint64_t>(std::min(a, b)) << 32 | std::max(a, b);
}

/// Leaves out points that no triangle has: those on contacts of a material with itself.
void drop_unused_points(InterfaceMesh& mesh) {
  constexpr std::uint32_t kUnused = 0xffffffffu;
  std::vector<std::uint32_t> number(mesh.points.size(), kUnused);
  for (const InterfaceTriangle& t : mesh.triangles) {
    for (const std::uint32_t p : t.points) number[p] = 0;
  }
  std::uint32_t count = 0;
  for (std::size_t p = 0; p < number.size(); ++p) {
    if (number[p] == kUnused) continue;
    mesh.points[count] = mesh.points[p];
    number[p] = count++;
  }
  mesh.points.resize(count);
  for (InterfaceTriangle& t : mesh.triangles) {
    for (std::uint32_t& p : t.points) p = number[p];
  }
}

}  // namespace

/// What one layer of lattice cells gives; layers are worked on in parallel and joined in order.
struct Reconstruction::Layer {
  ContactBuffer contacts;
  IdVector<MaterialId, double> volume;
  std::vector<std::pair<Part, MaterialId>> pointless;
};

Reconstruction::Reconstruction(const MultiMaterialData& data, const ReconstructionOptions& options,
                               Progress& progress)
    : Reconstruction(data, SiteValues(data, options.smooth_labels), progress) {}

Reconstruction::Reconstruction(const MultiMaterialData& data, SiteValues&& values, Progress& progress)
    : agreement_(correct_volumes(data, values, progress)),
      lost_bodies_(find_lost_bodies(data, values)),
      lattice_(data, values) {
  const std::uint32_t layers = lattice_.points(2) - 1;
  mesh_.source = data.source;
  ContactMeshBuilder builder(kWeldTolerance * data.grid.domain().diagonal());
  volume_reconstructed_.assign(data.materials.size(), 0);
  // As many as numbers suffice for.
  slots_ = 0xffffffffu / lattice_.point_count() > 6 * 8 + 1 ? 8 : 4;
  join_points();
  constexpr std::uint32_t kBatch = 8;
  for (std::uint32_t begin = 0; begin < layers; begin += kBatch) {
    progress.step("reconstructing interfaces", static_cast<double>(begin) / layers);
    const std::uint32_t count = std::min(kBatch, layers - begin);
    std::vector<Layer> batch(count);
    parallel_for(count, 1,
                 [&](std::size_t i) { extract_layer(begin + static_cast<std::uint32_t>(i), batch[i]); });
    for (Layer& layer : batch) {
      builder.append(layer.contacts);
      for (MaterialId m(0); m.value < data.materials.size(); ++m.value)
        volume_reconstructed_[m] += layer.volume[m];
      pointless_.insert(pointless_.end(), layer.pointless.begin(), layer.pointless.end());
    }
  }
  InterfaceMesh extracted = builder.finish();
  settle_parts(extracted);
  drop_unused_points(extracted);
  join_round_edges(extracted, data.grid.domain());
  number_bodies();

  const auto body_of = [&](std::uint32_t part) {
    return part < body_of_point_.size() ? body_of_point_[part] : body_of_pointless_.at(part);
  };
  mesh_.points = std::move(extracted.points);
  mesh_.triangles = std::move(extracted.triangles);
  mesh_.materials = data.materials;
  bodies_.reserve(mesh_.triangles.size());
  for (InterfaceTriangle& t : mesh_.triangles) {
    bodies_.push_back({body_of(t.front.value), body_of(t.back.value)});
    t.front = body_materials_[bodies_.back()[0]];
    t.back = body_materials_[bodies_.back()[1]];
  }

  volume_input_ = data.volumes();
}

void Reconstruction::extract_layer(std::uint32_t k, Layer& layer) const {
  layer.volume.assign(lattice_.material_count(), 0);
  for (std::uint32_t j = 0; j + 1 < lattice_.points(1); ++j) {
    for (std::uint32_t i = 0; i + 1 < lattice_.points(0); ++i) extract_cell({i, j, k}, layer);
  }
}

void Reconstruction::extract_cell(const MaterialLattice::Index& cell, Layer& layer) const {
  const Vec3 low = lattice_.position(cell), high = lattice_.position({cell[0] + 1, cell[1] + 1, cell[2] + 1});
  const double volume = Box3{low, high}.volume();
  const std::uint32_t first = lattice_.point_index(cell);
  const std::uint16_t owner = lattice_.owner(first);
  bool uniform = true;
  for (std::uint32_t c = 0; c < 8 && uniform; ++c) {
    const std::uint32_t p =
        lattice_.point_index({cell[0] + (c & 1u), cell[1] + (c >> 1 & 1u), cell[2] + (c >> 2)});
    uniform = lattice_.owner(p) == owner;
  }
  if (uniform) {
    layer.volume[lattice_.material(owner)] += volume;
    return;
  }
  for (std::size_t path = 0; path < MaterialLattice::kPaths.size(); ++path)
    extract_tetrahedron(cell, path, volume / 6, layer);
}

void Reconstruction::extract_tetrahedron(const MaterialLattice::Index& cell, std::size_t path, double volume,
                                         Layer& layer) const {
  thread_local OwnershipProblem problem;
  thread_local std::vector<OwnedTetrahedron> parts;
  const auto corners = lattice_.tetrahedron(cell, path);
  std::array<std::uint32_t, 4> points{};
  std::array<std::uint64_t, 4> ids{};
  std::array<Vec3, 4> positions;
  for (std::size_t c = 0; c < 4; ++c) {
    ids[c] = points[c] = lattice_.point_index(corners[c]);
    positions[c] = lattice_.position(corners[c]);
  }
  if (lattice_.have_one_owner(points)) {
    layer.volume[lattice_.material(lattice_.owner(points[0]))] += volume;
    return;
  }
  lattice_.ownership(points, problem);
  parts.clear();
  partition_tetrahedron(problem, parts);
  for (const OwnedTetrahedron& part : parts) {
    layer.volume[lattice_.material(part.owner)] += volume * volume_fraction(part.corners);
  }
  if (problem.candidates.size() < 2) return;
  // Also what round-off has taken: the tetrahedra on either side of a face agree on what lies on it.
  keep_owners(problem);
  const std::vector<OwnershipProblem::Candidate> owners = problem.candidates;
  for (std::size_t c = 0; c < owners.size(); ++c) {
    const Part part = problem.candidates[c].owner = part_in(cell, path, points, owners, owners[c].owner);
    if (is_pointless(part)) layer.pointless.emplace_back(part, lattice_.material(owners[c].owner));
  }
  layer.contacts.add(ids, positions, problem);
}

Reconstruction::Part Reconstruction::part_in(const MaterialLattice::Index& cell, std::size_t path,
                                             const std::array<std::uint32_t, 4>& corners,
                                             const std::vector<OwnershipProblem::Candidate>& owners,
                                             std::uint32_t number) const {
  for (const std::uint32_t p : corners) {
    if (lattice_.is_one_region(lattice_.owner(p), number)) return p;
  }
  // A tetrahedron has at most four regions that hold a corner; those that hold none are told apart by the
  // position of their material among those that own something. More of them in one tetrahedron than there
  // are numbers for, which hardly comes about, count as one.
  std::uint32_t slot = 0;
  for (const auto& candidate : owners) {
    if (candidate.owner == number) break;
    const bool holds = std::any_of(corners.begin(), corners.end(), [&](std::uint32_t p) {
      return lattice_.is_one_region(lattice_.owner(p), candidate.owner);
    });
    if (!holds) slot = std::min(slot + 1, slots_ - 1);
  }
  const std::uint32_t tetrahedron = lattice_.point_index(cell) * 6 + static_cast<std::uint32_t>(path);
  return lattice_.point_count() + tetrahedron * slots_ + slot;
}

void Reconstruction::join_points() {
  parent_.resize(lattice_.point_count());
  std::iota(parent_.begin(), parent_.end(), 0u);
  for (std::uint32_t k = 0; k < lattice_.points(2); ++k) {
    for (std::uint32_t j = 0; j < lattice_.points(1); ++j) {
      for (std::uint32_t i = 0; i < lattice_.points(0); ++i) {
        const std::uint32_t p = lattice_.point_index({i, j, k});
        for (std::uint32_t d = 1; d < 8; ++d) {
          const MaterialLattice::Index other{i + (d & 1u), j + (d >> 1 & 1u), k + (d >> 2)};
          if (other[0] >= lattice_.points(0) || other[1] >= lattice_.points(1) ||
              other[2] >= lattice_.points(2))
            continue;
          const std::uint32_t q = lattice_.point_index(other);
          if (lattice_.is_one_region(lattice_.owner(p), lattice_.owner(q))) join(p, q);
        }
      }
    }
  }
}

/// Parts without a corner that no triangle touches own nothing, and triangles with one material on both sides
/// are left by the welding of what lay between.
void Reconstruction::settle_parts(InterfaceMesh& mesh) {
  std::vector<Part> seen;
  for (const InterfaceTriangle& t : mesh.triangles) {
    for (const Part part : {t.front.value, t.back.value}) {
      if (is_pointless(part)) seen.push_back(part);
    }
  }
  std::sort(seen.begin(), seen.end());
  std::sort(pointless_.begin(), pointless_.end());
  pointless_.erase(std::unique(pointless_.begin(), pointless_.end()), pointless_.end());
  std::erase_if(pointless_, [&](const auto& entry) {
    return !std::binary_search(seen.begin(), seen.end(), entry.first);
  });
  for (const auto& [part, material] : pointless_) pointless_parent_.emplace(part, part);
  std::erase_if(mesh.triangles, [&](const InterfaceTriangle& t) {
    if (material_of(t.front.value) != material_of(t.back.value)) return false;
    join(t.front.value, t.back.value);
    return true;
  });
}

MaterialId Reconstruction::material_of(Part part) const {
  if (!is_pointless(part)) return lattice_.material(lattice_.owner(part));
  return std::lower_bound(pointless_.begin(), pointless_.end(), std::pair{part, MaterialId(0)})->second;
}

/// Edges, by their points, round which parts of one material may meet that are not yet one: where a part has
/// no corner, or the boundary of one is open.
std::vector<std::uint64_t> Reconstruction::loose_edges(const InterfaceMesh& mesh) {
  std::vector<std::pair<std::uint64_t, std::uint32_t>>
      all;  // edges with the triangle, and the side they are of
  all.reserve(3 * mesh.triangles.size());
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& p = mesh.triangles[t].points;
    for (std::uint32_t i = 0; i < 3; ++i) all.emplace_back(edge_key(p[i], p[(i + 1) % 3]), 3 * t + i);
  }
  std::sort(all.begin(), all.end());
  std::vector<std::uint64_t> loose;
  std::vector<std::pair<Part, int>> balance;
  const auto count = [&](Part part, int times) {
    const Part root = find(part);
    const auto found =
        std::find_if(balance.begin(), balance.end(), [&](const auto& entry) { return entry.first == root; });
    if (found == balance.end()) {
      balance.emplace_back(root, times);
    } else {
      found->second += times;
    }
  };
  for (std::size_t first = 0, last = 0; first < all.size(); first = last) {
    balance.clear();
    bool pointless = false;
    for (; last < all.size() && all[last].first == all[first].first; ++last) {
      const InterfaceTriangle& t = mesh.triangles[all[last].second / 3];
      const std::uint32_t i = all[last].second % 3;
      const int way = t.points[i] < t.points[(i + 1) % 3] ? 1 : -1;
      count(t.front.value, way);
      count(t.back.value, -way);
      pointless = pointless || is_pointless(t.front.value) || is_pointless(t.back.value);
    }
    const bool open =
        std::any_of(balance.begin(), balance.end(), [](const auto& entry) { return entry.second != 0; });
    if (pointless || open) loose.push_back(all[first].first);
  }
  return loose;
}

/// Joins parts of one material that meet round an edge, with nothing between them.
void Reconstruction::join_round_edges(const InterfaceMesh& mesh, const Box3& domain) {
  const std::vector<std::uint64_t> edges = loose_edges(mesh);
  if (edges.empty()) return;
  // The triangles at those edges, with points of their own.
  InterfaceMesh near;
  std::vector<std::array<Part, 2>> parts;
  std::vector<std::uint32_t> original;
  std::unordered_map<std::uint32_t, std::uint32_t> renumbered;
  for (const InterfaceTriangle& t : mesh.triangles) {
    bool touches = false;
    for (std::size_t i = 0; i < 3 && !touches; ++i)
      touches = std::binary_search(edges.begin(), edges.end(), edge_key(t.points[i], t.points[(i + 1) % 3]));
    if (!touches) continue;
    std::array<std::uint32_t, 3> points{};
    for (std::size_t i = 0; i < 3; ++i) {
      const auto [at, fresh] =
          renumbered.try_emplace(t.points[i], static_cast<std::uint32_t>(original.size()));
      if (fresh) {
        original.push_back(t.points[i]);
        near.points.push_back(mesh.points[t.points[i]]);
      }
      points[i] = at->second;
    }
    near.triangles.push_back({points, material_of(t.front.value), material_of(t.back.value)});
    parts.push_back({t.front.value, t.back.value});
  }
  const EdgeFans fans(near, &domain, kWeldTolerance);
  EdgeFans::Fan fan;
  for (std::size_t edge = 0; edge < fans.size(); ++edge) {
    const auto [low, high] = fans.ends(edge);
    if (!std::binary_search(edges.begin(), edges.end(), edge_key(original[low], original[high]))) continue;
    fans.fan(edge, fan);
    const std::size_t count = fan.blades.size();
    for (std::size_t i = 0; i < count && count > 1; ++i) {
      if (i == fan.outside_wedge) continue;
      const Blade &a = fan.blades[i], &b = fan.blades[(i + 1) % count];
      const auto ahead = static_cast<std::size_t>(EdgeFans::side_ahead(a)),
                 behind = static_cast<std::size_t>(EdgeFans::side_behind(b));
      if (fans.material(a.triangle, EdgeFans::side_ahead(a)) ==
          fans.material(b.triangle, EdgeFans::side_behind(b)))
        join(parts[a.triangle][ahead], parts[b.triangle][behind]);
    }
  }
}

Reconstruction::Part Reconstruction::find(Part part) {
  const auto parent = [&](Part p) -> Part& {
    return p < parent_.size() ? parent_[p] : pointless_parent_.at(p);
  };
  while (parent(part) != part) {
    parent(part) = parent(parent(part));
    part = parent(part);
  }
  return part;
}

void Reconstruction::join(Part a, Part b) {
  a = find(a), b = find(b);
  if (a == b) return;
  if (b < a) std::swap(a, b);
  (b < parent_.size() ? parent_[b] : pointless_parent_.at(b)) = a;
}

void Reconstruction::number_bodies() {
  body_of_point_.resize(lattice_.point_count());
  for (Part p = 0; p < lattice_.point_count(); ++p) {
    const Part root = find(p);
    if (root == p) {
      body_of_point_[p] = body_materials_.next_id();
      body_materials_.push_back(lattice_.material(lattice_.owner(p)));
    } else {
      body_of_point_[p] = body_of_point_[root];
    }
  }
  for (const auto& [part, material] : pointless_) {
    const Part root = find(part);
    if (root < body_of_point_.size()) {
      body_of_pointless_[part] = body_of_point_[root];
    } else if (root == part) {
      body_of_pointless_[part] = body_materials_.next_id();
      body_materials_.push_back(material);
    } else {
      body_of_pointless_[part] = body_of_pointless_.at(root);
    }
  }
  pointless_ = {};
  parent_ = {};
  pointless_parent_ = {};
}

BodyId Reconstruction::body_at(const Vec3& p) const {
  const auto location = lattice_.locate(p);
  const auto corners = lattice_.tetrahedron(location.cell, location.path);
  std::array<std::uint32_t, 4> points{};
  for (std::size_t c = 0; c < 4; ++c) points[c] = lattice_.point_index(corners[c]);
  if (lattice_.have_one_owner(points)) return body_of_point_[points[0]];
  OwnershipProblem problem;
  lattice_.ownership(points, problem);
  const std::uint32_t owner = problem.owner(location.weights);
  keep_owners(problem);
  const Part part = part_in(location.cell, location.path, points, problem.candidates, owner);
  if (part < body_of_point_.size()) return body_of_point_[part];
  const auto found = body_of_pointless_.find(part);
  return found != body_of_pointless_.end() ? found->second : body_of_point_[points[0]];
}

}  // namespace adamas
