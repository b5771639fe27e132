#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <map>
#include <random>

#include "isosurface/view/paged_frames.h"

namespace adamas::test {

using namespace isosurface;

/// A camera that mostly moves a little, and now and then jumps.
class CameraPath {
 public:
  CameraPath(const Box3& box, unsigned seed) : box_(box), random_(seed) { jump(); }

  Viewpoint next() {
    if (number(8) == 0) {
      jump();
    } else {
      viewpoint_.eye += 0.02 * box_.diagonal() * way();
      viewpoint_.target += 0.01 * box_.diagonal() * way();
    }
    return viewpoint_;
  }
  std::uint32_t number(std::uint32_t below) { return static_cast<std::uint32_t>(random_() % below); }

 private:
  Vec3 way() {
    std::uniform_real_distribution<double> unit(-1, 1);
    return {unit(random_), unit(random_), unit(random_)};
  }
  void jump() {
    const auto place = [&](double size) {
      const Vec3 half = 0.5 * size * box_.size(), part = way();
      return box_.center() + Vec3{half.x * part.x, half.y * part.y, half.z * part.z};
    };
    viewpoint_.eye = place(number(3) == 0 ? 1 : 3);
    viewpoint_.target = place(1);
    viewpoint_.up = {0.1, 0.2, 1};
    viewpoint_.near = 0.5;
    viewpoint_.width_pixels = 400;
    viewpoint_.height_pixels = 300;
    viewpoint_.height = number(5) == 0 ? box_.diagonal() / 2 : 0;
  }

  Box3 box_;
  std::mt19937 random_;
  Viewpoint viewpoint_;
};

using Chunks = std::map<std::uint64_t, SurfaceChunk>;

template <class Sample>
Chunks chunks_of(const PagedFrames<Sample>& frames) {
  Chunks chunks;
  frames.for_each_chunk([&](const SurfaceChunk& chunk) {
    EXPECT_TRUE(chunks.emplace(chunk.id, chunk).second) << "two chunks with one id";
  });
  return chunks;
}

/// Expects the same chunks; only their revisions, which count how often a chunk was made, may differ.
inline void expect_same(const Chunks& found, const Chunks& expected) {
  ASSERT_EQ(found.size(), expected.size());
  for (auto a = found.begin(), b = expected.begin(); a != found.end(); ++a, ++b) {
    ASSERT_EQ(a->first, b->first);
    EXPECT_EQ(a->second.points, b->second.points);
    EXPECT_EQ(a->second.normals, b->second.normals);
    EXPECT_EQ(a->second.triangles, b->second.triangles);
    EXPECT_EQ(a->second.ends, b->second.ends);
  }
}

}  // namespace adamas::test
