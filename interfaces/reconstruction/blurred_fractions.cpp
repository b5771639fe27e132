#include "interfaces/reconstruction/blurred_fractions.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <set>
#include <utility>
#include <vector>

#include "core/base/large_pages.h"
#include "core/base/parallel.h"
#include "interfaces/reconstruction/cell_volumes.h"
#include "interfaces/reconstruction/grid_sites.h"
#include "interfaces/reconstruction/interface_planes.h"
#include "interfaces/reconstruction/normal_distribution.h"
#include "interfaces/reconstruction/site_values.h"
#include "interfaces/reconstruction/sole_owners.h"
#include "interfaces/reconstruction/walls.h"

namespace adamas::interfaces {

namespace {

/// Only fractions from this to 1 minus this show the slope of a step at a side.
constexpr double kLeastClear = 0.02;
/// The least slope at a side that counts as continued, on a scale from a mirrored step's (0) to that inside
/// (1).
constexpr double kNearOne = 0.9;
/// Steps whose distance changes by more than this across a side are nearly parallel to it and do not count.
constexpr double kMostSlope = 0.8;
/// A mirror image bends a step within this many widths of the side.
constexpr double kBends = 2;

/// The line of sites from one at a side of the grid inwards along an axis.
struct WayInwards {
  const RectilinearGrid& grid;
  std::size_t axis, first;  ///< the first site's index along the axis: 0 or the last
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

/// Returns a product of slopes that is positive if a step's slope at a side of the grid is closer to its
/// slope inside than a mirrored step's could be; 0 if the fractions do not show this.
double continuation_evidence(const SiteValues& values, const WayInwards& way,
                             const SiteArray<float>& fractions, double width) {
  const double gap = way.gap(0);
  const auto within = static_cast<std::size_t>(std::max(2.0, std::round(kBends * width / gap)));
  if (within + 1 >= way.grid.sites(static_cast<int>(way.axis))) return 0;
  std::array<double, 4> distances{};
  const std::array<std::size_t, 4> steps{0, 1, within, within + 1};
  for (std::size_t i = 0; i < 4; ++i) {
    const auto f = static_cast<double>(fractions[way.at(steps[i])]);
    if (f < kLeastClear || f > 1 - kLeastClear || has_wall(values, way.at(steps[i]))) return 0;
    distances[i] = width * normal_quantile(f);
  }
  const double outer = (distances[1] - distances[0]) / gap,
               inner = (distances[3] - distances[2]) / way.gap(within);
  if (std::abs(inner) > kMostSlope) return 0;
  const double mirrored = std::erf(gap / (std::numbers::sqrt2 * width));
  return (outer - (kNearOne + (1 - kNearOne) * mirrored) * inner) * inner;
}

}  // namespace

GridSides continued_sides(const MultiMaterialData& data, const SiteValues& values) {
  const std::array<std::size_t, 3> n{data.grid.sites(0), data.grid.sites(1), data.grid.sites(2)},
      stride{1, n[0], n[0] * n[1]};
  std::array<double, 6> sums{};
  for (const std::uint32_t site : values.mixed_sites()) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::size_t at = site / stride[axis] % n[axis];
      if (n[axis] < 2 || (at != 0 && at + 1 != n[axis])) continue;
      const WayInwards way{data.grid, axis, at, site, stride[axis]};
      for (const SiteValues::Entry& entry : values.at(site)) {
        if (entry.width > 0)
          sums[way.side()] += continuation_evidence(
              values, way, data.fractions[values.material(entry.material)], values.width(entry));
      }
    }
  }
  GridSides sides{};
  for (std::size_t side = 0; side < 6; ++side) sides[side] = sums[side] > 0;
  return sides;
}

/// Returns a grid whose points are the sites of the box and those beyond it; sets the numbers of the latter.
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
      box_(grid_, {0, 0, 0}, {grid_.sites(0), grid_.sites(1), grid_.sites(2)}),
      own_width_(kUniformDeviation * grid_.least_spacing()) {}

