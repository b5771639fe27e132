#include "interfaces/reconstruction/reconstruction.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <unordered_map>

#include "core/base/error.h"
#include "core/base/hash.h"
#include "core/base/loop_progress.h"
#include "core/base/parallel.h"
#include "core/base/sort_unique.h"
#include "core/data/contact_mesh.h"
#include "core/geometry/ownership_problem.h"
#include "core/geometry/plane.h"
#include "interfaces/network/edge_fans.h"
#include "interfaces/reconstruction/flakes.h"
#include "interfaces/reconstruction/grid_sites.h"
#include "interfaces/reconstruction/total_closing.h"
#include "interfaces/reconstruction/volume_correction.h"

namespace adamas::interfaces {

namespace {

/// After flakes are given to neighbours, totals are closed again, at most kMostClosings times, until they are
/// right up to kTotalTolerance of the domain.
constexpr int kMostClosings = 3;
constexpr double kTotalTolerance = 5e-10;

/// Returns the greatest deviation of a difference of volumes from the mean of all differences.
double greatest_difference(const IdVector<MaterialId, double>& a, const IdVector<MaterialId, double>& b) {
  double mean = 0, greatest = 0;
  for (MaterialId m(0); m.value < a.size(); ++m.value) mean += (a[m] - b[m]) / static_cast<double>(a.size());
  for (MaterialId m(0); m.value < a.size(); ++m.value)
    greatest = std::max(greatest, std::abs(a[m] - b[m] - mean));
  return greatest;
}

double area_of(const std::vector<Vec3>& points, const std::vector<InterfaceTriangle>& triangles) {
  double area = 0;
  for (const InterfaceTriangle& t : triangles) {
    const Vec3& a = points[t.points[0]];
    area += 0.5 * norm(cross(points[t.points[1]] - a, points[t.points[2]] - a));
  }
  return area;
}

/// Returns the area of a contact polygon in a tetrahedron with these corners.
double area_of(const ContactPolygon& contact, const std::array<Vec3, 4>& corners) {
  std::vector<Vec3> places(contact.corners.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    for (std::size_t v = 0; v < 4; ++v) places[i] += contact.corners[i].weights[v] * corners[v];
  }
  return polygon_area(places);
}

/// The corners of a tetrahedron of a lattice cell.
struct Corners {
  std::array<std::uint32_t, 4> points{};
  std::array<std::uint64_t, 4> ids{};
  std::array<Vec3, 4> positions;

