#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <set>

#include "core/lattice/forced_split.h"
#include "interfaces/hierarchy/hierarchy.h"
#include "tests/interfaces/hierarchy_validation.h"
#include "tests/support/bisection_reference.h"
#include "tests/support/forced_merge.h"
#include "tests/support/hierarchy_checksum.h"

namespace adamas {

using namespace interfaces;

namespace {

Domain unit_domain(std::array<int, 3> roots) { return {{{0, 0, 0}, {1, 1, 1}}, roots}; }

std::vector<test::ReferenceTetrahedron> mesh(const HierarchyTopology& h) {
  std::vector<test::ReferenceTetrahedron> result;
  h.for_each_leaf([&](TetrahedronId t) { result.push_back(test::sorted(h.corners(t))); });
  return result;
}

/// Random splits and merges of a hierarchy without payload.
class RandomWalk {
 public:
  RandomWalk(const Domain& domain, unsigned seed) : hierarchy(domain), random_(seed) {}

  void split() {
    done.clear();
    hierarchy.split(random_leaf(), done);
    for (const Split& split : done) {
      if (split_points_.empty() || split_points_.back() != hierarchy.lattice(split.vertex)) {
        split_points_.push_back(hierarchy.lattice(split.vertex));
      }
    }
  }
  /// Merges a random descendant of a random split diamond, or nothing when only the roots are left.
  void merge() {
    restored.clear();
    if (split_points_.empty()) return;
    LatticePoint p = split_points_[random_() % split_points_.size()];
    while (!test::is_mergeable(hierarchy, p)) {
      const auto children = Diamond(p).children(hierarchy.domain());
      const LatticePoint child = children[random_() % children.size()];
      if (hierarchy.is_split(child)) p = child;
    }
    hierarchy.merge(hierarchy.find(p), restored);
    std::erase(split_points_, p);
  }
  /// Splits or merges once; phases of growing and shrinking alternate. If there were fewer than `size` leaves
  /// before, there are afterwards.
  void step(std::size_t size) {
    if (hierarchy.leaf_count() + 100 >= size) growing_ = false;
    if (hierarchy.leaf_count() < size / 4) growing_ = true;
    random_() % 100 < (growing_ ? 80 : 20) && hierarchy.leaf_count() + 100 < size ? split() : merge();
  }

  /// Forgets the points of splits. It has to be called after the hierarchy was changed from outside.
  void forget() { split_points_.clear(); }
  /// Undoes the last split.
  void undo() {
    for (auto split = done.rbegin(); split != done.rend(); ++split) {
      if (hierarchy.is_leaf(split->parent)) continue;
      const DiamondId d = hierarchy.diamond(split->parent);
      ASSERT_TRUE(hierarchy.can_merge(d));
      hierarchy.merge(d, restored);
      std::erase(split_points_, hierarchy.lattice(d));
    }
  }

  Hierarchy<> hierarchy;
  std::vector<Split> done;
  std::vector<TetrahedronId> restored;

 private:
  /// Returns a leaf somewhere below a random split diamond.
  TetrahedronId random_leaf() {
    TetrahedronId t = hierarchy.roots()[random_() % hierarchy.roots().size()];
    if (!split_points_.empty()) {
      const LatticePoint p = split_points_[random_() % split_points_.size()];
      const auto tetrahedra = hierarchy.tetrahedra(hierarchy.find(p));
      t = tetrahedra[random_() % tetrahedra.size()];
    }
    while (!hierarchy.is_leaf(t)) t = hierarchy.children(t)[random_() % 2];
    return t;
  }

