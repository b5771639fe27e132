#include "interfaces/mesh_reconstruction/mesh_layer.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "interfaces/reconstruction/cut_volumes.h"

namespace adamas::interfaces {

namespace {

using Index = MeshSubdivision::Index;
using Row = Eigen::Matrix<double, 7, 1>;

constexpr int kRounds = 8;
/// The greatest thickness, and distance of the middle from the cell's centre, in extents of the cells.
constexpr double kThickest = 1.6, kFarthest = 1.2;
/// Fractions of a layer spread across it at most this part of what they do along it, as variances.
constexpr double kFlat = 0.7;
/// The greatest root of the remaining sum of squares, in relation to that of the fractions.
constexpr double kMostLeft = 0.15;
/// A normal turns, a length changes, and a layer bends by at most this in a round; lengths are in sizes of
/// the cell.
constexpr double kMostTurn = 0.3, kMostChange = 0.5, kMostBend = 0.1;
/// Bends are damped more than what is found first.
constexpr double kDamping = 1e-3, kDampingOfBend = 1e-2;

/// A layer fitted to the cells round one.
class LayerFit {
 public:
  LayerFit(const MeshSubdivision& subdivision, Index cell, std::span<const Index> cells,
           std::span<const double> fractions)
      : subdivision_(subdivision),
        mesh_(subdivision.mesh()),
        center_(mesh_.cell_center(cell)),
        size_(std::cbrt(mesh_.cell_volume(cell))),
        cells_(cells),
        fractions_(fractions) {
    for (const Index c : cells)
      weights_.push_back(1 / (1 + squared_norm(mesh_.cell_center(c) - center_) / (size_ * size_)));
  }

  std::optional<MeshLayer> run() {
    std::optional<MeshLayer> layer = guess();
    for (int round = 0; layer && round < kRounds; ++round) improve(*layer);
    if (!layer || !is_good(*layer)) return {};
    return layer;
  }

