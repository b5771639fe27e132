#include "interfaces/reconstruction/material_lattice.h"

#include <algorithm>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/base/sort_unique.h"

namespace adamas::interfaces {

MaterialLattice::MaterialLattice(const MultiMaterialData& data, const SiteValues& values)
    : material_count_(data.materials.size()), far_(values.far_value()) {
  const bool margin = data.grid.centering == Centering::kCells;
  for (int axis = 0; axis < 3; ++axis) {
    auto& x = coordinates_[static_cast<std::size_t>(axis)];
    const auto& nodes = data.grid.nodes[static_cast<std::size_t>(axis)];
    if (margin) x.push_back(nodes.front());
    for (std::size_t i = 0; i < data.grid.sites(axis); ++i) x.push_back(data.grid.site_coordinate(axis, i));
    if (margin) x.push_back(nodes.back());
    margin_[static_cast<std::size_t>(axis)] = margin ? 1 : 0;
  }
  const double count = static_cast<double>(coordinates_[0].size()) *
                       static_cast<double>(coordinates_[1].size()) *
                       static_cast<double>(coordinates_[2].size());
  if (count > 1.6e8)
    fail("{}: expected a grid of at most 160 million sites, found {:.0f}", data.source, count);
  for (std::size_t n = 0; n < values.number_count(); ++n) {
    by_name_.push_back(values.material(static_cast<std::uint16_t>(n)));
    whole_.push_back(values.material_number(static_cast<std::uint16_t>(n)));
  }
  add_values(data, values);
  find_owners(data, values);
}

std::size_t MaterialLattice::nearest_site(const MultiMaterialData& data, const Index& p) const {
  std::array<std::size_t, 3> site{};
  for (std::size_t a = 0; a < 3; ++a)
    site[a] =
        std::min<std::size_t>(p[a] - std::min(p[a], margin_[a]), data.grid.sites(static_cast<int>(a)) - 1);
  return data.grid.site_index(site[0], site[1], site[2]);
}

/// Copies the values of sites, and continues those of the nearest site's materials to points on the border.
void MaterialLattice::add_values(const MultiMaterialData& data, const SiteValues& values) {
  first_.assign(point_count() + std::size_t{1}, 0);
  const auto for_each_point = [&](auto&& visit) {
    parallel_for(points(2), 1, [&](std::size_t k) {
      Index p{0, 0, static_cast<std::uint32_t>(k)};
      for (p[1] = 0; p[1] < points(1); ++p[1]) {
        for (p[0] = 0; p[0] < points(0); ++p[0]) visit(p);
      }
    });
  };
  for_each_point([&](const Index& p) {
    first_[point_index(p) + 1] = static_cast<std::uint32_t>(values.at(nearest_site(data, p)).size());
  });
  std::uint64_t total = 0;
  for (std::uint32_t& first : first_) {
    total += first;
    if (total > 0xffffffffu) fail("{}: expected fewer materials side by side, found too many", data.source);
    first = static_cast<std::uint32_t>(total);
  }
  entries_.resize(total);
  for_each_point([&](const Index& p) {
    std::uint32_t at = first_[point_index(p)];
    for (const SiteValues::Entry& e : values.at(nearest_site(data, p)))
      entries_[at++] = {e.value, e.material, e.is_pure()};
  });
  // Values are continued along one axis after another, so that corners take theirs from edges.
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    const auto& x = coordinates_[a];
    if (margin_[a] == 0 || data.grid.sites(axis) < 2) continue;
    const std::uint32_t last = points(axis) - 1;
    const double low = (x[0] - x[1]) / (x[1] - x[2]),
                 high = (x[last] - x[last - 1]) / (x[last - 1] - x[last - 2]);
    for_each_point([&](const Index& p) {
      if (p[a] != 0 && p[a] != last) return;
      // Points on the border along a later axis are set in its turn.
      for (std::size_t b = a + 1; b < 3; ++b) {
        if (margin_[b] != 0 && (p[b] == 0 || p[b] + 1 == points(static_cast<int>(b)))) return;
      }
      Index one = p, two = p;
      one[a] = p[a] == 0 ? 1 : last - 1;
      two[a] = p[a] == 0 ? 2 : last - 2;
      const std::uint32_t point = point_index(p), near = point_index(one), next = point_index(two);
      for (std::uint32_t e = first_[point]; e < first_[point + 1]; ++e) {
        Entry& entry = entries_[e];
        entry.value = continued(value(near, entry.material), value(next, entry.material),
                                p[a] == 0 ? low : high, far_, entry.is_pure);
      }
    });
  }
}

