#include "interfaces/reconstruction/reconstruction.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/base/disjoint_sets.h"
#include "core/base/error.h"
#include "core/base/loop_progress.h"
#include "core/base/parallel.h"
#include "core/base/release_memory.h"
#include "core/data/contact_mesh.h"
#include "core/geometry/ownership_problem.h"
#include "interfaces/reconstruction/cut_volumes.h"
#include "interfaces/reconstruction/fraction_area.h"
#include "interfaces/reconstruction/grid_flakes.h"
#include "interfaces/reconstruction/total_closing.h"
#include "interfaces/reconstruction/volume_correction.h"

namespace adamas::interfaces {

namespace {

double area_of(const std::vector<Vec3>& points, const std::vector<InterfaceTriangle>& triangles) {
  double area = 0;
  for (const InterfaceTriangle& t : triangles) {
    const Vec3& a = points[t.points[0]];
    area += 0.5 * norm(cross(points[t.points[1]] - a, points[t.points[2]] - a));
  }
  return area;
}

/// The corners of a tetrahedron of a lattice cell.
struct Corners {
  std::array<MaterialLattice::Index, 4> indices;
  std::array<std::uint32_t, 4> points{};
  std::array<std::uint64_t, 4> ids{};
  std::array<Vec3, 4> positions;

