#include "isosurface/gradients/gradient_estimator.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace adamas {

using namespace isosurface;

namespace {

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
const Vec3 kSpacing{0.5, 2, 1.25};

template <class Function>
Neighbourhood sampled(const Function& f) {
  Neighbourhood values;
  for (int k = -1; k <= 1; ++k) {
    for (int j = -1; j <= 1; ++j) {
      for (int i = -1; i <= 1; ++i)
        values[neighbour(i, j, k)] = f(Vec3{i * kSpacing.x, j * kSpacing.y, k * kSpacing.z});
    }
  }
  return values;
}

double linear(const Vec3& p) { return 7 + 3 * p.x - 2 * p.y + 0.5 * p.z; }
const Vec3 kSlope{3, -2, 0.5};

/// Solves the least-squares problem of the directional derivatives by Gauss-Newton steps along each axis in
/// turn until the solution no longer moves. This is slow, but uses no matrix.
Vec3 minimised(const Neighbourhood& values) {
  struct Equation {
    Vec3 direction;
    double slope;
  };
  std::vector<Equation> equations;
  for (std::size_t n = 14; n < 27; ++n) {  // one of each pair of opposite neighbours
    const int i = static_cast<int>(n % 3) - 1, j = static_cast<int>(n / 3 % 3) - 1,
              k = static_cast<int>(n / 9) - 1;
    const Vec3 step{i * kSpacing.x, j * kSpacing.y, k * kSpacing.z};
    const double ahead = values[n], behind = values[26 - n], middle = values[13];
    const double length = norm(step);
    const Vec3 unit = (1 / length) * step;
    if (!std::isnan(ahead) && !std::isnan(behind)) {
      equations.push_back({unit, (ahead - behind) / (2 * length)});
    } else if (!std::isnan(ahead)) {
      equations.push_back({unit, (ahead - middle) / length});
    } else if (!std::isnan(behind)) {
      equations.push_back({unit, (middle - behind) / length});
    }
  }
  Vec3 g;
  for (int round = 0; round < 20000; ++round) {
    for (int axis = 0; axis < 3; ++axis) {
      double numerator = 0, denominator = 0;
      for (const Equation& e : equations) {
        numerator += e.direction[axis] * (e.slope - dot(e.direction, g));
        denominator += e.direction[axis] * e.direction[axis];
      }
      if (denominator > 0) g[axis] += numerator / denominator;
    }
  }
  return g;
}

TEST(GradientEstimator, IsExactOnLinearFieldsAtEveryBorder) {
  const GradientEstimator estimate(kSpacing);
  // The bits of `sides` say on which sides of the middle there are neighbours: for each axis, the lower bit
  // for the side below, the higher one for the side above.
  for (int sides = 0; sides < 64; ++sides) {
    Neighbourhood values = sampled(linear);
    Vec3 expected = kSlope;
    for (int axis = 0; axis < 3; ++axis) {
      const int there = sides >> (2 * axis) & 3;
      if (there == 0) expected[axis] = 0;
      for (std::size_t n = 0; n < 27; ++n) {
        const int at = static_cast<int>(axis == 0 ? n % 3 : axis == 1 ? n / 3 % 3 : n / 9) - 1;
        if ((at < 0 && (there & 1) == 0) || (at > 0 && (there & 2) == 0)) values[n] = kNothing;
      }
    }
    EXPECT_LT(norm(estimate(values) - expected), 1e-12) << sides;
  }
}

TEST(GradientEstimator, IsTheLeastSquaresSolution) {
  const GradientEstimator estimate(kSpacing);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> number(-1, 1);
  for (int trial = 0; trial < 100; ++trial) {
    Neighbourhood values;
    for (double& v : values) v = number(random);
    // Neighbours are missing at random; in the last trials many are.
    for (std::size_t n = 0; n < 27; ++n) {
      if (n != 13 && random() % 300 < static_cast<unsigned>(trial)) values[n] = kNothing;
    }
    EXPECT_LT(norm(estimate(values) - minimised(values)), 1e-8) << trial;
  }
}

TEST(GradientEstimator, OfASmoothFieldIsSecondOrder) {
  const auto error = [](double h) {
    const GradientEstimator estimate(h * kSpacing);
    const auto f = [h](const Vec3& p) {
      return std::sin(1 + h * p.x) * std::exp(0.3 * h * p.y) + std::cos(h * p.z - 0.4);
    };
    const Vec3 expected{std::cos(1.0), 0.3 * std::sin(1.0), std::sin(0.4)};
    return norm(estimate(sampled(f)) - expected);
  };
  EXPECT_NEAR(std::log2(error(0.02) / error(0.01)), 2, 0.05);
}

TEST(GradientEstimator, OfNothingIsZero) {
  const GradientEstimator estimate(kSpacing);
  Neighbourhood values = sampled(linear);
  values[13] = kNothing;
  EXPECT_EQ(norm(estimate(values)), 0);
  values.fill(kNothing);
  values[13] = 4;
  EXPECT_EQ(norm(estimate(values)), 0);
  values[14] = std::numeric_limits<double>::infinity();
  EXPECT_EQ(norm(estimate(values)), 0);
}

}  // namespace
}  // namespace adamas
