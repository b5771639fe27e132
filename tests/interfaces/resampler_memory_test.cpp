#include <gtest/gtest.h>

#include <vector>

#include "tests/interfaces/resampler_scenes.h"

namespace adamas {
namespace {

using interfaces::MeshHierarchy;

/// Lists of triangles take no more memory than they need: each triangle of the input is in several of them.
TEST(ResamplerMemory, OnlyLeavesHaveListsOfTriangles) {
  test::SceneCase scene;
  scene.name = "shell3";
  scene.options.interface_error = 0.02;
  const test::ResampledScene resampled(scene);
  const MeshHierarchy& hierarchy = resampled.resampler->hierarchy();
  std::vector<TetrahedronId> open = hierarchy.roots();
  std::size_t leaves = 0, inner = 0, listed = 0;
  while (!open.empty()) {
    const TetrahedronId t = open.back();
    open.pop_back();
    const std::vector<std::uint32_t>& triangles = hierarchy.payload(t).triangles;
    if (hierarchy.is_leaf(t)) {
      EXPECT_EQ(triangles.capacity(), triangles.size());
      ++leaves, listed += triangles.size();
      continue;
    }
    EXPECT_EQ(triangles.capacity(), 0u);
    ++inner;
    for (const TetrahedronId child : hierarchy.children(t)) open.push_back(child);
  }
  EXPECT_GT(inner, 100u);
  EXPECT_EQ(leaves, inner + hierarchy.roots().size());
  EXPECT_GE(listed, resampled.source.network->triangles().size());
}

}  // namespace
}  // namespace adamas