  Corners(const MaterialLattice& lattice, const MaterialLattice::Index& cell, std::size_t path) {
    const auto corners = lattice.tetrahedron(cell, path);
    for (std::size_t c = 0; c < 4; ++c) {
      ids[c] = points[c] = lattice.point_index(corners[c]);
      positions[c] = lattice.position(corners[c]);
    }
  }
};

/// Returns the area of the interfaces of a lattice.
double interface_area(const MaterialLattice& lattice) {
  const std::uint32_t layers = lattice.points(2) - 1;
  std::vector<double> areas(layers, 0);
  parallel_for(layers, 1, [&](std::size_t k) {
    OwnershipProblem problem;
    std::vector<ContactPolygon> contacts;
    MaterialLattice::Index cell{0, 0, static_cast<std::uint32_t>(k)};
    for (cell[1] = 0; cell[1] + 1 < lattice.points(1); ++cell[1]) {
      for (cell[0] = 0; cell[0] + 1 < lattice.points(0); ++cell[0]) {
        for (std::size_t path = 0; path < MaterialLattice::kPaths.size(); ++path) {
          const Corners corners(lattice, cell, path);
          if (lattice.have_one_owner(corners.points)) continue;
          lattice.ownership(corners.points, problem);
          if (problem.candidates.size() < 2) continue;
          contacts.clear();
          contact_polygons(problem, contacts);
          for (const ContactPolygon& contact : contacts) areas[k] += area_of(contact, corners.positions);
        }
      }
    }
  });
  return std::accumulate(areas.begin(), areas.end(), 0.0);
}

/// Estimates the work of extracting the layers of lattice cells before each one, and of all at the end: cells
/// with several owners take kMixedWork times as long as others. Some cells of each layer stand for all.
std::vector<double> work_before_layers(const MaterialLattice& lattice) {
  constexpr std::uint32_t kStride = 5;
  constexpr double kMixedWork = 200;
  const std::uint32_t layers = lattice.points(2) - 1;
  std::vector<double> sums(layers + 1, 0);
  parallel_for(layers, 1, [&](std::size_t k) {
    MaterialLattice::Index cell{0, 0, static_cast<std::uint32_t>(k)};
    for (cell[1] = 0; cell[1] + 1 < lattice.points(1); cell[1] += kStride) {
      for (cell[0] = 0; cell[0] + 1 < lattice.points(0); cell[0] += kStride) {
        const MaterialLattice::Index opposite{cell[0] + 1, cell[1] + 1, cell[2] + 1};
        const bool mixed =
            lattice.owner(lattice.point_index(cell)) != lattice.owner(lattice.point_index(opposite));
        sums[k + 1] += mixed ? kMixedWork : 1;
      }
    }
  });
  std::partial_sum(sums.begin(), sums.end(), sums.begin());
  return sums;
}

/// Returns the options. Throws Error (kUsage) if one is out of range.
const FractionOptions& checked(const FractionOptions& options) {
  constexpr double kMostBlur = FractionOptions::kMostBlur, kMostError = FractionOptions::kMostError;
  if (const std::optional<double> blur = options.known_blur(); blur && !(*blur >= 0 && *blur <= kMostBlur))
    wrong_usage("--blur: expected a number from 0 to {}, found '{}'", kMostBlur, *blur);
  if (const std::optional<double> error = options.known_error();
      error && !(*error >= 0 && *error <= kMostError))
    wrong_usage("--fraction-error: expected a part from 0 to {}, or from 0% to {}%, found '{}'", kMostError,
                100 * kMostError, *error);
  return options;
}

/// Removes points without triangles, which are on contacts of a material with itself.
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

/// The result of one layer of lattice cells. Layers are extracted in parallel and joined in order.
struct Reconstruction::Layer {
  ContactBuffer contacts;
  IdVector<MaterialId, double> volume;
  std::vector<std::pair<Part, MaterialId>> inner_parts;
};

Reconstruction::Reconstruction(const MultiMaterialData& data, const ReconstructionOptions& options,
                               Progress& progress)
    : Reconstruction(data, SiteValues(data, options.smooth_labels, checked(options.fractions), progress),
                     SiteCells(data.grid), progress) {}

Reconstruction::Reconstruction(const MultiMaterialData& data, SiteValues&& values, const SiteCells& cells,
                               Progress& progress)
    : lattice_((correct_volumes(data, values, cells, progress), MaterialLattice(data, values))),
      volume_input_(data.volumes()),
      volume_wanted_(values.volumes()),
      findings_(values.findings()) {
  const LoopProgress loops(progress);
  mesh_.source = data.source;
  mesh_.materials = data.materials;
  extract(data, progress);
  // Smoothed labels have no flakes.
  std::vector<VolumeMove> moves;
  if (values.least_label_value() == 0) moves = give_flakes_to_neighbours(data, values, cells, progress);
  const LoopProgress stage(progress, "comparing volumes");
  agreement_ = volume_agreement(data, values, cells, moves);
  lost_bodies_ = find_lost_bodies(data, values, cells);
  if (!data.labels.empty()) return;
  findings_.cells_off = agreement_.cells_off;
  findings_.greatest_difference = agreement_.greatest_difference;
  findings_.tolerance = agreement_.tolerance;
  findings_.area = findings_.area_of_fractions = area_of(mesh_.points, mesh_.triangles);
  if (findings_.blur_share > 0 || findings_.fraction_error > 0)
    findings_.area_of_fractions = interface_area(MaterialLattice(data, SiteValues::fractions(data)));
}

/// Closes totals again until they are right with the flakes counted for their neighbours; returns the volumes
/// that neighbours get.
std::vector<VolumeMove> Reconstruction::give_flakes_to_neighbours(const MultiMaterialData& data,
                                                                  SiteValues& values, const SiteCells& cells,
                                                                  Progress& progress) {
  const GridSites sites(data.grid);
  std::vector<Flake> flakes;
  std::vector<VolumeMove> moves;
  for (int closings = 0;; ++closings) {
    flakes = find_flakes(data, values, mesh_, bodies_, body_materials_);
    moves.clear();
    IdVector<MaterialId, double> wanted = volume_wanted_, given = volume_reconstructed_;
    for (const Flake& flake : flakes) {
      const MaterialId from = body_materials_[flake.body], to = body_materials_[flake.neighbour];
      moves.push_back({flake.site, from, to, flake.volume / sites.cell(flake.site).volume()});
      wanted[from] += flake.volume, given[from] -= flake.volume;
      wanted[to] -= flake.volume, given[to] += flake.volume;
    }
    if ((closings == 0 && flakes.empty()) ||
        greatest_difference(given, volume_wanted_) <= kTotalTolerance * data.grid.domain().volume()) {
      volume_reconstructed_ = given;
      break;
    }
    // If the flakes change with the offsets, they are left as they are.
    const bool give_up = closings == kMostClosings;
    if (give_up) flakes.clear(), moves.clear(), wanted = volume_wanted_;
    close_totals(data, wanted, values, cells, progress);
    lattice_ = MaterialLattice(data, values);
    extract(data, progress);
    if (give_up) break;
  }
  if (flakes.empty()) return moves;
  const IdVector<BodyId, BodyId> numbers = drop_flakes(flakes, mesh_, bodies_, body_materials_);
  for (BodyId& body : body_of_point_) body = numbers[body];
  for (auto& [part, body] : body_of_inner_part_) body = numbers[body];
  drop_unused_points(mesh_);
  return moves;
}

void Reconstruction::extract(const MultiMaterialData& data, Progress& progress) {
  const std::uint32_t layers = lattice_.points(2) - 1;
  ContactMeshBuilder builder(kWeldTolerance * data.grid.domain().diagonal());
  volume_reconstructed_.assign(data.materials.size(), 0);
  // A tetrahedron gets eight numbers for inner parts if 32 bits are enough for this, else four.
  slots_ = 0xffffffffu / lattice_.point_count() > 6 * 8 + 1 ? 8 : 4;
  join_points();
  constexpr std::uint32_t kBatch = 8;
  const std::vector<double> work = work_before_layers(lattice_);
  for (std::uint32_t begin = 0; begin < layers; begin += kBatch) {
    progress.step("reconstructing interfaces", work[begin] / work[layers]);
    const std::uint32_t count = std::min(kBatch, layers - begin);
    std::vector<Layer> batch(count);
    parallel_for(count, 1,
                 [&](std::size_t i) { extract_layer(begin + static_cast<std::uint32_t>(i), batch[i]); });
    for (Layer& layer : batch) {
      builder.append(layer.contacts);
      for (MaterialId m(0); m.value < data.materials.size(); ++m.value)
        volume_reconstructed_[m] += layer.volume[m];
      inner_parts_.insert(inner_parts_.end(), layer.inner_parts.begin(), layer.inner_parts.end());
    }
  }
  const LoopProgress stage(progress, "joining interfaces");
  InterfaceMesh extracted = builder.finish();
  settle_parts(extracted);
  drop_unused_points(extracted);
  LoopProgress::check();
  join_round_edges(extracted, data.grid.domain());
  LoopProgress::check();
  number_bodies();

  const auto body_of = [&](std::uint32_t part) {
    return part < body_of_point_.size() ? body_of_point_[part] : body_of_inner_part_.at(part);
  };
  mesh_.points = std::move(extracted.points);
  mesh_.triangles = std::move(extracted.triangles);
  bodies_.clear();
  bodies_.reserve(mesh_.triangles.size());
  for (InterfaceTriangle& t : mesh_.triangles) {
    bodies_.push_back({body_of(t.front.value), body_of(t.back.value)});
    t.front = body_materials_[bodies_.back()[0]];
    t.back = body_materials_[bodies_.back()[1]];
  }
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
  const auto [points, ids, positions] = Corners(lattice_, cell, path);
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
  // Owners of volumes that are only round-off stay, so that the tetrahedra on the two sides of a face agree
  // on its owners.
  keep_owners(problem);
  const std::vector<OwnershipProblem::Candidate> owners = problem.candidates;
  for (std::size_t c = 0; c < owners.size(); ++c) {
    const Part part = problem.candidates[c].owner = part_in(cell, path, points, owners, owners[c].owner);
    if (is_inner(part)) layer.inner_parts.emplace_back(part, lattice_.material(owners[c].owner));
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
  // A tetrahedron has at most four regions that hold a corner; inner parts are numbered by the position of
  // their material among the owners. If a tetrahedron has more of them than numbers, which hardly occurs, the
  // last ones count as one.
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
    LoopProgress::check();
    for (std::uint32_t j = 0; j < lattice_.points(1); ++j) {
      for (std::uint32_t i = 0; i < lattice_.points(0); ++i) {
        const std::uint32_t p = lattice_.point_index({i, j, k});
        for (std::uint32_t d = 1; d < 8; ++d) {
          const MaterialLattice::Index other{i + (d & 1u), j + (d >> 1 & 1u), k + (d >> 2)};
          if (other[0] >= lattice_.points(0) || other[1] >= lattice_.points(1) ||
              other[2] >= lattice_.points(2))
            continue;
          const std::uint32_t q = lattice_.point_index(other);
          if (parent_[p] != parent_[q] && lattice_.is_one_region(lattice_.owner(p), lattice_.owner(q)))
            join(p, q);
        }
      }
    }
  }
}

/// Drops inner parts that no triangle touches: they own nothing. Triangles with one material on both sides,
/// which remain where welding has closed a thin part, are dropped too, and the parts on their sides are
/// joined.
void Reconstruction::settle_parts(InterfaceMesh& mesh) {
  LoopProgress::check();
  std::vector<Part> seen;
  for (const InterfaceTriangle& t : mesh.triangles) {
    for (const Part part : {t.front.value, t.back.value}) {
      if (is_inner(part)) seen.push_back(part);
    }
  }
  std::sort(seen.begin(), seen.end());
  sort_unique(inner_parts_);
  std::erase_if(inner_parts_, [&](const auto& entry) {
    return !std::binary_search(seen.begin(), seen.end(), entry.first);
  });
  LoopProgress::check();
  for (const auto& [part, material] : inner_parts_) inner_parents_.emplace(part, part);
  std::erase_if(mesh.triangles, [&](const InterfaceTriangle& t) {
    if (material_of(t.front.value) != material_of(t.back.value)) return false;
    join(t.front.value, t.back.value);
    return true;
  });
}

MaterialId Reconstruction::material_of(Part part) const {
  if (!is_inner(part)) return lattice_.material(lattice_.owner(part));
  return std::lower_bound(inner_parts_.begin(), inner_parts_.end(), std::pair{part, MaterialId(0)})->second;
}

/// Returns the keys of edges at which parts of one material may meet that are not yet joined: those with an
/// inner part, or where the boundary of a part is open.
std::vector<std::uint64_t> Reconstruction::loose_edges(const InterfaceMesh& mesh) {
  std::vector<std::pair<std::uint64_t, std::uint32_t>> all;  // edges with the number of the triangle's side
  all.reserve(3 * mesh.triangles.size());
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& p = mesh.triangles[t].points;
    for (std::uint32_t i = 0; i < 3; ++i) all.emplace_back(edge_key(p[i], p[(i + 1) % 3]), 3 * t + i);
  }
  LoopProgress::check();
  std::sort(all.begin(), all.end());
  std::vector<std::uint64_t> loose;
  std::size_t edges = 0;
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
    LoopProgress::check_step(edges++);
    balance.clear();
    bool has_inner = false;
    for (; last < all.size() && all[last].first == all[first].first; ++last) {
      const InterfaceTriangle& t = mesh.triangles[all[last].second / 3];
      const std::uint32_t i = all[last].second % 3;
      const int way = t.points[i] < t.points[(i + 1) % 3] ? 1 : -1;
      count(t.front.value, way);
      count(t.back.value, -way);
      has_inner = has_inner || is_inner(t.front.value) || is_inner(t.back.value);
    }
    const bool open =
        std::any_of(balance.begin(), balance.end(), [](const auto& entry) { return entry.second != 0; });
    if (has_inner || open) loose.push_back(all[first].first);
  }
  return loose;
}

