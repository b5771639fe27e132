#include "interfaces/mesh_reconstruction/mesh_walls.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "core/base/parallel.h"

namespace adamas::interfaces {

namespace {

using Entry = MeshValues::Entry;

/// The others' values are continued to so many layers of cells of a wall.
constexpr int kLayers = 3;
/// At least so many cells make a linear function.
constexpr std::size_t kLeastCells = 6;

/// Returns the value, at a cell's centre, of the linear function that fits those of a material in the known
/// cells round it by least squares; that of the entry where there are too few.
double continued(const MeshValues& values, MeshValues::Index cell, const Entry& entry,
                 const std::vector<MeshValues::Index>& round, const std::vector<char>& known) {
  const PolyhedralMesh& mesh = values.subdivision().mesh();
  const double size = values.size(cell);
  Eigen::Matrix4d squares = Eigen::Matrix4d::Zero();
  Eigen::Vector4d right = Eigen::Vector4d::Zero();
  std::size_t count = 0;
  for (const MeshValues::Index other : round) {
    if (known[other] == 0) continue;
    const std::span<const Entry> there = values.at(other);
    const auto same = std::ranges::find(there, entry.material, &Entry::material);
    if (same == there.end()) continue;
    const Vec3 d = (1 / size) * (mesh.cell_center(other) - mesh.cell_center(cell));
    const Eigen::Vector4d row(1, d.x, d.y, d.z);
    const double w = std::exp(-0.5 * squared_norm(d));
    squares += w * row * row.transpose();
    right += w * same->value * row;
    ++count;
  }
  if (count < kLeastCells) return entry.value;
  squares.diagonal().array() += 1e-6 * squares.trace();
  const double value = squares.ldlt().solve(right)[0];
  return std::isfinite(value) ? value : entry.value;
}

}  // namespace

MeshWalls::MeshWalls(const MeshValues& values)
    : is_wall_(values.material_count(), 1), filled_(values.subdivision().mesh().cell_count(), 0) {
  bool is_mixed = false;
  for (const Index c : values.active_cells()) {
    for (const Entry& entry : values.at(c)) {
      if (entry.fraction <= 0 || entry.fraction >= 1) continue;
      is_wall_[entry.material] = 0;
      is_mixed = true;
    }
  }
  if (!is_mixed) return;
  for (std::size_t c = 0; c < filled_.size(); ++c) {
    for (const Entry& entry : values.at(c)) {
      if (entry.fraction >= 1 && is_wall_[entry.material] != 0) filled_[c] = 1;
    }
    any_ = any_ || filled_[c] != 0;
  }
}

void MeshWalls::keep_distances(const MeshValues& values) {
  distances_.clear();
  for (const Index c : values.active_cells()) {
    for (const Entry& entry : values.at(c)) distances_.push_back(entry.value);
  }
}

void MeshWalls::set_values(MeshValues& values) const {
  if (!any_) return;
  const std::vector<Index>& active = values.active_cells();
  std::vector<char> known(filled_.size(), 0);
  for (const Index c : active) known[c] = filled_[c] == 0 ? 1 : 0;
  for (int layer = 0; layer < kLayers; ++layer) {
    std::vector<std::vector<double>> found(active.size());
    parallel_for(active.size(), 64, [&](std::size_t n) {
      const Index c = active[n];
      if (known[c] != 0) return;
      thread_local std::vector<Index> ring, wider;
      values.subdivision().find_ring(std::array{c}, ring);
      if (std::ranges::none_of(ring, [&](Index other) { return known[other] != 0; })) return;
      values.subdivision().find_ring(ring, wider);
      const std::span<const Entry> own = std::as_const(values).at(c);
      for (const Entry& entry : own) {
        const bool continues = is_wall_[entry.material] == 0;
        found[n].push_back(continues ? continued(values, c, entry, wider, known) : entry.value);
      }
    });
    for (std::size_t n = 0; n < active.size(); ++n) {
      if (found[n].empty()) continue;
      const std::span<Entry> own = values.at(active[n]);
      for (std::size_t e = 0; e < own.size(); ++e) own[e].value = found[n][e];
      known[active[n]] = 1;
    }
  }
  std::size_t at = 0;
  for (const Index c : active) {
    const std::span<Entry> own = values.at(c);
    double most = -std::numeric_limits<double>::infinity();
    for (const Entry& entry : own) {
      if (is_wall_[entry.material] == 0) most = std::max(most, entry.value);
    }
    for (Entry& entry : own) {
      const double distance = distances_[at++];
      if (is_wall_[entry.material] == 0) continue;
      entry.value = std::isfinite(most) ? most + 2 * distance : distance;
    }
  }
}

}  // namespace adamas::interfaces
