#include "interfaces/reconstruction/flakes.h"

#include <algorithm>
#include <limits>
#include <map>

#include "interfaces/network/domain_faces.h"
#include "interfaces/reconstruction/grid_sites.h"

namespace adamas {

namespace {

using Entry = SiteValues::Entry;

/// A flake has no more volume, in cells, and no more triangles.
constexpr double kMostVolume = 0.05;
constexpr std::size_t kMostTriangles = 200;
/// Flakes have together no more than this part of what the cells hold that hang together with theirs.
constexpr double kMostOfHeld = 0.01;

/// Cells that hold a material and hang together, and what they hold.
class HeldVolumes {
 public:
  HeldVolumes(const MultiMaterialData& data, const SiteValues& values)
      : sites_(data.grid), values_(values), group_of_(values.entries().size(), kNone) {}

  static constexpr std::uint32_t kNone = 0xffffffffu;

  /// The number of the group of a site's cell, or of one beside it; kNone where none holds the material.
  std::uint32_t group(std::size_t site, MaterialId material) {
    std::size_t at = site;
    const Entry* first = find(at, material);
    sites_.for_each_neighbour(site, [&](std::size_t other, int, int, int) {
      if (first != nullptr) return;
      at = other;
      first = find(at, material);
    });
    if (first == nullptr) return kNone;
    if (group_of_[index(first)] == kNone) collect(at, *first, material);
    return group_of_[index(first)];
  }
  /// In cells; those that the material fills without others near are left out.
  [[nodiscard]] double held(std::uint32_t group) const { return held_[group]; }
  /// Whether a cell of a group holds more of the material than of all others, so that it shows there.
  [[nodiscard]] bool shows(std::uint32_t group) const { return shows_[group] != 0; }

 private:
  [[nodiscard]] std::size_t index(const Entry* entry) const {
    return static_cast<std::size_t>(entry - values_.entries().data());
  }
  /// The entry of a material, or that of its regions which has the greatest part.
  [[nodiscard]] const Entry* find(std::size_t site, MaterialId material) const {
    const Entry* found = nullptr;
    for (const Entry& entry : values_.at(site)) {
      if (values_.material(entry.material) == material && entry.fraction > kFractionTrace &&
          (found == nullptr || entry.fraction > found->fraction))
        found = &entry;
    }
    return found;
  }

  void collect(std::size_t site, const Entry& first, MaterialId material) {
    const auto group = static_cast<std::uint32_t>(held_.size());
    double held = 0;
    bool shows = false;
    std::vector<std::size_t> waiting{site};
    group_of_[index(&first)] = group;
    while (!waiting.empty()) {
      const std::size_t cell = waiting.back();
      waiting.pop_back();
      const float fraction = find(cell, material)->fraction;
      held += static_cast<double>(fraction);
      shows = shows || fraction > 0.5f;
      sites_.for_each_neighbour(cell, [&](std::size_t other, int, int, int) {
        const Entry* entry = find(other, material);
        if (entry == nullptr || group_of_[index(entry)] != kNone) return;
        group_of_[index(entry)] = group;
        waiting.push_back(other);
      });
    }
    held_.push_back(held);
    shows_.push_back(shows ? 1 : 0);
  }

  GridSites sites_;
  const SiteValues& values_;
  std::vector<std::uint32_t> group_of_;  // by entry
  std::vector<double> held_;             // by group
  std::vector<char> shows_;              // by group
};

class FlakeSearch {
 public:
  FlakeSearch(const MultiMaterialData& data, const SiteValues& values, const InterfaceMesh& mesh,
              const std::vector<std::array<BodyId, 2>>& bodies,
              const IdVector<BodyId, MaterialId>& body_materials)
      : domain_(data.grid.domain()),
        sites_(data.grid),
        held_(data, values),
        mesh_(mesh),
        bodies_(bodies),
        materials_(body_materials) {}

  std::vector<Flake> run() {
    find_small_bodies();
    std::map<std::uint32_t, double> sums;  // volumes of flakes, in cells, by group
    std::vector<std::uint32_t> groups;
    for (const Flake& flake : flakes_) {
      groups.push_back(held_.group(flake.site, materials_[flake.body]));
      sums[groups.back()] += flake.volume / sites_.cell(flake.site).volume();
    }
    std::vector<Flake> kept;
    for (std::size_t n = 0; n < flakes_.size(); ++n) {
      const std::uint32_t group = groups[n];
      if (group == HeldVolumes::kNone ||
          (held_.shows(group) && sums[group] <= kMostOfHeld * held_.held(group)))
        kept.push_back(flakes_[n]);
    }
    return kept;
  }

 private:
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
      // What lies round another body has a negative volume.
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
    // Seen from where faces on the domain's boundary, which no triangle has, add nothing.
    const double near = kOnDomainFace * domain_.diagonal();
    Vec3 origin = box.center();
    for (int axis = 0; axis < 3; ++axis) {
      const bool at_min = box.min[axis] - domain_.min[axis] <= near,
                 at_max = domain_.max[axis] - box.max[axis] <= near;
      // From one side of the domain to the other: no flake.
      if (at_min && at_max) return {body, {}, 0, std::numeric_limits<double>::infinity()};
      if (at_min) origin[axis] = domain_.min[axis];
      if (at_max) origin[axis] = domain_.max[axis];
    }
    double volume = 0;
    for (const std::uint32_t t : triangles) {
      const auto& [a, b, c] = mesh_.triangles[t].points;
      const double part = signed_volume(origin, mesh_.points[a], mesh_.points[b], mesh_.points[c]);
      volume += bodies_[t][0] == body ? -part : part;
    }
    return {body, {}, static_cast<std::uint32_t>(sites_.site_at(box.center())), volume};
  }

  /// The neighbour with the greatest area between, whose material no other neighbour has; returns whether
  /// there is one, and all neighbours are other than these.
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
  HeldVolumes held_;
  const InterfaceMesh& mesh_;
  const std::vector<std::array<BodyId, 2>>& bodies_;
  const IdVector<BodyId, MaterialId>& materials_;
  std::vector<Flake> flakes_;
};

}  // namespace

std::vector<Flake> find_flakes(const MultiMaterialData& data, const SiteValues& values,
                               const InterfaceMesh& mesh, const std::vector<std::array<BodyId, 2>>& bodies,
                               const IdVector<BodyId, MaterialId>& body_materials) {
  return FlakeSearch(data, values, mesh, bodies, body_materials).run();
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
  // Neighbours are no flakes.
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

}  // namespace adamas
