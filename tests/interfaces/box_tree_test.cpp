#include "interfaces/network/box_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <mutex>
#include <random>

#include "tests/interfaces/network_meshes.h"

namespace adamas {

using namespace interfaces;

namespace {

using Pair = std::array<std::uint32_t, 2>;

/// Boxes of all kinds: on a lattice many touch, and some are the same, flat, points, or empty.
class RandomBoxes {
 public:
  explicit RandomBoxes(std::uint64_t seed, int lattice) : random_(seed), lattice_(lattice) {}
  Box3 box() {
    Box3 box;
    if (random_() % 20 == 0) return box;
    const Vec3 p = point(1);
    box.extend(p);
    if (random_() % 4 != 0) box.extend(p + point(0.2));
    return box;
  }
  std::vector<Box3> boxes(std::size_t count) {
    std::vector<Box3> result(count);
    for (Box3& b : result) b = box();
    return result;
  }
  std::mt19937_64& random() { return random_; }
  Vec3 point(double size) {
    Vec3 p = size * test::random_point(random_, test::unit_box());
    for (int axis = 0; lattice_ > 0 && axis < 3; ++axis) p[axis] = std::floor(lattice_ * p[axis]) / lattice_;
    return p;
  }

 private:
  std::mt19937_64 random_;
  int lattice_;
};

void compare_pairs(const BoxTree& tree, const std::vector<Box3>& boxes) {
  std::vector<Pair> expected, found;
  for (std::uint32_t i = 0; i < boxes.size(); ++i) {
    for (std::uint32_t j = i + 1; j < boxes.size(); ++j) {
      if (boxes[i].touches(boxes[j])) expected.push_back({i, j});
    }
  }
  std::mutex mutex;
  tree.for_each_touching_pair([&](std::uint32_t i, std::uint32_t j) {
    const std::lock_guard lock(mutex);
    found.push_back({i, j});
  });
  std::sort(found.begin(), found.end());
  ASSERT_EQ(found, expected);
}

TEST(BoxTree, PairsAreThoseOfLookingAtAll) {
  for (const int lattice : {0, 1, 5, 20}) {
    RandomBoxes random(7, lattice);
    for (const std::size_t count : {0u, 1u, 2u, 4u, 5u, 8u, 9u, 17u, 200u, 1000u}) {
      std::vector<Box3> boxes = random.boxes(count);
      BoxTree tree(boxes);
      compare_pairs(tree, boxes);
      for (std::uint32_t i = 0; i < count; i += 3) {
        boxes[i] = random.box();
        tree.set(i, boxes[i]);
      }
      compare_pairs(tree, boxes);
    }
  }
}

TEST(BoxTree, PairsOfBoxesThatAreTheSame) {
  const std::vector<Box3> boxes(300, Box3{{0, 0, 0}, {1, 1, 1}});
  compare_pairs(BoxTree(boxes), boxes);
  compare_pairs(BoxTree(std::vector<Box3>(300)), std::vector<Box3>(300));
}

TEST(BoxTree, FindsWhatTouchesABoxWhileBoxesChange) {
  for (const int lattice : {0, 10}) {
    RandomBoxes random(3, lattice);
    for (const std::size_t count : {0u, 1u, 2u, 3u, 17u, 200u}) {
      std::vector<Box3> boxes = random.boxes(count);
      BoxTree tree(boxes);
      for (int step = 0; step < 200; ++step) {
        if (count > 0) {
          const auto i = static_cast<std::uint32_t>(random.random()() % count);
          boxes[i] = random.box();
          tree.set(i, boxes[i]);
        }
        const Box3 query = random.box();
        std::vector<std::uint32_t> expected, found;
        for (std::uint32_t i = 0; i < count; ++i) {
          if (boxes[i].touches(query)) expected.push_back(i);
        }
        tree.for_each_touching(query, [&found](std::uint32_t i) { return found.push_back(i), true; });
        std::sort(found.begin(), found.end());
        ASSERT_EQ(found, expected);
        std::size_t visits = 0;
        tree.for_each_touching(query, [&visits](std::uint32_t) { return ++visits, false; });
        ASSERT_EQ(visits, expected.empty() ? 0u : 1u);
      }
    }
  }
}

TEST(BoxTree, FindsWhatIsNearAPoint) {
  RandomBoxes random(5, 0);
  for (const std::size_t count : {0u, 1u, 9u, 300u}) {
    const std::vector<Box3> boxes = random.boxes(count);
    const BoxTree tree(boxes);
    std::vector<std::uint32_t> found;
    for (int i = 0; i < 200; ++i) {
      const Vec3 p = random.point(1.2);
      const double radius = 0.002 * i;
      std::vector<std::uint32_t> expected;
      for (std::uint32_t b = 0; b < count; ++b) {
        if (squared_distance(boxes[b], p) <= radius * radius) expected.push_back(b);
      }
      tree.near(p, radius, found);
      ASSERT_EQ(found, expected);
    }
  }
}

}  // namespace
}  // namespace adamas
