#include "interfaces/reconstruction/material_lattice.h"

#include <algorithm>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/base/sort_unique.h"

namespace adamas::interfaces {

MaterialLattice::MaterialLattice(const MultiMaterialData& data, const SiteValues& values)
    : values_(values), material_count_(data.materials.size()), far_(values.far_value()) {
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
  if (margin) add_border(data);
  find_owners(data);
}

bool MaterialLattice::is_on_border(const Index& p) const {
  for (std::size_t a = 0; a < 3; ++a) {
    if (margin_[a] != 0 && (p[a] == 0 || p[a] + 1 == points(static_cast<int>(a)))) return true;
  }
  return false;
}

std::span<const MaterialLattice::Entry> MaterialLattice::at(const Index& p) const {
  if (is_on_border(p)) {
    const auto found = std::lower_bound(border_.begin(), border_.end(), point_index(p));
    const auto n = static_cast<std::size_t>(found - border_.begin());
    return std::span(border_entries_).subspan(border_first_[n], border_first_[n + 1] - border_first_[n]);
  }
  const std::size_t nx = points(0) - 2 * margin_[0], ny = points(1) - 2 * margin_[1];
  return values_.at(p[0] - margin_[0] + nx * (p[1] - margin_[1] + ny * (p[2] - margin_[2])));
}

std::size_t MaterialLattice::nearest_site(const RectilinearGrid& grid, const Index& p) const {
  std::array<std::size_t, 3> site{};
  for (std::size_t a = 0; a < 3; ++a)
    site[a] = std::min<std::size_t>(p[a] - std::min(p[a], margin_[a]), grid.sites(static_cast<int>(a)) - 1);
  return grid.site_index(site[0], site[1], site[2]);
}

std::optional<MaterialLattice::Inwards> MaterialLattice::inwards(const Index& p) const {
  for (std::size_t a = 3; a-- > 0;) {
    const std::uint32_t last = points(static_cast<int>(a)) - 1;
    if (margin_[a] == 0 || (p[a] != 0 && p[a] != last)) continue;
    // With one site along the axis there are two points beside it.
    if (last < 3) return {};
    const auto& x = coordinates_[a];
    const bool low = p[a] == 0;
    Inwards found{
        p, p, low ? (x[0] - x[1]) / (x[1] - x[2]) : (x[last] - x[last - 1]) / (x[last - 1] - x[last - 2])};
    found.nearest[a] = low ? 1 : last - 1;
    found.next[a] = low ? 2 : last - 2;
    return found;
  }
  return {};
}

/// Calls visit(point) for all points; planes z = const are visited in parallel.
template <class Visit>
void MaterialLattice::for_each_point(const Visit& visit) const {
  parallel_for(points(2), 1, [&](std::size_t k) {
    Index p{0, 0, static_cast<std::uint32_t>(k)};
    for (p[1] = 0; p[1] < points(1); ++p[1]) {
      for (p[0] = 0; p[0] < points(0); ++p[0]) visit(p);
    }
  });
}

/// Continues the values of the nearest site's materials to points on the border.
void MaterialLattice::add_border(const MultiMaterialData& data) {
  std::uint64_t total = 0;
  for (Index p{0, 0, 0}; p[2] < points(2); ++p[2]) {
    for (p[1] = 0; p[1] < points(1); ++p[1]) {
      for (p[0] = 0; p[0] < points(0); ++p[0]) {
        if (!is_on_border(p)) {
          p[0] = points(0) - 2;  // the next one is at the end of the row
          continue;
        }
        border_.push_back(point_index(p));
        border_first_.push_back(static_cast<std::uint32_t>(total));
        const std::span<const Entry> nearest = values_.at(nearest_site(data.grid, p));
        border_entries_.insert(border_entries_.end(), nearest.begin(), nearest.end());
        total += nearest.size();
        if (total > 0xffffffffu)
          fail("{}: expected fewer materials side by side, found too many", data.source);
      }
    }
  }
  border_first_.push_back(static_cast<std::uint32_t>(total));
  for (std::size_t axis = 0; axis < 3; ++axis) continue_along(axis);
}

/// Continues values to the points on the border that take theirs along an axis.
void MaterialLattice::continue_along(std::size_t axis) {
  parallel_for(border_.size(), 1024, [&](std::size_t n) {
    const Index p = indices(border_[n]);
    const std::optional<Inwards> from = inwards(p);
    if (!from || from->nearest[axis] == p[axis]) return;
    const std::span<const Entry> near = at(from->nearest), next = at(from->next);
    for (std::uint32_t e = border_first_[n]; e < border_first_[n + 1]; ++e) {
      Entry& entry = border_entries_[e];
      entry.value = continued(value(near, entry.material), value(next, entry.material), from->step, far_,
                              entry.is_pure());
    }
  });
}

double MaterialLattice::value(std::span<const Entry> entries, std::uint16_t number) const {
  for (const Entry& entry : entries) {
    if (entry.material == number) return entry.value;
  }
  return whole_[number] == number ? far_ : value(entries, whole_[number]);
}

void MaterialLattice::find_owners(const MultiMaterialData& data) {
  owner_.resize(point_count());
  for_each_point([&](const Index& p) {
    const std::span<const Entry> own = at(p);
    // The first of equal values, in the order of names, wins.
    owner_[point_index(p)] = own.empty() ? values_.sole_material(nearest_site(data.grid, p))
                                         : std::ranges::max_element(own, {}, &Entry::value)->material;
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

std::vector<std::uint8_t> MaterialLattice::sites_beside_others() const {
  const std::array<std::size_t, 3> n{points(0) - 2 * margin_[0], points(1) - 2 * margin_[1],
                                     points(2) - 2 * margin_[2]};
  std::vector<std::uint8_t> marks(n[0] * n[1] * n[2], 0);
  Index cell{};
  const auto corner = [&](std::uint32_t c) {
    return Index{cell[0] + (c & 1u), cell[1] + (c >> 1 & 1u), cell[2] + (c >> 2)};
  };
  for (cell[2] = 0; cell[2] + 1 < points(2); ++cell[2]) {
    for (cell[1] = 0; cell[1] + 1 < points(1); ++cell[1]) {
      for (cell[0] = 0; cell[0] + 1 < points(0); ++cell[0]) {
        const std::uint16_t first = owner_[point_index(cell)];
        bool several = false;
        for (std::uint32_t c = 1; c < 8 && !several; ++c) several = owner_[point_index(corner(c))] != first;
        for (std::uint32_t c = 0; c < 8 && several; ++c) {
          const Index p = corner(c);
          if (!is_on_border(p))
            marks[p[0] - margin_[0] + n[0] * (p[1] - margin_[1] + n[1] * (p[2] - margin_[2]))] = 1;
        }
      }
    }
  }
  return marks;
}

void MaterialLattice::ownership(const std::array<Index, 4>& corners, OwnershipProblem& problem) const {
  problem.clear();
  const std::array<std::span<const Entry>, 4> entries{at(corners[0]), at(corners[1]), at(corners[2]),
                                                      at(corners[3])};
  // Materials are in the order of names, independent of the order of corners.
  thread_local std::vector<std::uint16_t> near;
  near.clear();
  for (const std::span<const Entry>& own : entries) {
    for (const Entry& entry : own) near.push_back(entry.material);
  }
  sort_unique(near);
  for (const std::uint16_t m : near) {
    problem.add_candidate(m);
    const auto at_corner = [&](std::size_t c) {
      // A point without values belongs to its only material and to each of its regions.
      const bool sole = entries[c].empty() && owner_[point_index(corners[c])] == whole_[m];
      return sole ? -far_ : value(entries[c], m);
    };
    problem.add_function({at_corner(0), at_corner(1), at_corner(2), at_corner(3)}, m);
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