double MaterialLattice::value(std::uint32_t point, std::uint16_t number) const {
  for (std::uint32_t e = first_[point]; e < first_[point + 1]; ++e) {
    if (entries_[e].material == number) return entries_[e].value;
  }
  return whole_[number] == number ? far_ : value(point, whole_[number]);
}

void MaterialLattice::find_owners(const MultiMaterialData& data, const SiteValues& values) {
  owner_.resize(point_count());
  parallel_for(points(2), 1, [&](std::size_t k) {
    for (std::uint32_t j = 0; j < points(1); ++j) {
      for (std::uint32_t i = 0; i < points(0); ++i) {
        const std::uint32_t p = point_index({i, j, static_cast<std::uint32_t>(k)});
        if (first_[p] == first_[p + 1]) {
          owner_[p] = values.sole_material(nearest_site(data, {i, j, static_cast<std::uint32_t>(k)}));
          continue;
        }
        // The first of equal values, in the order of names, wins.
        const Entry* best = &entries_[first_[p]];
        for (std::uint32_t e = first_[p] + 1; e < first_[p + 1]; ++e) {
          const Entry& entry = entries_[e];
          if (entry.value > best->value) best = &entry;
        }
        owner_[p] = best->material;
      }
    }
  });
}

std::array<MaterialLattice::Index, 4> MaterialLattice::tetrahedron(const Index& cell,
                                                                   std::size_t path) const {
  std::array<Index, 4> corners{cell, cell, cell, cell};
  for (std::size_t step = 0; step < 3; ++step) {
    for (std::size_t c = step + 1; c < 4; ++c) ++corners[c][static_cast<std::size_t>(kPaths[path][step])];
  }
  return corners;
}

bool MaterialLattice::have_one_owner(const std::array<std::uint32_t, 4>& corners) const {
  std::uint16_t region = owner_[corners[0]];
  for (const std::uint32_t corner : corners) {
    const std::uint16_t other = owner_[corner];
    if (!is_one_region(region, other)) return false;
    // A region of a material is more specific than the material.
    if (whole_[region] == region) region = other;
  }
  return true;
}

void MaterialLattice::ownership(const std::array<std::uint32_t, 4>& corners,
                                OwnershipProblem& problem) const {
  problem.clear();
  // Materials are in the order of names, independent of the order of corners.
  thread_local std::vector<std::uint16_t> near;
  near.clear();
  for (const std::uint32_t corner : corners) {
    for (std::uint32_t e = first_[corner]; e < first_[corner + 1]; ++e) near.push_back(entries_[e].material);
  }
  sort_unique(near);
  for (const std::uint16_t m : near) {
    problem.add_candidate(m);
    const auto at = [&](std::size_t c) {
      // A point without values belongs to its only material and to each of its regions.
      const std::uint32_t point = corners[c];
      const bool sole = first_[point] == first_[point + 1] && owner_[point] == whole_[m];
      return sole ? -far_ : value(point, m);
    };
    problem.add_function({at(0), at(1), at(2), at(3)}, m);
  }
}

LatticeLocation locate_in_lattice(const std::array<std::vector<double>, 3>& coordinates, const Vec3& p) {
  LatticeLocation location{};
  std::array<double, 3> local{};
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    const auto& x = coordinates[a];
    const double clamped = std::clamp(p[axis], x.front(), x.back());
    const auto above = std::upper_bound(x.begin() + 1, x.end() - 1, clamped);
    const auto i = static_cast<std::size_t>(above - x.begin()) - 1;
    location.cell[a] = static_cast<std::uint32_t>(i);
    local[a] = std::clamp((clamped - x[i]) / (x[i + 1] - x[i]), 0.0, 1.0);
  }
  for (location.path = 0; location.path < 6; ++location.path) {
    const auto& path = MaterialLattice::kPaths[location.path];
    const double a = local[static_cast<std::size_t>(path[0])], b = local[static_cast<std::size_t>(path[1])],
                 c = local[static_cast<std::size_t>(path[2])];
    if (a < b || b < c) continue;
    location.weights = {1 - a, a - b, b - c, c};
    break;
  }
  return location;
}

}  // namespace adamas::interfaces
