#include "tests/support/indexed_hierarchy.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>
#include <vector>

#include "core/base/error.h"
#include "core/lattice/forced_split.h"
#include "interfaces/hierarchy/hierarchy.h"
#include "tests/support/bisection_reference.h"
#include "tests/support/forced_merge.h"
#include "tests/support/hierarchy_checksum.h"

namespace adamas {

using namespace interfaces;
using test::IndexedHierarchy;
using test::pack;
using test::PackedPoint;
using test::unpack;

namespace {

Domain unit_domain(std::array<int, 3> roots) { return {{{0, 0, 0}, {1, 1, 1}}, roots}; }

std::vector<test::ReferenceTetrahedron> mesh(const IndexedHierarchy& h) {
  std::vector<test::ReferenceTetrahedron> result;
  h.for_each_tetrahedron(
      [&](const Diamond& d, int slot) { result.push_back(test::sorted(d.tetrahedron(slot))); });
  std::sort(result.begin(), result.end());
  return result;
}

/// An indexed and a pointer-based hierarchy that get the same requests.
class Pair {
 public:
  explicit Pair(const Domain& domain, int levels) : indexed(domain, levels), linked_(domain) {
    linked_.for_each_leaf(
        [this](TetrahedronId t) { candidates_.push_back(linked_.lattice(linked_.diamond(t))); });
  }

  void split(LatticePoint p) {
    std::vector<LatticePoint> done;
    indexed.split(p, done);
    std::vector<LatticePoint> wanted;
    if (indexed.can_split(p)) {
      forced_split(linked_, p, [&](LatticePoint q) {
        std::vector<Split> splits;
        linked_.split(linked_.tetrahedra(linked_.find(q))[0], splits);
        wanted.push_back(q);
      });
    }
    ASSERT_EQ(done, wanted);
    for (const LatticePoint point : done) {
      for (const LatticePoint child : Diamond(point).children(indexed.domain())) candidates_.push_back(child);
    }
  }
  void merge(LatticePoint p) {
    const DiamondId d = linked_.find(p);
    std::vector<TetrahedronId> restored;
    if (d.valid()) linked_.merge(d, restored);
    ASSERT_EQ(indexed.merge(p), !restored.empty());
  }
  /// Returns a diamond that was once in the mesh.
  LatticePoint any() { return candidates_[random_() % candidates_.size()]; }
  unsigned number() { return static_cast<unsigned>(random_()); }

  void expect_same() const {
    ASSERT_EQ(indexed.tetrahedron_count(), linked_.leaf_count());
    ASSERT_EQ(indexed.checksum(), test::checksum(linked_));
    ASSERT_EQ(indexed.diamond_count(), linked_.diamond_count());
  }

  IndexedHierarchy indexed;

