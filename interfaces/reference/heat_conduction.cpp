#include "interfaces/reference/heat_conduction.h"

#include <Eigen/Eigenvalues>
#include <Eigen/IterativeLinearSolvers>
#include <Eigen/Sparse>
#include <cmath>
#include <limits>

#include "core/base/error.h"
#include "core/geometry/tetrahedron.h"
#include "interfaces/network/domain_faces.h"

namespace adamas::interfaces {

namespace {

using Matrix = Eigen::SparseMatrix<double>;
using Vector = Eigen::VectorXd;

constexpr Eigen::Index kFixed = -1;

/// The equations for the unknowns, which are the temperatures at the points inside the box.
struct Equations {
  std::vector<Eigen::Index> unknown;  ///< by point; kFixed on the box
  Matrix matrix;
  Vector right;
};

/// Points within this distance of a side of the box, relative to its diagonal, lie on it.
constexpr double kOnSide = 1e-12;

Equations assemble(const ConformingMesh& mesh, const HeatProblem& problem) {
  Equations equations;
  Eigen::Index count = 0;
  for (const Vec3& p : mesh.points)
    equations.unknown.push_back(domain_faces_at(problem.box, p, kOnSide) != 0 ? kFixed : count++);
  equations.right = Vector::Zero(count);
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    const Tetrahedron frame(mesh.corners(t));
    const double k = problem.conductivity[mesh.bodies[t].value];
    for (std::size_t i = 0; i < 4; ++i) {
      const Eigen::Index row = equations.unknown[mesh.tetrahedra[t][i]];
      if (row == kFixed) continue;
      for (std::size_t j = 0; j < 4; ++j) {
        const double entry = k * frame.volume * dot(frame.slopes[i], frame.slopes[j]);
        const Eigen::Index column = equations.unknown[mesh.tetrahedra[t][j]];
        if (column == kFixed) {
          equations.right[row] -= entry * problem.boundary(frame.corners[j]);
        } else {
          entries.emplace_back(row, column, entry);
        }
      }
    }
  }
  equations.matrix.resize(count, count);
  equations.matrix.setFromTriplets(entries.begin(), entries.end());
  return equations;
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

std::vector<double> solve_heat_conduction(const ConformingMesh& mesh, const HeatProblem& problem) {
  const Equations equations = assemble(mesh, problem);
  Eigen::ConjugateGradient<Matrix, Eigen::Lower | Eigen::Upper> solver;
  solver.setTolerance(1e-12);
  solver.compute(equations.matrix);
  const Vector solution = solver.solve(equations.right);
  if (solver.info() != Eigen::Success)
    fail("heat conduction: expected conjugate gradients to converge, found an error of {:.3g} after {} steps",
         solver.error(), solver.iterations());
  std::vector<double> temperatures;
  for (std::size_t p = 0; p < mesh.points.size(); ++p) {
    const Eigen::Index i = equations.unknown[p];
    temperatures.push_back(i == kFixed ? problem.boundary(mesh.points[p]) : solution[i]);
  }
  return temperatures;
}

double stiffness_condition_number(const ConformingMesh& mesh, const Box3& box) {
  std::uint32_t bodies = 0;
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    const auto x = mesh.corners(t);
    if (!(signed_volume(x[0], x[1], x[2], x[3]) > 0)) return std::numeric_limits<double>::infinity();
    bodies = std::max(bodies, mesh.bodies[t].value + 1);
  }
  const HeatProblem problem{box, std::vector<double>(bodies, 1.0), [](const Vec3&) { return 0.0; }};
  return condition_number(assemble(mesh, problem).matrix);
}

}  // namespace adamas::interfaces