  Corners(const MaterialLattice& lattice, const MaterialLattice::Index& cell, std::size_t path)
      : indices(lattice.tetrahedron(cell, path)) {
    for (std::size_t c = 0; c < 4; ++c) {
      ids[c] = points[c] = lattice.point_index(indices[c]);
      positions[c] = lattice.position(indices[c]);
    }
  }
};

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

}  // namespace

void check_range(const FractionOptions& options) {
  constexpr double kMostBlur = FractionOptions::kMostBlur, kMostError = FractionOptions::kMostError;
  if (const std::optional<double> blur = options.known_blur(); blur && !(*blur >= 0 && *blur <= kMostBlur))
    wrong_usage("--blur: expected a number from 0 to {}, found '{}'", kMostBlur, *blur);
  if (const std::optional<double> error = options.known_error();
      error && !(*error >= 0 && *error <= kMostError))
    wrong_usage("--fraction-error: expected a part from 0 to {}, or from 0% to {}%, found '{}'", kMostError,
                100 * kMostError, *error);
}

/// The result of one layer of lattice cells. Layers are extracted in parallel and joined in order.
struct Reconstruction::Layer {
  ContactBuffer contacts;
  IdVector<MaterialId, double> volume;
  std::vector<std::pair<Part, MaterialId>> inner_parts;
};

Reconstruction::Reconstruction(const MultiMaterialData& data, const ReconstructionOptions& options,
                               Progress& progress)
    : volume_input_(data.volumes()) {
  mesh_.source = data.source;
  mesh_.materials = data.materials;
  if (!data.labels.empty() && take_labels(data, options, progress)) return;
  check_range(options.fractions);
  values_ = std::make_unique<SiteValues>(data, options.smooth_labels, options.fractions, progress);
  reconstruct(data, SiteCells(data.grid), progress);
}

Reconstruction::Reconstruction(const MultiMaterialData& data, const SiteValues& values, Progress& progress)
    : volume_input_(data.volumes()) {
  mesh_.source = data.source;
  mesh_.materials = data.materials;
  values_ = std::make_unique<SiteValues>(values);
  lattice_.emplace(data, *values_);
  extract(data, progress);
}

/// Reconstructs labels, unless their values have to be treated as those of fractions; then returns false.
bool Reconstruction::take_labels(const MultiMaterialData& data, const ReconstructionOptions& options,
                                 Progress& progress) {
  const LoopProgress loops(progress);
  labels_ = LabelInterfaces::make(data, volume_input_, options.smooth_labels, progress);
  if (!labels_) return false;
  mesh_.points = labels_->take_points();
  mesh_.triangles = labels_->take_triangles();
  bodies_ = labels_->take_bodies();
  body_materials_ = labels_->body_materials();
  volume_wanted_ = volume_input_;
  volume_reconstructed_ = labels_->volumes();
  return true;
}

void Reconstruction::reconstruct(const MultiMaterialData& data, const SiteCells& cells, Progress& progress) {
  SiteValues& values = *values_;
  correct_volumes(data, values, cells, progress);
  lattice_.emplace(data, values);
  volume_wanted_ = values.volumes();
  findings_ = values.findings();
  const LoopProgress loops(progress);
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
    findings_.area_of_fractions = interface_area_of_fractions(data, values, *lattice_);
}

/// Gives flakes to their neighbours and closes totals with them; returns what cells of neighbours get.
std::vector<VolumeMove> Reconstruction::give_flakes_to_neighbours(const MultiMaterialData& data,
                                                                  SiteValues& values, const SiteCells& cells,
                                                                  Progress& progress) {
  const auto find = [&] { return find_flakes(data, values, mesh_, bodies_, body_materials_); };
  const auto close = [&](const IdVector<MaterialId, double>& wanted) {
    close_totals(data, wanted, values, cells, progress);
    lattice_.emplace(data, values);
    extract(data, progress);
    return volume_reconstructed_;
  };
  IdVector<MaterialId, double> given = volume_reconstructed_;
  const std::vector<Flake> flakes =
      settle_flakes(volume_wanted_, data.grid.domain().volume(), find, close, given);
  volume_reconstructed_ = given;
  if (flakes.empty()) return {};
  const IdVector<BodyId, BodyId> numbers = drop_flakes(flakes, mesh_, bodies_, body_materials_);
  for (BodyId& body : part_bodies_.of_part) body = numbers[body];
  for (auto& [part, body] : part_bodies_.of_inner_part) body = numbers[body];
  drop_unused_points(mesh_);
  std::vector<VolumeMove> moves;
  for (const Flake& flake : flakes) moves.push_back(flake.move);
  return moves;
}

void Reconstruction::extract(const MultiMaterialData& data, Progress& progress) {
  // What was extracted before is not needed any more.
  release_memory(mesh_.points);
  release_memory(mesh_.triangles);
  release_memory(bodies_);
  part_bodies_ = RegionParts::Bodies();
  const std::uint32_t layers = lattice_->points(2) - 1;
  ContactMeshBuilder builder(kWeldTolerance * data.grid.domain().diagonal());
  volume_reconstructed_.assign(data.materials.size(), 0);
  // A tetrahedron gets eight numbers for inner parts if 32 bits are enough for this, else four.
  slots_ = 0xffffffffu / lattice_->point_count() > 6 * 8 + 1 ? 8 : 4;
  RegionParts parts(join_points(), [this](Part part) { return lattice_->material(lattice_->owner(part)); });
  constexpr std::uint32_t kBatch = 8;
  const std::vector<double> work = work_before_layers(*lattice_);
  for (std::uint32_t begin = 0; begin < layers; begin += kBatch) {
    progress.step("reconstructing interfaces", work[begin] / work[layers]);
    const std::uint32_t count = std::min(kBatch, layers - begin);
    std::vector<Layer> batch(count);
    parallel_for(count, 1,
                 [&](std::size_t i) { extract_layer(begin + static_cast<std::uint32_t>(i), batch[i]); });
    std::vector<const ContactBuffer*> contacts;
    for (const Layer& layer : batch) contacts.push_back(&layer.contacts);
    builder.append(contacts);
    for (const Layer& layer : batch) {
      for (MaterialId m(0); m.value < data.materials.size(); ++m.value)
        volume_reconstructed_[m] += layer.volume[m];
      parts.add_inner(layer.inner_parts);
    }
  }
  const LoopProgress stage(progress, "joining interfaces");
  InterfaceMesh extracted = builder.finish();
  parts.settle(extracted);
  drop_unused_points(extracted);
  LoopProgress::check();
  parts.join_round_edges(extracted, data.grid.domain());
  LoopProgress::check();
  part_bodies_ = parts.bodies();
  mesh_.points = std::move(extracted.points);
  mesh_.triangles = std::move(extracted.triangles);
  bodies_ = part_bodies_.name_sides(mesh_.triangles);
  body_materials_ = part_bodies_.materials;
}

void Reconstruction::extract_layer(std::uint32_t k, Layer& layer) const {
  layer.volume.assign(lattice_->material_count(), 0);
  for (std::uint32_t j = 0; j + 1 < lattice_->points(1); ++j) {
    for (std::uint32_t i = 0; i + 1 < lattice_->points(0); ++i) extract_cell({i, j, k}, layer);
  }
}

void Reconstruction::extract_cell(const MaterialLattice::Index& cell, Layer& layer) const {
  const Vec3 low = lattice_->position(cell),
             high = lattice_->position({cell[0] + 1, cell[1] + 1, cell[2] + 1});
  const double volume = Box3{low, high}.volume();
  const std::uint32_t first = lattice_->point_index(cell);
  const std::uint16_t owner = lattice_->owner(first);
  bool uniform = true;
  for (std::uint32_t c = 0; c < 8 && uniform; ++c) {
    const std::uint32_t p =
        lattice_->point_index({cell[0] + (c & 1u), cell[1] + (c >> 1 & 1u), cell[2] + (c >> 2)});
    uniform = lattice_->owner(p) == owner;
  }
  if (uniform) {
    layer.volume[lattice_->material(owner)] += volume;
    return;
  }
  for (std::size_t path = 0; path < MaterialLattice::kPaths.size(); ++path)
    extract_tetrahedron(cell, path, volume / 6, layer);
}

void Reconstruction::extract_tetrahedron(const MaterialLattice::Index& cell, std::size_t path, double volume,
                                         Layer& layer) const {
  thread_local OwnershipProblem problem;
  thread_local std::vector<OwnedTetrahedron> parts;
  const auto [indices, points, ids, positions] = Corners(*lattice_, cell, path);
  if (lattice_->have_one_owner(points)) {
    layer.volume[lattice_->material(lattice_->owner(points[0]))] += volume;
    return;
  }
  lattice_->ownership(indices, problem);
  if (extract_between_two(points, ids, positions, problem, volume, layer)) return;
  parts.clear();
  partition_tetrahedron(problem, parts);
  for (const OwnedTetrahedron& part : parts) {
    layer.volume[lattice_->material(part.owner)] += volume * volume_fraction(part.corners);
  }
  if (problem.candidates.size() < 2) return;
  // Owners of volumes that are only round-off stay, so that the tetrahedra on the two sides of a face agree
  // on its owners.
  keep_owners(problem);
  const std::vector<OwnershipProblem::Candidate> owners = problem.candidates;
  for (std::size_t c = 0; c < owners.size(); ++c) {
    const Part part = problem.candidates[c].owner = part_in(cell, path, points, owners, owners[c].owner);
    if (part >= lattice_->point_count())
      layer.inner_parts.emplace_back(part, lattice_->material(owners[c].owner));
  }
  layer.contacts.add(ids, positions, problem);
}

/// Extracts the polygon in a tetrahedron that two owners share, each of which has a corner; returns false if
/// there may be other owners.
bool Reconstruction::extract_between_two(const std::array<std::uint32_t, 4>& points,
                                         const std::array<std::uint64_t, 4>& ids,
                                         const std::array<Vec3, 4>& positions,
                                         const OwnershipProblem& problem, double volume, Layer& layer) const {
  const std::optional<TwoOwners> two = two_owners(problem);
  if (!two) return false;
  const std::array<std::uint32_t, 2> owners{two->first->owner, two->second->owner};
  std::array<Part, 2> parts{};
  for (std::size_t o = 0; o < 2; ++o) {
    const auto corner = std::ranges::find_if(
        points, [&](std::uint32_t p) { return lattice_->is_one_region(lattice_->owner(p), owners[o]); });
    if (corner == points.end()) return false;
    parts[o] = *corner;
  }
  const std::array<LinearFunction, 2> functions{problem.functions[two->first->first],
                                                problem.functions[two->second->first]};
  std::array<double, 4> above{};
  for (std::size_t c = 0; c < 4; ++c) above[c] = functions[0].values[c] - functions[1].values[c];
  const double own = volume * positive_part(above).volume;
  layer.volume[lattice_->material(owners[0])] += own;
  layer.volume[lattice_->material(owners[1])] += volume - own;
  // Corners of tetrahedra are in the order of their numbers.
  layer.contacts.add_between(ids, positions, functions, parts);
  return true;
}

Reconstruction::Part Reconstruction::part_in(const MaterialLattice::Index& cell, std::size_t path,
                                             const std::array<std::uint32_t, 4>& corners,
                                             const std::vector<OwnershipProblem::Candidate>& owners,
                                             std::uint32_t number) const {
  for (const std::uint32_t p : corners) {
    if (lattice_->is_one_region(lattice_->owner(p), number)) return p;
  }
  // A tetrahedron has at most four regions that hold a corner; inner parts are numbered by the position of
  // their material among the owners. If a tetrahedron has more of them than numbers, which hardly occurs, the
  // last ones count as one.
  std::uint32_t slot = 0;
  for (const auto& candidate : owners) {
    if (candidate.owner == number) break;
    const bool holds = std::any_of(corners.begin(), corners.end(), [&](std::uint32_t p) {
      return lattice_->is_one_region(lattice_->owner(p), candidate.owner);
    });
    if (!holds) slot = std::min(slot + 1, slots_ - 1);
  }
  const std::uint32_t tetrahedron = lattice_->point_index(cell) * 6 + static_cast<std::uint32_t>(path);
  return lattice_->point_count() + tetrahedron * slots_ + slot;
}

std::vector<Reconstruction::Part> Reconstruction::join_points() const {
  DisjointSets sets(lattice_->point_count());
  for (std::uint32_t k = 0; k < lattice_->points(2); ++k) {
    LoopProgress::check();
    for (std::uint32_t j = 0; j < lattice_->points(1); ++j) {
      for (std::uint32_t i = 0; i < lattice_->points(0); ++i) {
        const std::uint32_t p = lattice_->point_index({i, j, k});
        for (std::uint32_t d = 1; d < 8; ++d) {
          const MaterialLattice::Index other{i + (d & 1u), j + (d >> 1 & 1u), k + (d >> 2)};
          if (other[0] >= lattice_->points(0) || other[1] >= lattice_->points(1) ||
              other[2] >= lattice_->points(2))
            continue;
          const std::uint32_t q = lattice_->point_index(other);
          if (lattice_->is_one_region(lattice_->owner(p), lattice_->owner(q))) sets.join(p, q);
        }
      }
    }
  }
  return std::move(sets).roots();
}

void Reconstruction::keep_bodies_alone() {
  if (values_) values_->keep_values_at(lattice_->sites_beside_others());
}

BodyId Reconstruction::body_at(const Vec3& p) const {
  if (labels_) return labels_->body_at(p);
  const auto location = lattice_->locate(p);
  const auto corners = lattice_->tetrahedron(location.cell, location.path);
  std::array<std::uint32_t, 4> points{};
  for (std::size_t c = 0; c < 4; ++c) points[c] = lattice_->point_index(corners[c]);
  if (lattice_->have_one_owner(points)) return part_bodies_.of(points[0]);
  OwnershipProblem problem;
  lattice_->ownership(corners, problem);
  const std::uint32_t owner = problem.owner(location.weights);
  keep_owners(problem);
  const Part part = part_in(location.cell, location.path, points, problem.candidates, owner);
  if (!part_bodies_.is_inner(part)) return part_bodies_.of(part);
  const auto found = part_bodies_.of_inner_part.find(part);
  return found != part_bodies_.of_inner_part.end() ? found->second : part_bodies_.of(points[0]);
}

}  // namespace adamas::interfaces
