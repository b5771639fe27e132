#include "interfaces/reconstruction/site_box.h"

#include <algorithm>
#include <limits>

namespace adamas::interfaces {

namespace {

/// The greatest variance of one step of diffusion, in squared distances of sites. With greater ones values of
/// neighbours would oscillate.
constexpr double kGreatestStep = 0.25;

}  // namespace

SiteBox::SiteBox(const RectilinearGrid& grid, const Index& low, const Index& high)
    : grid_(grid), sites_(grid), low_(low), n_{high[0] - low[0], high[1] - low[1], high[2] - low[2]} {
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    for (std::size_t i = low[a]; i + 1 < high[a]; ++i)
      gaps_[a].push_back(grid.site_coordinate(axis, i + 1) - grid.site_coordinate(axis, i));
  }
}

SiteBox SiteBox::round(const RectilinearGrid& grid, const std::vector<std::uint32_t>& sites,
                       std::size_t margin) {
  const GridSites grid_sites(grid);
  const Index n{grid.sites(0), grid.sites(1), grid.sites(2)};
  Index low = n, high{0, 0, 0};
  for (const std::size_t site : sites) {
    const Index p = grid_sites.indices(site);
    for (std::size_t a = 0; a < 3; ++a) {
      low[a] = std::min(low[a], p[a]);
      high[a] = std::max(high[a], p[a] + 1);
    }
  }
  for (std::size_t a = 0; a < 3; ++a) {
    low[a] -= std::min(low[a], margin);
    high[a] = std::min(high[a] + margin, n[a]);
  }
  return {grid, low, high};
}

bool SiteBox::contains(std::size_t site) const {
  const Index p = sites_.indices(site);
  for (std::size_t a = 0; a < 3; ++a) {
    if (p[a] < low_[a] || p[a] >= low_[a] + n_[a]) return false;
  }
  return true;
}

void SiteBox::dilate(std::vector<std::uint8_t>& marks, int reach) const {
  std::vector<std::uint8_t> next(size());
  const std::array<std::size_t, 3> stride{1, n_[0], n_[0] * n_[1]};
  for (std::size_t a = 0; a < 3; ++a) {
    std::fill(next.begin(), next.end(), std::uint8_t{0});
    for_each([&](std::size_t place, std::size_t) {
      const auto at = static_cast<std::int64_t>(place / stride[a] % n_[a]),
                 last = static_cast<std::int64_t>(n_[a]) - 1;
      const std::int64_t from = std::max<std::int64_t>(-reach, -at),
                         to = std::min<std::int64_t>(reach, last - at);
      for (std::int64_t d = from; d <= to && next[place] == 0; ++d)
        next[place] = marks[static_cast<std::size_t>(static_cast<std::int64_t>(place) +
                                                     d * static_cast<std::int64_t>(stride[a]))];
    });
    marks.swap(next);
  }
}

double SiteBox::greatest_step() const {
  double least = std::numeric_limits<double>::infinity();
  for (const auto& gaps : gaps_) {
    for (const double gap : gaps) least = std::min(least, gap);
  }
  return kGreatestStep * least * least;
}

void SiteBox::squared_gradient(const std::vector<float>& values, std::vector<float>& squared,
                               std::vector<float>& widened) const {
  squared.assign(size(), 0);
  widened.assign(size(), 0);
  const std::array<std::size_t, 3> stride{1, n_[0], n_[0] * n_[1]};
  parallel_for(n_[2], 1, [&](std::size_t k) {
    Index p{0, 0, k};
    std::size_t at = k * stride[2];
    for (p[1] = 0; p[1] < n_[1]; ++p[1]) {
      for (p[0] = 0; p[0] < n_[0]; ++p[0], ++at) {
        const SquaredGradient found = squared_gradient_at(p, [&](std::size_t axis, int d) {
          return d == 0 ? values[at] : d > 0 ? values[at + stride[axis]] : values[at - stride[axis]];
        });
        squared[at] = found.squared;
        widened[at] = found.widened;
      }
    }
  });
}

