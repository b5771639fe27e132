#include "interfaces/reconstruction/site_cell.h"

#include <algorithm>
#include <cmath>

#include "core/geometry/vec3.h"
#include "interfaces/reconstruction/material_lattice.h"

namespace adamas {

namespace {

using Tetrahedron4 = std::array<Vec3, 4>;

/// Beyond so many different cells none is kept.
constexpr std::size_t kMostCells = 4096;

/// Numbers that differ by round-off only become the same.
double rounded(double x) {
  constexpr double kSteps = 0x1p36;
  return std::round(x * kSteps) / kSteps;
}

/// Replaces tetrahedra by those that fill their parts where sign * x[axis] <= sign * wall.
void clip(std::vector<Tetrahedron4>& all, int axis, double wall, double sign,
          std::vector<Tetrahedron4>& scratch) {
  scratch.clear();
  for (const Tetrahedron4& t : all) {
    std::array<double, 4> d{};
    std::array<std::size_t, 4> order{0, 1, 2, 3};
    for (std::size_t i = 0; i < 4; ++i) d[i] = sign * (wall - t[i][axis]);
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return d[a] > d[b]; });
    const auto inside =
        static_cast<std::size_t>(std::count_if(d.begin(), d.end(), [](double x) { return x > 0; }));
    const bool whole = d[order[3]] >= 0;
    if (whole && inside > 0) scratch.push_back(t);
    if (whole || inside == 0) continue;
    const auto corner = [&](std::size_t i) { return t[order[i]]; };
    const auto cut = [&](std::size_t i, std::size_t j) {
      const double a = d[order[i]], b = d[order[j]];
      if (b == 0) return corner(j);
      Vec3 p = corner(i) + (a / (a - b)) * (corner(j) - corner(i));
      p[axis] = wall;
      return p;
    };
    if (inside == 1) {
      scratch.push_back({corner(0), cut(0, 1), cut(0, 2), cut(0, 3)});
    } else if (inside == 2) {
      scratch.push_back({corner(0), corner(1), cut(1, 2), cut(1, 3)});
      scratch.push_back({corner(0), cut(0, 2), cut(0, 3), cut(1, 3)});
      scratch.push_back({corner(0), cut(0, 2), cut(1, 2), cut(1, 3)});
    } else {
      scratch.push_back({corner(0), corner(1), corner(2), cut(2, 3)});
      scratch.push_back({corner(0), corner(1), cut(1, 3), cut(2, 3)});
      scratch.push_back({corner(0), cut(0, 3), cut(1, 3), cut(2, 3)});
    }
  }
  all.swap(scratch);
}

}  // namespace

SiteCells::Shape SiteCells::shape_at(const RectilinearGrid& grid, int axis, std::size_t i) {
  const std::size_t n = grid.sites(axis);
  const double x = grid.site_coordinate(axis, i);
  const auto& nodes = grid.nodes[static_cast<std::size_t>(axis)];
  const bool cells = grid.centering == Centering::kCells;
  // The ends of the cell, and the lattice points before and behind.
  const double before = i > 0 ? grid.site_coordinate(axis, i - 1) : nodes.front();
  const double behind = i + 1 < n ? grid.site_coordinate(axis, i + 1) : nodes.back();
  const double low = cells ? nodes[i] : 0.5 * (before + x), high = cells ? nodes[i + 1] : 0.5 * (x + behind);
  const double width = high - low;
  const auto side = [&](double end, double point) {
    const double interval = std::abs(point - x);
    return Side{interval > 0 ? rounded(std::abs(end - x) / interval) : 0, rounded(interval / width)};
  };
  return {side(low, before), side(high, behind)};
}