 private:
  /// Returns the layer through the mean of the fractions, across the direction in which they spread least;
  /// none if they form no layer.
  [[nodiscard]] std::optional<MeshLayer> guess() const {
    double sum = 0, most = 0;
    Vec3 mean;
    for (std::size_t i = 0; i < cells_.size(); ++i) {
      const double own = weights_[i] * fractions_[i] * mesh_.cell_volume(cells_[i]);
      sum += own;
      mean += own * (mesh_.cell_center(cells_[i]) - center_);
      most = std::max(most, fractions_[i]);
    }
    if (!(sum > 0)) return {};
    mean *= 1 / sum;
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
    for (std::size_t i = 0; i < cells_.size(); ++i) {
      const Vec3 d = mesh_.cell_center(cells_[i]) - center_ - mean;
      const Eigen::Vector3d x(d.x, d.y, d.z);
      spread += weights_[i] * fractions_[i] * mesh_.cell_volume(cells_[i]) / sum * x * x.transpose();
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> found(spread);
    if (!(found.eigenvalues()[0] < kFlat * found.eigenvalues()[1])) return {};
    const Eigen::Vector3d n = found.eigenvectors().col(0);
    const Vec3 normal{n[0], n[1], n[2]};
    return MeshLayer{normal, dot(mean, normal), std::clamp(most, 0.1, 0.9) * size_, {}};
  }

  /// Moves a layer towards the least squares by the method of Gauss and Newton, damped.
  void improve(MeshLayer& layer) const {
    const Vec3 u = normalized(std::abs(layer.normal.x) < 0.6 ? cross(layer.normal, {1, 0, 0})
                                                             : cross(layer.normal, {0, 1, 0})),
               v = cross(layer.normal, u);
    Eigen::Matrix<double, 7, 7> squares = Eigen::Matrix<double, 7, 7>::Zero();
    Row right = Row::Zero();
    for (std::size_t i = 0; i < cells_.size(); ++i) {
      if (!(mesh_.cell_volume(cells_[i]) > 0)) continue;
      Row row = Row::Zero();
      const double missing = fractions_[i] - part(cells_[i], layer, u, v, row);
      squares += weights_[i] * row * row.transpose();
      right += weights_[i] * missing * row;
    }
    const double greatest = squares.diagonal().head<4>().maxCoeff();
    squares.diagonal().array() += kDamping * greatest + 1e-12;
    squares.diagonal().tail<3>().array() += kDampingOfBend * greatest;
    const Row move = squares.ldlt().solve(right);
    const auto limited = [](double x, double most) { return std::clamp(x, -most, most); };
    layer.normal =
        normalized(layer.normal + limited(move[0], kMostTurn) * u + limited(move[1], kMostTurn) * v);
    layer.middle += size_ * limited(move[2], kMostChange);
    layer.thickness = std::clamp(layer.thickness + size_ * limited(move[3], kMostChange), 0.01 * size_,
                                 3 * kThickest * size_);
    const auto bend = [&](double by, const Vec3& a, const Vec3& b) {
      const double amount = limited(by, kMostBend) / size_;
      layer.bend[0] += amount * a.x * b.x, layer.bend[1] += amount * a.y * b.y,
          layer.bend[2] += amount * a.z * b.z;
      layer.bend[3] += 0.5 * amount * (a.x * b.y + a.y * b.x);
      layer.bend[4] += 0.5 * amount * (a.x * b.z + a.z * b.x);
      layer.bend[5] += 0.5 * amount * (a.y * b.z + a.z * b.y);
    };
    bend(move[4], u, u), bend(move[5], u, v), bend(move[6], v, v);
  }

  /// Returns the part of a cell in a layer, and sets its derivatives by turns towards u and v, by lengths,
  /// and by bends along u, both and v; all in sizes of the cell.
  double part(Index cell, const MeshLayer& layer, const Vec3& u, const Vec3& v, Row& row) const {
    double inside = 0;
    subdivision_.for_each_tetrahedron(cell, [&](const std::array<Index, 4>& corners) {
      const double own = subdivision_.volume(corners) / mesh_.cell_volume(cell);
      std::array<Vec3, 4> x;
      std::array<double, 4> heights{};
      for (std::size_t i = 0; i < 4; ++i) {
        x[i] = subdivision_.position(corners[i]) - center_;
        heights[i] = layer.height(x[i]);
      }
      for (const double side : {-1.0, 1.0}) {
        std::array<double, 4> above = heights;
        for (double& height : above) height -= 0.5 * side * layer.thickness;
        const PositivePart found = positive_part(above);
        inside -= side * own * found.volume;
        for (std::size_t i = 0; i < 4; ++i) {
          const double by = -side * own * found.growth[i];
          const double along_u = dot(u, x[i]), along_v = dot(v, x[i]);
          row[0] += by * along_u;
          row[1] += by * along_v;
          row[4] -= 0.5 * by * along_u * along_u / size_;
          row[5] -= 0.5 * by * along_u * along_v / size_;
          row[6] -= 0.5 * by * along_v * along_v / size_;
          row[2] -= by * size_;
          row[3] -= 0.5 * side * by * size_;
        }
      }
    });
    return inside;
  }

  [[nodiscard]] bool is_good(const MeshLayer& layer) const {
    double left = 0, all = 0, extent = 0, weights = 0;
    for (std::size_t i = 0; i < cells_.size(); ++i) {
      const double off = fractions_[i] - parts_of_cell(subdivision_, cells_[i], layer, center_).inside;
      left += weights_[i] * off * off;
      all += weights_[i] * fractions_[i] * fractions_[i];
      if (!(fractions_[i] > 0)) continue;
      extent += weights_[i] * std::cbrt(mesh_.cell_volume(cells_[i]));
      weights += weights_[i];
    }
    extent /= weights;
    return left <= kMostLeft * kMostLeft * all && layer.thickness <= kThickest * extent &&
           std::abs(layer.middle) <= kFarthest * extent;
  }

  const MeshSubdivision& subdivision_;
  const PolyhedralMesh& mesh_;
  Vec3 center_;
  double size_;
  std::span<const Index> cells_;
  std::span<const double> fractions_;
  std::vector<double> weights_;
};

}  // namespace

LayerParts parts_of_cell(const MeshSubdivision& subdivision, Index cell, const MeshLayer& layer,
                         const Vec3& center) {
  LayerParts result;
  const double volume = subdivision.mesh().cell_volume(cell);
  if (!(volume > 0)) return result;
  subdivision.for_each_tetrahedron(cell, [&](const std::array<Index, 4>& corners) {
    std::array<double, 4> low{}, high{};
    for (std::size_t i = 0; i < 4; ++i) {
      const double height = layer.height(subdivision.position(corners[i]) - center);
      low[i] = height + 0.5 * layer.thickness, high[i] = height - 0.5 * layer.thickness;
    }
    const double own = subdivision.volume(corners) / volume, above = positive_part(high).volume;
    result.inside += own * (positive_part(low).volume - above);
    result.above += own * above;
  });
  return result;
}

double inner_radius(const PolyhedralMesh& mesh, Index cell) {
  double least = std::numeric_limits<double>::infinity();
  for (const Index f : mesh.faces_of_cell(cell)) {
    const Vec3 away = mesh.face_center(f) - mesh.cell_center(cell);
    least = std::min(least, std::abs(dot(normalized(mesh.face_area(f)), away)));
  }
  return least;
}

std::optional<MeshLayer> fit_layer(const MeshSubdivision& subdivision, Index cell,
                                   std::span<const Index> cells, std::span<const double> fractions) {
  return LayerFit(subdivision, cell, cells, fractions).run();
}

}  // namespace adamas::interfaces
