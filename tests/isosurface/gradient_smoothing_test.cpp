#include "isosurface/gradients/gradient_smoothing.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "adamas/geometry.h"
#include "core/base/parallel.h"
#include "tests/support/smoothed_block.h"

namespace adamas {

using namespace isosurface;

namespace {

using Sizes = std::array<std::size_t, 3>;

struct Block {
  Sizes sizes;
  std::vector<Gradient> gradients;

  explicit Block(const Sizes& n, const Gradient& g = {}) : sizes(n), gradients(n[0] * n[1] * n[2], g) {}
  [[nodiscard]] std::size_t index(const Sizes& p) const { return p[0] + sizes[0] * (p[1] + sizes[1] * p[2]); }
  [[nodiscard]] Sizes place(std::size_t at) const {
    return {at % sizes[0], at / sizes[0] % sizes[1], at / sizes[0] / sizes[1]};
  }
  std::size_t smooth(const GradientSmoothingOptions& options) {
    return test::smooth_gradients(gradients, sizes, options);
  }
};

Vec3 vector(const Gradient& g) { return {g[0], g[1], g[2]}; }

/// Returns random gradients about one direction, with lengths from 0.5 to 2; some are zero.
Block random_block(const Sizes& sizes, unsigned seed, unsigned holes_of_ten = 2) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> number(-0.4F, 0.4F);
  Block block(sizes);
  for (Gradient& g : block.gradients) {
    if (random() % 10 >= holes_of_ten) g = {number(random), 1 + number(random), number(random) - 0.5F};
  }
  return block;
}

/// Smooths in double precision, step by step as the definition says.
Block plainly_smoothed(const Block& block, const GradientSmoothingOptions& options) {
  const std::size_t count = block.gradients.size();
  std::vector<Vec3> now(count), anchors(count);
  double mean_square = 0;
  std::size_t not_zero = 0;
  for (std::size_t i = 0; i < count; ++i) {
    now[i] = vector(block.gradients[i]);
    mean_square += squared_norm(now[i]);
    not_zero += squared_norm(now[i]) > 0 ? 1 : 0;
  }
  mean_square /= static_cast<double>(not_zero);
  const double least = 1e-6 * std::sqrt(mean_square);
  const std::vector<Vec3> original = now;
  const auto average = [&](const std::vector<Vec3>& of, std::size_t at) {
    Vec3 sum;
    double weights = 0;
    const Sizes p = block.place(at);
    for (int n = 0; n < 27; ++n) {
      const std::array<int, 3> step{n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1};
      Sizes q;
      bool inside = true;
      double weight = 1;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        q[axis] = p[axis] + static_cast<std::size_t>(step[axis]);
        inside &= q[axis] < block.sizes[axis];
        weight *= 2 - std::abs(step[axis]);
      }
      if (!inside || norm(of[block.index(q)]) <= least) continue;
      sum += weight * of[block.index(q)];
      weights += weight;
    }
    return weights > 0 ? (1 / weights) * sum : Vec3{};
  };
  for (int round = 0; round < options.free_rounds + options.constrained_rounds; ++round) {
    if (round == options.free_rounds) anchors = now;
    const std::vector<Vec3> before = now;
    for (std::size_t i = count; i-- > 0;) {
      const Vec3 a = average(before, i);
      if (norm(a) <= least) continue;
      now[i] = a;
      if (round < options.free_rounds || norm(original[i]) <= least) continue;
      const Vec3 d = a - anchors[i];
      if (norm(d) == 0) continue;
      const double k = options.freedom * mean_square;
      now[i] = anchors[i] + std::min(1.0, k / (norm(anchors[i]) * norm(d))) * d;
    }
  }
  Block result = block;
  for (std::size_t i = 0; i < count; ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      result.gradients[i][static_cast<std::size_t>(axis)] = static_cast<float>(now[i][axis]);
    }
  }
  return result;
}

void expect_near(const Block& a, const Block& b, double tolerance) {
  ASSERT_EQ(a.gradients.size(), b.gradients.size());
  for (std::size_t i = 0; i < a.gradients.size(); ++i) {
    ASSERT_LT(distance(vector(a.gradients[i]), vector(b.gradients[i])), tolerance) << i;
  }
}

const std::vector<GradientSmoothingOptions> kOptions = {{0, 0, 0.25}, {1, 0, 0.25}, {5, 0, 0.25}, {0, 1, 0.1},
                                                        {2, 3, 0.02}, {3, 4, 0.25}, {1, 2, 0}};

