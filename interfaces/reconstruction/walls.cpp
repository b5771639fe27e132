#include "interfaces/reconstruction/walls.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/parallel.h"
#include "core/base/sort_unique.h"
#include "interfaces/reconstruction/grid_sites.h"
#include "interfaces/reconstruction/site_values.h"
#include "interfaces/reconstruction/thin_sheets.h"

namespace adamas::interfaces {

namespace {

using Entry = SiteValues::Entry;

/// The least sharp part of a wall's steps within kReach sites, and at the site and its neighbours; and the
/// greatest sharp parts of the steps of two materials before the wall.
constexpr double kOfSharp = 0.95, kOfSharpAtOnce = 0.5, kOfBlurred = 0.7, kSurelyBlurred = 0.3;
/// The reach of these, in sites along each axis.
constexpr std::size_t kReach = 4;
/// Values are continued into walls from sites within kContinued along each axis, if there are kLeastCount;
/// kSteady damps slopes of which little is known.
constexpr std::size_t kContinued = 2;
constexpr int kLeastCount = 6;
constexpr double kSteady = 1e-3;
/// The least part of a mixed cell that walls leave.
constexpr double kLeastPart = 1e-6;

/// Returns the part of a material's steps round a site that are sharp.
double sharp_round(const SiteValues& values, const GridSites& sites, std::size_t site, std::uint16_t material,
                   std::size_t reach) {
  int sharp = 0, count = 0;
  sites.for_each_within(site, reach, [&](std::size_t other, int, int, int) {
    const Entry* there = find_entry(values.at(other), material);
    if (there == nullptr || there->is_pure()) return;
    ++count;
    sharp += there->width == 0 ? 1 : 0;
  });
  return count > 0 ? static_cast<double>(sharp) / count : 1;
}

/// Returns whether a material that is absent from a site fills a neighbour, so that its boundary is the face
/// between cells.
bool fills_a_neighbour(const SiteValues& values, const GridSites& sites, std::size_t site,
                       const Entry& entry) {
  return entry.fraction <= 0 && sites.any_neighbour(site, [&](std::size_t other) {
    const Entry* there = find_entry(values.at(other), entry.material);
    return there != nullptr && there->fraction >= 1;
  });
}

enum : char { kNoWall, kPerhaps, kSurely };

/// Marks the entries of walls at a blurred site: kSurely if two other materials have blurred steps there,
/// kPerhaps if the step of one of them ends there.
void find_walls_at(const SiteValues& values, const GridSites& sites, std::size_t site,
                   std::vector<char>& found) {
  const std::span<const Entry> own = values.at(site);
  const auto may_be_wall = [&](const Entry& entry) {
    return (!entry.is_pure() || fills_a_neighbour(values, sites, site, entry)) &&
           sharp_round(values, sites, site, entry.material, 1) >= kOfSharpAtOnce;
  };
  if (own.size() < 3 || std::ranges::none_of(own, may_be_wall)) return;
  // At least two materials are before a wall, and the step between them is blurred.
  std::vector<double> sharp;
  for (const Entry& entry : own) sharp.push_back(sharp_round(values, sites, site, entry.material, kReach));
  const auto count = [&](double most) {
    return std::ranges::count_if(sharp, [&](double part) { return part <= most; });
  };
  if (count(kOfBlurred) < 2 || count(kSurelyBlurred) < 1) return;
  const char kind = count(kSurelyBlurred) < 2 ? kPerhaps : kSurely;
  for (std::size_t e = 0; e < own.size(); ++e) {
    if (sharp[e] >= kOfSharp && may_be_wall(own[e])) found[values.index(own[e])] = kind;
  }
}

/// Keeps entries that are perhaps walls only if they are connected, through neighbours, with sure ones;
/// returns whether there are any.
bool keep_connected(const SiteValues& values, const GridSites& sites, std::vector<char>& found) {
  std::vector<std::pair<std::size_t, std::uint16_t>> reached;
  for (const std::uint32_t site : values.mixed_sites()) {
    for (const Entry& entry : values.at(site)) {
      if (found[values.index(entry)] == kSurely) reached.emplace_back(site, entry.material);
    }
  }
  if (reached.empty()) return false;
  for (std::size_t next = 0; next < reached.size(); ++next) {
    const std::uint16_t material = reached[next].second;
    sites.for_each_neighbour(reached[next].first, [&](std::size_t other, int, int, int) {
      const Entry* there = find_entry(values.at(other), material);
      if (there == nullptr || found[values.index(*there)] != kPerhaps) return;
      found[values.index(*there)] = kSurely;
      reached.emplace_back(other, material);
    });
  }
  std::ranges::replace(found, char{kPerhaps}, char{kNoWall});
  return true;
}

}  // namespace

void find_walls(const RectilinearGrid& grid, const ThinSheets& sheets, const std::vector<char>& is_blurred,
                SiteValues& values) {
  const GridSites sites(grid);
  std::vector<char> found(values.entries().size(), 0);
  parallel_for(values.mixed_sites().size(), 256, [&](std::size_t n) {
    const std::size_t site = values.mixed_sites()[n];
    if (is_blurred[site] != 0) find_walls_at(std::as_const(values), sites, site, found);
  });
  for (const SheetPlace& place : sheets.places) {
    for (const Entry& entry : std::as_const(values).at(place.site)) found[values.index(entry)] = kNoWall;
  }
  if (!keep_connected(std::as_const(values), sites, found)) return;
  // Entries beside walls that cut their cells are marked where the wall's material is absent or alone;
  // entries beside other walls where it is alone.
  std::vector<std::uint32_t> at_walls;
  std::vector<std::size_t> beside;
  for (const std::uint32_t site : values.mixed_sites()) {
    for (const Entry& entry : std::as_const(values).at(site)) {
      if (found[values.index(entry)] == kNoWall) continue;
      at_walls.push_back(site);
      sites.for_each_neighbour(site, [&](std::size_t other, int, int, int) {
        const Entry* there = find_entry(std::as_const(values).at(other), entry.material);
        if (there == nullptr || !there->is_pure() || (entry.is_pure() && there->fraction < 1)) return;
        at_walls.push_back(static_cast<std::uint32_t>(other));
        beside.push_back(values.index(*there));
      });
    }
  }
  for (const std::size_t entry : beside) found[entry] = kSurely;
  for (const SheetPlace& place : sheets.places) {
    for (const Entry& entry : std::as_const(values).at(place.site)) found[values.index(entry)] = kNoWall;
  }
  sort_unique(at_walls);
  values.set_walls(std::move(found), std::move(at_walls));
}

bool has_wall(const SiteValues& values, std::size_t site) {
  return std::ranges::any_of(values.at(site), [&](const Entry& entry) { return values.is_wall(entry); });
}

double part_before_walls(const SiteValues& values, std::size_t site) {
  double part = 1;
  for (const Entry& entry : values.at(site)) {
    if (values.is_wall(entry)) part -= static_cast<double>(entry.fraction);
  }
  return std::max(part, kLeastPart);
}

double fraction_before_walls(const SiteValues& values, std::size_t site, float fraction) {
  return std::min(static_cast<double>(fraction) / part_before_walls(values, site), 1 - kLeastPart);
}

namespace {

/// Returns whether walls own the centre of a cell.
bool is_behind_wall(const SiteValues& values, std::size_t site) {
  return part_before_walls(values, site) < 0.5;
}

/// Returns the greatest value of the materials at a site that are no walls; SiteValues::far_value() if all
/// are walls.
double greatest_before_walls(const SiteValues& values, std::size_t site) {
  double greatest = values.far_value();
  for (const Entry& entry : values.at(site)) {
    if (!values.is_wall(entry)) greatest = std::max(greatest, entry.value);
  }
  return greatest;
}

/// Returns the value of a material at a site on the plane fitted to the values at sites round it whose cells
/// are mostly free of walls; `value` if there are too few of these.
double continued_value(const SiteValues& values, const GridSites& sites, std::size_t site,
                       std::uint16_t material, double value) {
  Eigen::Matrix4d sums = Eigen::Matrix4d::Zero();
  Eigen::Vector4d right = Eigen::Vector4d::Zero();
  const Vec3 centre = sites.position(site), size = sites.cell(site).size();
  int count = 0;
  sites.for_each_within(site, kContinued, [&](std::size_t other, int, int, int) {
    const Entry* there = find_entry(values.at(other), material);
    if (there == nullptr || there->width == 0 || is_behind_wall(values, other)) return;
    const Vec3 way = sites.position(other) - centre;
    const Eigen::Vector4d terms(1, way.x / size.x, way.y / size.y, way.z / size.z);
    const double w = std::exp(-0.5 * (terms.squaredNorm() - 1));
    sums += w * terms * terms.transpose();
    right += w * there->value * terms;
    ++count;
  });
  if (count < kLeastCount) return value;
  sums.diagonal().tail<3>().array() += kSteady * sums(0, 0);
  const double found = sums.ldlt().solve(right)[0];
  return std::isfinite(found) ? std::clamp(found, -values.greatest_value(), values.greatest_value()) : value;
}

}  // namespace

void set_values_at_walls(const RectilinearGrid& grid, SiteValues& values) {
  if (values.wall_sites().empty()) return;
  const GridSites sites(grid);
  std::vector<double> continued(values.entries().size());
  parallel_for(values.wall_sites().size(), 64, [&](std::size_t n) {
    const std::size_t site = values.wall_sites()[n];
    const std::span<const Entry> own = std::as_const(values).at(site);
    for (const Entry& entry : own) {
      continued[values.index(entry)] =
          !values.is_wall(entry) && is_behind_wall(values, site)
              ? continued_value(std::as_const(values), sites, site, entry.material, entry.value)
              : entry.value;
    }
  });
  for (const std::uint32_t site : values.wall_sites()) {
    const std::span<Entry> own = values.at(site);
    for (Entry& entry : own) entry.value = continued[values.index(entry)];
    const double before = greatest_before_walls(values, site);
    if (before == values.far_value()) continue;
    for (Entry& entry : own) {
      if (values.is_wall(entry)) entry.value = before + 2 * entry.value;
    }
  }
}

void set_distances_at_walls(SiteValues& values) {
  for (const std::uint32_t site : values.wall_sites()) {
    const std::span<Entry> own = values.at(site);
    const double before = greatest_before_walls(values, site);
    if (before == values.far_value()) continue;
    for (Entry& entry : own) {
      if (values.is_wall(entry)) entry.value = 0.5 * (entry.value - before);
    }
  }
}

}  // namespace adamas::interfaces
