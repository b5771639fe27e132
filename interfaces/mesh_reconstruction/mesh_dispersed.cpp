#include "interfaces/mesh_reconstruction/mesh_dispersed.h"

#include <algorithm>
#include <utility>

#include "core/base/parallel.h"
#include "core/base/sort_unique.h"
#include "interfaces/reconstruction/dispersed_criterion.h"

namespace adamas::interfaces {

namespace {

using Index = MeshSubdivision::Index;
using Entry = MeshValues::Entry;
using Is = DispersedCriterion;

class DispersedCells {
 public:
  /// `number`: that of the material.
  DispersedCells(const MeshValues& values, std::uint16_t number)
      : subdivision_(values.subdivision()), fractions_(subdivision_.mesh().cell_count(), 0) {
    for (std::size_t c = 0; c < fractions_.size(); ++c) {
      for (const Entry& entry : values.at(c)) {
        if (entry.material == number) fractions_[c] = entry.fraction;
      }
    }
  }

  /// Returns those of the cells with little of the material where it is dispersed. `reach`: in cells.
  [[nodiscard]] std::vector<Index> find(const std::vector<Index>& little, int reach) const {
    const std::vector<char> much = near_much(reach);
    return parallel_collect<Index>(little.size(), 64,
                                   [&](std::size_t begin, std::size_t end, std::vector<Index>& found) {
                                     std::vector<Index> ring, wider;
                                     for (std::size_t n = begin; n < end; ++n) {
                                       if (much[little[n]] == 0 && is_everywhere(little[n], ring, wider))
                                         found.push_back(little[n]);
                                     }
                                   });
  }

 private:
  /// Marks the cells within reach of one with more than little.
  [[nodiscard]] std::vector<char> near_much(int reach) const {
    const PolyhedralMesh& mesh = subdivision_.mesh();
    std::vector<char> cells(fractions_.size(), 0), points(mesh.points().size(), 0);
    for (std::size_t c = 0; c < cells.size(); ++c) cells[c] = fractions_[c] >= Is::kLittle ? 1 : 0;
    for (int step = 0; step < reach; ++step) {
      parallel_for(points.size(), 1024, [&](std::size_t p) {
        points[p] = std::ranges::any_of(mesh.cells_round(p), [&](Index c) { return cells[c] != 0; }) ? 1 : 0;
      });
      parallel_for(cells.size(), 1024, [&](std::size_t c) {
        cells[c] =
            std::ranges::any_of(mesh.points_of_cell(c), [&](Index p) { return points[p] != 0; }) ? 1 : 0;
      });
    }
    return cells;
  }

  /// Returns whether most of the cells near a cell hold about as much as it does.
  [[nodiscard]] bool is_everywhere(Index cell, std::vector<Index>& ring, std::vector<Index>& wider) const {
    ring.assign(1, cell);
    for (std::size_t step = 0; step < Is::kNear; ++step) {
      subdivision_.find_ring(ring, wider);
      ring.swap(wider);
    }
    const auto alike =
        std::ranges::count_if(ring, [&](Index c) { return Is::is_alike(fractions_[c], fractions_[cell]); });
    return Is::is_most(static_cast<std::size_t>(alike), ring.size());
  }

  const MeshSubdivision& subdivision_;
  std::vector<float> fractions_;  // of the material, by cell
};

}  // namespace

std::vector<double> take_dispersed(const std::vector<double>& widths, MeshValues& values) {
  const PolyhedralMesh& mesh = values.subdivision().mesh();
  std::vector<double> taken(values.material_count(), 0);
  std::vector<std::vector<Index>> little(values.material_count());
  for (const Index c : values.active_cells()) {
    for (const Entry& entry : std::as_const(values).at(c)) {
      if (entry.fraction > 0 && entry.fraction < Is::kLittle) little[entry.material].push_back(c);
    }
  }
  std::vector<Index> changed;
  for (std::uint16_t number = 0; number < little.size(); ++number) {
    if (little[number].empty()) continue;
    const DispersedCells cells(values, number);
    for (const Index c : cells.find(little[number], Is::reach(widths[number]))) {
      // A cell's only material is not taken out.
      if (!holds_another(values.at(c), number)) continue;
      Entry& entry = *std::ranges::find(values.at(c), number, &Entry::material);
      taken[values.material(number).value] += mesh.cell_volume(c) * static_cast<double>(entry.fraction);
      entry.fraction = 0;
      changed.push_back(c);
    }
  }
  sort_unique(changed);
  for (const Index c : changed) give_to_others(values.at(c));
  if (!changed.empty()) values.drop_absent();
  return taken;
}

}  // namespace adamas::interfaces
