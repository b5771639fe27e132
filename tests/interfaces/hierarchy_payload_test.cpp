#include <gtest/gtest.h>

#include <memory>
#include <random>
#include <set>
#include <stdexcept>
#include <string>

#include "interfaces/hierarchy/hierarchy.h"
#include "tests/interfaces/hierarchy_validation.h"

namespace adamas::interfaces {

namespace {

Domain box_domain() { return {{{-3, 0, 1}, {5, 7, 8}}, {1, 1, 1}}; }

TEST(HierarchyPayload, FollowsItsElementAndNeverMoves) {
  Hierarchy<std::shared_ptr<int>, int> h(box_domain());
  std::vector<Split> done;
  std::vector<TetrahedronId> restored;
  const VertexId corner = h.vertices(h.roots()[0])[0];
  h.payload(corner) = std::make_shared<int>(5);
  h.payload(h.roots()[2]) = 17;
  const int* place = &h.payload(h.roots()[2]);
  std::mt19937 random(3);
  for (int step = 0; step < 2000; ++step) {
    TetrahedronId t = h.roots()[random() % 6];
    while (!h.is_leaf(t)) t = h.children(t)[random() % 2];
    h.split(t, done);
  }
  EXPECT_EQ(*h.payload(corner), 5);
  EXPECT_EQ(&h.payload(h.roots()[2]), place);
  EXPECT_EQ(*place, 17);
}

TEST(HierarchyPayload, IsDefaultAgainAfterAMerge) {
  Hierarchy<std::shared_ptr<int>, int> h(box_domain());
  std::vector<Split> done;
  std::vector<TetrahedronId> restored;
  h.split(h.roots()[0], done);
  ASSERT_EQ(done.size(), 6u);
  const auto shared = std::make_shared<int>(1);
  h.payload(done[0].vertex) = shared;
  for (const Split& split : done) h.payload(split.children[0]) = h.payload(split.children[1]) = 9;
  h.merge(h.diamond(h.roots()[0]), restored);
  EXPECT_EQ(restored.size(), 6u);
  EXPECT_EQ(shared.use_count(), 1);
  done.clear();
  h.split(h.roots()[0], done);
  EXPECT_EQ(h.payload(done[0].vertex), nullptr);
  for (const Split& split : done) {
    EXPECT_EQ(h.payload(split.children[0]), 0);
    EXPECT_EQ(h.payload(split.children[1]), 0);
  }
}

TEST(HierarchyPayload, NoneTakesNoMemory) {
  Hierarchy<> none(box_domain());
  EXPECT_EQ(none.bytes(), static_cast<const HierarchyTopology&>(none).bytes());
}

TEST(HierarchyDepth, SplittingStopsWhereTheLatticeOrThePrecisionEnds) {
  for (const double offset : {0.0, 1e9}) {
    const Domain domain({{offset, offset, offset}, {offset + 1, offset + 1, offset + 1}}, {1, 1, 1});
    Hierarchy<> h(domain);
    std::vector<Split> done;
    TetrahedronId t = h.roots()[0];
    int bisections = 0;
    for (; h.can_split(t); ++bisections) {
      h.split(t, done);
      t = h.children(t)[bisections % 2];
    }
    EXPECT_EQ(bisections, 3 * domain.depth());
    const std::size_t leaves = h.leaf_count();
    h.split(t, done);
    EXPECT_EQ(h.leaf_count(), leaves);
    EXPECT_NO_THROW(test::validate(h));
  }
}

TEST(HierarchyDepth, RequestsThatMeanNothingAreIgnored) {
  Hierarchy<> h(box_domain());
  std::vector<Split> done;
  std::vector<TetrahedronId> restored;
  h.merge(h.diamond(h.roots()[0]), restored);
  EXPECT_TRUE(restored.empty());
  h.split(h.roots()[0], done);
  const std::size_t count = done.size();
  h.split(h.roots()[0], done);
  EXPECT_EQ(done.size(), count);
  EXPECT_FALSE(h.find({1, 2, 3}).valid());
  EXPECT_FALSE(h.is_split(LatticePoint{1, 2, 3}));
}

/// Returns the message of test::validate() about a hierarchy of some splits after `harm`.
template <class Harm>
std::string complaint(Harm&& harm) {
  Hierarchy<> h(box_domain());
  std::vector<Split> done;
  for (int step = 0; step < 30; ++step) {
    std::vector<TetrahedronId> leaves;
    h.for_each_leaf([&](TetrahedronId t) { leaves.push_back(t); });
    h.split(leaves[static_cast<std::size_t>(step * 7) % leaves.size()], done);
  }
  test::validate(h);
  TetrahedronId leaf;
  h.for_each_leaf([&](TetrahedronId t) { leaf = t; });
  harm(h, leaf, h.parent(leaf));
  try {
    test::validate(h);
  } catch (const std::logic_error& error) {
    return error.what();
  }
  return "all is well";
}

TEST(HierarchyValidate, NamesWhatIsBroken) {
  using Access = HierarchyTestAccess;
  const auto says = [](const std::string& message, const std::string& part) {
    EXPECT_NE(message.find(part), std::string::npos) << message;
  };
  using H = HierarchyTopology;
  using T = TetrahedronId;
  says(complaint([](H& h, T leaf, T) { Access::swap_vertices(h, leaf); }), "its diamond (");
  says(complaint([](H& h, T leaf, T) { Access::move_vertex(h, h.vertices(leaf)[0]); }), "has vertex (");
  says(complaint([](H& h, T, T parent) { Access::forget_children(h, parent); }), "is no child of its parent");
  says(complaint([](H& h, T, T parent) { Access::forget_split(h, h.diamond(parent)); }), "is not split, but");
  says(complaint([](H& h, T leaf, T) { Access::forget_diamond(h, h.diamond(leaf)); }),
       "is not found by its point");
  says(complaint([](H& h, T leaf, T) { Access::forget_parent(h, leaf); }),
       "is not the parent of its children");
  says(complaint([](H& h, T leaf, T) { Access::drop_from_diamond(h, leaf); }),
       "is not listed by its diamond");
  says(complaint([](H& h, T, T) { Access::miscount(h); }), "counted");
}

}  // namespace
}  // namespace adamas::interfaces
