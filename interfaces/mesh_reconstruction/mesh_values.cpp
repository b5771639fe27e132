#include "interfaces/mesh_reconstruction/mesh_values.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/parallel.h"
#include "core/base/sort_unique.h"
#include "interfaces/reconstruction/site_values.h"

namespace adamas::interfaces {

namespace {

/// Cells have entries for the materials of the cells this many steps away: values at points are those of the
/// cells round them and of those beside these, and a material has values wherever it could own something.
constexpr int kRings = 3;
constexpr std::uint32_t kNone = 0xffffffffu;

/// Appends the materials of another list.
void unite(std::vector<std::uint16_t>& list, std::span<const std::uint16_t> other) {
  list.insert(list.end(), other.begin(), other.end());
}

}  // namespace

MeshValues::MeshValues(const MeshData& data, const MeshSubdivision& subdivision)
    : subdivision_(subdivision), by_name_(materials_by_name(data.materials)), is_part_(by_name_.size(), 0) {
  for (std::uint16_t n = 0; n < by_name_.size(); ++n) wholes_.push_back(n);
  std::vector<std::vector<Held>> held(data.mesh.cell_count());
  for (std::uint16_t n = 0; n < by_name_.size(); ++n) {
    for (std::size_t c = 0; c < held.size(); ++c) {
      if (const float fraction = data.fraction(by_name_[n], c); fraction > 0)
        held[c].push_back({n, fraction});
    }
  }
  find_entries(held);
}

void MeshValues::drop_absent() {
  std::vector<std::vector<Held>> held(subdivision_.mesh().cell_count());
  for (std::size_t c = 0; c < held.size(); ++c) {
    for (const Entry& entry : at(c)) {
      if (entry.fraction > 0) held[c].push_back({entry.material, entry.fraction});
    }
  }
  find_entries(held);
}

void MeshValues::divide(const std::vector<MaterialId>& added,
                        const std::vector<std::vector<std::pair<std::uint16_t, float>>>& held) {
  for (const MaterialId material : added) {
    const auto whole = static_cast<std::uint16_t>(std::ranges::find(by_name_, material) - by_name_.begin());
    by_name_.push_back(material);
    wholes_.push_back(whole);
    is_part_.push_back(1);
    is_part_[whole] = 1;
  }
  std::vector<std::vector<Held>> sorted(held.size());
  for (std::size_t c = 0; c < held.size(); ++c) {
    for (const auto& [number, fraction] : held[c]) {
      const auto known = std::ranges::find(sorted[c], number, &Held::material);
      if (known == sorted[c].end()) {
        sorted[c].push_back({number, fraction});
      } else {
        known->fraction += fraction;
      }
    }
    std::ranges::sort(sorted[c], {}, &Held::material);
  }
  find_entries(sorted);
}

/// `held`: what each cell holds, ascending by number.
void MeshValues::find_entries(const std::vector<std::vector<Held>>& held) {
  const PolyhedralMesh& mesh = subdivision_.mesh();
  const std::size_t cells = mesh.cell_count();
  // The materials of cells spread over points: from cells to their points and back is one ring.
  std::vector<std::vector<std::uint16_t>> of_cells(cells), of_points(mesh.points().size());
  for (std::size_t c = 0; c < cells; ++c) {
    for (const Held& own : held[c]) of_cells[c].push_back(own.material);
  }
  for (int ring = 0; ring < kRings; ++ring) {
    parallel_for(of_points.size(), 1024, [&](std::size_t p) {
      of_points[p].clear();
      for (const Index c : mesh.cells_round(p)) unite(of_points[p], of_cells[c]);
      sort_unique(of_points[p]);
    });
    parallel_for(cells, 1024, [&](std::size_t c) {
      of_cells[c].clear();
      for (const Index p : mesh.points_of_cell(c)) unite(of_cells[c], of_points[p]);
      sort_unique(of_cells[c]);
    });
  }
  first_entries_.assign(1, 0);
  entries_.clear(), active_.clear(), place_of_point_.clear();
  double widest = 0;
  for (std::size_t c = 0; c < cells; ++c) {
    for (const std::uint16_t n : of_cells[c]) {
      const auto own = std::ranges::find(held[c], n, &Held::material);
      entries_.push_back({n, own == held[c].end() ? 0 : own->fraction, 0});
    }
    first_entries_.push_back(static_cast<std::uint32_t>(entries_.size()));
    if (of_cells[c].size() > 1) active_.push_back(static_cast<Index>(c));
    widest = std::max(widest, size(c));
  }
  far_ = -32 * widest;
}

/// Finds the points of active cells, and which values they have.
void MeshValues::find_points() {
  const PolyhedralMesh& mesh = subdivision_.mesh();
  points_.clear();
  for (const Index c : active_) {
    const std::span<const Index> round = mesh.points_of_cell(c);
    points_.insert(points_.end(), round.begin(), round.end());
    for (const Index f : mesh.faces_of_cell(c)) points_.push_back(subdivision_.face_center(f));
  }
  sort_unique(points_);
  place_of_point_.assign(subdivision_.cell_center(0), kNone);
  for (std::uint32_t n = 0; n < points_.size(); ++n) place_of_point_[points_[n]] = n;
  stencils_.resize(points_.size());
  parallel_for(points_.size(), 256,
               [&](std::size_t n) { subdivision_.find_stencil(points_[n], stencils_[n]); });
  owners_.assign(points_.size(), 0);
  first_of_point_.assign(1, 0);
  of_points_.clear();
  std::vector<std::uint16_t> common;
  for (const MeshSubdivision::Stencil& stencil : stencils_) {
    // The materials that all cells of the stencil have entries of.
    common.clear();
    for (const Entry& entry : at(stencil.cells[0])) common.push_back(entry.material);
    for (const Index c : stencil.cells) {
      std::erase_if(common, [&](std::uint16_t n) {
        return std::ranges::none_of(at(c), [&](const Entry& entry) { return entry.material == n; });
      });
    }
    for (const std::uint16_t n : common) of_points_.push_back({n, 0});
    first_of_point_.push_back(static_cast<std::uint32_t>(of_points_.size()));
  }
}

double MeshValues::size(std::size_t cell) const {
  return std::cbrt(std::abs(subdivision_.mesh().cell_volume(cell)));
}

double MeshValues::extent(Index cell, const Vec3& direction) const {
  const Vec3 center = subdivision_.mesh().cell_center(cell);
  double moment = 0, first = 0, volume = 0;
  subdivision_.for_each_tetrahedron(cell, [&](const std::array<Index, 4>& corners) {
    double sum = 0, squares = 0;
    for (const Index corner : corners) {
      const double height = dot(subdivision_.position(corner) - center, direction);
      sum += height;
      squares += height * height;
    }
    const double own = subdivision_.volume(corners);
    moment += own * (squares + sum * sum) / 20;
    first += own * sum / 4;
    volume += own;
  });
  if (!(volume > 0)) return size(cell);
  const double mean = first / volume, variance = moment / volume - mean * mean;
  return variance > 0 ? std::sqrt(12 * variance) : size(cell);
}

void MeshValues::interpolate() {
  if (place_of_point_.empty()) find_points();
  parallel_for(points_.size(), 1024, [&](std::size_t n) {
    const auto& [cells, weights] = stencils_[n];
    for (std::uint32_t e = first_of_point_[n]; e < first_of_point_[n + 1]; ++e) {
      double sum = 0;
      for (std::size_t i = 0; i < cells.size(); ++i) {
        for (const Entry& entry : std::as_const(*this).at(cells[i])) {
          if (entry.material == of_points_[e].material) sum += weights[i] * entry.value;
        }
      }
      of_points_[e].value = sum;
    }
    owners_[n] = greatest(at_point(points_[n]));
  });
}

template <class Entries>
std::uint16_t MeshValues::greatest(const Entries& entries) {
  std::uint16_t best = 0;
  double most = -std::numeric_limits<double>::infinity();
  for (const auto& entry : entries) {
    if (entry.value > most) best = entry.material, most = entry.value;
  }
  return best;
}

std::span<const MeshValues::PointEntry> MeshValues::at_point(Index point) const {
  const std::uint32_t n = place_of_point_[point];
  return std::span(of_points_).subspan(first_of_point_[n], first_of_point_[n + 1] - first_of_point_[n]);
}

std::uint16_t MeshValues::owner(Index point) const {
  if (point < place_of_point_.size()) return owners_[place_of_point_[point]];
  return greatest(at(point - place_of_point_.size()));
}

std::optional<std::uint16_t> MeshValues::sole_owner(Index cell) const {
  const PolyhedralMesh& mesh = subdivision_.mesh();
  const std::uint16_t first = owner(subdivision_.cell_center(cell));
  const auto differs = [&](Index point) { return owner(point) != first; };
  if (std::ranges::any_of(mesh.points_of_cell(cell), differs)) return {};
  for (const Index f : mesh.faces_of_cell(cell)) {
    if (differs(subdivision_.face_center(f))) return {};
  }
  return first;
}

void MeshValues::find_materials(const std::array<Index, 4>& corners, std::vector<CornerValues>& found) const {
  found.clear();
  for (std::size_t c = 0; c < 4; ++c) {
    const auto add = [&](const auto& entries) {
      for (const auto& entry : entries) {
        auto at = std::ranges::find_if(found, [&](const auto& m) { return m.number >= entry.material; });
        if (at == found.end() || at->number != entry.material)
          at = found.insert(at, {entry.material, {far_, far_, far_, far_}});
        at->values[c] = entry.value;
      }
    };
    if (corners[c] < place_of_point_.size()) {
      add(at_point(corners[c]));
    } else {
      add(at(corners[c] - place_of_point_.size()));
    }
  }
}

std::vector<std::uint32_t> first_active_entries(const MeshValues& values) {
  std::vector<std::uint32_t> firsts{0};
  for (const MeshValues::Index c : values.active_cells())
    firsts.push_back(firsts.back() + static_cast<std::uint32_t>(values.at(c).size()));
  return firsts;
}

}  // namespace adamas::interfaces