TEST(GradientSmoothing, IsWhatTheDefinitionSays) {
  for (const Sizes& sizes : {Sizes{7, 6, 5}, {1, 1, 1}, {1, 9, 1}, {2, 1, 8}, {11, 3, 2}}) {
    for (const unsigned holes : {0u, 2u, 8u}) {
      for (const auto& options : kOptions) {
        Block block = random_block(sizes, 3, holes);
        const Block expected = plainly_smoothed(block, options);
        block.smooth(options);
        expect_near(block, expected, 1e-5);
      }
    }
  }
}

TEST(GradientSmoothing, ConstantFieldsStay) {
  for (const auto& options : kOptions) {
    Block block({6, 7, 8}, {0.3F, -2, 5e-3F});
    const Block before = block;
    EXPECT_EQ(block.smooth(options), 0u);
    expect_near(block, before, 1e-6);
    Block zero({3, 4, 5});
    EXPECT_EQ(zero.smooth(options), 60u);
    EXPECT_EQ(zero.gradients, Block({3, 4, 5}).gradients);
  }
  EXPECT_EQ(test::smooth_gradients({}, {0, 3, 3}), 0u);
}

TEST(GradientSmoothing, DegenerateRegionsAreFilledFromTheirBorders) {
  // There are two walls, and no gradients between them.
  Block walls({12, 5, 4});
  for (std::size_t i = 0; i < walls.gradients.size(); ++i) {
    if (walls.place(i)[0] == 0) walls.gradients[i] = {1, 0, 0};
    if (walls.place(i)[0] == 11) walls.gradients[i] = {0, 1, 0};
  }
  const std::size_t plane = 5 * 4;
  for (int rounds = 0; rounds <= 6; ++rounds) {
    Block block = walls;
    // Each round fills one more sample from either side.
    const auto left = static_cast<std::size_t>(std::max(0, 10 - 2 * rounds)) * plane;
    EXPECT_EQ(block.smooth({rounds, 0, 0.25}), left);
    block = walls;
    EXPECT_EQ(block.smooth({0, rounds, 0}), left);
  }
  Block block = walls;
  block.smooth({0, 1000, 0});
  for (std::size_t i = 0; i < block.gradients.size(); ++i) {
    const Sizes p = block.place(i);
    // The walls have no freedom and stay; between them the stationary solution of diffusion is linear.
    const double x = static_cast<double>(p[0]) / 11;
    EXPECT_LT(distance(vector(block.gradients[i]), {1 - x, x, 0}), 1e-3) << i;
  }
}

TEST(GradientSmoothing, ShortAveragesAreNotUsed) {
  // Where the average cancels, the gradient stays as it is. The weights are 2 and 1 here.
  Block two({2, 1, 1});
  two.gradients = {{1, 2, 3}, {-2, -4, -6}};
  two.smooth({1, 0, 0.25});
  EXPECT_EQ(two.gradients[0], (Gradient{1, 2, 3}));
  EXPECT_EQ(two.gradients[1], (Gradient{-1, -2, -3}));
  Block three({3, 1, 1});
  three.gradients = {{1, 2, 3}, {}, {-1, -2, -3}};
  three.smooth({1, 1, 0.25});
  EXPECT_EQ(three.gradients[1], Gradient{});
  // A gradient of the size of rounding errors counts as zero, so it is filled.
  Block noise({4, 1, 1}, {0, 1, 0});
  noise.gradients[2] = {1e-9F, 0, 0};
  EXPECT_EQ(noise.smooth({1, 0, 0.25}), 0u);
  expect_near(noise, Block({4, 1, 1}, {0, 1, 0}), 1e-6);
}

