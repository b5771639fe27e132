#include "interfaces/mesh_reconstruction/mesh_errors.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/base/parallel.h"
#include "interfaces/reconstruction/cut_volumes.h"
#include "interfaces/reconstruction/error_criterion.h"
#include "interfaces/reconstruction/normal_distribution.h"

namespace adamas::interfaces {

namespace {

using Entry = MeshValues::Entry;
using Quadric = Eigen::Matrix<double, 10, 1>;

constexpr std::uint32_t kNone = 0xffffffffu;
/// Differences count together with those of cells up to this squared distance, in cells.
constexpr double kSquaredNear = 3;

bool is_mixed(const Entry& entry) { return entry.fraction > 0 && entry.fraction < 1; }

/// The diameter of the ball that touches the faces of a cell; that of cells without such a ball is meant so
/// too.
double inner_diameter(const PolyhedralMesh& mesh, std::uint32_t cell) {
  double area = 0;
  for (const std::uint32_t f : mesh.faces_of_cell(cell)) area += norm(mesh.face_area(f));
  return 6 * mesh.cell_volume(cell) / area;
}

/// The products of coordinates that a quadric is made of. The constant is the last one.
Quadric terms(const std::array<double, 3>& x) {
  Quadric row;
  row << x[0] * x[0], x[1] * x[1], x[2] * x[2], x[0] * x[1], x[0] * x[2], x[1] * x[2], x[0], x[1], x[2], 1;
  return row;
}

}  // namespace

/// What a surface through its neighbours predicts for an entry.
struct MeshErrors::Prediction {
  double value = 0, fraction = 0;
  double own = 0;        ///< the weight of the entry's own value in a surface through it and its neighbours
  double curved = 0;     ///< the mean curvature, signed, in cells
  bool is_alone = true;  ///< whether the neighbours hold no third material
  bool known = false;
};

MeshErrors::MeshErrors(const std::vector<double>& widths, const std::vector<double>& extents,
                       const MeshFilms& films, const MeshValues& values)
    : widths_(widths),
      extents_(extents),
      films_(films),
      values_(values),
      firsts_{0},
      of_cells_(values.subdivision().mesh().cell_count(), kNone),
      moments_(values.active_cells().size()) {
  const std::vector<Index>& active = values.active_cells();
  const MeshSubdivision& subdivision = values.subdivision();
  for (std::uint32_t n = 0; n < active.size(); ++n) {
    of_cells_[active[n]] = n;
    firsts_.push_back(firsts_.back() + values.at(active[n]).size());
  }
  parallel_for(active.size(), 64, [&](std::size_t n) {
    const Vec3 center = subdivision.mesh().cell_center(active[n]);
    double volume = 0;
    subdivision.for_each_tetrahedron(active[n], [&](const std::array<Index, 4>& corners) {
      const double own = subdivision.volume(corners) / 20;
      Vec3 sum;
      const auto add = [&](const Vec3& d) {
        const std::array<double, 6> products{d.x * d.x, d.y * d.y, d.z * d.z,
                                             d.x * d.y, d.x * d.z, d.y * d.z};
        for (std::size_t i = 0; i < 6; ++i) moments_[n][i] += own * products[i];
      };
      for (const Index corner : corners) {
        const Vec3 d = subdivision.position(corner) - center;
        sum += d;
        add(d);
      }
      add(sum);
      volume += 20 * own;
    });
    for (double& moment : moments_[n]) moment = volume > 0 ? moment / volume : 0;
  });
}

/// Finds the active cells near one. Distances are in cells: they are those after the cell, in the mean of it
/// and those round it, was made to have the second moments of a unit cube.
void MeshErrors::find_places(std::size_t n, std::vector<Place>& places) const {
  thread_local std::vector<Index> ring, wider;
  const Index cell = values_.active_cells()[n];
  const PolyhedralMesh& mesh = values_.subdivision().mesh();
  places.clear();
  ring.assign(1, cell);
  values_.subdivision().find_ring(ring, wider);
  std::array<double, 6> sum{};
  double count = 0;
  for (const Index c : wider) {
    if (of_cells_[c] == kNone) continue;
    for (std::size_t i = 0; i < 6; ++i) sum[i] += moments_[of_cells_[c]][i];
    ++count;
  }
  for (double& moment : sum) moment *= 12 / count;
  Eigen::Matrix3d moments;
  moments << sum[0], sum[3], sum[4], sum[3], sum[1], sum[5], sum[4], sum[5], sum[2];
  moments.diagonal().array() += 1e-9 * moments.trace();
  const Eigen::LLT<Eigen::Matrix3d> shape(moments);
  if (shape.info() != Eigen::Success) return;
  values_.subdivision().find_ring(wider, ring);
  for (const Index c : ring) {
    if (of_cells_[c] == kNone) continue;
    const Vec3 d = mesh.cell_center(c) - mesh.cell_center(cell);
    const Eigen::Vector3d x = shape.matrixL().solve(Eigen::Vector3d(d.x, d.y, d.z));
    if (x.squaredNorm() <= ErrorCriterion::kSquaredReach + 1e-9)
      places.push_back({of_cells_[c], {x[0], x[1], x[2]}, x.squaredNorm()});
  }
}

double MeshErrors::width_of(std::size_t n, std::size_t e) const {
  const double width = widths_[values_.at(values_.active_cells()[n])[e].material];
  return (width > 0 ? width : 1) * extents_[firsts_[n] + e];
}

/// Returns whether all materials that the other cell holds are in this one too.
bool MeshErrors::has_no_third(std::size_t n, std::size_t other) const {
  const std::span<const Entry> own = values_.at(values_.active_cells()[n]);
  return std::ranges::all_of(values_.at(values_.active_cells()[other]), [&](const Entry& there) {
    return there.fraction <= 0 || std::ranges::any_of(own, [&](const Entry& here) {
             return here.material == there.material && here.fraction > 0;
           });
  });
}

MeshErrors::Prediction MeshErrors::predict(std::size_t n, std::size_t e,
                                           const std::vector<Place>& places) const {
  const Index cell = values_.active_cells()[n];
  const Entry& entry = values_.at(cell)[e];
  const double width = width_of(n, e);
  Prediction result;
  Eigen::Matrix<double, 10, 10> squares = Eigen::Matrix<double, 10, 10>::Zero();
  Quadric right = Quadric::Zero();
  double sum = 0;
  std::size_t count = 0;
  const auto weight = [&](double value) { return std::exp(-value * value / (width * width)); };
  Eigen::Matrix3d real = Eigen::Matrix3d::Zero(), across = Eigen::Matrix3d::Zero();
  const PolyhedralMesh& mesh = values_.subdivision().mesh();
  for (const Place& place : places) {
    const Index other = values_.active_cells()[place.n];
    if (place.n == n || films_.holds(other)) continue;
    const std::span<const Entry> there = values_.at(other);
    const auto found = std::ranges::find(there, entry.material, &Entry::material);
    if (found == there.end() || !is_mixed(*found)) continue;
    const double w = std::exp(-0.5 * place.squared) * weight(found->value);
    const Quadric row = terms(place.x);
    squares.selfadjointView<Eigen::Lower>().rankUpdate(row, w);
    right += w * found->value * row;
    sum += w;
    ++count;
    result.is_alone = result.is_alone && has_no_third(n, place.n);
    const Vec3 d = mesh.cell_center(other) - mesh.cell_center(cell);
    const Eigen::Vector3d x(place.x[0], place.x[1], place.x[2]), away(d.x, d.y, d.z);
    real += w * away * away.transpose();
    across += w * away * x.transpose();
  }
  if (count < ErrorCriterion::kLeastNeighbours || sum < ErrorCriterion::kLeastWeight) return result;
  squares.diagonal().array() += 1e-9 * sum;
  const Eigen::LDLT<Eigen::Matrix<double, 10, 10>, Eigen::Lower> solver(squares);
  const Quadric fitted = solver.solve(right), unit = solver.solve(Quadric::Unit(9));
  const double value = fitted[9], growth = unit[9];
  if (!std::isfinite(value) || !std::isfinite(growth)) return result;
  result.value = value;
  const double w = weight(entry.value);
  result.own = w * growth / (1 + w * growth);
  const double extent = extents_[firsts_[n] + e];
  result.curved = (fitted[0] + fitted[1] + fitted[2]) / (extent * extent) * inner_diameter(mesh, cell);
  result.known = true;
  // The gradient in space: coordinates are linear in the place.
  real.diagonal().array() += 1e-12 * real.trace();
  const Eigen::Vector3d slope = real.ldlt().solve(across * fitted.segment<3>(6));
  const Vec3 towards = normalized(Vec3{slope[0], slope[1], slope[2]});
  if (widths_[entry.material] > 0) {
    // The cell itself is a part of the width, which is that of the cells round it.
    const double self = values_.extent(cell, towards);
    const double squared = width * width + kCellVariance * (self * self - extent * extent);
    result.fraction = normal_probability(value / std::sqrt(std::max(squared, 0.25 * width * width)));
  } else {
    result.fraction = part_behind(cell, towards, value);
  }
  return result;
}

/// Returns the part of a cell on the side, to which `towards` points, of a plane at this distance before the
/// centre.
double MeshErrors::part_behind(Index cell, const Vec3& towards, double distance) const {
  const MeshSubdivision& subdivision = values_.subdivision();
  const Vec3 center = subdivision.mesh().cell_center(cell);
  double part = 0, volume = 0;
  subdivision.for_each_tetrahedron(cell, [&](const std::array<Index, 4>& corners) {
    std::array<double, 4> heights{};
    for (std::size_t i = 0; i < 4; ++i)
      heights[i] = distance + dot(towards, subdivision.position(corners[i]) - center);
    const double own = subdivision.volume(corners);
    part += own * positive_part(heights).volume;
    volume += own;
  });
  return volume > 0 ? std::clamp(part / volume, 0.0, 1.0) : 0.5;
}

/// Returns whether a cell is mixed, by other materials than films.
bool MeshErrors::is_examined(Index cell) const {
  return !films_.holds(cell) && std::ranges::any_of(values_.at(cell), is_mixed);
}

double MeshErrors::deviation(double width) const {
  std::vector<std::uint32_t> mixed;
  const std::vector<Index>& active = values_.active_cells();
  for (std::uint32_t n = 0; n < active.size(); ++n) {
    if (is_examined(active[n])) mixed.push_back(n);
  }
  const std::size_t stride = ErrorCriterion::stride(mixed.size());
  std::vector<ErrorCriterion::Sample> samples((mixed.size() + stride - 1) / stride);
  parallel_for(samples.size(), 32, [&](std::size_t s) {
    thread_local std::vector<Place> places;
    const std::size_t n = mixed[s * stride];
    find_places(n, places);
    const std::span<const Entry> own = values_.at(active[n]);
    for (std::size_t e = 0; e < own.size(); ++e) {
      const auto f = static_cast<double>(own[e].fraction);
      if (f < ErrorCriterion::kLeastClear || f > 1 - ErrorCriterion::kLeastClear) continue;
      const Prediction found = predict(n, e, places);
      const bool is_sharp = widths_[own[e].material] == 0;
      if (!found.known || (is_sharp && !found.is_alone)) continue;
      const double off = std::abs(found.fraction - f);
      if (off > samples[s].off) samples[s] = {off, found.curved, own[e].material, is_sharp};
    }
  });
  const std::size_t wanted = mixed.size() / stride;
  return ErrorCriterion::deviation(std::move(samples), wanted, values_.material_count(), width).value_or(0);
}

void MeshErrors::smooth(double deviation, MeshValues& values) const {
  const std::vector<Index>& active = values_.active_cells();
  std::vector<Prediction> found(firsts_.back());
  std::vector<std::vector<std::uint32_t>> near(active.size());
  parallel_for(active.size(), 32, [&](std::size_t n) {
    const std::span<const Entry> own = values_.at(active[n]);
    if (!is_examined(active[n])) return;
    thread_local std::vector<Place> places;
    find_places(n, places);
    for (std::size_t e = 0; e < own.size(); ++e) {
      if (is_mixed(own[e])) found[firsts_[n] + e] = predict(n, e, places);
    }
    for (const Place& place : places) {
      if (place.squared <= kSquaredNear + 1e-9) near[n].push_back(static_cast<std::uint32_t>(place.n));
    }
  });
  const auto square = [&](std::size_t n, std::uint16_t material) {
    const std::span<const Entry> own = values_.at(active[n]);
    for (std::size_t e = 0; e < own.size(); ++e) {
      const Prediction& there = found[firsts_[n] + e];
      if (own[e].material != material || !there.known) continue;
      const double off = there.fraction - static_cast<double>(own[e].fraction);
      return off * off;
    }
    return -1.0;
  };
  std::vector<double> kept(found.size(), 1);
  parallel_for(active.size(), 64, [&](std::size_t n) {
    const std::span<const Entry> own = values_.at(active[n]);
    for (std::size_t e = 0; e < own.size(); ++e) {
      if (!found[firsts_[n] + e].known) continue;
      double sum = 0;
      int count = 0;
      for (const std::uint32_t other : near[n]) {
        if (const double off = square(other, own[e].material); off >= 0) sum += off, ++count;
      }
      kept[firsts_[n] + e] =
          ErrorCriterion::part_kept(sum / std::max(count, 1), deviation, found[firsts_[n] + e].own);
    }
  });
  for (std::size_t n = 0; n < active.size(); ++n) {
    const std::span<Entry> own = values.at(active[n]);
    float sum = 0;
    bool changed = false;
    for (std::size_t e = 0; e < own.size(); ++e) {
      const Prediction& there = found[firsts_[n] + e];
      if (there.known) {
        const double part = kept[firsts_[n] + e];
        own[e].value = there.value + part * (own[e].value - there.value);
        const double fraction =
            there.fraction + part * (static_cast<double>(own[e].fraction) - there.fraction);
        own[e].fraction = static_cast<float>(std::clamp(fraction, 1e-6, 1 - 1e-6));
        changed = true;
      }
      sum += own[e].fraction;
    }
    for (Entry& entry : own) {
      if (changed && is_mixed(entry)) entry.fraction = std::clamp(entry.fraction / sum, 1e-6f, 1 - 1e-6f);
    }
  }
}

void MeshErrors::take_means(std::vector<double>& numbers) const {
  const std::vector<Index>& active = values_.active_cells();
  std::vector<double> means = numbers;
  parallel_for(active.size(), 32, [&](std::size_t n) {
    const std::span<const Entry> own = values_.at(active[n]);
    if (std::ranges::none_of(own, is_mixed)) return;
    thread_local std::vector<Place> places;
    find_places(n, places);
    for (std::size_t e = 0; e < own.size(); ++e) {
      if (!is_mixed(own[e]) || widths_[own[e].material] == 0) continue;
      double sum = 0, weights = 0;
      for (const Place& place : places) {
        if (place.squared > kSquaredNear + 1e-9) continue;
        const std::span<const Entry> there = values_.at(active[place.n]);
        const auto found = std::ranges::find(there, own[e].material, &Entry::material);
        if (found == there.end() || !is_mixed(*found)) continue;
        const std::size_t at = static_cast<std::size_t>(found - there.begin());
        const double steps = found->value / width_of(place.n, at),
                     w = std::exp2(-place.squared) * std::exp(-steps * steps);
        sum += w * numbers[firsts_[place.n] + at];
        weights += w;
      }
      if (weights > 0) means[firsts_[n] + e] = sum / weights;
    }
  });
  numbers.swap(means);
}

}  // namespace adamas::interfaces