SiteBox ContinuedBox::near_sides(std::size_t depth) const {
  SiteBox::Index first{}, count{};
  int sides = 0;
  for (std::size_t a = 0; a < 3; ++a) {
    const std::size_t n = count[a] = inner_.sites(static_cast<int>(a));
    for (std::size_t end = 0; end < 2; ++end) {
      if (cells_[a][end] == 0) continue;
      ++sides;
      // What continues the fractions is taken from as many sites.
      count[a] = std::min(n, std::max({depth, cells_[a][end], std::size_t{2}}));
      first[a] = end == 0 ? 0 : n - count[a];
    }
  }
  return sides == 1 ? inner_.part(first, count) : inner_;
}

std::size_t ContinuedBox::place(std::size_t inner) const {
  const std::size_t nx = inner_.sites(0), ny = inner_.sites(1);
  return inner % nx + cells_[0][0] +
         box_.sites(0) *
             (inner / nx % ny + cells_[1][0] + box_.sites(1) * (inner / (nx * ny) + cells_[2][0]));
}

std::size_t ContinuedBox::sites_to_beyond(std::size_t inner) const {
  std::size_t least = std::numeric_limits<std::size_t>::max();
  for (std::size_t a = 0; a < 3; ++a) {
    const std::size_t n = inner_.sites(static_cast<int>(a)), at = inner % n;
    inner /= n;
    if (cells_[a][0] > 0) least = std::min(least, at + 1);
    if (cells_[a][1] > 0) least = std::min(least, n - at);
  }
  return least;
}

template <class Visit>
void ContinuedBox::for_each_near_side(const Visit& visit) const {
  const auto is_near = [&](std::size_t a, std::size_t at) {
    const std::size_t n = inner_.sites(static_cast<int>(a));
    const auto within = [&](std::size_t cells, std::size_t from) {
      return cells > 0 && from < std::max<std::size_t>(cells, 2);
    };
    return within(cells_[a][0], at) || within(cells_[a][1], n - 1 - at);
  };
  inner_.for_each_row([&](std::size_t place, std::size_t site, std::size_t count) {
    const std::size_t row = place / count, ny = inner_.sites(1);
    const bool all = is_near(1, row % ny) || is_near(2, row / ny);
    for (std::size_t i = 0; i < count; ++i) {
      if (all || is_near(0, i)) visit(place + i, site + i);
    }
  });
}

template <class Next>
void ContinuedBox::continue_beyond(std::vector<float>& values, const Next& next) const {
  const std::array<std::size_t, 3> n{box_.sites(0), box_.sites(1), box_.sites(2)},
      stride{1, n[0], n[0] * n[1]};
  // Values beyond the sides of later axes are replaced when these are continued.
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
  continue_beyond(mirrored,
                  [](std::size_t, std::size_t, const auto& line, std::size_t k) { return line(k - 1); });
  // A distance changes by no more than the way does.
  continue_beyond(beyond, [&](std::size_t a, std::size_t side, const auto& line, std::size_t k) {
    const auto& x = grid_.nodes[a];
    const auto gap = static_cast<float>(side == 0 ? x[1] - x[0] : x.back() - x[x.size() - 2]);
    return line(0) + static_cast<float>(k) * std::clamp(line(0) - line(1), -gap, gap);
  });
  parallel_for(beyond.size(), 1 << 14, [&](std::size_t p) {
    const bool is_beyond = is_within[p] == 0;
    beyond[p] = is_beyond
                    ? static_cast<float>(normal_probability(static_cast<double>(beyond[p]) / own_width_)) -
                          mirrored[p]
                    : 0.0f;
  });
  return beyond;
}

namespace {

using Entry = SiteValues::Entry;

/// Fractions are spread over at most this many widths.
constexpr double kReach = 3;
/// Distances computed from fractions are limited to this many widths.
constexpr double kFarthest = 3;
/// Spread walls leave at least this part of a cell.
constexpr float kLeastLeft = 1e-3f;
/// DiffusionNeeds count fewer steps than this.
constexpr std::size_t kMostSteps = 0xffff;
/// If spread walls have more than this part of a cell, its fractions do not depend on the materials before
/// the walls alone.
constexpr float kNearWall = 0.03f;

}  // namespace