TEST(GradientSmoothing, FirstPhaseStaysWithinItsNeighbours) {
  Block block = random_block({9, 8, 7}, 11, 3);
  for (int round = 0; round < 4; ++round) {
    const Block before = block;
    block.smooth({1, 0, 0.25});
    for (std::size_t i = 0; i < block.gradients.size(); ++i) {
      if (squared_norm(vector(block.gradients[i])) == 0) continue;
      const Sizes p = block.place(i);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        float least = INFINITY, greatest = -INFINITY;
        for (std::size_t at = 0; at < before.gradients.size(); ++at) {
          const Sizes q = before.place(at);
          const bool near = q[0] + 1 >= p[0] && q[0] <= p[0] + 1 && q[1] + 1 >= p[1] && q[1] <= p[1] + 1 &&
                            q[2] + 1 >= p[2] && q[2] <= p[2] + 1;
          if (!near || squared_norm(vector(before.gradients[at])) == 0) continue;
          least = std::min(least, before.gradients[at][axis]);
          greatest = std::max(greatest, before.gradients[at][axis]);
        }
        EXPECT_GE(block.gradients[i][axis], least - 1e-6F);
        EXPECT_LE(block.gradients[i][axis], greatest + 1e-6F);
      }
    }
  }
}

TEST(GradientSmoothing, SecondPhaseHasTheFixedPointsThatItsFreedomSays) {
  // Without freedom gradients that were not zero stay as they are.
  const Block original = random_block({8, 8, 8}, 4, 0);
  Block block = original;
  block.smooth({0, 10, 0});
  EXPECT_EQ(block.gradients, original.gradients);
  // With unlimited freedom the second phase is the first.
  Block constrained = original;
  constrained.smooth({0, 6, 1e9});
  Block free = original;
  free.smooth({6, 0, 0});
  EXPECT_EQ(constrained.gradients, free.gradients);
  // With some freedom gradients stay within their bounds, whatever the number of rounds, and converge.
  double mean_square = 0;
  for (const Gradient& g : original.gradients) mean_square += squared_norm(vector(g));
  mean_square /= static_cast<double>(original.gradients.size());
  block.smooth({0, 400, 0.1});
  Block further = original;
  further.smooth({0, 401, 0.1});
  std::size_t at_bounds = 0;
  for (std::size_t i = 0; i < block.gradients.size(); ++i) {
    const Vec3 from = vector(original.gradients[i]), to = vector(block.gradients[i]);
    const double bound = 0.1 * mean_square / norm(from);
    EXPECT_LE(distance(from, to), bound * (1 + 1e-5));
    at_bounds += distance(from, to) > bound * (1 - 1e-5) ? 1 : 0;
  }
  EXPECT_GT(at_bounds, block.gradients.size() / 4);
  expect_near(block, further, 1e-4);
}

/// Returns a block whose axis a is axis order[a] of the given one, reversed where `reversed` has bit a.
Block turned(const Block& block, const std::array<std::size_t, 3>& order, unsigned reversed) {
  Block result({block.sizes[order[0]], block.sizes[order[1]], block.sizes[order[2]]});
  for (std::size_t i = 0; i < block.gradients.size(); ++i) {
    const Sizes p = block.place(i);
    Sizes q;
    Gradient g;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const bool back = (reversed >> axis & 1) != 0;
      q[axis] = back ? result.sizes[axis] - 1 - p[order[axis]] : p[order[axis]];
      g[axis] = back ? -block.gradients[i][order[axis]] : block.gradients[i][order[axis]];
    }
    result.gradients[result.index(q)] = g;
  }
  return result;
}

TEST(GradientSmoothing, DoesNotDependOnTheOrderOfAxesAndSamples) {
  const Block block = random_block({7, 5, 6}, 8);
  const GradientSmoothingOptions options{3, 4, 0.05};
  Block smoothed = block;
  smoothed.smooth(options);
  for (const auto& order : {Sizes{0, 1, 2}, {1, 0, 2}, {2, 0, 1}, {2, 1, 0}}) {
    for (unsigned reversed = 0; reversed < 8; ++reversed) {
      Block other = turned(block, order, reversed);
      other.smooth(options);
      const Block expected = turned(smoothed, order, reversed);
      if (order == Sizes{0, 1, 2}) {
        EXPECT_EQ(other.gradients, expected.gradients) << reversed;
      } else {
        expect_near(other, expected, 1e-5);
      }
    }
  }
}

TEST(GradientSmoothing, IsTheSameOnAnyNumberOfThreads) {
  const Block block = random_block({60, 90, 8}, 5);
  std::vector<std::vector<Gradient>> results;
  for (const unsigned threads : {1u, 2u, 5u}) {
    set_thread_limit(threads);
    Block other = block;
    other.smooth({});
    results.push_back(other.gradients);
  }
  set_thread_limit(0);
  EXPECT_EQ(results[0], results[1]);
  EXPECT_EQ(results[0], results[2]);
}

}  // namespace
}  // namespace adamas
