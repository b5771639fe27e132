#include "interfaces/mesh_reconstruction/mesh_subdivision.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <utility>

#include "core/base/parallel.h"
#include "core/base/sort_unique.h"

namespace adamas::interfaces {

namespace {

/// Cells extend in all directions if, along each, the spread of their centres is at least this part of that
/// of their points: one layer of cells has nearly none across it, two have some 0.4.
constexpr double kLeastSpread = 0.1;
/// Slopes in directions in which the cells do not extend are kept at 0 by this part of the others' weight.
constexpr double kNoSlope = 1e-9;

/// A set of numbers that is cheap to empty.
class Marks {
 public:
  /// Empties the set; numbers are less than `count`.
  void clear(std::size_t count) {
    if (rounds_.size() < count) rounds_.resize(count, 0);
    if (++round_ != 0) return;
    std::ranges::fill(rounds_, 0);
    round_ = 1;
  }
  /// Adds a number; returns whether it is new.
  bool add(std::size_t n) { return std::exchange(rounds_[n], round_) != round_; }

 private:
  std::vector<std::uint32_t> rounds_;
  std::uint32_t round_ = 0;
};

}  // namespace

MeshSubdivision::MeshSubdivision(const PolyhedralMesh& mesh) : mesh_(mesh), face_centers_(mesh.face_count()) {
  parallel_for(face_centers_.size(), 4096, [&](std::size_t f) { face_centers_[f] = mesh.face_center(f); });
}

Vec3 MeshSubdivision::position(Index point) const {
  if (point < mesh_.points().size()) return mesh_.points()[point];
  point -= static_cast<Index>(mesh_.points().size());
  if (point < face_centers_.size()) return face_centers_[point];
  return mesh_.cell_center(point - face_centers_.size());
}

void MeshSubdivision::find_ring(std::span<const Index> cells, std::vector<Index>& ring) const {
  thread_local Marks points, found;
  points.clear(mesh_.points().size());
  found.clear(mesh_.cell_count());
  ring.clear();
  for (const Index c : cells) {
    for (const Index p : mesh_.points_of_cell(c)) {
      if (!points.add(p)) continue;
      for (const Index other : mesh_.cells_round(p)) {
        if (found.add(other)) ring.push_back(other);
      }
    }
  }
  std::ranges::sort(ring);
}

void MeshSubdivision::find_stencil(Index point, Stencil& stencil) const {
  stencil.cells.clear();
  if (point < mesh_.points().size()) {
    const std::span<const Index> round = mesh_.cells_round(point);
    stencil.cells.assign(round.begin(), round.end());
  } else {
    for (const Index p : mesh_.face(point - mesh_.points().size())) {
      const std::span<const Index> round = mesh_.cells_round(p);
      stencil.cells.insert(stencil.cells.end(), round.begin(), round.end());
    }
    sort_unique(stencil.cells);
  }
  if (!extend(stencil.cells)) {
    std::vector<Index> ring;
    find_ring(stencil.cells, ring);
    stencil.cells = std::move(ring);
  }
  set_weights(position(point), stencil);
}

/// Returns whether the centres of cells extend in all directions.
bool MeshSubdivision::extend(std::span<const Index> cells) const {
  const auto spread = [](const std::vector<Vec3>& places) {
    Vec3 mean;
    for (const Vec3& p : places) mean += p;
    mean *= 1.0 / static_cast<double>(places.size());
    Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
    for (const Vec3& p : places) {
      const Eigen::Vector3d d(p.x - mean.x, p.y - mean.y, p.z - mean.z);
      sum += d * d.transpose();
    }
    return Eigen::Matrix3d(sum / static_cast<double>(places.size()));
  };
  std::vector<Vec3> centers, points;
  for (const Index c : cells) {
    centers.push_back(mesh_.cell_center(c));
    for (const Index p : mesh_.points_of_cell(c)) points.push_back(mesh_.points()[p]);
  }
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::Matrix3d> solver(spread(centers), spread(points),
                                                                         Eigen::EigenvaluesOnly);
  return solver.info() == Eigen::Success && solver.eigenvalues()[0] >= kLeastSpread;
}

/// Sets the weights that give the value, at a point, of the linear function that fits values at the centres
/// of the cells.
void MeshSubdivision::set_weights(const Vec3& at, Stencil& stencil) const {
  double longest = 0;
  for (const Index c : stencil.cells) longest = std::max(longest, squared_norm(mesh_.cell_center(c) - at));
  const double unit = longest > 0 ? 1 / std::sqrt(longest) : 1;
  using Row = Eigen::Vector4d;
  Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
  std::vector<Row> rows;
  std::vector<double> weights;
  double sum = 0;
  Row mean = Row::Zero();
  for (const Index c : stencil.cells) {
    const Vec3 d = unit * (mesh_.cell_center(c) - at);
    const Row row(1, d.x, d.y, d.z);
    const double squared = squared_norm(d), w = 1 / std::max(squared * squared, 1e-12);
    rows.push_back(row);
    weights.push_back(w);
    normal += w * row * row.transpose();
    mean += w * row;
    sum += w;
  }
  mean /= sum;
  const Eigen::Matrix3d spread = (normal / sum - mean * mean.transpose()).bottomRightCorner<3, 3>();
  const double trace = spread.trace() * sum;
  normal.diagonal().tail<3>().array() += kNoSlope * (trace > 0 ? trace : 1);
  const Row solution = normal.ldlt().solve(Row(1, 0, 0, 0));
  stencil.weights.clear();
  for (std::size_t i = 0; i < rows.size(); ++i) stencil.weights.push_back(weights[i] * solution.dot(rows[i]));
}

}  // namespace adamas::interfaces
