#include "interfaces/reconstruction/site_cell.h"

#include <cmath>
#include <map>

#include "core/geometry/convex_polyhedron.h"
#include "core/geometry/divider.h"
#include "interfaces/reconstruction/material_lattice.h"

namespace adamas::interfaces {

namespace {

/// The greatest number of different cells that are kept.
constexpr std::size_t kMostCells = 4096;

/// Rounds a number so that numbers that differ by round-off only become equal.
double rounded(double x) {
  constexpr double kSteps = 0x1p36;
  return std::round(x * kSteps) / kSteps;
}

/// Parts with less than this volume, relative to the cell's, are round-off.
constexpr double kLeastVolume = 1e-13;

/// Keeps the part of the polyhedron where a linear function with these values at the tetrahedron's corners is
/// positive; returns false if nothing is left.
bool keep_positive(const std::array<double, 4>& values, ConvexPolyhedron& polyhedron) {
  const std::vector<Weights>& corners = polyhedron.corners();
  std::vector<double> d(corners.size());
  std::vector<char> positive(corners.size());
  std::size_t above = 0, below = 0;
  for (std::size_t c = 0; c < corners.size(); ++c) {
    d[c] = rounded(evaluate(values, corners[c]));
    positive[c] = d[c] > 0 ? 1 : 0;
    above += d[c] > 0 ? 1 : 0;
    below += d[c] < 0 ? 1 : 0;
  }
  if (above == 0 || below == 0) return above > 0;
  ConvexPolyhedron kept, rest;
  polyhedron.cut(d, positive, kept, rest);
  polyhedron = kept;
  return true;
}

}  // namespace

SiteCells::Shape SiteCells::shape_at(const RectilinearGrid& grid, int axis, std::size_t i) {
  const std::size_t n = grid.sites(axis);
  const double x = grid.site_coordinate(axis, i);
  const auto& nodes = grid.nodes[static_cast<std::size_t>(axis)];
  const bool cells = grid.centering == Centering::kCells;
  // These are the lattice points before and behind the site, and the ends of its cell.
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
      ConvexPolyhedron inside = ConvexPolyhedron::unit();
      bool empty = false;
      for (std::size_t step = 0; step < 3 && !empty; ++step) {
        const auto a = static_cast<std::size_t>(path[step]);
        const double reach = sides[a].reach;
        // Along this axis, the corners up to the step's corner are at 0 and the others at 1.
        Weights distances{};
        for (std::size_t c = 0; c < 4; ++c) {
          const double x = c > step ? 1 : 0;
          distances[c] = first[a] == 0 ? reach - x : x - (1 - reach);
        }
        if (reach < 1) empty = !keep_positive(distances, inside);
      }
      if (empty) continue;
      inside.for_each_tetrahedron([&](const std::array<Weights, 4>& corners) {
        SiteCell::Part part{{}, measure / 6 * std::abs(volume_fraction(corners))};
        if (part.volume < kLeastVolume) return;
        for (std::size_t c = 0; c < 4; ++c) {
          SiteCell::Node node{};
          std::array<int, 3> corner = first;
          std::array<double, 3> place{};
          for (std::size_t step = 0; step < 4; ++step) {
            node.points[step] =
                static_cast<std::uint8_t>(corner[0] + 1 + 3 * (corner[1] + 1) + 9 * (corner[2] + 1));
            node.weights[step] = corners[c][step];
            for (std::size_t a = 0; a < 3; ++a) place[a] += node.weights[step] * corner[a];
            if (step < 3) ++corner[static_cast<std::size_t>(path[step])];
          }
          for (double& x : place) x = rounded(x);
          const auto [at, fresh] = numbers.try_emplace(place, static_cast<std::uint16_t>(cell.nodes.size()));
          if (fresh) cell.nodes.push_back(node);
          part.nodes[c] = at->second;
        }
        cell.parts.push_back(part);
      });
    }
  }
  cell.volume = 0;
  for (const SiteCell::Part& part : cell.parts) cell.volume += part.volume;
}

}  // namespace adamas::interfaces