BlurredFractions::BlurredFractions(const MultiMaterialData& data, const SiteValues& values,
                                   const SiteCells& cells)
    : data_(data), values_(values), cells_(cells) {
  std::vector<std::vector<std::uint32_t>> sites(data.materials.size());
  for (const std::uint32_t site : values.mixed_sites()) {
    for (const Entry& entry : values.at(site)) {
      if (entry.width == 0) continue;
      auto& own = sites[values.material_number(entry.material)];
      if (own.empty() || own.back() != site) own.push_back(site);
    }
  }
  for (std::uint16_t number = 0; number < sites.size(); ++number) {
    if (!sites[number].empty()) add_part(number, sites[number]);
  }
  owned_.resize(values.entries().size());
  near_wall_.resize(owned_.size());
  predicted_.resize(owned_.size());
}

void BlurredFractions::add_part(std::uint16_t number, const std::vector<std::uint32_t>& sites) {
  const GridSites grid_sites(data_.grid);
  const SiteArray<float>& fractions = data_.fractions[values_.material(number)];
  double widest = 0;
  for (const std::uint32_t site : sites) {
    for (const Entry& entry : values_.at(site)) {
      if (values_.material_number(entry.material) == number) widest = std::max(widest, values_.width(entry));
    }
  }
  const auto margin = static_cast<std::size_t>(std::ceil(kReach * widest / data_.grid.least_spacing())) + 1;
  Part part{number, SiteBox::round(data_.grid, sites, margin), 0, widest, {}, {}, {}};
  part.step = part.box.greatest_step();
  mark_walls(part, margin);
  struct Found {
    std::size_t steps;
    Part::Target target;
  };
  std::vector<Found> found(sites.size());
  parallel_for(sites.size(), 1024, [&](std::size_t n) {
    const std::size_t site = sites[n], entry = first_entry(values_, site, number);
    // Regions of a material have the width of the material.
    double width = 0;
    for (const Entry& other : values_.at(site)) {
      if (values_.material_number(other.material) == number) width = std::max(width, values_.width(other));
    }
    const Vec3 size = grid_sites.cell(site).size(),
               normal =
                   normalized(fraction_gradient(grid_sites, site, {fractions.begin(), fractions.size()}));
    double own = 0;
    for (int axis = 0; axis < 3; ++axis) own += normal[axis] * normal[axis] * size[axis] * size[axis] / 12;
    const double steps = std::max(0.0, width * width - own) / part.step;
    found[n] = {static_cast<std::size_t>(steps),
                {static_cast<std::uint32_t>(entry), static_cast<std::uint32_t>(part.box.place(site)),
                 static_cast<float>(steps - std::floor(steps))}};
  });
  for (const Found& each : found) {
    if (part.targets.size() <= each.steps) part.targets.resize(each.steps + 1);
    part.targets[each.steps].push_back(each.target);
  }
  find_needs(part);
  parts_.push_back(std::move(part));
}

/// Finds the places of a part's box whose spread volumes are needed.
void BlurredFractions::find_needs(Part& part) {
  if (part.targets.size() >= kMostSteps) return;
  std::vector<DiffusionNeeds::Target> targets;
  for (std::size_t steps = 0; steps < part.targets.size(); ++steps) {
    for (const Part::Target& target : part.targets[steps])
      targets.push_back({target.place, static_cast<std::uint16_t>(steps + 1)});
  }
  part.needs.emplace(std::array<std::size_t, 3>{part.box.sites(0), part.box.sites(1), part.box.sites(2)},
                     targets);
}