/// Joins parts of one material that meet at an edge with nothing between them.
void Reconstruction::join_round_edges(const InterfaceMesh& mesh, const Box3& domain) {
  const std::vector<std::uint64_t> edges = loose_edges(mesh);
  if (edges.empty()) return;
  // These are the triangles at those edges, with points numbered anew.
  InterfaceMesh near;
  std::vector<std::array<Part, 2>> parts;
  std::vector<std::uint32_t> original;
  std::unordered_map<std::uint32_t, std::uint32_t> renumbered;
  std::size_t step = 0;
  for (const InterfaceTriangle& t : mesh.triangles) {
    LoopProgress::check_step(step++);
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
    LoopProgress::check_step(edge);
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
  const auto parent = [&](Part p) -> Part& { return p < parent_.size() ? parent_[p] : inner_parents_.at(p); };
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
  (b < parent_.size() ? parent_[b] : inner_parents_.at(b)) = a;
}

void Reconstruction::number_bodies() {
  body_materials_ = {};
  body_of_inner_part_.clear();
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
  for (const auto& [part, material] : inner_parts_) {
    const Part root = find(part);
    if (root < body_of_point_.size()) {
      body_of_inner_part_[part] = body_of_point_[root];
    } else if (root == part) {
      body_of_inner_part_[part] = body_materials_.next_id();
      body_materials_.push_back(material);
    } else {
      body_of_inner_part_[part] = body_of_inner_part_.at(root);
    }
  }
  inner_parts_ = {};
  parent_ = {};
  inner_parents_ = {};
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
  const auto found = body_of_inner_part_.find(part);
  return found != body_of_inner_part_.end() ? found->second : body_of_point_[points[0]];
}

}  // namespace adamas::interfaces