 private:
  Hierarchy<> linked_;
  std::vector<LatticePoint> candidates_;
  std::mt19937 random_{11};
};

class IndexedHierarchyLaws : public testing::TestWithParam<std::array<int, 3>> {};

TEST_P(IndexedHierarchyLaws, UniformRefinementIsBruteForceBisection) {
  IndexedHierarchy h(unit_domain(GetParam()), 4);
  for (int generation = 0; generation <= 7; ++generation) {
    const test::BisectionReference reference(GetParam(), generation);
    std::vector<test::ReferenceTetrahedron> wanted = reference.mesh();
    std::sort(wanted.begin(), wanted.end());
    ASSERT_EQ(mesh(h), wanted);
    h.validate();
    std::set<LatticePoint> points;
    h.for_each_tetrahedron([&](const Diamond& d, int) { points.insert(d.point()); });
    std::vector<LatticePoint> done;
    for (const LatticePoint p : points) h.split(p, done);
    ASSERT_EQ(std::set(done.begin(), done.end()), points);
  }
}

/// The indexed and the pointer-based hierarchy have the same mesh after the same 10,000 random requests.
TEST_P(IndexedHierarchyLaws, IsThePointerBasedMeshForTheSameRequests) {
  Pair pair(unit_domain(GetParam()), 12);
  bool growing = true;
  for (int step = 0; step < 10000; ++step) {
    const std::size_t count = pair.indexed.tetrahedron_count();
    if (count > (step < 7000 ? 500u : 8000u)) growing = false;
    if (count < 100) growing = true;
    if (pair.number() % 100 < (growing ? 80u : 20u)) {
      pair.split(pair.any());
    } else {
      // A descent leads to a split diamond none of whose children is split, where there is one.
      LatticePoint p = pair.any();
      while (pair.indexed.is_split(p) && !pair.indexed.can_merge(p)) {
        const auto children = Diamond(p).children(pair.indexed.domain());
        const LatticePoint child = children[pair.number() % children.size()];
        if (pair.indexed.can_split(child) && pair.indexed.is_split(child)) p = child;
      }
      pair.merge(p);
    }
    ASSERT_FALSE(HasFatalFailure());
    if (pair.indexed.tetrahedron_count() < 500 || step % 500 == 0) {
      ASSERT_NO_THROW(pair.indexed.validate()) << "after step " << step;
      pair.expect_same();
      ASSERT_FALSE(HasFatalFailure());
    }
  }
  pair.expect_same();
}

TEST_P(IndexedHierarchyLaws, MergingAllLeavesTheRoots) {
  IndexedHierarchy h(unit_domain(GetParam()), 9);
  const auto roots = mesh(h);
  std::mt19937 random(4);
  std::vector<LatticePoint> done, points;
  h.for_each_tetrahedron([&](const Diamond& d, int) { points.push_back(d.point()); });
  const std::set<LatticePoint> root_diamonds(points.begin(), points.end());
  for (int step = 0; step < 2000; ++step) {
    done.clear();
    h.split(points[random() % points.size()], done);
    for (const LatticePoint p : done) {
      for (const LatticePoint child : Diamond(p).children(h.domain())) points.push_back(child);
    }
  }
  EXPECT_GT(h.tetrahedron_count(), 2000u);
  for (const LatticePoint root : root_diamonds)
    test::forced_merge(h, root, [&h](LatticePoint p) { ASSERT_TRUE(h.merge(p)); });
  EXPECT_EQ(mesh(h), roots);
  EXPECT_EQ(h.diamond_count(), root_diamonds.size());
  h.validate();
}

INSTANTIATE_TEST_SUITE_P(Roots, IndexedHierarchyLaws,
                         testing::Values(std::array{1, 1, 1}, std::array{2, 1, 3}, std::array{1, 2, 2}));

TEST(IndexedHierarchy, RefusesWhatTheLatticeHasNoRoomFor) {
  const Domain cube = unit_domain({1, 1, 1});
  EXPECT_NO_THROW(IndexedHierarchy(cube, 19));
  EXPECT_THROW(IndexedHierarchy(cube, 20), Error);
  EXPECT_THROW(IndexedHierarchy(cube, -1), Error);
  EXPECT_THROW(IndexedHierarchy(unit_domain({4, 1, 1}), 18), Error);
  IndexedHierarchy flat(cube, 0);
  std::vector<LatticePoint> done;
  flat.split({1 << 23, 1 << 23, 1 << 23}, done);
  EXPECT_TRUE(done.empty());
  flat.validate();
}

TEST(PackedPoint, UnpacksToItself) {
  for (const LatticePoint p :
       {LatticePoint{0, 0, 0}, {1 << 20, 3, 1 << 20}, {(1 << 21) - 1, 0, (1 << 21) - 1}}) {
    for (const int shift : {0, 4, 9}) {
      const LatticePoint scaled{p.i << shift, p.j << shift, p.k << shift};
      EXPECT_EQ(unpack(pack(scaled, shift), shift), scaled);
      EXPECT_NE(pack(scaled, shift), kNoKey<PackedPoint>);
    }
  }
}

}  // namespace
}  // namespace adamas