/// Marks the places of a part's box at which the volume of another material counts as a wall's: those within
/// `reach` of sites at which that material is a wall.
void BlurredFractions::mark_walls(Part& part, std::size_t reach) const {
  std::map<std::uint16_t, std::vector<std::uint8_t>> walls;
  for (const std::uint32_t site : values_.wall_sites()) {
    for (const Entry& entry : values_.at(site)) {
      const std::uint16_t wall = values_.material_number(entry.material);
      if (!values_.is_wall(entry) || wall == part.number || !part.box.contains(site)) continue;
      auto& marks = walls[wall];
      marks.resize(part.box.size(), 0);
      marks[part.box.place(site)] = 1;
    }
  }
  for (auto& [wall, marks] : walls) {
    part.box.dilate(marks, static_cast<int>(reach));
    part.walls.push_back({wall, std::move(marks)});
  }
}

std::vector<float> BlurredFractions::wall_volumes(const Part& part) const {
  std::vector<float> found(part.box.size());
  for (const Part::Wall& wall : part.walls) {
    const std::vector<float> own = volumes(part.box, wall.number);
    for (std::size_t place = 0; place < own.size(); ++place)
      found[place] += wall.marks[place] != 0 ? own[place] : 0;
  }
  return found;
}

void BlurredFractions::predict() {
  measure();
  if (beyond_.empty()) find_beyond();
  predicted_ = owned_;
  for (const Part& part : parts_) {
    const DiffusionNeeds* needs = part.needs ? &*part.needs : nullptr;
    spread(part.box, part.step, part.targets, needs, volumes(part.box, part.number),
           [&](const Part::Target& target, float fraction) {
             predicted_[target.entry] = fraction + beyond_[target.entry];
           });
    if (part.walls.empty()) continue;
    // Nothing is spread into walls: fractions are relative to what these leave of a cell.
    const std::vector<float> walls = wall_volumes(part);
    spread(
        part.box, part.step, part.targets, needs, walls, [&](const Part::Target& target, float spread_walls) {
          if (values_.is_wall(values_.entries()[target.entry])) return;
          near_wall_[target.entry] = spread_walls > kNearWall ? 1 : 0;
          float& predicted = predicted_[target.entry];
          predicted =
              (1 - walls[target.place]) * std::min(predicted / std::max(1 - spread_walls, kLeastLeft), 1.0f);
        });
  }
}

/// Computes the volumes that materials own in the cells of sites.
void BlurredFractions::measure() {
  const SoleOwners owners(data_.grid, values_);
  parallel_chunks(data_.grid.site_count(), 4096, [&](std::size_t begin, std::size_t end) {
    CellVolumes cell(data_.grid, values_, cells_);
    for (std::size_t site = begin; site < end; ++site) {
      const std::span<const Entry> own = values_.at(site);
      if (own.empty()) continue;
      for (const Entry& entry : own) owned_[values_.index(entry)] = 0;
      if (const std::uint16_t owner = owners.owner(site); owner != SoleOwners::kNone) {
        owned_[first_entry(values_, site, values_.material_number(owner))] = 1;
        continue;
      }
      cell.set_site(site);
      const std::vector<double>& volumes = cell.measure();
      for (std::size_t m = 0; m < volumes.size(); ++m)
        owned_[first_entry(values_, site, cell.materials()[m].number)] = static_cast<float>(volumes[m]);
    }
  });
}

float BlurredFractions::volume_at(std::size_t site, std::uint16_t number) const {
  const std::span<const Entry> own = values_.at(site);
  if (own.empty()) return values_.sole_material(site) == number ? 1.0f : 0.0f;
  for (const Entry& entry : own) {
    if (values_.material_number(entry.material) == number) return owned_[values_.index(entry)];
  }
  return 0;
}

std::vector<float> BlurredFractions::volumes(const SiteBox& box, std::uint16_t number) const {
  std::vector<float> found;
  reserve_in_large_pages(found, box.size());
  found.resize(box.size());
  box.for_each([&](std::size_t place, std::size_t site) { found[place] = volume_at(site, number); });
  return found;
}

template <class Set>
void BlurredFractions::spread(const SiteBox& box, double by, const Part::Targets& targets,
                              const DiffusionNeeds* needs, std::vector<float> now, const Set& set) {
  std::vector<float> next;
  for (std::size_t steps = 0; steps < targets.size(); ++steps) {
    const std::vector<Part::Target>& own = targets[steps];
    box.diffuse(now, by, needs, steps, next);
    parallel_for(own.size(), 4096, [&](std::size_t n) {
      const std::size_t at = own[n].place;
      set(own[n], now[at] + own[n].rest * (next[at] - now[at]));
    });
    now.swap(next);
  }
}

