#include "interfaces/fields/linear_fit.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

namespace adamas::interfaces {

void fit_linear_at_origin(const std::vector<Vec3>& offsets, const std::vector<double>& values,
                          std::size_t components, double softening, std::span<double> out) {
  if (offsets.empty()) {
    std::ranges::fill(out, std::numeric_limits<double>::quiet_NaN());
    return;
  }
  // Axes are scaled equally, so that flat cells keep all slopes.
  Vec3 scale;
  for (const Vec3& offset : offsets) {
    for (int axis = 0; axis < 3; ++axis) scale[axis] = std::max(scale[axis], std::abs(offset[axis]));
  }
  for (int axis = 0; axis < 3; ++axis) scale[axis] = scale[axis] > 0 ? 1 / scale[axis] : 1;
  const auto scaled = [&](const Vec3& d) { return Vec3{d.x * scale.x, d.y * scale.y, d.z * scale.z}; };
  double total = 0;
  Vec3 center;
  std::vector<double> mean(components);
  std::vector<double> weights;
  for (std::size_t i = 0; i < offsets.size(); ++i) {
    const double weight = 1 / (squared_norm(offsets[i]) + softening * softening);
    weights.push_back(weight);
    total += weight;
    center += weight * scaled(offsets[i]);
    for (std::size_t c = 0; c < components; ++c) mean[c] += weight * values[i * components + c];
  }
  center *= 1 / total;
  for (double& m : mean) m /= total;

  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  Eigen::Matrix3Xd moment = Eigen::Matrix3Xd::Zero(3, static_cast<Eigen::Index>(components));
  for (std::size_t i = 0; i < offsets.size(); ++i) {
    const Vec3 d = scaled(offsets[i]) - center;
    const Eigen::Vector3d e(d.x, d.y, d.z);
    spread += weights[i] * e * e.transpose();
    for (std::size_t c = 0; c < components; ++c) {
      moment.col(static_cast<Eigen::Index>(c)) += weights[i] * (values[i * components + c] - mean[c]) * e;
    }
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(spread);
  const double least = 1e-9 * solver.eigenvalues().maxCoeff();
  Eigen::Vector3d inverse;
  for (int i = 0; i < 3; ++i) inverse[i] = solver.eigenvalues()[i] > least ? 1 / solver.eigenvalues()[i] : 0;
  const Eigen::Matrix3Xd slopes =
      solver.eigenvectors() * inverse.asDiagonal() * solver.eigenvectors().transpose() * moment;
  for (std::size_t c = 0; c < components; ++c) {
    const Eigen::Vector3d slope = slopes.col(static_cast<Eigen::Index>(c));
    out[c] = mean[c] - (slope[0] * center.x + slope[1] * center.y + slope[2] * center.z);
  }
}

}  // namespace adamas::interfaces
