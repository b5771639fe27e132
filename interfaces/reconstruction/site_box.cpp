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
        float sum = 0, wide = 0;
        for (std::size_t a = 0; a < 3; ++a) {
          if (n_[a] < 2) continue;
          const bool first = p[a] == 0, last = p[a] + 1 == n_[a];
          const double before = first ? 0 : gaps_[a][p[a] - 1], behind = last ? 0 : gaps_[a][p[a]];
          const float g = (values[last ? at : at + stride[a]] - values[first ? at : at - stride[a]]) /
                          static_cast<float>(before + behind);
          const auto half = static_cast<float>(0.5 * (before + behind));
          sum += g * g;
          wide += g * g * g * g * half * half;
        }
        squared[at] = sum;
        widened[at] = sum > 0 ? wide / sum / sum : 0;
      }
    }
  });
}

std::vector<SiteBox::Share> SiteBox::shares(int axis, double variance, bool in_sites) const {
  const std::size_t n = sites(axis);
  const std::vector<double>& gaps = gaps_[static_cast<std::size_t>(axis)];
  std::vector<Share> result(n, {0, 0});
  for (std::size_t i = 0; i < n && n > 1; ++i) {
    // Values are mirrored beyond an end.
    const double before = in_sites ? 1 : gaps[i > 0 ? i - 1 : 0],
                 behind = in_sites ? 1 : gaps[i + 1 < n ? i : n - 2];
    const double both = variance / (before + behind);
    result[i] = {i > 0 ? static_cast<float>(both / before) : 0,
                 i + 1 < n ? static_cast<float>(both / behind) : 0};
  }
  return result;
}

void SiteBox::spread(std::vector<float>& values, double variance, bool in_sites,
                     std::vector<float>& scratch) const {
  scratch.resize(size());
  const std::size_t nx = n_[0], row = n_[0], plane = n_[0] * n_[1];
  for (int axis = 0; axis < 3; ++axis) {
    const std::vector<Share> by = shares(axis, variance, in_sites);
    parallel_for(n_[2], 1, [&](std::size_t k) {
      for (std::size_t j = 0; j < n_[1]; ++j) {
        const float* from = values.data() + row * j + plane * k;
        float* to = scratch.data() + row * j + plane * k;
        if (axis == 0) {
          for (std::size_t i = 0; i < nx; ++i)
            to[i] = from[i] + by[i].before * (from[i > 0 ? i - 1 : i] - from[i]) +
                    by[i].behind * (from[i + 1 < nx ? i + 1 : i] - from[i]);
        } else {
          const std::size_t at = axis == 1 ? j : k, stride = axis == 1 ? row : plane;
          const auto [before, behind] = by[at];
          const float* low = before > 0 ? from - stride : from;
          const float* high = behind > 0 ? from + stride : from;
          for (std::size_t i = 0; i < nx; ++i)
            to[i] = from[i] + before * (low[i] - from[i]) + behind * (high[i] - from[i]);
        }
      }
    });
    values.swap(scratch);
  }
}

void SiteBox::diffuse(std::vector<float>& values, double variance, std::vector<float>& scratch) const {
  spread(values, variance, false, scratch);
}

void SiteBox::blend(std::vector<float>& values, double variance, std::vector<float>& scratch) const {
  spread(values, variance, true, scratch);
}

}  // namespace adamas::interfaces