void BlurredFractions::find_beyond() {
  beyond_.assign(owned_.size(), 0);
  const GridSides sides = continued_sides(data_, values_);
  // Thin sheets are left out: their two faces are not a single step that continues.
  std::set<std::uint16_t> sheets;
  for (const SiteValues::Layer& layer : values_.layers())
    sheets.insert(values_.material_number(values_.entries()[layer.sheet].material));
  for (const Part& part : parts_) {
    if (!sheets.contains(part.number)) find_beyond(part, sides);
  }
}

void BlurredFractions::find_beyond(const Part& part, const GridSides& sides) {
  const ContinuedBox whole(data_.grid, part.box, sides, kReach * part.widest);
  if (!whole.reaches_beyond()) return;
  // Contributions reach as many sites as there are steps. What comes to a target by way of a site has gone
  // there from the side and on to the target.
  Part::Targets near;
  std::size_t deepest = 0;
  for (std::size_t steps = 0; steps < part.targets.size(); ++steps) {
    for (const Part::Target& target : part.targets[steps]) {
      const std::size_t away = whole.sites_to_beyond(target.place);
      if (away > steps + 1) continue;
      near.resize(steps + 1);
      near.back().push_back(target);
      deepest = std::max(deepest, (steps + 1 + away) / 2);
    }
  }
  if (near.empty()) return;
  // At the last sites of this box nothing has arrived when the last targets are reached from there.
  const SiteBox inner = whole.near_sides(deepest + 2);
  const ContinuedBox continued(data_.grid, inner, sides, kReach * part.widest, whole);
  const SiteBox& box = continued.box();
  std::vector<DiffusionNeeds::Target> needed;
  for (std::size_t steps = 0; steps < near.size(); ++steps) {
    for (Part::Target& target : near[steps]) {
      target.place = static_cast<std::uint32_t>(continued.place(inner.place(part.box.site(target.place))));
      needed.push_back(
          {target.place, static_cast<std::uint16_t>(std::min<std::size_t>(steps + 1, kMostSteps))});
    }
  }
  std::optional<DiffusionNeeds> needs;
  if (part.targets.size() < kMostSteps)
    needs.emplace(std::array{box.sites(0), box.sites(1), box.sites(2)}, needed);
  const auto farthest = static_cast<float>(kFarthest * part.widest);
  std::vector<float> own(inner.size(), 0), distances(inner.size(), 0);
  continued.for_each_near_side([&](std::size_t place, std::size_t site) {
    own[place] = volume_at(site, part.number);
    const float f = data_.fractions[values_.material(part.number)][site];
    distances[place] = f < 0.5f ? -farthest : farthest;
    const std::span<const Entry> there = values_.at(site);
    const auto blurred = std::ranges::find_if(there, [&](const Entry& e) {
      return values_.material_number(e.material) == part.number && e.width > 0;
    });
    if (f <= 0 || f >= 1 || blurred == there.end()) return;
    distances[place] =
        std::clamp(static_cast<float>(values_.width(*blurred) *
                                      normal_quantile(fraction_before_walls(values_, site, f))),
                   -farthest, farthest);
  });
  spread(box, part.step, near, needs ? &*needs : nullptr, continued.beyond_mirrored(own, distances),
         [&](const Part::Target& target, float fraction) { beyond_[target.entry] = fraction; });
}

namespace {

/// The number of rounds, and that of rounds with means, for fractions with errors: more rounds would fit the
/// errors.
constexpr int kRounds = 5, kRoundsByMeans = 2;
/// If the median width, in cells, is less than this, moves are means too, as the errors of the model would
/// make interfaces rough.
constexpr double kNarrow = 0.7;
/// A round moves values by this part of what is missing, and by at most this part of a cell.
constexpr double kRelax = 0.7, kMostMove = 0.5;
/// Sums of weights below this are ignored.
constexpr double kNothing = 1e-12;

/// Moves the values of blurred entries in rounds, by the differences of their fractions.
class BlurredFit {
 public:
  BlurredFit(const MultiMaterialData& data, SiteValues& values, const SiteCells& cells)
      : grid_(data.grid), values_(values), sites_(data.grid), predicted_(data, values, cells) {}