SiteBox::Shares SiteBox::shares(int axis, double variance, bool in_sites) const {
  const std::size_t n = sites(axis);
  const std::vector<double>& gaps = gaps_[static_cast<std::size_t>(axis)];
  Shares result{std::vector<float>(n, 0), std::vector<float>(n, 0)};
  for (std::size_t i = 0; i < n && n > 1; ++i) {
    // Values are mirrored beyond an end.
    const double before = in_sites ? 1 : gaps[i > 0 ? i - 1 : 0],
                 behind = in_sites ? 1 : gaps[i + 1 < n ? i : n - 2];
    const double both = variance / (before + behind);
    if (i > 0) result.before[i] = static_cast<float>(both / before);
    if (i + 1 < n) result.behind[i] = static_cast<float>(both / behind);
  }
  return result;
}

namespace {

/// Spreads a row of values along itself. `before`, `behind`: the shares of each site's neighbours.
void spread_along(const float* from, float* __restrict to, std::size_t n, const float* before,
                  const float* behind) {
  const auto at = [&](std::size_t i, std::size_t low, std::size_t high) {
    to[i] = from[i] + before[i] * (from[low] - from[i]) + behind[i] * (from[high] - from[i]);
  };
  at(0, 0, n > 1 ? 1 : 0);
  for (std::size_t i = 1; i + 1 < n; ++i) at(i, i - 1, i + 1);
  if (n > 1) at(n - 1, n - 2, n - 1);
}

/// Spreads a row of values to and from the rows beside it.
void spread_across(const float* from, const float* low, const float* high, float* __restrict to,
                   std::size_t n, float before, float behind) {
  for (std::size_t i = 0; i < n; ++i)
    to[i] = from[i] + before * (low[i] - from[i]) + behind * (high[i] - from[i]);
}

}  // namespace

void SiteBox::spread(const std::vector<float>& from, double variance, bool in_sites, std::vector<float>& to,
                     std::vector<float>& scratch) const {
  scratch.resize(size());
  to.resize(size());
  const std::size_t nx = n_[0], ny = n_[1], nz = n_[2], plane = nx * ny;
  const Shares x = shares(0, variance, in_sites), y = shares(1, variance, in_sites),
               z = shares(2, variance, in_sites);
  // Rows are spread along x just before they are needed along y, while they are in the cache.
  parallel_for(nz, 1, [&](std::size_t k) {
    thread_local std::vector<float> rows;
    rows.resize(3 * nx);
    const auto row = [&](std::size_t j) { return rows.data() + nx * (j % 3); };
    const auto fill = [&](std::size_t j) {
      spread_along(from.data() + plane * k + nx * j, row(j), nx, x.before.data(), x.behind.data());
    };
    fill(0);
    for (std::size_t j = 0; j < ny; ++j) {
      if (j + 1 < ny) fill(j + 1);
      spread_across(row(j), row(j > 0 ? j - 1 : j), row(j + 1 < ny ? j + 1 : j),
                    scratch.data() + plane * k + nx * j, nx, y.before[j], y.behind[j]);
    }
  });
  parallel_for(nz, 1, [&](std::size_t k) {
    const float* own = scratch.data() + plane * k;
    spread_across(own, k > 0 ? own - plane : own, k + 1 < nz ? own + plane : own, to.data() + plane * k,
                  plane, z.before[k], z.behind[k]);
  });
}

void SiteBox::diffuse(const std::vector<float>& from, double variance, std::vector<float>& to,
                      std::vector<float>& scratch) const {
  spread(from, variance, false, to, scratch);
}

void SiteBox::blend(std::vector<float>& values, double variance, std::vector<float>& scratch) const {
  spread(values, variance, true, values, scratch);
}

}  // namespace adamas::interfaces
