#include "interfaces/reconstruction/flakes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "interfaces/network/domain_faces.h"

namespace adamas::interfaces {

namespace {

/// The greatest volume, in cells, and number of triangles of a flake.
constexpr double kMostVolume = 0.05;
constexpr std::size_t kMostTriangles = 200;
/// Together, flakes have at most this part of the material's volume in the connected cells that hold them.
constexpr double kMostOfHeld = 0.01;
/// After flakes are given to neighbours, totals are closed again, at most kMostClosings times, until they are
/// right up to kTotalTolerance of the domain.
constexpr int kMostClosings = 3;
constexpr double kTotalTolerance = 5e-10;

class FlakeSearch {
 public:
  FlakeSearch(const FlakeCells& cells, const InterfaceMesh& mesh,
              const std::vector<std::array<BodyId, 2>>& bodies,
              const IdVector<BodyId, MaterialId>& body_materials)
      : domain_(cells.domain()), cells_(cells), mesh_(mesh), bodies_(bodies), materials_(body_materials) {}

  std::vector<Flake> run() {
    find_small_bodies();
    std::vector<std::uint32_t> group_of;  // by flake
    for (const Flake& flake : flakes_) {
      group_of.push_back(cells_.group(flake.move.cell, flake.move.from));
      if (group_of.back() != FlakeCells::kNone) group(group_of.back()).in_flakes += flake.move.part;
    }
    std::vector<Flake> kept;
    for (std::size_t n = 0; n < flakes_.size(); ++n) {
      if (group_of[n] == FlakeCells::kNone || group(group_of[n]).can_spare_flakes())
        kept.push_back(flakes_[n]);
    }
    return kept;
  }

 private:
  /// A connected group of cells that hold a material.
  struct Group {
    double held = 0, in_flakes = 0;  ///< in cells
    bool shows = false;              ///< whether the material has more than half of some cell
    [[nodiscard]] bool can_spare_flakes() const { return shows && in_flakes <= kMostOfHeld * held; }
  };

  Group& group(std::uint32_t number) {
    const auto [place, is_new] = groups_.try_emplace(number);
    Group& group = place->second;
    if (is_new) {
      cells_.for_each_fraction(number, [&](double fraction) {
        group.held += fraction;
        group.shows = group.shows || fraction > 0.5;
      });
    }
    return group;
  }

  void find_small_bodies() {
    IdVector<BodyId, std::vector<std::uint32_t>> triangles(materials_.size());
    for (std::uint32_t t = 0; t < bodies_.size(); ++t) {
      for (const BodyId body : bodies_[t]) {
        if (body.valid() && triangles[body].size() <= kMostTriangles) triangles[body].push_back(t);
      }
    }
    std::vector<BodyId> found;
    for (BodyId body(0); body.value < triangles.size(); ++body.value) {
      if (triangles[body].empty() || triangles[body].size() > kMostTriangles ||
          cells_.is_outside(materials_[body]))
        continue;
      Flake flake = describe(body, triangles[body]);
      // A body's volume is negative if it encloses another one.
      if (flake.volume < 0 || !(flake.move.part <= kMostVolume) ||
          !choose_neighbour(triangles[body], found, flake))
        continue;
      found.push_back(body);
      flakes_.push_back(flake);
    }
  }

  [[nodiscard]] Flake describe(BodyId body, const std::vector<std::uint32_t>& triangles) const {
    constexpr double kInfinite = std::numeric_limits<double>::infinity();
    Box3 box;
    for (const std::uint32_t t : triangles) {
      for (const std::uint32_t p : mesh_.triangles[t].points) box.extend(mesh_.points[p]);
    }
    Flake flake{body, {}, {0, materials_[body], {}, kInfinite}, kInfinite};
    // The volume is measured from a point for which faces on the domain's boundary, which have no triangles,
    // add nothing.
    const unsigned faces = domain_faces_at(domain_, box.min) | domain_faces_at(domain_, box.max);
    Vec3 origin = box.center();
    for (int axis = 0; axis < 3; ++axis) {
      const unsigned ends = faces >> (2 * axis) & 3u;
      // A body that reaches from one side of the domain to the other is no flake.
      if (ends == 3) return flake;
      if (ends != 0) origin[axis] = ends == 1 ? domain_.min[axis] : domain_.max[axis];
    }
    flake.volume = 0;
    for (const std::uint32_t t : triangles) {
      const auto& [a, b, c] = mesh_.triangles[t].points;
      const double part = signed_volume(origin, mesh_.points[a], mesh_.points[b], mesh_.points[c]);
      flake.volume += bodies_[t][0] == body ? -part : part;
    }
    flake.move.cell = cells_.cell_at(box.center());
    flake.move.part = flake.volume / cells_.volume(flake.move.cell);
    return flake;
  }