  void run(Progress& progress) {
    const FractionFindings& found = values_.findings();
    const bool by_means = found.fraction_error > SiteValues::kLeastError || found.blur_median < kNarrow;
    const int rounds = by_means ? kRoundsByMeans : kRounds;
    for (int round = 0; round < rounds; ++round) {
      progress.step("fitting blurred fractions", static_cast<double>(round) / rounds);
      predicted_.predict();
      find_missing();
      set_distances_at_walls(values_);
      move(by_means);
      set_values_at_walls(grid_, values_);
      values_.hold_layers();
    }
  }

 private:
  [[nodiscard]] std::size_t index(const Entry& entry) const { return values_.index(entry); }

  /// Finds the differences between the fractions of blurred entries and those predicted.
  void find_missing() {
    missing_.assign(values_.entries().size(), 0);
    for (const std::uint32_t site : values_.mixed_sites()) {
      const std::span<const Entry> own = std::as_const(values_).at(site);
      for (const Entry& entry : own) {
        if (entry.width == 0 && !values_.is_wall(entry)) continue;
        // The predicted fraction is stored at a material's first entry.
        const std::size_t first = first_entry(values_, site, values_.material_number(entry.material));
        missing_[index(entry)] = entry.fraction - predicted_.at(first);
      }
    }
  }

  /// Returns the weight of an entry: the scaled derivative of fractions at its distance from the interface.
  [[nodiscard]] double weight_of(const Entry& entry) const {
    const double steps = entry.value / values_.width(entry);
    return std::exp(-steps * steps);
  }

  /// Moves values by the difference at each entry or by the mean of the differences round it.
  void move(bool by_means) {
    const double most = values_.greatest_value();
    moves_.assign(missing_.size(), 0);
    if (by_means) {
      weights_.resize(missing_.size());
      parallel_for(weights_.size(), 1 << 14, [&](std::size_t e) {
        const Entry& entry = values_.entries()[e];
        weights_[e] = entry.width > 0 ? weight_of(entry) : 0;
      });
    }
    parallel_for(values_.mixed_sites().size(), 1024, [&](std::size_t n) {
      const std::size_t site = values_.mixed_sites()[n];
      for (const Entry& entry : std::as_const(values_).at(site)) {
        if (entry.width > 0 || values_.is_wall(entry))
          moves_[index(entry)] =
              by_means && entry.width > 0 ? mean_missing(site, entry) : missing_[index(entry)];
      }
    });
    continue_moves();
    parallel_for(values_.mixed_sites().size(), 1024, [&](std::size_t n) {
      const std::size_t site = values_.mixed_sites()[n];
      const double farthest = kMostMove * sites_.least_side(site);
      const std::span<Entry> own = values_.at(site);
      for (Entry& entry : own) {
        if (values_.is_wall(entry) || entry.width == 0) continue;
        const double by = kRelax * values_.width(entry) * std::sqrt(2 * std::numbers::pi) *
                          static_cast<double>(moves_[index(entry)]);
        // Values of materials across a sheet are below the limit and stay there.
        entry.value = std::clamp(entry.value + std::clamp(by, -farthest, farthest),
                                 std::min(-most, entry.value), std::max(most, entry.value));
      }
      for (Entry& entry : own) {
        if (!values_.is_wall(entry)) continue;
        const double by = sites_.least_side(site) * static_cast<double>(moves_[index(entry)]);
        entry.value += std::clamp(by, -farthest, farthest);
      }
    });
  }

  /// Returns whether an entry's difference is unreliable because a wall is near.
  [[nodiscard]] bool is_unreliable(std::size_t site, const Entry& entry) const {
    if (values_.wall_sites().empty() || values_.is_wall(entry)) return false;
    return predicted_.is_near_wall(first_entry(values_, site, values_.material_number(entry.material)));
  }

