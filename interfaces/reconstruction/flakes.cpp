#include "interfaces/reconstruction/flakes.h"

#include <algorithm>
#include <limits>
#include <map>

#include "interfaces/network/domain_faces.h"
#include "interfaces/reconstruction/grid_sites.h"
#include "interfaces/reconstruction/held_cells.h"

namespace adamas::interfaces {

namespace {

/// The greatest volume, in cells, and number of triangles of a flake.
constexpr double kMostVolume = 0.05;
constexpr std::size_t kMostTriangles = 200;
/// Together, flakes have at most this part of the material's volume in the connected cells that hold them.
constexpr double kMostOfHeld = 0.01;

class FlakeSearch {
 public:
  FlakeSearch(const MultiMaterialData& data, const InterfaceMesh& mesh,
              const std::vector<std::array<BodyId, 2>>& bodies,
              const IdVector<BodyId, MaterialId>& body_materials)
      : domain_(data.grid.domain()),
        sites_(data.grid),
        mesh_(mesh),
        bodies_(bodies),
        materials_(body_materials) {}

  std::vector<Flake> run(const MultiMaterialData& data, const SiteValues& values) {
    find_small_bodies();
    if (flakes_.empty()) return {};
    const HeldCells cells(data, values);
    groups_.resize(cells.group_count());
    std::vector<std::uint32_t> group_of;  // by flake
    for (const Flake& flake : flakes_) {
      group_of.push_back(group(flake, cells));
      if (group_of.back() != HeldCells::kNone)
        groups_[group_of.back()].in_flakes += flake.volume / sites_.cell(flake.site).volume();
    }
    std::vector<Flake> kept;
    for (std::size_t n = 0; n < flakes_.size(); ++n) {
      if (group_of[n] == HeldCells::kNone || groups_[group_of[n]].can_spare_flakes())
        kept.push_back(flakes_[n]);
    }
    return kept;
  }

 private:
  /// A connected group of cells that hold a material.
  struct Group {
    double held = 0, in_flakes = 0;  ///< in cells
    bool shows = false;              ///< whether the material has more than half of some cell
    bool is_known = false;           ///< whether `held` and `shows` have been found
    [[nodiscard]] bool can_spare_flakes() const { return shows && in_flakes <= kMostOfHeld * held; }
  };

  /// Returns the group of a flake's cell or of one beside it; kNone if none of these holds the material.
  std::uint32_t group(const Flake& flake, const HeldCells& cells) {
    const MaterialId material = materials_[flake.body];
    std::size_t site = flake.site;
    sites_.for_each_neighbour(flake.site, [&](std::size_t other, int, int, int) {
      if (cells.find(site, material) == nullptr) site = other;
    });
    const std::uint32_t number = cells.group(site, material);
    if (number == HeldCells::kNone || groups_[number].is_known) return number;
    Group& group = groups_[number];
    group.is_known = true;
    cells.for_each_cell(number, [&](std::size_t, double fraction) {
      group.held += fraction;
      group.shows = group.shows || fraction > 0.5;
      return true;
    });
    return number;
  }

  void find_small_bodies() {
    IdVector<BodyId, std::vector<std::uint32_t>> triangles(materials_.size());
    for (std::uint32_t t = 0; t < bodies_.size(); ++t) {
      for (const BodyId body : bodies_[t]) {
        if (triangles[body].size() <= kMostTriangles) triangles[body].push_back(t);
      }
    }
    std::vector<BodyId> found;
    for (BodyId body(0); body.value < triangles.size(); ++body.value) {
      if (triangles[body].empty() || triangles[body].size() > kMostTriangles) continue;
      Flake flake = describe(body, triangles[body]);
      // A body's volume is negative if it encloses another one.
      if (flake.volume < 0 || flake.volume > kMostVolume * sites_.cell(flake.site).volume() ||
          !choose_neighbour(triangles[body], found, flake))
        continue;
      found.push_back(body);
      flakes_.push_back(flake);
    }
  }

  [[nodiscard]] Flake describe(BodyId body, const std::vector<std::uint32_t>& triangles) const {
    Box3 box;
    for (const std::uint32_t t : triangles) {
      for (const std::uint32_t p : mesh_.triangles[t].points) box.extend(mesh_.points[p]);
    }
    // The volume is measured from a point for which faces on the domain's boundary, which have no triangles,
    // add nothing.
    const unsigned faces = domain_faces_at(domain_, box.min) | domain_faces_at(domain_, box.max);
    Vec3 origin = box.center();
    for (int axis = 0; axis < 3; ++axis) {
      const unsigned ends = faces >> (2 * axis) & 3u;
      // A body that reaches from one side of the domain to the other is no flake.
      if (ends == 3) return {body, {}, 0, std::numeric_limits<double>::infinity()};
      if (ends != 0) origin[axis] = ends == 1 ? domain_.min[axis] : domain_.max[axis];
    }
    double volume = 0;
    for (const std::uint32_t t : triangles) {
      const auto& [a, b, c] = mesh_.triangles[t].points;
      const double part = signed_volume(origin, mesh_.points[a], mesh_.points[b], mesh_.points[c]);
      volume += bodies_[t][0] == body ? -part : part;
    }
    return {body, {}, static_cast<std::uint32_t>(sites_.site_at(box.center())), volume};
  }

  /// Sets the flake's neighbour to the one with the greatest common area whose material no other neighbour
  /// has. Returns whether there is one and no neighbour is among `flakes`.
  [[nodiscard]] bool choose_neighbour(const std::vector<std::uint32_t>& triangles,
                                      const std::vector<BodyId>& flakes, Flake& flake) const {
    std::map<BodyId, double> areas;
    for (const std::uint32_t t : triangles) {
      const auto& [a, b, c] = mesh_.triangles[t].points;
      areas[bodies_[t][bodies_[t][0] == flake.body ? 1 : 0]] +=
          norm(cross(mesh_.points[b] - mesh_.points[a], mesh_.points[c] - mesh_.points[a]));
    }
    double greatest = 0;
    for (const auto& [body, area] : areas) {
      if (std::binary_search(flakes.begin(), flakes.end(), body)) return false;
      const bool alone = std::all_of(areas.begin(), areas.end(), [&, own = body](const auto& other) {
        return other.first == own || materials_[other.first] != materials_[own];
      });
      if (alone && area > greatest) greatest = area, flake.neighbour = body;
    }
    return greatest > 0;
  }

  Box3 domain_;
  GridSites sites_;
  const InterfaceMesh& mesh_;
  const std::vector<std::array<BodyId, 2>>& bodies_;
  const IdVector<BodyId, MaterialId>& materials_;
  std::vector<Flake> flakes_;
  std::vector<Group> groups_;
};

}  // namespace

std::vector<Flake> find_flakes(const MultiMaterialData& data, const SiteValues& values,
                               const InterfaceMesh& mesh, const std::vector<std::array<BodyId, 2>>& bodies,
                               const IdVector<BodyId, MaterialId>& body_materials) {
  return FlakeSearch(data, mesh, bodies, body_materials).run(data, values);
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
    const std::array<BodyId, 2> sides{numbers[bodies[t][0]], numbers[bodies[t][1]]};
    if (sides[0] == sides[1]) continue;
    mesh.triangles[count] = {mesh.triangles[t].points, body_materials[sides[0]], body_materials[sides[1]]};
    bodies[count++] = sides;
  }
  mesh.triangles.resize(count);
  bodies.resize(count);
  return numbers;
}

}  // namespace adamas::interfaces
