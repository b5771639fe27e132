#include "interfaces/reconstruction/border_continuation.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "interfaces/reconstruction/normal_distribution.h"
#include "interfaces/reconstruction/walls.h"

namespace adamas::interfaces {

namespace {

/// Fractions between the first and what it leaves of 1 tell how a step runs towards a side.
constexpr double kTelling = 0.02;
/// Slopes at the side are to be so near to those within, between what a mirror image leaves of them and all.
constexpr double kNearOne = 0.9;
/// Steps that run along a side nearly, whose distance changes by more than this across it, tell nothing of
/// it.
constexpr double kMostSlope = 0.8;
/// A mirror image bends a step nearer to the side than so many widths.
constexpr double kBends = 2;

/// The sites from one at a side of the grid inwards along an axis.
struct WayInwards {
  const RectilinearGrid& grid;
  std::size_t axis, first;  ///< the site's number along the axis: 0, or the last one
  std::size_t site, stride;

  [[nodiscard]] std::size_t side() const { return 2 * axis + (first == 0 ? 0 : 1); }
  [[nodiscard]] std::size_t at(std::size_t steps) const {
    return first == 0 ? site + steps * stride : site - steps * stride;
  }
  [[nodiscard]] double coordinate(std::size_t steps) const {
    return grid.site_coordinate(static_cast<int>(axis), first == 0 ? steps : first - steps);
  }
  [[nodiscard]] double gap(std::size_t steps) const {
    return std::abs(coordinate(steps + 1) - coordinate(steps));
  }
};

/// By how much the slope at a side of a step of some width is nearer to that within than one that is mirrored
/// has to be, in squares of slopes; 0 where nothing tells.
double runs_on(const SiteValues& values, const WayInwards& way, const SiteArray<float>& fractions,
               double width) {
  const double gap = way.gap(0);
  const auto within = static_cast<std::size_t>(std::max(2.0, std::round(kBends * width / gap)));
  if (within + 1 >= way.grid.sites(static_cast<int>(way.axis))) return 0;
  std::array<double, 4> distances{};
  const std::array<std::size_t, 4> steps{0, 1, within, within + 1};
  for (std::size_t i = 0; i < 4; ++i) {
    const auto f = static_cast<double>(fractions[way.at(steps[i])]);
    if (f < kTelling || f > 1 - kTelling || has_wall(values, way.at(steps[i]))) return 0;
    distances[i] = width * normal_quantile(f);
  }
  const double outer = (distances[1] - distances[0]) / gap,
               inner = (distances[3] - distances[2]) / way.gap(within);
  if (std::abs(inner) > kMostSlope) return 0;
  const double mirrored = std::erf(gap / (std::numbers::sqrt2 * width));
  return (outer - (kNearOne + (1 - kNearOne) * mirrored) * inner) * inner;
}

}  // namespace

GridSides sides_that_run_on(const MultiMaterialData& data, const SiteValues& values) {
  const std::array<std::size_t, 3> n{data.grid.sites(0), data.grid.sites(1), data.grid.sites(2)},
      stride{1, n[0], n[0] * n[1]};
  std::array<double, 6> sums{};
  for (const std::uint32_t site : values.mixed()) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::size_t at = site / stride[axis] % n[axis];
      if (n[axis] < 2 || (at != 0 && at + 1 != n[axis])) continue;
      const WayInwards way{data.grid, axis, at, site, stride[axis]};
      for (const SiteValues::Entry& entry : values.at(site)) {
        if (entry.width > 0)
          sums[way.side()] +=
              runs_on(values, way, data.fractions[values.material(entry.material)], values.width(entry));
      }
    }
  }
  GridSides sides{};
  for (std::size_t side = 0; side < 6; ++side) sides[side] = sums[side] > 0;
  return sides;
}