  /// Gives entries near walls the mean move of the entries round them that are farther away, ring by ring. An
  /// entry without such neighbours keeps its own difference.
  void continue_moves() {
    if (values_.wall_sites().empty()) return;
    struct Place {
      std::size_t site, entry;
    };
    std::vector<Place> left;
    std::vector<char> known(moves_.size(), 1);
    for (const std::uint32_t site : values_.mixed_sites()) {
      for (const Entry& entry : std::as_const(values_).at(site)) {
        if (entry.width == 0 || !is_unreliable(site, entry)) continue;
        known[index(entry)] = 0;
        left.push_back({site, index(entry)});
      }
    }
    for (bool changed = true; changed;) {
      std::vector<float> means(left.size());
      std::vector<char> found(left.size(), 0);
      parallel_for(left.size(), 1024, [&](std::size_t n) {
        found[n] = find_mean_move(left[n].site, left[n].entry, known, means[n]) ? 1 : 0;
      });
      std::vector<Place> rest;
      for (std::size_t n = 0; n < left.size(); ++n) {
        if (found[n] == 0) {
          rest.push_back(left[n]);
        } else {
          moves_[left[n].entry] = means[n], known[left[n].entry] = 1;
        }
      }
      changed = rest.size() < left.size();
      left = std::move(rest);
    }
  }

  /// Finds the mean move of a material's known entries at the neighbours of a site; returns whether there are
  /// any.
  [[nodiscard]] bool find_mean_move(std::size_t site, std::size_t entry, const std::vector<char>& known,
                                    float& mean) const {
    const std::uint16_t material = std::as_const(values_).entries()[entry].material;
    float sum = 0, count = 0;
    sites_.for_each_neighbour(site, [&](std::size_t other, int, int, int) {
      const Entry* there = find_entry(std::as_const(values_).at(other), material);
      if (there != nullptr && there->width > 0 && known[index(*there)] != 0)
        sum += moves_[index(*there)], ++count;
    });
    mean = count > 0 ? sum / count : 0;
    return count > 0;
  }

  [[nodiscard]] float mean_missing_of_wall(std::size_t site, const Entry& entry) const {
    float weights = 1, sum = missing_[index(entry)];
    sites_.for_each_neighbour(site, [&](std::size_t other, int di, int dj, int dk) {
      const Entry* there = find_entry(std::as_const(values_).at(other), entry.material);
      if (there == nullptr || !values_.is_wall(*there) || there->is_pure()) return;
      const float w = 1.0f / static_cast<float>(1 << (di * di + dj * dj + dk * dk));
      sum += w * missing_[index(*there)];
      weights += w;
    });
    return sum / weights;
  }

  [[nodiscard]] float mean_missing(std::size_t site, const Entry& entry) const {
    if (values_.is_wall(entry)) return mean_missing_of_wall(site, entry);
    double weights = weights_[index(entry)], sum = weights * static_cast<double>(missing_[index(entry)]);
    sites_.for_each_neighbour(site, [&](std::size_t other, int di, int dj, int dk) {
      for (const Entry& there : std::as_const(values_).at(other)) {
        if (there.material != entry.material || there.width == 0 || is_unreliable(other, there)) continue;
        const double w = weights_[index(there)] / (1 << (di * di + dj * dj + dk * dk));
        sum += w * static_cast<double>(missing_[index(there)]);
        weights += w;
      }
    });
    return weights > kNothing ? static_cast<float>(sum / weights) : 0;
  }

  const RectilinearGrid& grid_;
  SiteValues& values_;
  GridSites sites_;
  BlurredFractions predicted_;
  std::vector<float> missing_, moves_;  // by entry
  std::vector<double> weights_;         // by entry, for means
};

}  // namespace

void fit_blurred(const MultiMaterialData& data, SiteValues& values, const SiteCells& cells,
                 Progress& progress) {
  BlurredFit(data, values, cells).run(progress);
}

}  // namespace adamas::interfaces