  std::mt19937 random_;
  std::vector<LatticePoint> split_points_;
  bool growing_ = true;
};

void expect_no_vertex_inside_an_edge(const HierarchyTopology& h) {
  std::vector<LatticePoint> vertices;
  h.for_each_vertex([&](VertexId v) { vertices.push_back(h.lattice(v)); });
  std::set<std::array<LatticePoint, 2>> edges;
  for (const auto& t : mesh(h)) {
    for (std::size_t a = 0; a < 4; ++a) {
      for (std::size_t b = a + 1; b < 4; ++b) edges.insert({t[a], t[b]});
    }
  }
  for (const auto& [a, b] : edges) {
    for (const LatticePoint v : vertices) {
      if (v == a || v == b) continue;
      const auto wide = [](LatticePoint p) { return std::array<std::int64_t, 3>{p.i, p.j, p.k}; };
      const auto u = wide(v - a), w = wide(b - a);
      const bool parallel =
          u[0] * w[1] == u[1] * w[0] && u[1] * w[2] == u[2] * w[1] && u[2] * w[0] == u[0] * w[2];
      const std::int64_t along = u[0] * w[0] + u[1] * w[1] + u[2] * w[2];
      ASSERT_FALSE(parallel && along > 0 && along < w[0] * w[0] + w[1] * w[1] + w[2] * w[2]);
    }
  }
}

void expect_faces_shared_by_two(const HierarchyTopology& h) {
  std::map<std::array<LatticePoint, 3>, int> faces;
  for (const auto& t : mesh(h)) {
    for (std::size_t left_out = 0; left_out < 4; ++left_out) {
      std::array<LatticePoint, 3> face;
      std::size_t n = 0;
      for (std::size_t v = 0; v < 4; ++v) {
        if (v != left_out) face[n++] = t[v];
      }
      ++faces[face];
    }
  }
  const LatticePoint extent = h.domain().extent();
  for (const auto& entry : faces) {
    const auto& face = entry.first;
    bool on_boundary = false;
    for (int axis = 0; axis < 3; ++axis) {
      const auto lies_at = [&](std::int32_t x) {
        return std::all_of(face.begin(), face.end(), [&](LatticePoint p) { return p[axis] == x; });
      };
      on_boundary = on_boundary || lies_at(0) || lies_at(extent[axis]);
    }
    ASSERT_EQ(entry.second, on_boundary ? 1 : 2);
  }
}

class HierarchyLaws : public testing::TestWithParam<std::array<int, 3>> {};

TEST_P(HierarchyLaws, UniformRefinementIsBruteForceBisection) {
  Hierarchy<> hierarchy(unit_domain(GetParam()));
  std::vector<Split> done;
  for (int generation = 0; generation <= 7; ++generation) {
    std::vector<TetrahedronId> leaves;
    hierarchy.for_each_leaf([&](TetrahedronId t) { leaves.push_back(t); });
    ASSERT_EQ(leaves.size(), hierarchy.leaf_count());
    const test::BisectionReference reference(GetParam(), generation);
    const std::vector<test::ReferenceTetrahedron> found = mesh(hierarchy);
    EXPECT_EQ(std::set(found.begin(), found.end()),
              std::set(reference.mesh().begin(), reference.mesh().end()));
    for (const TetrahedronId t : leaves) {
      EXPECT_EQ(hierarchy.phase(t), generation % 3);
      EXPECT_EQ(hierarchy.level(t), generation / 3);
      const auto p = hierarchy.corners(t);
      const auto [a, b] = test::longest_edge(p);
      EXPECT_EQ(a, 0u);
      EXPECT_EQ(b, 1u);
      EXPECT_EQ(hierarchy.lattice(hierarchy.diamond(t)), test::midpoint(p[0], p[1]));
    }
    test::validate(hierarchy);
    for (const TetrahedronId t : leaves) {
      if (hierarchy.is_leaf(t)) hierarchy.split(t, done);
    }
  }
}

TEST_P(HierarchyLaws, SmallMeshesStayValidAndConforming) {
  RandomWalk walk(unit_domain(GetParam()), 1);
  for (int step = 0; step < 2000; ++step) {
    walk.step(500);
    ASSERT_NO_THROW(test::validate(walk.hierarchy)) << "after step " << step;
    if (step % 100 == 0) {
      expect_no_vertex_inside_an_edge(walk.hierarchy);
      expect_faces_shared_by_two(walk.hierarchy);
    }
    if (HasFatalFailure()) return;
  }
}

TEST_P(HierarchyLaws, SplitThenMergeRestoresTheMesh) {
  RandomWalk walk(unit_domain(GetParam()), 2);
  Hierarchy<>& h = walk.hierarchy;
  for (int round = 0; round < 300; ++round) {
    const std::uint64_t before = test::checksum(h);
    const auto mesh_before = mesh(h);
    walk.split();
    ASSERT_NE(test::checksum(h), before);
    ASSERT_FALSE(walk.done.empty());
    walk.undo();
    ASSERT_EQ(test::checksum(h), before);
    ASSERT_EQ(mesh(h), mesh_before);
    for (int step = 0; step < 5; ++step) walk.step(3000);
  }
  test::validate(h);
}

TEST_P(HierarchyLaws, BisectionsAreReportedParentsFirstAndOnce) {
  RandomWalk walk(unit_domain(GetParam()), 3);
  const Hierarchy<>& h = walk.hierarchy;
  for (int round = 0; round < 300; ++round) {
    std::set<TetrahedronId> leaves;
    h.for_each_leaf([&](TetrahedronId t) { leaves.insert(t); });
    walk.split();
    for (const Split& split : walk.done) {
      ASSERT_EQ(leaves.erase(split.parent), 1u);
      ASSERT_EQ(split.children, h.children(split.parent));
      ASSERT_EQ(split.vertex, h.split_vertex(h.diamond(split.parent)));
      const auto [a, b] = h.split_edge(split.parent);
      ASSERT_EQ(h.lattice(split.vertex), test::midpoint(h.lattice(a), h.lattice(b)));
      for (const std::size_t end : {std::size_t{0}, std::size_t{1}}) {
        ASSERT_EQ(h.parent(split.children[end]), split.parent);
        const auto v = h.vertices(split.children[end]);
        ASSERT_NE(std::find(v.begin(), v.end(), h.split_edge(split.parent)[end]), v.end());
        ASSERT_NE(std::find(v.begin(), v.end(), split.vertex), v.end());
        leaves.insert(split.children[end]);
      }
    }
    std::set<TetrahedronId> now;
    h.for_each_leaf([&](TetrahedronId t) { now.insert(t); });
    ASSERT_EQ(leaves, now);
  }
}

TEST_P(HierarchyLaws, TheMeshDependsOnTheSplitDiamondsAlone) {
  RandomWalk walk(unit_domain(GetParam()), 4);
  for (int step = 0; step < 3000; ++step) walk.step(1000);
  std::vector<LatticePoint> split;
  walk.hierarchy.for_each_diamond([&](DiamondId d) {
    if (walk.hierarchy.is_split(d)) split.push_back(walk.hierarchy.lattice(d));
  });
  std::shuffle(split.begin(), split.end(), std::mt19937(5));
  Hierarchy<> other(walk.hierarchy.domain());
  const auto split_one = [&](LatticePoint p) {
    // The diamond exists once its parents are split.
    std::vector<Split> done;
    other.split(other.tetrahedra(other.find(p))[0], done);
  };
  for (const LatticePoint p : split) forced_split(other, p, split_one);
  EXPECT_EQ(mesh(other), mesh(walk.hierarchy));
  EXPECT_EQ(test::checksum(other), test::checksum(walk.hierarchy));
  EXPECT_EQ(other.vertex_count(), walk.hierarchy.vertex_count());
  EXPECT_EQ(other.diamond_count(), walk.hierarchy.diamond_count());
}

TEST_P(HierarchyLaws, ForcedMergeOfTheRootsLeavesTheRoots) {
  RandomWalk walk(unit_domain(GetParam()), 6);
  Hierarchy<>& h = walk.hierarchy;
  const std::uint64_t checksum = test::checksum(h);
  for (int step = 0; step < 500; ++step) walk.split();
  const std::size_t bytes = h.bytes();
  h.for_each_diamond([&](DiamondId d) { EXPECT_EQ(h.can_merge(d), test::is_mergeable(h, h.lattice(d))); });
  for (const TetrahedronId root : h.roots()) {
    test::forced_merge(h, h.lattice(h.diamond(root)), [&](LatticePoint p) {
      ASSERT_TRUE(h.can_merge(h.find(p)));
      h.merge(h.find(p), walk.restored);
    });
  }
  test::validate(h);
  EXPECT_EQ(h.leaf_count(), h.roots().size());
  EXPECT_EQ(h.tetrahedron_count(), h.roots().size());
  EXPECT_EQ(test::checksum(h), checksum);
  // Freed memory is used again.
  walk.forget();
  for (int step = 0; step < 200; ++step) walk.split();
  EXPECT_LE(h.bytes(), bytes + bytes / 4);
}

INSTANTIATE_TEST_SUITE_P(Roots, HierarchyLaws,
                         testing::Values(std::array{1, 1, 1}, std::array{2, 1, 3}, std::array{1, 2, 2}));

class LongHierarchy : public testing::TestWithParam<std::array<int, 3>> {};

TEST_P(LongHierarchy, TenThousandRandomStepsKeepAllLaws) {
  RandomWalk walk(unit_domain(GetParam()), 8);
  std::size_t greatest = 0;
  for (int step = 0; step < 10000; ++step) {
    walk.step(step < 7000 ? 500 : 8000);
    greatest = std::max(greatest, walk.hierarchy.leaf_count());
    if (walk.hierarchy.leaf_count() < 500 || step % 500 == 0) {
      ASSERT_NO_THROW(test::validate(walk.hierarchy)) << "after step " << step;
    }
    if (step % 2500 == 0) expect_faces_shared_by_two(walk.hierarchy);
  }
  test::validate(walk.hierarchy);
  EXPECT_GT(greatest, 5000u);
}

INSTANTIATE_TEST_SUITE_P(Roots, LongHierarchy, testing::Values(std::array{1, 1, 1}, std::array{2, 1, 3}));

}  // namespace
}  // namespace adamas
