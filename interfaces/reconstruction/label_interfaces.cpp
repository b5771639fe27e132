#include "interfaces/reconstruction/label_interfaces.h"

#include <algorithm>
#include <optional>
#include <tuple>

#include "core/base/error.h"
#include "core/base/loop_progress.h"
#include "core/base/parallel.h"
#include "core/base/sort_unique.h"
#include "core/data/contact_mesh.h"
#include "core/geometry/ownership_problem.h"
#include "interfaces/reconstruction/label_totals.h"
#include "interfaces/reconstruction/site_values.h"

namespace adamas::interfaces {

namespace {

using Index = LabelLattice::Index;

/// The number of layers of cells of a slab. So many slabs at once are made in parallel and appended in order.
constexpr std::uint32_t kSlab = 4, kBatch = 16;
/// A tetrahedron has at most so many numbers for inner parts.
constexpr std::size_t kSlots = 8;

/// Returns the owner among candidates at a point of a tetrahedron.
std::uint16_t owner_at(const OwnershipProblem& problem, const Weights& weights) {
  return static_cast<std::uint16_t>(problem.owner(weights));
}

}  // namespace

std::unique_ptr<LabelInterfaces> LabelInterfaces::make(const MultiMaterialData& data,
                                                       const IdVector<MaterialId, double>& wanted,
                                                       bool smooth, Progress& progress) {
  std::optional<LabelLattice> lattice;
  if (smooth) {
    lattice.emplace(data, SiteValues(data, true, {}, progress));
  } else {
    lattice.emplace(data);
  }
  if (!smooth && !lattice->has_even_spacing()) return nullptr;
  IdVector<MaterialId, double> volumes = close_label_totals(data, wanted, *lattice, progress);
  if (!lattice->labels_stay()) return nullptr;
  std::unique_ptr<LabelInterfaces> result = make(data, std::move(*lattice), smooth, progress);
  if (result) result->volumes_ = std::move(volumes);
  return result;
}

std::unique_ptr<LabelInterfaces> LabelInterfaces::make(const MultiMaterialData& data, LabelLattice&& lattice,
                                                       bool may_leave_out, Progress& progress) {
  std::unique_ptr<LabelInterfaces> result(new LabelInterfaces(data, std::move(lattice)));
  if (!result->extract(data, may_leave_out, progress)) return nullptr;
  return result;
}

std::unique_ptr<LabelInterfaces> LabelInterfaces::without_triangles(const MultiMaterialData& data,
                                                                    LabelLattice&& lattice) {
  std::unique_ptr<LabelInterfaces> result(new LabelInterfaces(data, std::move(lattice)));
  result->part_bodies_ = result->parts_of_runs().bodies();
  return result;
}

RegionParts LabelInterfaces::parts_of_runs() const {
  return {lattice_.runs().roots(),
          [this](RegionParts::Part run) { return lattice_.material(lattice_.runs().number(run)); }};
}

bool LabelInterfaces::extract(const MultiMaterialData& data, bool may_leave_out, Progress& progress) {
  const std::uint32_t layers = lattice_.points(2) - 1;
  std::vector<Place> below;
  for (std::uint32_t begin = 0; begin < layers; begin += kBatch * kSlab) {
    progress.step("reconstructing interfaces", static_cast<double>(begin) / layers);
    std::vector<Slab> slabs((std::min(layers - begin, kBatch * kSlab) + kSlab - 1) / kSlab);
    parallel_for(slabs.size(), 1, [&](std::size_t n) {
      const std::uint32_t first = begin + static_cast<std::uint32_t>(n) * kSlab,
                          last = std::min(first + kSlab, layers);
      Slab& slab = slabs[n];
      slab.surfaces =
          label_surfaces(lattice_, {0, 0, first}, {lattice_.points(0) - 1, lattice_.points(1) - 1, last});
      if (first > 0) slab.low = places_in_plane(slab.surfaces, first);
      if (last < layers) slab.high = places_in_plane(slab.surfaces, last);
    });
    for (Slab& slab : slabs) {
      const auto& left_out = slab.surfaces.left_out;
      left_out_.insert(left_out_.end(), left_out.begin(), left_out.end());
      if (!may_leave_out && !left_out_.empty()) return false;
      append(slab, below);
      slab = {};
    }
  }
  const LoopProgress stage(progress, "joining interfaces");
  RegionParts parts = parts_of_runs();
  LoopProgress::check();
  if (!left_out_.empty() && !add_left_out(data, parts)) return false;
  part_bodies_ = parts.bodies();
  bodies_ = part_bodies_.name_sides(mesh_.triangles);
  return true;
}

/// Returns the features in the plane with an index along z, in ascending order, with the numbers of their
/// points.
std::vector<LabelInterfaces::Place> LabelInterfaces::places_in_plane(const LabelSurfaces& surfaces,
                                                                     std::uint32_t k) const {
  std::vector<Place> places;
  for (std::uint32_t p = 0; p < surfaces.points.size(); ++p) {
    if (is_in_plane(lattice_, surfaces.features[p], k)) places.emplace_back(surfaces.features[p], p);
  }
  std::sort(places.begin(), places.end());
  return places;
}

/// Appends the surfaces of a slab to the mesh. Slabs share the points in the plane between them, each of
/// which is in the lower slab: the tetrahedra on both sides of the plane use it. `below`: the places in the
/// plane below with the numbers of points of the mesh; becomes those in the plane above.
void LabelInterfaces::append(const Slab& slab, std::vector<Place>& below) {
  constexpr std::uint32_t kNew = 0xffffffffu;
  const LabelSurfaces& surfaces = slab.surfaces;
  std::vector<LatticeFeature> beside;
  for (const LatticeTetrahedron& tetrahedron : surfaces.left_out) add_features(lattice_, tetrahedron, beside);
  sort_unique(beside);
  std::vector<std::uint32_t> numbers(surfaces.points.size(), kNew);
  auto known = below.begin();
  for (const auto& [feature, p] : slab.low) {
    while (known->first != feature) ++known;
    numbers[p] = known->second;
  }
  for (std::uint32_t p = 0; p < numbers.size(); ++p) {
    if (numbers[p] == kNew) {
      if (mesh_.points.size() >= kNew)
        fail("{}: expected fewer points of interfaces, found too many", source_);
      numbers[p] = static_cast<std::uint32_t>(mesh_.points.size());
      mesh_.points.push_back(surfaces.points[p]);
    }
    if (!beside.empty() && std::binary_search(beside.begin(), beside.end(), surfaces.features[p]))
      points_beside_[surfaces.features[p]] = numbers[p];
  }
  for (const InterfaceTriangle& t : surfaces.triangles)
    mesh_.triangles.push_back(
        {{numbers[t.points[0]], numbers[t.points[1]], numbers[t.points[2]]}, t.front, t.back});
  below.clear();
  for (const auto& [feature, p] : slab.high) below.emplace_back(feature, numbers[p]);
}

/// Adds the interfaces in tetrahedra that are left out, behind the others. They are found as for fractions.
/// Returns false where points on the features that they share with others do not stay.
bool LabelInterfaces::add_left_out(const MultiMaterialData& data, RegionParts& parts) {
  const Box3 domain = data.grid.domain();
  ContactMeshBuilder builder(kWeldTolerance * domain.diagonal());
  ContactBuffer buffer;
  std::unordered_map<std::uint64_t, LatticeFeature> features;  // by the first word of the digest
  std::vector<LabelLattice::Candidate> candidates;
  OwnershipProblem problem;
  std::vector<ContactPolygon> contacts;
  for (const LatticeTetrahedron& left_out : left_out_) {
    const auto tetrahedron = lattice_.tetrahedron(left_out.cell, left_out.path);
    lattice_.find_candidates(left_out.cell, left_out.path, tetrahedron.owners, candidates);
    LabelLattice::set_problem(candidates, problem);
    keep_owners(problem);
    std::array<std::uint64_t, 4> ids{};
    std::array<Vec3, 4> places;
    for (std::size_t c = 0; c < 4; ++c) {
      const Index& p = tetrahedron.corners[c];
      ids[c] = p[0] + lattice_.points(0) * (p[1] + std::uint64_t{lattice_.points(1)} * p[2]);
      places[c] = lattice_.position(p);
    }
    contacts.clear();
    contact_polygons(problem, contacts);
    for (const ContactPolygon& contact : contacts) {
      for (const ContactPolygon::Corner& corner : contact.corners) {
        const auto [feature, known] = feature_of(lattice_, left_out, tetrahedron.owners, corner);
        if (known) features[ContactBuffer::digest(ids, corner.zero_weights, corner.functions).low] = feature;
      }
    }
    if (!name_parts(left_out, tetrahedron, problem, parts)) return false;
    buffer.clear();
    buffer.add(ids, places, problem);
    builder.append(buffer);
  }
  std::vector<Digest> keys;
  InterfaceMesh found = builder.finish(&keys);
  parts.settle(found);
  parts.join_round_edges(found, domain);
  const bool joined = append_left_out(found, [&](std::size_t p) {
    const auto feature = features.find(keys[p].low);
    return feature == features.end() ? points_beside_.end() : points_beside_.find(feature->second);
  });
  if (joined) points_beside_ = {};
  return joined;
}

/// Replaces the owners of a problem of a tetrahedron by their parts, and adds inner parts for those that own
/// no corner. Returns whether there are numbers enough.
bool LabelInterfaces::name_parts(const LatticeTetrahedron& left_out,
                                 const LabelLattice::Tetrahedron& tetrahedron, OwnershipProblem& problem,
                                 RegionParts& parts) {
  std::size_t slot = 0;
  std::vector<std::pair<RegionParts::Part, MaterialId>> inner_parts;
  for (auto& candidate : problem.candidates) {
    const auto number = static_cast<std::uint16_t>(candidate.owner);
    const auto corner = std::ranges::find(tetrahedron.owners, number);
    if (corner != tetrahedron.owners.end()) {
      candidate.owner =
          run_of(tetrahedron.corners[static_cast<std::size_t>(corner - tetrahedron.owners.begin())]);
      continue;
    }
    const std::uint64_t key = inner_key(left_out, std::min(slot++, kSlots - 1));
    const std::size_t next = lattice_.runs().size() + inner_parts_.size();
    if (next >= 0xffffffffu) return false;
    candidate.owner = inner_parts_.try_emplace(key, static_cast<RegionParts::Part>(next)).first->second;
    inner_parts.emplace_back(candidate.owner, lattice_.material(number));
  }
  parts.add_inner(inner_parts);
  return true;
}

/// Appends the interfaces of the tetrahedra left out. `known_point(p)`: the entry of points_beside_, or its
/// end, of each of their points. Returns whether all triangles that were there end at points that both have.
template <class Known>
bool LabelInterfaces::append_left_out(const InterfaceMesh& found, Known&& known_point) {
  std::vector<char> stays(mesh_.points.size(), 1);
  for (const auto& [feature, p] : points_beside_) stays[p] = 0;
  std::vector<std::uint32_t> numbers(found.points.size());
  for (std::size_t p = 0; p < numbers.size(); ++p) {
    const auto known = known_point(p);
    if (known != points_beside_.end()) {
      numbers[p] = known->second;
      stays[known->second] = 1;
    } else {
      numbers[p] = static_cast<std::uint32_t>(mesh_.points.size());
      mesh_.points.push_back(found.points[p]);
    }
  }
  for (const InterfaceTriangle& t : mesh_.triangles) {
    for (const std::uint32_t p : t.points) {
      if (stays[p] == 0) return false;
    }
  }
  for (const InterfaceTriangle& t : found.triangles)
    mesh_.triangles.push_back(
        {{numbers[t.points[0]], numbers[t.points[1]], numbers[t.points[2]]}, t.front, t.back});
  drop_unused_points(mesh_);
  return true;
}

std::uint32_t LabelInterfaces::run_of(const Index& point) const {
  return lattice_.runs().find(lattice_.site(0, point[0]),
                              lattice_.site(1, point[1]) + lattice_.sites(1) * lattice_.site(2, point[2]));
}

std::uint64_t LabelInterfaces::inner_key(const LatticeTetrahedron& tetrahedron, std::size_t slot) const {
  const auto& [i, j, k] = tetrahedron.cell;
  const std::uint64_t cell = i + lattice_.points(0) * (j + std::uint64_t{lattice_.points(1)} * k);
  return (cell * MaterialLattice::kPaths.size() + tetrahedron.path) * kSlots + slot;
}

BodyId LabelInterfaces::body_at(const Vec3& p) const {
  const LatticeLocation location = lattice_.locate(p);
  const auto tetrahedron = lattice_.tetrahedron(location.cell, location.path);
  const auto body_of_corner = [&](std::size_t c) { return part_bodies_.of(run_of(tetrahedron.corners[c])); };
  const auto& owners = tetrahedron.owners;
  if (std::ranges::all_of(owners, [&](std::uint16_t owner) { return owner == owners[0]; }))
    return body_of_corner(0);
  thread_local std::vector<LabelLattice::Candidate> candidates;
  OwnershipProblem problem;
  lattice_.find_candidates(location.cell, location.path, owners, candidates);
  LabelLattice::set_problem(candidates, problem);
  const std::uint16_t owner = owner_at(problem, location.weights);
  const auto corner = std::ranges::find(owners, owner);
  if (corner != owners.end()) return body_of_corner(static_cast<std::size_t>(corner - owners.begin()));
  keep_owners(problem);
  std::size_t slot = 0;
  for (const auto& candidate : problem.candidates) {
    if (candidate.owner == owner) break;
    slot += std::ranges::find(owners, candidate.owner) == owners.end() ? 1 : 0;
  }
  const auto inner = inner_parts_.find(inner_key({location.cell, location.path}, std::min(slot, kSlots - 1)));
  if (inner == inner_parts_.end()) return body_of_corner(0);
  const auto body = part_bodies_.of_inner_part.find(inner->second);
  return body != part_bodies_.of_inner_part.end() ? body->second : body_of_corner(0);
}

}  // namespace adamas::interfaces
