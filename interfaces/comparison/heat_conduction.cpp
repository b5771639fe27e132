#include "interfaces/comparison/heat_conduction.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Sparse>
#include <cmath>
#include <limits>
#include <vector>

#include "core/geometry/tetrahedron.h"
#include "interfaces/network/domain_faces.h"

namespace adamas::interfaces {

namespace {

using Matrix = Eigen::SparseMatrix<double>;
using Vector = Eigen::VectorXd;

/// Points within this distance of a side of the box, relative to its diagonal, lie on it.
constexpr double kOnSide = 1e-12;

/// Returns the matrix of the equations for the temperatures at the points inside the box.
Matrix stiffness_matrix(const ConformingMesh& mesh, const Box3& box) {
  constexpr Eigen::Index kFixed = -1;
  std::vector<Eigen::Index> unknown;  // by point; kFixed on the box
  Eigen::Index count = 0;
  for (const Vec3& p : mesh.points)
    unknown.push_back(domain_faces_at(box, p, kOnSide) != 0 ? kFixed : count++);
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    const Tetrahedron frame(mesh.corners(t));
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t j = 0; j < 4; ++j) {
        const Eigen::Index row = unknown[mesh.tetrahedra[t][i]], column = unknown[mesh.tetrahedra[t][j]];
        if (row != kFixed && column != kFixed)
          entries.emplace_back(row, column, frame.volume * dot(frame.slopes[i], frame.slopes[j]));
      }
    }
  }
  Matrix matrix(count, count);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

/// Estimates the condition number from the tridiagonal matrix of conjugate gradients, whose extreme
/// eigenvalues approach those of the matrix.
double condition_number(const Matrix& matrix) {
  constexpr int kMostSteps = 3000;
  constexpr double kSmall = 1e-12;
  // Any right side with components along all eigenvectors will do; this one is reproducible.
  Vector residual(matrix.rows());
  for (Eigen::Index i = 0; i < residual.size(); ++i)
    residual[i] = std::fmod(static_cast<double>(i + 1) * 0.6180339887498949, 1.0) - 0.5;
  Vector direction = residual;
  double square = residual.squaredNorm();
  const double enough = kSmall * kSmall * square;
  std::vector<double> diagonal, beside;
  double last_step = 0, last_ratio = 0;
  for (int step = 0; step < kMostSteps && square > enough; ++step) {
    const Vector image = matrix * direction;
    const double curvature = direction.dot(image);
    if (!(curvature > 0)) return std::numeric_limits<double>::infinity();
    const double length = square / curvature;
    diagonal.push_back(1 / length + (step > 0 ? last_ratio / last_step : 0));
    residual -= length * image;
    const double next = residual.squaredNorm(), ratio = next / square;
    beside.push_back(std::sqrt(ratio) / length);
    direction = residual + ratio * direction;
    square = next, last_step = length, last_ratio = ratio;
  }
  if (diagonal.empty()) return 1;
  const auto size = static_cast<Eigen::Index>(diagonal.size());
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver;
  solver.computeFromTridiagonal(Eigen::Map<const Vector>(diagonal.data(), size),
                                Eigen::Map<const Vector>(beside.data(), size - 1), Eigen::EigenvaluesOnly);
  const double least = solver.eigenvalues().minCoeff();
  return least > 0 ? solver.eigenvalues().maxCoeff() / least : std::numeric_limits<double>::infinity();
}

}  // namespace

double stiffness_condition_number(const ConformingMesh& mesh, const Box3& box) {
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    const auto x = mesh.corners(t);
    if (!(signed_volume(x[0], x[1], x[2], x[3]) > 0)) return std::numeric_limits<double>::infinity();
  }
  return condition_number(stiffness_matrix(mesh, box));
}

}  // namespace adamas::interfaces