SiteCells::SiteCells(const RectilinearGrid& grid) {
  std::size_t combinations = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    std::map<Shape, std::uint32_t> numbers;
    for (std::size_t i = 0; i < grid.sites(axis); ++i) {
      const Shape shape = shape_at(grid, axis, i);
      const auto [at, fresh] = numbers.try_emplace(shape, static_cast<std::uint32_t>(shapes_[a].size()));
      if (fresh) shapes_[a].push_back(shape);
      shape_of_[a].push_back(at->second);
    }
    combinations *= shapes_[a].size();
  }
  if (combinations > kMostCells) return;
  cells_.resize(combinations);
  std::size_t next = 0;
  for (const Shape& z : shapes_[2]) {
    for (const Shape& y : shapes_[1]) {
      for (const Shape& x : shapes_[0]) make({x, y, z}, cells_[next++]);
    }
  }
}

const SiteCell& SiteCells::at(std::size_t i, std::size_t j, std::size_t k, SiteCell& scratch) const {
  const std::size_t x = shape_of_[0][i], y = shape_of_[1][j], z = shape_of_[2][k];
  if (!cells_.empty()) return cells_[x + shapes_[0].size() * (y + shapes_[1].size() * z)];
  make({shapes_[0][x], shapes_[1][y], shapes_[2][z]}, scratch);
  return scratch;
}

void SiteCells::make(const std::array<Shape, 3>& shapes, SiteCell& cell) {
  cell.nodes.clear();
  cell.parts.clear();
  std::map<std::array<double, 3>, std::uint16_t> numbers;
  std::vector<Tetrahedron4> pieces, scratch;
  for (unsigned octant = 0; octant < 8; ++octant) {
    // Coordinates run from 0 to 1 in the lattice cell, whose lowest corner is the neighbour `first`.
    std::array<Side, 3> sides;
    std::array<int, 3> first{};
    double measure = 1;
    for (std::size_t a = 0; a < 3; ++a) {
      const unsigned high = octant >> a & 1u;
      sides[a] = shapes[a][high];
      first[a] = high != 0 ? 0 : -1;
      measure *= sides[a].reach > 0 ? sides[a].length : 0;
    }
    if (measure == 0) continue;
    for (const auto& path : MaterialLattice::kPaths) {
      Tetrahedron4 whole{};
      for (std::size_t step = 0; step < 3; ++step) {
        for (std::size_t c = step + 1; c < 4; ++c) whole[c][path[step]] = 1;
      }
      pieces.assign(1, whole);
      for (int axis = 0; axis < 3; ++axis) {
        const auto a = static_cast<std::size_t>(axis);
        const double reach = sides[a].reach;
        if (reach >= 1) continue;
        if (first[a] == 0) {
          clip(pieces, axis, reach, 1, scratch);
        } else {
          clip(pieces, axis, 1 - reach, -1, scratch);
        }
      }
      for (const Tetrahedron4& piece : pieces) {
        SiteCell::Part part{};
        part.volume = measure * std::abs(signed_volume(piece[0], piece[1], piece[2], piece[3]));
        if (part.volume == 0) continue;
        for (std::size_t c = 0; c < 4; ++c) {
          const Vec3& p = piece[c];
          const std::array<double, 3> place{p.x + first[0], p.y + first[1], p.z + first[2]};
          const auto [at, fresh] = numbers.try_emplace(place, static_cast<std::uint16_t>(cell.nodes.size()));
          if (fresh) {
            // Down the path the weights are the steps between coordinates.
            SiteCell::Node node{};
            std::array<int, 3> corner = first;
            double before = 1;
            for (std::size_t step = 0; step < 4; ++step) {
              const double x = step < 3 ? p[path[step]] : 0;
              node.points[step] =
                  static_cast<std::uint8_t>(corner[0] + 1 + 3 * (corner[1] + 1) + 9 * (corner[2] + 1));
              node.weights[step] = before - x;
              before = x;
              if (step < 3) ++corner[static_cast<std::size_t>(path[step])];
            }
            cell.nodes.push_back(node);
          }
          part.nodes[c] = at->second;
        }
        cell.parts.push_back(part);
      }
    }
  }
}

}  // namespace adamas
