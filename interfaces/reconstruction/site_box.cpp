#include "interfaces/reconstruction/site_box.h"

#include <algorithm>
#include <limits>

#include "core/base/large_pages.h"
#include "core/base/simd.h"

namespace adamas::interfaces {

namespace {

/// The greatest variance of one step of diffusion, in squared distances of sites. With greater ones values of
/// neighbours would oscillate.
constexpr double kGreatestStep = 0.25;
/// The number of planes that are spread by one thread at a time.
constexpr std::size_t kPlanes = 16;

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

namespace {

/// Marks the places of a row of n places within `reach` places of a marked one.
void dilate_along(const std::uint8_t* marks, std::uint8_t* dilated, std::size_t n, std::size_t reach) {
  std::size_t done = 0;  // places below this are known
  for (std::size_t i = 0; i < n; ++i) {
    if (marks[i] == 0) continue;
    const std::size_t begin = std::max(done, i - std::min(i, reach)), end = std::min(n, i + reach + 1);
    for (; done < begin; ++done) dilated[done] = 0;
    for (; done < end; ++done) dilated[done] = 1;
  }
  for (; done < n; ++done) dilated[done] = 0;
}

}  // namespace

void SiteBox::dilate(std::vector<std::uint8_t>& marks, int reach) const {
  const auto r = static_cast<std::size_t>(reach);
  const std::size_t nx = n_[0], rows = n_[1] * n_[2];
  std::vector<std::uint8_t> next(size());
  parallel_for(rows, 64, [&](std::size_t row) {
    dilate_along(marks.data() + nx * row, next.data() + nx * row, nx, r);
  });
  marks.swap(next);
  for (std::size_t a = 1; a < 3; ++a) {
    const std::size_t stride = a == 1 ? 1 : n_[1];
    parallel_for(rows, 64, [&](std::size_t row) {
      const std::size_t at = row / stride % n_[a], first = row - stride * std::min(at, r),
                        last = row + stride * std::min(n_[a] - 1 - at, r);
      std::uint8_t* const to = next.data() + nx * row;
      std::fill(to, to + nx, std::uint8_t{0});
      for (std::size_t other = first; other <= last; other += stride) {
        const std::uint8_t* const from = marks.data() + nx * other;
        for (std::size_t i = 0; i < nx; ++i) to[i] = static_cast<std::uint8_t>(to[i] | from[i]);
      }
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

/// The shares of neighbours before and behind a site.
struct Share {
  float before, behind;
};

/// Spreads the values from `begin` to below `end` of a row of n values along the row.
void spread_along(const float* from, float* __restrict to, std::size_t begin, std::size_t end, std::size_t n,
                  const float* before, const float* behind) {
  const auto at = [&](std::size_t i, std::size_t low, std::size_t high) {
    to[i] = from[i] + before[i] * (from[low] - from[i]) + behind[i] * (from[high] - from[i]);
  };
  if (begin == 0) at(0, 0, n > 1 ? 1 : 0);
  const std::size_t first = std::max<std::size_t>(begin, 1), last = std::min(end, n - 1);
  with_wide_lanes([=](auto) {
    for (std::size_t i = first; i < last; ++i)
      to[i] = from[i] + before[i] * (from[i - 1] - from[i]) + behind[i] * (from[i + 1] - from[i]);
  });
  if (end == n && n > 1) at(n - 1, n - 2, n - 1);
}

/// Spreads the values from `begin` to below `end` of a row to and from the rows beside it.
void spread_across(const float* from, const float* low, const float* high, float* __restrict to,
                   std::size_t begin, std::size_t end, const Share& by) {
  with_wide_lanes([=](auto) {
    for (std::size_t i = begin; i < end; ++i)
      to[i] = from[i] + by.before * (low[i] - from[i]) + by.behind * (high[i] - from[i]);
  });
}

}  // namespace

void SiteBox::spread(const std::vector<float>& from, double variance, bool in_sites,
                     const DiffusionNeeds* needs, std::size_t steps, std::vector<float>& to) const {
  if (to.capacity() < size()) reserve_in_large_pages(to, size());
  to.resize(size());
  const std::size_t nx = n_[0], ny = n_[1], nz = n_[2], plane = nx * ny;
  const Shares x = shares(0, variance, in_sites), y = shares(1, variance, in_sites),
               z = shares(2, variance, in_sites);
  const auto for_each_range = [&](std::size_t row, std::size_t after, const auto& visit) {
    needs == nullptr ? visit(std::size_t{0}, nx) : needs->for_each_range(row, after, visit);
  };
  // Rows are spread along x just before they are needed along y, and planes just before they are needed along
  // z, while they are in the cache. A chunk of planes spreads the planes beside it as well.
  parallel_chunks(nz, kPlanes, [&](std::size_t begin, std::size_t end) {
    thread_local std::vector<float> rows, planes;
    rows.resize(3 * nx);
    planes.resize(3 * plane);
    const auto row = [&](std::size_t j) { return rows.data() + nx * (j % 3); };
    const auto spread_plane = [&](std::size_t k) {
      float* const spread = planes.data() + plane * (k % 3);
      const auto fill = [&](std::size_t j) {
        for_each_range(j + ny * k, steps, [&](std::size_t first, std::size_t last) {
          spread_along(from.data() + plane * k + nx * j, row(j), first, last, nx, x.before.data(),
                       x.behind.data());
        });
      };
      fill(0);
      for (std::size_t j = 0; j < ny; ++j) {
        if (j + 1 < ny) fill(j + 1);
        for_each_range(j + ny * k, steps, [&](std::size_t first, std::size_t last) {
          spread_across(row(j), row(j > 0 ? j - 1 : j), row(j + 1 < ny ? j + 1 : j), spread + nx * j, first,
                        last, {y.before[j], y.behind[j]});
        });
      }
    };
    for (std::size_t k = begin > 0 ? begin - 1 : begin; k <= begin; ++k) spread_plane(k);
    for (std::size_t k = begin; k < end; ++k) {
      if (k + 1 < nz) spread_plane(k + 1);
      const auto at = [&](std::size_t other, std::size_t j) {
        return planes.data() + plane * (other % 3) + nx * j;
      };
      for (std::size_t j = 0; j < ny; ++j) {
        for_each_range(j + ny * k, steps + 1, [&](std::size_t first, std::size_t last) {
          spread_across(at(k, j), at(k > 0 ? k - 1 : k, j), at(k + 1 < nz ? k + 1 : k, j),
                        to.data() + plane * k + nx * j, first, last, {z.before[k], z.behind[k]});
        });
      }
    }
  });
}

void SiteBox::blend(std::vector<float>& values, double variance, std::vector<float>& scratch) const {
  spread(values, variance, true, nullptr, 0, scratch);
  values.swap(scratch);
}

namespace {

/// Raises the numbers of a row to those of another one, at the same places and beside these, less 1.
void raise_to(const std::uint16_t* other, std::uint16_t* __restrict row, std::size_t n) {
  const auto raise = [&](std::size_t i, std::uint16_t by) {
    row[i] = std::max(row[i], static_cast<std::uint16_t>(by - (by > 0 ? 1 : 0)));
  };
  for (std::size_t i = 0; i < n; ++i) raise(i, other[i]);
  for (std::size_t i = 1; i < n; ++i) raise(i, other[i - 1]);
  for (std::size_t i = 0; i + 1 < n; ++i) raise(i, other[i + 1]);
}

/// Raises each number of a box to those round it less 1, those round these less 2, and so on, in two passes
/// (chessboard distances of Rosenfeld and Pfaltz, Distance functions on digital pictures, 1968).
void raise_round(std::vector<std::uint16_t>& numbers, const std::array<std::size_t, 3>& n) {
  const auto row = [&](std::size_t j, std::size_t k) { return numbers.data() + n[0] * (j + n[1] * k); };
  const auto raise_along = [&](std::uint16_t* at, std::ptrdiff_t step) {
    for (std::size_t i = 1; i < n[0]; ++i) {
      const std::uint16_t before = *at;
      at += step;
      if (before > 1) *at = std::max(*at, static_cast<std::uint16_t>(before - 1));
    }
  };
  for (std::size_t k = 0; k < n[2]; ++k) {
    for (std::size_t j = 0; j < n[1]; ++j) {
      if (j > 0) raise_to(row(j - 1, k), row(j, k), n[0]);
      if (k > 0) {
        for (std::size_t other = j > 0 ? j - 1 : j; other < std::min(j + 2, n[1]); ++other)
          raise_to(row(other, k - 1), row(j, k), n[0]);
      }
      raise_along(row(j, k), 1);
    }
  }
  for (std::size_t k = n[2]; k-- > 0;) {
    for (std::size_t j = n[1]; j-- > 0;) {
      if (j + 1 < n[1]) raise_to(row(j + 1, k), row(j, k), n[0]);
      if (k + 1 < n[2]) {
        for (std::size_t other = j > 0 ? j - 1 : j; other < std::min(j + 2, n[1]); ++other)
          raise_to(row(other, k + 1), row(j, k), n[0]);
      }
      raise_along(row(j, k) + n[0] - 1, -1);
    }
  }
}

}  // namespace

DiffusionNeeds::DiffusionNeeds(const std::array<std::size_t, 3>& n, const std::vector<Target>& targets)
    : row_(n[0]), blocks_((n[0] + kBlock - 1) / kBlock), steps_(blocks_ * n[1] * n[2], 0) {
  std::vector<std::uint16_t> needed(n[0] * n[1] * n[2], 0);
  for (const Target& target : targets)
    needed[target.place] = std::max(needed[target.place], static_cast<std::uint16_t>(target.last + 1));
  raise_round(needed, n);
  for (std::size_t place = 0; place < needed.size(); ++place) {
    std::uint16_t& most = steps_[place % n[0] / kBlock + blocks_ * (place / n[0])];
    most = std::max(most, needed[place]);
  }
}

}  // namespace adamas::interfaces