/// The sites of the box and those beyond it, as the points of a grid.
RectilinearGrid ContinuedBox::extended(const RectilinearGrid& grid, const SiteBox& box,
                                       std::array<std::array<std::size_t, 2>, 3>& cells,
                                       const GridSides& sides, double reach) {
  RectilinearGrid wider;
  wider.centering = Centering::kPoints;
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    const std::size_t n = box.sites(axis), low = box.low(axis);
    const auto site = [&](std::size_t i) { return grid.site_coordinate(axis, low + i); };
    std::array<double, 2> gaps{};
    if (n > 1) gaps = {site(1) - site(0), site(n - 1) - site(n - 2)};
    const std::array<bool, 2> at_side{low == 0, low + n == grid.sites(axis)};
    for (std::size_t end = 0; end < 2; ++end) {
      if (sides[2 * a + end] && at_side[end] && n > 1)
        cells[a][end] = static_cast<std::size_t>(std::ceil(reach / gaps[end])) + 1;
    }
    auto& nodes = wider.nodes[a];
    for (std::size_t k = cells[a][0]; k > 0; --k) nodes.push_back(site(0) - static_cast<double>(k) * gaps[0]);
    for (std::size_t i = 0; i < n; ++i) nodes.push_back(site(i));
    for (std::size_t k = 1; k <= cells[a][1]; ++k)
      nodes.push_back(site(n - 1) + static_cast<double>(k) * gaps[1]);
  }
  return wider;
}

ContinuedBox::ContinuedBox(const RectilinearGrid& grid, const SiteBox& box, const GridSides& sides,
                           double reach)
    : inner_(box),
      grid_(extended(grid, box, cells_, sides, reach)),
      box_(grid_, {0, 0, 0}, {grid_.sites(0), grid_.sites(1), grid_.sites(2)}) {}

std::size_t ContinuedBox::place(std::size_t inner) const {
  const std::size_t nx = inner_.sites(0), ny = inner_.sites(1);
  return inner % nx + cells_[0][0] +
         box_.sites(0) *
             (inner / nx % ny + cells_[1][0] + box_.sites(1) * (inner / (nx * ny) + cells_[2][0]));
}

template <class Next>
void ContinuedBox::run_on(std::vector<float>& values, const Next& next) const {
  const std::array<std::size_t, 3> n{box_.sites(0), box_.sites(1), box_.sites(2)},
      stride{1, n[0], n[0] * n[1]};
  // What an axis leaves wrong beyond the sides of later ones these replace.
  for (std::size_t a = 0; a < 3; ++a) {
    const std::size_t within = inner_.sites(static_cast<int>(a));
    for (std::size_t side = 0; side < 2; ++side) {
      if (cells_[a][side] == 0) continue;
      const std::size_t nearest = side == 0 ? cells_[a][0] : n[a] - 1 - cells_[a][1];
      const auto inwards = static_cast<std::ptrdiff_t>(stride[a]) * (side == 0 ? 1 : -1);
      const std::size_t u = a == 0 ? 1 : 0, v = a == 2 ? 1 : 2;
      for (std::size_t j = 0; j < n[v]; ++j) {
        for (std::size_t i = 0; i < n[u]; ++i) {
          float* const at = values.data() + nearest * stride[a] + i * stride[u] + j * stride[v];
          const auto line = [&](std::size_t steps) {
            return at[inwards * static_cast<std::ptrdiff_t>(std::min(steps, within - 1))];
          };
          for (std::size_t k = 1; k <= cells_[a][side]; ++k)
            at[-inwards * static_cast<std::ptrdiff_t>(k)] = next(a, side, line, k);
        }
      }
    }
  }
}

std::vector<float> ContinuedBox::beyond_mirrored(const std::vector<float>& volumes,
                                                 const std::vector<float>& distances) const {
  std::vector<float> mirrored(box_.size(), 0), beyond(box_.size(), 0);
  std::vector<char> is_within(box_.size(), 0);
  for (std::size_t p = 0; p < inner_.size(); ++p) {
    const std::size_t at = place(p);
    mirrored[at] = volumes[p];
    beyond[at] = distances[p];
    is_within[at] = 1;
  }
  run_on(mirrored, [](std::size_t, std::size_t, const auto& line, std::size_t k) { return line(k - 1); });
  // A distance changes by no more than the way does.
  run_on(beyond, [&](std::size_t a, std::size_t side, const auto& line, std::size_t k) {
    const auto& x = grid_.nodes[a];
    const auto gap = static_cast<float>(side == 0 ? x[1] - x[0] : x.back() - x[x.size() - 2]);
    return line(0) + static_cast<float>(k) * std::clamp(line(0) - line(1), -gap, gap);
  });
  const double own = kUniformDeviation * grid_.least_spacing();
  parallel_for(beyond.size(), 1 << 14, [&](std::size_t p) {
    const double volume = normal_probability(static_cast<double>(beyond[p]) / own);
    beyond[p] = is_within[p] != 0 ? 0.0f : static_cast<float>(volume) - mirrored[p];
  });
  return beyond;
}

}  // namespace adamas::interfaces
