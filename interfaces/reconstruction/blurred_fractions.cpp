#include "interfaces/reconstruction/blurred_fractions.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "core/base/parallel.h"
#include "interfaces/reconstruction/border_continuation.h"
#include "interfaces/reconstruction/cell_volumes.h"
#include "interfaces/reconstruction/grid_sites.h"
#include "interfaces/reconstruction/interface_planes.h"
#include "interfaces/reconstruction/normal_distribution.h"
#include "interfaces/reconstruction/site_entries.h"
#include "interfaces/reconstruction/walls.h"

namespace adamas::interfaces {

namespace {

using Entry = SiteValues::Entry;

/// What is farther away than so many widths does not count.
constexpr double kReach = 3;
/// Distances are told from fractions up to so many widths.
constexpr double kFarthest = 3;
/// Of a cell that is to hold something walls leave no less than this, spread alike.
constexpr float kLeastLeft = 1e-3f;
/// And where spread walls have more than this of a cell, what is before them is not all that blur mixes
/// there.
constexpr float kNearWall = 0.03f;

}  // namespace

BlurredFractions::BlurredFractions(const MultiMaterialData& data, const SiteValues& values,
                                   const SiteCells& cells)
    : data_(data), values_(values), cells_(cells) {
  std::vector<std::vector<std::uint32_t>> sites(data.materials.size());
  for (const std::uint32_t site : values.mixed()) {
    for (const Entry& entry : values.at(site)) {
      if (entry.width == 0) continue;
      auto& own = sites[values.whole(entry.material)];
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
      if (values_.whole(entry.material) == number) widest = std::max(widest, values_.width(entry));
    }
  }
  const auto margin = static_cast<std::size_t>(std::ceil(kReach * widest / data_.grid.least_spacing())) + 1;
  Part part{number, SiteBox::round(data_.grid, sites, margin), 0, widest, {}, {}};
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
      if (values_.whole(other.material) == number) width = std::max(width, values_.width(other));
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
  parts_.push_back(std::move(part));
}

/// Marks the places of a part's box at which the volume of another material counts as a wall's: those within
/// reach of sites at which it is one.
void BlurredFractions::mark_walls(Part& part, std::size_t reach) const {
  std::map<std::uint16_t, std::vector<std::uint8_t>> walls;
  for (const std::uint32_t site : values_.at_walls()) {
    for (const Entry& entry : values_.at(site)) {
      const std::uint16_t wall = values_.whole(entry.material);
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
  if (beyond_.empty()) look_beyond();
  predicted_ = owned_;
  for (const Part& part : parts_) {
    const auto same = [](std::size_t place) { return place; };
    spread(part, part.box, volumes(part.box, part.number), same,
           [&](const Part::Target& target, float fraction) {
             predicted_[target.entry] = fraction + beyond_[target.entry];
           });
    if (part.walls.empty()) continue;
    // Nothing is spread into walls: fractions are parts of what these leave of a cell.
    const std::vector<float> walls = wall_volumes(part);
    spread(part, part.box, walls, same, [&](const Part::Target& target, float spread_walls) {
      if (values_.is_wall(values_.entries()[target.entry])) return;
      near_wall_[target.entry] = spread_walls > kNearWall ? 1 : 0;
      float& predicted = predicted_[target.entry];
      predicted =
          (1 - walls[target.place]) * std::min(predicted / std::max(1 - spread_walls, kLeastLeft), 1.0f);
    });
  }
}

/// The volumes that materials own in the cells of sites.
void BlurredFractions::measure() {
  parallel_chunks(data_.grid.site_count(), 4096, [&](std::size_t begin, std::size_t end) {
    CellVolumes cell(data_.grid, values_, cells_);
    for (std::size_t site = begin; site < end; ++site) {
      const std::span<const Entry> own = values_.at(site);
      if (own.empty()) continue;
      cell.go_to(site);
      const std::vector<double>& volumes = cell.measure();
      for (const Entry& entry : own) owned_[values_.index(entry)] = 0;
      for (std::size_t m = 0; m < volumes.size(); ++m)
        owned_[first_entry(values_, site, cell.materials()[m].number)] = static_cast<float>(volumes[m]);
    }
  });
}

std::vector<float> BlurredFractions::volumes(const SiteBox& box, std::uint16_t number) const {
  std::vector<float> found(box.size());
  box.for_each([&](std::size_t place, std::size_t site) {
    const std::span<const Entry> own = values_.at(site);
    float volume = own.empty() && values_.sole_material(site) == number ? 1.0f : 0.0f;
    for (const Entry& entry : own) {
      if (values_.whole(entry.material) != number) continue;
      volume = owned_[values_.index(entry)];
      break;
    }
    found[place] = volume;
  });
  return found;
}

template <class Place, class Set>
void BlurredFractions::spread(const Part& part, const SiteBox& box, std::vector<float> now,
                              const Place& place, const Set& set) const {
  std::vector<float> before, scratch;
  for (const auto& targets : part.targets) {
    before = now;
    box.diffuse(now, part.step, scratch);
    parallel_for(targets.size(), 4096, [&](std::size_t n) {
      const std::size_t at = place(targets[n].place);
      set(targets[n], before[at] + targets[n].rest * (now[at] - before[at]));
    });
  }
}

void BlurredFractions::look_beyond() {
  beyond_.assign(owned_.size(), 0);
  const GridSides sides = sides_that_run_on(data_, values_);
  // The two faces of a thin sheet are no single step that runs on.
  std::set<std::uint16_t> sheets;
  for (const SiteValues::Layer& layer : values_.layers())
    sheets.insert(values_.whole(values_.entries()[layer.sheet].material));
  for (const Part& part : parts_) {
    if (sheets.contains(part.number)) continue;
    const ContinuedBox continued(data_.grid, part.box, sides, kReach * part.widest);
    if (!continued.reaches_beyond()) continue;
    const auto farthest = static_cast<float>(kFarthest * part.widest);
    std::vector<float> distances(part.box.size());
    part.box.for_each([&](std::size_t place, std::size_t site) {
      const float f = data_.fractions[values_.material(part.number)][site];
      distances[place] = f < 0.5f ? -farthest : farthest;
      const std::span<const Entry> own = values_.at(site);
      const auto blurred = std::ranges::find_if(
          own, [&](const Entry& e) { return values_.whole(e.material) == part.number && e.width > 0; });
      if (f <= 0 || f >= 1 || blurred == own.end()) return;
      distances[place] =
          std::clamp(static_cast<float>(values_.width(*blurred) *
                                        normal_quantile(fraction_before_walls(values_, site, f))),
                     -farthest, farthest);
    });
    spread(
        part, continued.box(), continued.beyond_mirrored(volumes(part.box, part.number), distances),
        [&](std::size_t place) { return continued.place(place); },
        [&](const Part::Target& target, float fraction) { beyond_[target.entry] = fraction; });
  }
}

}  // namespace adamas::interfaces
