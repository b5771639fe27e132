#include "isosurface/volume/z_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace adamas {

using namespace isosurface;

namespace {

/// Interleaves the bits one by one, as the order is defined.
std::uint64_t interleaved(LatticePoint p, int bits) {
  std::uint64_t z = 0;
  for (int b = 0; b < bits; ++b) {
    for (int axis = 0; axis < 3; ++axis) z |= static_cast<std::uint64_t>(p[axis] >> b & 1) << (3 * b + axis);
  }
  return z;
}

std::vector<LatticePoint> all_points(int bits) {
  std::vector<LatticePoint> points;
  const int side = 1 << bits;
  for (int k = 0; k < side; ++k) {
    for (int j = 0; j < side; ++j) {
      for (int i = 0; i < side; ++i) points.push_back({i, j, k});
    }
  }
  return points;
}

TEST(ZOrder, SortsByLodThenByInterleavedBits) {
  for (int bits = 1; bits <= 5; ++bits) {
    std::vector<LatticePoint> points = all_points(bits);
    const auto place = [bits](LatticePoint p) {
      return std::pair(-std::min(trailing_zeros(p), bits), interleaved(p, bits));
    };
    std::sort(points.begin(), points.end(),
              [&](LatticePoint a, LatticePoint b) { return place(a) < place(b); });
    const ZOrder order(bits);
    ASSERT_EQ(order.size(), points.size());
    for (std::size_t n = 0; n < points.size(); ++n) {
      ASSERT_EQ(order.index(points[n]), n);
      ASSERT_EQ(order.point(n), points[n]);
    }
  }
}

TEST(ZOrder, HasEveryLodAsAPrefix) {
  const ZOrder order(4);
  for (const LatticePoint p : all_points(4)) {
    for (int lod = 0; lod <= 4; ++lod)
      EXPECT_EQ(order.index(p) < order.size(lod), trailing_zeros(p) >= lod) << p.i << p.j << p.k << lod;
  }
}

TEST(ZOrder, IndexAndPointAreInverseAtAnySize) {
  std::mt19937_64 random(3);
  for (int bits = 1; bits <= ZOrder::kMaxBits; ++bits) {
    const ZOrder order(bits);
    const std::int32_t mask = (1 << bits) - 1;
    for (int trial = 0; trial < 2000; ++trial) {
      const int shift = static_cast<int>(random() % static_cast<unsigned>(bits));
      const auto coordinate = [&] {
        return static_cast<std::int32_t>(random()) & mask & ~((1 << shift) - 1);
      };
      const LatticePoint p{coordinate(), coordinate(), coordinate()};
      const std::uint64_t index = order.index(p);
      ASSERT_LT(index, order.size());
      ASSERT_EQ(order.point(index), p);
    }
    const std::uint64_t last = order.size() - 1;
    EXPECT_EQ(order.index(order.point(last)), last);
    EXPECT_EQ(order.point(last), (LatticePoint{mask, mask, mask}));
  }
}

}  // namespace
}  // namespace adamas
