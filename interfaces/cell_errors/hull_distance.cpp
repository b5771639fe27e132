#include "interfaces/cell_errors/hull_distance.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace adamas::interfaces {

namespace {

/// The search ends when a step would gain less than this, relative to the size of the points.
constexpr double kEnough = 1e-13;
/// The greatest number of steps, far more than the corners round any nearest point.
constexpr int kMostSteps = 200;

/// The nearest point as a combination of at most dimension + 1 of the points.
class NearestPoint {
 public:
  NearestPoint(std::span<const double> points, std::size_t dimension)
      : points_(points.data(), static_cast<Eigen::Index>(dimension),
                static_cast<Eigen::Index>(points.size() / dimension)) {
    Eigen::Index first = 0;
    greatest_ = std::sqrt(points_.colwise().squaredNorm().maxCoeff());
    points_.colwise().squaredNorm().minCoeff(&first);
    corral_ = {first};
    weights_ = Eigen::VectorXd::Ones(1);
    nearest_ = points_.col(first);
    least_ = nearest_.norm();
  }

  [[nodiscard]] double find() {
    for (int step = 0; step < kMostSteps; ++step) {
      Eigen::Index best = 0;
      const double least = (nearest_.transpose() * points_).minCoeff(&best);
      if (nearest_.squaredNorm() - least <= kEnough * greatest_ * greatest_) break;
      if (std::find(corral_.begin(), corral_.end(), best) != corral_.end()) break;
      corral_.push_back(best);
      weights_.conservativeResize(weights_.size() + 1);
      weights_[weights_.size() - 1] = 0;
      const double before = nearest_.norm();
      while (!move_to_flat()) {
      }
      if (!(nearest_.norm() < before)) break;
      least_ = std::min(least_, nearest_.norm());
    }
    return least_;
  }

 private:
  /// Moves to the nearest point of the affine hull of the points in use, the corral, or as far towards it as
  /// their convex hull reaches, which drops a point from the corral. Returns whether it was reached.
  bool move_to_flat() {
    const auto n = static_cast<Eigen::Index>(corral_.size());
    Eigen::MatrixXd system = Eigen::MatrixXd::Zero(n + 1, n + 1);
    Eigen::VectorXd right = Eigen::VectorXd::Zero(n + 1);
    right[n] = 1;
    const double scale = greatest_ > 0 ? 1 / greatest_ : 1;
    for (Eigen::Index i = 0; i < n; ++i) {
      for (Eigen::Index j = 0; j < n; ++j)
        system(i, j) = (scale * points_.col(corral_[i])).dot(scale * points_.col(corral_[j]));
      system(i, n) = system(n, i) = 1;
    }
    const Eigen::VectorXd wanted = system.fullPivLu().solve(right).head(n);
    double part = 1;
    for (Eigen::Index i = 0; i < n; ++i) {
      if (wanted[i] <= 0) part = std::min(part, weights_[i] / (weights_[i] - wanted[i]));
    }
    part = std::isfinite(part) ? part : 0;
    weights_ += part * (wanted - weights_);
    if (part < 1) drop_least();
    weights_ = weights_.cwiseMax(0) / weights_.cwiseMax(0).sum();
    nearest_.setZero();
    for (std::size_t i = 0; i < corral_.size(); ++i)
      nearest_ += weights_[static_cast<Eigen::Index>(i)] * points_.col(corral_[i]);
    return part == 1 || corral_.size() == 1;
  }

  void drop_least() {
    Eigen::Index least = 0;
    weights_.minCoeff(&least);
    corral_.erase(corral_.begin() + least);
    const Eigen::Index after = weights_.size() - least - 1;
    weights_.segment(least, after) = weights_.tail(after).eval();
    weights_.conservativeResize(weights_.size() - 1);
  }

  Eigen::Map<const Eigen::MatrixXd> points_;
  double greatest_ = 0;
  std::vector<Eigen::Index> corral_;
  Eigen::VectorXd weights_, nearest_;
  double least_ = 0;  ///< the least distance of all points that the search has visited
};

}  // namespace

double distance_from_hull(std::span<const double> points, std::size_t dimension) {
  if (points.empty()) return std::numeric_limits<double>::infinity();
  return NearestPoint(points, dimension).find();
}

}  // namespace adamas::interfaces
