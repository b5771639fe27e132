#include "interfaces/comparison/heat_conduction.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <Eigen/IterativeLinearSolvers>
#include <Eigen/Sparse>
#include <functional>

#include "core/geometry/tetrahedron.h"
#include "interfaces/network/domain_faces.h"
#include "tests/interfaces/cutting_meshes.h"

namespace adamas::test {

using namespace interfaces;

namespace {

using Matrix = Eigen::SparseMatrix<double>;
using Vector = Eigen::VectorXd;

/// A problem of steady heat conduction, div(k grad T) = 0 with linear finite elements, a conductivity per
/// body and given temperatures on the box. Its error measures how well a mesh serves solvers.
struct HeatProblem {
  Box3 box;
  std::vector<double> conductivity;  ///< by body
  std::function<double(const Vec3&)> boundary;
};

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

/// Returns the temperatures at the points of the mesh, by conjugate gradients, exact to round-off.
std::vector<double> solve_heat_conduction(const ConformingMesh& mesh, const HeatProblem& problem) {
  const Equations equations = assemble(mesh, problem);
  Eigen::ConjugateGradient<Matrix, Eigen::Lower | Eigen::Upper> solver;
  solver.setTolerance(1e-12);
  solver.compute(equations.matrix);
  const Vector solution = solver.solve(equations.right);
  EXPECT_EQ(solver.info(), Eigen::Success);
  std::vector<double> temperatures;
  for (std::size_t p = 0; p < mesh.points.size(); ++p) {
    const Eigen::Index i = equations.unknown[p];
    temperatures.push_back(i == kFixed ? problem.boundary(mesh.points[p]) : solution[i]);
  }
  return temperatures;
}

/// A ball of another conductivity in a uniform flux (Maxwell): the field is linear inside, and that of a
/// dipole is added outside.
struct BallInFlux {
  Vec3 center{0.5, 0.5, 0.5};
  double radius = 0.3, outside = 1, inside = 10;

  [[nodiscard]] double distance(const Vec3& p) const { return norm(p - center) - radius; }
  [[nodiscard]] double temperature(const Vec3& p) const {
    const Vec3 x = p - center;
    const double sum = inside + 2 * outside, r = norm(x);
    if (r < radius) return 3 * outside / sum * x.x;
    return x.x * (1 - (inside - outside) / sum * std::pow(radius / r, 3));
  }
};

/// Returns the root of the mean squared error, taken at the corners and the middle of each tetrahedron.
double error_of(const ConformingMesh& mesh, const std::vector<double>& temperatures, const BallInFlux& ball) {
  double sum = 0;
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    const auto x = mesh.corners(t);
    const double volume = signed_volume(x[0], x[1], x[2], x[3]);
    double mean = 0, corners = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      const double found = temperatures[mesh.tetrahedra[t][i]];
      mean += found / 4;
      corners += std::pow(found - ball.temperature(x[i]), 2) / 20;
    }
    sum +=
        volume * (corners + 0.8 * std::pow(mean - ball.temperature(0.25 * (x[0] + x[1] + x[2] + x[3])), 2));
  }
  return std::sqrt(sum);
}

TEST(HeatConduction, AcrossABallIsOfOrderTwo) {
  const BallInFlux ball;
  std::vector<double> errors;
  for (const std::uint32_t n : {6u, 12u, 24u}) {
    const ResampledMesh mesh = uniform_mesh(n, [&](const Vec3& p) { return ball.distance(p); });
    const ConformingMesh cut = cut_mesh(mesh, 0.25 / (n * n));
    const auto temperatures = solve_heat_conduction(
        cut, {mesh.box, {ball.outside, ball.inside}, [&](const Vec3& p) { return ball.temperature(p); }});
    errors.push_back(error_of(cut, temperatures, ball));
    std::printf("%2u cells a side: %zu tetrahedra, error %.3g, condition number %.4g\n", n,
                cut.tetrahedra.size(), errors.back(), stiffness_condition_number(cut, mesh.box));
  }
  EXPECT_GT(std::log2(errors[0] / errors[1]), 1.7);
  EXPECT_GT(std::log2(errors[1] / errors[2]), 1.7);
  EXPECT_LT(errors[2], 1e-3);
}

/// Across a plane the temperature is linear on each side, so that linear elements have it exactly.
TEST(HeatConduction, AcrossAPlaneIsExact) {
  const double place = 0.437, k0 = 2, k1 = 5;
  const ResampledMesh mesh = uniform_mesh(5, [&](const Vec3& p) { return p.x - place; });
  const ConformingMesh cut = cut_mesh(mesh, 1e-3);
  const auto exact = [&](const Vec3& p) { return (p.x - place) / (p.x > place ? k0 : k1); };
  // The cut may be off by the tolerance, so the temperature is that of the mesh's own interface only up to
  // this error.
  const auto temperatures = solve_heat_conduction(cut, {mesh.box, {k0, k1}, exact});
  for (std::size_t p = 0; p < cut.points.size(); ++p)
    EXPECT_NEAR(temperatures[p], exact(cut.points[p]), 1e-3);
}

/// The condition number is compared with all eigenvalues of the matrix, whose entries are differences of the
/// energy.
TEST(HeatConduction, ConditionNumberIsThatOfTheMatrix) {
  const ResampledMesh mesh = uniform_mesh(4, [](const Vec3& p) { return p.x - 0.37; });
  const ConformingMesh cut = cut_mesh(mesh, 1e-2);
  std::vector<std::size_t> inside;
  for (std::size_t p = 0; p < cut.points.size(); ++p) {
    const Vec3& x = cut.points[p];
    if (std::min({x.x, x.y, x.z, 1 - x.x, 1 - x.y, 1 - x.z}) > 1e-9) inside.push_back(p);
  }
  const auto energy = [&](const std::vector<double>& u) {
    double sum = 0;
    for (std::size_t t = 0; t < cut.tetrahedra.size(); ++t) {
      const auto x = cut.corners(t);
      Eigen::Matrix3d edges;
      Eigen::Vector3d differences;
      for (int i = 0; i < 3; ++i) {
        const Vec3 e = x[static_cast<std::size_t>(i) + 1] - x[0];
        edges.row(i) << e.x, e.y, e.z;
        differences[i] = u[cut.tetrahedra[t][static_cast<std::size_t>(i) + 1]] - u[cut.tetrahedra[t][0]];
      }
      sum += edges.determinant() / 6 * edges.inverse().operator*(differences).squaredNorm();
    }
    return sum;
  };
  const auto n = static_cast<Eigen::Index>(inside.size());
  Eigen::MatrixXd matrix(n, n);
  std::vector<double> u(cut.points.size(), 0.0);
  Eigen::VectorXd single(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    u[inside[static_cast<std::size_t>(i)]] = 1;
    single[i] = energy(u);
    u[inside[static_cast<std::size_t>(i)]] = 0;
  }
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j) {
      u[inside[static_cast<std::size_t>(i)]] += 1;
      u[inside[static_cast<std::size_t>(j)]] += 1;
      matrix(i, j) = i == j ? single[i] : (energy(u) - single[i] - single[j]) / 2;
      u[inside[static_cast<std::size_t>(i)]] = u[inside[static_cast<std::size_t>(j)]] = 0;
    }
  }
  const Eigen::VectorXd values = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(matrix).eigenvalues();
  const double expected = values[n - 1] / values[0];
  EXPECT_NEAR(stiffness_condition_number(cut, mesh.box), expected, 1e-3 * expected);
}

}  // namespace

}  // namespace adamas::test
