#include "interfaces/mesh_reconstruction/mesh_volumes.h"

#include <algorithm>
#include <array>

#include "core/base/parallel.h"

namespace adamas::interfaces {

using Entry = MeshValues::Entry;

MeshVolumes::MeshVolumes(const MeshValues& values) : values_(values) {
  first_.push_back(0);
  for (const Index c : values.active_cells()) first_.push_back(first_.back() + values.at(c).size());
  parts_.resize(first_.back());
  growths_.resize(first_.back());
  exchanges_.resize(values.active_cells().size());
}

void MeshVolumes::measure(bool growth) {
  parallel_for(exchanges_.size(), 32, [&](std::size_t n) { measure_cell(n, growth); });
}

void MeshVolumes::measure_cell(std::size_t n, bool growth) {
  thread_local std::vector<CornerValues> found;
  thread_local TetrahedronShares shares;
  const Index cell = values_.active_cells()[n];
  const MeshSubdivision& subdivision = values_.subdivision();
  const std::span<const Entry> own = values_.at(cell);
  const std::span<double> parts = std::span(parts_).subspan(first_[n], own.size()),
                          growths = std::span(growths_).subspan(first_[n], own.size());
  std::ranges::fill(parts, 0);
  std::ranges::fill(growths, 0);
  exchanges_[n].clear();
  const auto place = [&](std::uint16_t number) {
    return static_cast<std::size_t>(std::ranges::find(own, number, &Entry::material) - own.begin());
  };
  if (!(subdivision.mesh().cell_volume(cell) > 0)) {
    // A tangled cell is left as it is.
    for (std::size_t e = 0; e < own.size(); ++e) parts[e] = static_cast<double>(own[e].fraction);
    return;
  }
  if (const auto sole = values_.sole_owner(cell)) {
    parts[place(*sole)] = 1;
    return;
  }
  const double unit = 1 / subdivision.mesh().cell_volume(cell);
  subdivision.for_each_tetrahedron(cell, [&](const std::array<Index, 4>& corners) {
    const double volume = unit * subdivision.volume(corners);
    const std::uint16_t first = values_.owner(corners[0]);
    if (std::all_of(corners.begin() + 1, corners.end(), [&](Index p) { return values_.owner(p) == first; })) {
      parts[place(first)] += volume;
      return;
    }
    values_.find_materials(corners, found);
    shares.divide(
        found, growth,
        [&](std::uint16_t number, double part) {
          const std::size_t e = place(number);
          if (e < own.size()) parts[e] += volume * part;
        },
        [&](const CornerValues& a, const CornerValues& b, const std::array<double, 4>& by) {
          const double sum = volume * (by[0] + by[1] + by[2] + by[3]);
          if (sum == 0) return;
          const std::size_t e = place(a.number), f = place(b.number);
          if (e < own.size()) growths[e] += sum;
          if (f < own.size()) growths[f] += sum;
          auto known = std::ranges::find_if(
              exchanges_[n], [&](const Exchange& x) { return x.first == a.number && x.second == b.number; });
          if (known == exchanges_[n].end())
            known = exchanges_[n].insert(known, Exchange{a.number, b.number, 0, {}});
          known->growth += sum;
          for (std::size_t i = 0; i < 4; ++i) {
            if (by[i] == 0) continue;
            auto point = std::ranges::find(known->of_points, corners[i], &std::pair<Index, double>::first);
            if (point == known->of_points.end()) point = known->of_points.insert(point, {corners[i], 0.0});
            point->second += volume * by[i];
          }
        });
  });
}

}  // namespace adamas::interfaces
