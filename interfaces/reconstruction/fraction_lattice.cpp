#include "interfaces/reconstruction/fraction_lattice.h"

#include <algorithm>
#include <numeric>

#include "core/base/error.h"
#include "core/base/parallel.h"

namespace adamas {

namespace {

/// How a lattice point takes its value from sites along one axis: `low + weight (high - low)`.
struct Source {
  std::size_t low, high;
  double weight;
};

std::vector<Source> sources_along(const RectilinearGrid& grid, int axis,
                                  const std::vector<double>& coordinates, bool margin) {
  std::vector<Source> sources;
  const std::size_t n = grid.sites(axis);
  for (std::size_t i = 0; i < coordinates.size(); ++i) {
    const bool first = margin && i == 0, last = margin && i + 1 == coordinates.size();
    if ((first || last) && n > 1) {
      const std::size_t a = first ? 0 : n - 2;
      const double x0 = grid.site_coordinate(axis, a), x1 = grid.site_coordinate(axis, a + 1);
      sources.push_back({a, a + 1, (coordinates[i] - x0) / (x1 - x0)});
    } else {
      const std::size_t site = first ? 0 : last ? n - 1 : i - (margin ? 1 : 0);
      sources.push_back({site, site, 0});
    }
  }
  return sources;
}

}  // namespace

FractionLattice::FractionLattice(const MultiMaterialData& data) {
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
  std::vector<std::uint32_t> order(data.materials.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) {
    return data.materials[MaterialId(a)] < data.materials[MaterialId(b)];
  });
  rank_.resize(order.size());
  for (std::uint32_t r = 0; r < order.size(); ++r) rank_[MaterialId(order[r])] = r;
  extend(data);
}

void FractionLattice::extend(const MultiMaterialData& data) {
  std::array<std::vector<Source>, 3> sources;
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    sources[a] = sources_along(data.grid, axis, coordinates_[a], margin_[a] != 0);
  }
  const std::uint32_t nx = points(0), ny = points(1), nz = points(2);
  owner_.resize(point_count());
  if (!data.labels.empty()) {
    // The extrapolation of a one-hot vector, normalised, is the vector of the nearest site.
    const auto nearest = [](const Source& s) { return s.weight > 1 ? s.high : s.low; };
    parallel_for(nz, 1, [&](std::size_t k) {
      for (std::size_t j = 0; j < ny; ++j) {
        for (std::size_t i = 0; i < nx; ++i) {
          owner_[i + nx * (j + ny * k)] = data.labels[data.grid.site_index(
              nearest(sources[0][i]), nearest(sources[1][j]), nearest(sources[2][k]))];
        }
      }
    });
    of_labels_ = true;
    return;
  }
  fractions_.resize(data.materials.size());
  for (MaterialId m(0); m.value < data.materials.size(); ++m.value) {
    fractions_[m].resize(point_count());
    const auto& given = data.fractions[m];
    parallel_for(nz, 1, [&](std::size_t k) {
      for (std::size_t j = 0; j < ny; ++j) {
        for (std::size_t i = 0; i < nx; ++i) {
          const Source &x = sources[0][i], &y = sources[1][j], &z = sources[2][k];
          const auto at = [&](std::size_t sx, std::size_t sy, std::size_t sz) {
            return static_cast<double>(given[data.grid.site_index(sx, sy, sz)]);
          };
          const auto along_x = [&](std::size_t sy, std::size_t sz) {
            return x.weight == 0 ? at(x.low, sy, sz)
                                 : (1 - x.weight) * at(x.low, sy, sz) + x.weight * at(x.high, sy, sz);
          };
          const auto along_y = [&](std::size_t sz) {
            return y.weight == 0 ? along_x(y.low, sz)
                                 : (1 - y.weight) * along_x(y.low, sz) + y.weight * along_x(y.high, sz);
          };
          const double value =
              z.weight == 0 ? along_y(z.low) : (1 - z.weight) * along_y(z.low) + z.weight * along_y(z.high);
          fractions_[m][i + nx * (j + ny * k)] = static_cast<float>(std::max(0.0, value));
        }
      }
    });
  }
  normalise();
  find_owners();
}

void FractionLattice::normalise() {
  parallel_for(point_count(), 1 << 16, [&](std::size_t p) {
    double sum = 0;
    for (const auto& f : fractions_) sum += static_cast<double>(f[p]);
    if (sum == 1 || !(sum > 0)) return;
    for (auto& f : fractions_) f[p] = static_cast<float>(static_cast<double>(f[p]) / sum);
  });
}

void FractionLattice::find_owners() {
  pure_.resize(point_count());
  for (std::uint32_t p = 0; p < point_count(); ++p) {
    MaterialId best(0);
    for (MaterialId m(1); m.value < fractions_.size(); ++m.value) {
      const float difference = fractions_[m][p] - fractions_[best][p];
      if (difference > 0 || (difference == 0 && rank_[m] < rank_[best])) best = m;
    }
    owner_[p] = static_cast<std::uint16_t>(best.value);
    pure_[p] = fractions_[best][p] >= 1.0f;
  }
}

std::array<FractionLattice::Index, 4> FractionLattice::tetrahedron(const Index& cell,
                                                                   std::size_t path) const {
  std::array<Index, 4> corners{cell, cell, cell, cell};
  for (std::size_t step = 0; step < 3; ++step) {
    for (std::size_t c = step + 1; c < 4; ++c) ++corners[c][static_cast<std::size_t>(kPaths[path][step])];
  }
  return corners;
}

void FractionLattice::ownership(const std::array<std::uint32_t, 4>& corners,
                                OwnershipProblem& problem) const {
  problem.clear();
  const auto consider = [&](MaterialId m) {
    const std::array<double, 4> values{
        static_cast<double>(fraction(m, corners[0])), static_cast<double>(fraction(m, corners[1])),
        static_cast<double>(fraction(m, corners[2])), static_cast<double>(fraction(m, corners[3]))};
    if (std::all_of(values.begin(), values.end(), [](double v) { return v <= 0; })) return;
    problem.add_candidate(m.value);
    problem.add_function(values, rank_[m]);
  };
  if (!of_labels_) {
    for (MaterialId m(0); m.value < fractions_.size(); ++m.value) consider(m);
    return;
  }
  std::array<std::uint16_t, 4> labels{};
  for (std::size_t c = 0; c < 4; ++c) labels[c] = owner_[corners[c]];
  std::sort(labels.begin(), labels.end());
  for (std::size_t c = 0; c < 4; ++c) {
    if (c == 0 || labels[c] != labels[c - 1]) consider(MaterialId(labels[c]));
  }
}

FractionLattice::Location FractionLattice::locate(const Vec3& p) const {
  Location location{};
  std::array<double, 3> local{};
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    const auto& x = coordinates_[a];
    const double clamped = std::clamp(p[axis], x.front(), x.back());
    const auto above = std::upper_bound(x.begin() + 1, x.end() - 1, clamped);
    const auto i = static_cast<std::size_t>(above - x.begin()) - 1;
    location.cell[a] = static_cast<std::uint32_t>(i);
    local[a] = std::clamp((clamped - x[i]) / (x[i + 1] - x[i]), 0.0, 1.0);
  }
  for (location.path = 0; location.path < 6; ++location.path) {
    const auto& path = kPaths[location.path];
    const double a = local[static_cast<std::size_t>(path[0])], b = local[static_cast<std::size_t>(path[1])],
                 c = local[static_cast<std::size_t>(path[2])];
    if (a < b || b < c) continue;
    location.weights = {1 - a, a - b, b - c, c};
    break;
  }
  return location;
}

}  // namespace adamas