  /// Sets the flake's neighbour to the one with the greatest common area whose material no other neighbour
  /// has. Returns whether there is one and no neighbour is among `flakes`.
  [[nodiscard]] bool choose_neighbour(const std::vector<std::uint32_t>& triangles,
                                      const std::vector<BodyId>& flakes, Flake& flake) const {
    std::map<BodyId, double> areas;
    for (const std::uint32_t t : triangles) {
      const auto& [a, b, c] = mesh_.triangles[t].points;
      const BodyId other = bodies_[t][bodies_[t][0] == flake.body ? 1 : 0];
      if (cells_.is_outside(materials_[other])) continue;
      areas[other] += norm(cross(mesh_.points[b] - mesh_.points[a], mesh_.points[c] - mesh_.points[a]));
    }
    double greatest = 0;
    for (const auto& [body, area] : areas) {
      if (std::binary_search(flakes.begin(), flakes.end(), body)) return false;
      const bool alone = std::all_of(areas.begin(), areas.end(), [&, own = body](const auto& other) {
        return other.first == own || materials_[other.first] != materials_[own];
      });
      if (alone && area > greatest) greatest = area, flake.neighbour = body;
    }
    if (greatest > 0) flake.move.to = materials_[flake.neighbour];
    return greatest > 0;
  }

  Box3 domain_;
  const FlakeCells& cells_;
  const InterfaceMesh& mesh_;
  const std::vector<std::array<BodyId, 2>>& bodies_;
  const IdVector<BodyId, MaterialId>& materials_;
  std::vector<Flake> flakes_;
  std::map<std::uint32_t, Group> groups_;
};

/// Returns the greatest deviation of a difference of volumes from the mean of all differences.
double greatest_difference(const IdVector<MaterialId, double>& a, const IdVector<MaterialId, double>& b) {
  double mean = 0, greatest = 0;
  for (MaterialId m(0); m.value < a.size(); ++m.value) mean += (a[m] - b[m]) / static_cast<double>(a.size());
  for (MaterialId m(0); m.value < a.size(); ++m.value)
    greatest = std::max(greatest, std::abs(a[m] - b[m] - mean));
  return greatest;
}

}  // namespace

std::vector<Flake> find_flakes(const FlakeCells& cells, const InterfaceMesh& mesh,
                               const std::vector<std::array<BodyId, 2>>& bodies,
                               const IdVector<BodyId, MaterialId>& body_materials) {
  return FlakeSearch(cells, mesh, bodies, body_materials).run();
}

std::vector<Flake> settle_flakes(
    const IdVector<MaterialId, double>& wanted, double domain,
    const std::function<std::vector<Flake>()>& find,
    const std::function<IdVector<MaterialId, double>(const IdVector<MaterialId, double>&)>& close,
    IdVector<MaterialId, double>& given) {
  for (int closings = 0;; ++closings) {
    std::vector<Flake> flakes = find();
    IdVector<MaterialId, double> with_flakes = wanted, counted = given;
    for (const Flake& flake : flakes) {
      const auto& [cell, from, to, part] = flake.move;
      with_flakes[from] += flake.volume, counted[from] -= flake.volume;
      with_flakes[to] -= flake.volume, counted[to] += flake.volume;
    }
    if ((closings == 0 && flakes.empty()) ||
        greatest_difference(counted, wanted) <= kTotalTolerance * domain) {
      given = counted;
      return flakes;
    }
    // If the flakes change with the offsets, they are left as they are.
    const bool give_up = closings == kMostClosings;
    given = close(give_up ? wanted : with_flakes);
    if (give_up) return {};
  }
}

IdVector<BodyId, BodyId> drop_flakes(const std::vector<Flake>& flakes, InterfaceMesh& mesh,
                                     std::vector<std::array<BodyId, 2>>& bodies,
                                     IdVector<BodyId, MaterialId>& body_materials) {
  IdVector<BodyId, BodyId> numbers(body_materials.size());
  for (const Flake& flake : flakes) numbers[flake.body] = flake.neighbour;
  IdVector<BodyId, MaterialId> kept;
  for (BodyId body(0); body.value < numbers.size(); ++body.value) {
    if (numbers[body].valid()) continue;
    numbers[body] = kept.next_id();
    kept.push_back(body_materials[body]);
  }
  // No neighbour is a flake itself.
  for (const Flake& flake : flakes) numbers[flake.body] = numbers[flake.neighbour];
  body_materials = std::move(kept);
  std::size_t count = 0;
  for (std::size_t t = 0; t < bodies.size(); ++t) {
    std::array<BodyId, 2> sides = bodies[t];
    InterfaceTriangle triangle = mesh.triangles[t];
    if (sides[0].valid()) {
      sides = {numbers[sides[0]], numbers[sides[1]]};
      if (sides[0] == sides[1]) continue;
      triangle.front = body_materials[sides[0]], triangle.back = body_materials[sides[1]];
    }
    mesh.triangles[count] = triangle;
    bodies[count++] = sides;
  }
  mesh.triangles.resize(count);
  bodies.resize(count);
  return numbers;
}

}  // namespace adamas::interfaces
