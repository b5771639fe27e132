#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <vector>

#include "adamas/progress.h"
#include "isosurface/extraction/surface_normals.h"
#include "isosurface/view/paged_frames.h"
#include "tests/isosurface/contour_checks.h"
#include "tests/isosurface/frame_checks.h"
#include "tests/isosurface/surface_checks.h"

namespace adamas {

using namespace isosurface;

namespace {

using test::Chunks;
using test::chunks_of;
using test::expect_same;
using test::MemoryVolume;
using test::OpenStore;
using Path = test::CameraPath;

/// What a renderer keeps when it is given nothing but the changes.
class Copy {
 public:
  template <class Sample>
  void update(PagedFrames<Sample>& frames) {
    const ChunkChanges& changes = frames.changes();
    for (const auto* ids : {&changes.added, &changes.changed, &changes.removed})
      EXPECT_TRUE(std::ranges::is_sorted(*ids));
    for (const std::uint64_t id : changes.removed) EXPECT_EQ(chunks_.erase(id), 1u);
    for (const std::uint64_t id : changes.added) {
      EXPECT_TRUE(chunks_.emplace(id, *frames.chunk(id)).second);
    }
    for (const std::uint64_t id : changes.changed) {
      const auto known = chunks_.find(id);
      ASSERT_NE(known, chunks_.end());
      EXPECT_LT(known->second.revision, frames.chunk(id)->revision);
      known->second = *frames.chunk(id);
    }
    for (const auto& [id, chunk] : chunks_of(frames)) {
      const auto known = chunks_.find(id);
      ASSERT_NE(known, chunks_.end());
      EXPECT_EQ(known->second.revision, chunk.revision);
    }
    expect_same(chunks_, chunks_of(frames));
  }

 private:
  Chunks chunks_;
};

using Corner = std::array<double, 3>;
Corner corner(const Vec3& p) { return {p.x, p.y, p.z}; }

/// Appends the triangles as the places of their corners, each beginning with its least corner.
void add_triangles(const std::vector<Vec3>& points,
                   const std::vector<std::array<std::uint32_t, 3>>& triangles,
                   std::vector<std::array<Corner, 3>>& all) {
  for (const auto& t : triangles) {
    std::array<Corner, 3> places{corner(points[t[0]]), corner(points[t[1]]), corner(points[t[2]])};
    std::rotate(places.begin(), std::ranges::min_element(places), places.end());
    all.push_back(places);
  }
}

/// Expects that the chunks together are the surface, and have the places and normals of its points.
template <class Sample>
void expect_parts(StoredPages<OrderedWord<Sample>>& pages, const PagedFrames<Sample>& frames) {
  const Contour contour = frames.contour();
  const std::vector<Vec3> normals = surface_normals<Sample>(pages, contour).normals;
  std::map<Corner, Vec3> normal_at;
  for (std::size_t p = 0; p < normals.size(); ++p) normal_at.emplace(corner(contour.points[p]), normals[p]);
  std::vector<std::array<Corner, 3>> whole, parts;
  add_triangles(contour.points, contour.triangles, whole);
  frames.for_each_chunk([&](const SurfaceChunk& chunk) {
    add_triangles(chunk.points, chunk.triangles, parts);
    ASSERT_EQ(chunk.points.size(), chunk.normals.size());
    for (std::size_t p = 0; p < chunk.points.size(); ++p) {
      const auto expected = normal_at.find(corner(chunk.points[p]));
      ASSERT_NE(expected, normal_at.end());
      EXPECT_EQ(chunk.normals[p], expected->second);
    }
  });
  std::ranges::sort(whole);
  std::ranges::sort(parts);
  EXPECT_EQ(whole, parts);
}

/// Expects that chunks of edges' ends have the same triangles as chunks of points, and that the points and
/// normals that a vertex shader interpolates from the ends agree with the points. Gradients of ends have 15
/// bits.
void expect_ends(const Chunks& of_ends, const Chunks& of_points, double isovalue) {
  ASSERT_EQ(of_ends.size(), of_points.size());
  for (auto a = of_ends.begin(), b = of_points.begin(); a != of_ends.end(); ++a, ++b) {
    const SurfaceChunk &ends = a->second, &points = b->second;
    ASSERT_EQ(a->first, b->first);
    EXPECT_EQ(ends.triangles, points.triangles);
    if (ends.ends.empty()) {  // a chunk without a page
      EXPECT_EQ(ends.points, points.points);
      continue;
    }
    EXPECT_TRUE(ends.points.empty() && ends.normals.empty());
    ASSERT_EQ(ends.ends.size(), points.points.size());
    for (std::size_t n = 0; n < ends.ends.size(); ++n) {
      const EdgeEnds& edge = ends.ends[n];
      const double t = edge.parameter(isovalue, SurfaceRequest{}.least_parameter);
      const Vec3 at = edge.at(t),
                 place = ends.corner + Vec3{ends.step.x * at.x, ends.step.y * at.y, ends.step.z * at.z};
      EXPECT_LT(distance(place, points.points[n]), 1e-12 * (1 + norm(points.points[n])));
      const auto& d = edge.descents;
      const Vec3 first{double(d[0]), double(d[1]), double(d[2])},
          second{double(d[3]), double(d[4]), double(d[5])}, descent = (1 - t) * first + t * second;
      // Where the gradients of both ends nearly cancel, the direction has fewer bits.
      if (norm(descent) < 300) continue;
      EXPECT_GT(dot(normalized(descent), points.normals[n]), 1 - 1e-4);
    }
  }
}

class FrameChunks : public testing::TestWithParam<unsigned> {
 protected:
  [[nodiscard]] auto hills() const {
    return [noise = GetParam() % 2 == 0 ? 2.0 : 40.0, random = std::mt19937(6)](LatticePoint p) mutable {
      return 100 + 60 * std::sin(0.35 * p.i + 0.2 * p.k) * std::cos(0.3 * p.j) +
             noise * static_cast<double>(random() % 1024) / 1024;
    };
  }
  template <class Sample>
  void fly(const MemoryVolume<Sample>& volume, bool is_whole);
};

template <class Sample>
void FrameChunks::fly(const MemoryVolume<Sample>& volume, bool is_whole) {
  OpenStore<Sample> store(volume), other(volume), third(volume);
  Path path(volume.grid.box(), GetParam());
  PagedFrames<Sample> frames(store.pages(), 1 << 14), of_ends(third.pages(), 1 << 14, SurfaceForm::kEdgeEnds);
  Copy copy, copy_of_ends;
  FrameRequest first;
  Chunks first_chunks;
  std::size_t stopped = 0, kept = 0;
  double isovalue = 80.5;
  for (int n = 0; n < 24; ++n) {
    FrameRequest wanted;
    wanted.viewpoint = path.next();
    // The new isovalue may lie between the same two samples as the last one.
    if (path.number(5) == 0) isovalue = 80.1 + path.number(3) * 20 + 0.4 * path.number(3);
    wanted.isovalue = isovalue;
    wanted.pixels = 0.5 * (1 + path.number(8));
    if (path.number(3) != 0) wanted.max_triangles = 40 + path.number(12000);
    const std::uint32_t steps = 1 + path.number(120);
    std::uint32_t done = 0;
    if (path.number(4) == 0) wanted.stop = [&] { return ++done >= steps; };
    const Chunks before = chunks_of(frames);
    set_thread_limit(4);
    const FrameFigures figures = frames.refine(wanted);
    copy.update(frames);
    FrameRequest unlimited = wanted;
    if (path.number(2) == 0) unlimited.stop = nullptr;
    done = 0;
    const bool has_ends = !of_ends.refine(unlimited).stopped;
    copy_of_ends.update(of_ends);
    set_thread_limit(1);
    const Contour contour = frames.contour();
    EXPECT_EQ(figures.triangles, contour.triangles.size());
    if (is_whole) test::expect_sound(contour, volume.grid.box());
    if (n % 6 == 0) expect_parts<Sample>(store.pages(), frames);
    if (figures.stopped) {
      ++stopped;
      // A frame that was stopped leaves the chunks as they were, or those of the mesh in which nothing is
      // split.
      if (chunks_of(frames).size() > 1) expect_same(chunks_of(frames), before);
      continue;
    }
    PagedFrames<Sample> fresh(other.pages());
    wanted.stop = nullptr;
    const FrameFigures of_fresh = fresh.refine(wanted);
    expect_same(chunks_of(frames), chunks_of(fresh));
    EXPECT_EQ(contour, fresh.contour());
    if (has_ends) {
      expect_ends(chunks_of(of_ends), chunks_of(fresh), isovalue);
      EXPECT_EQ(of_ends.contour(), contour);
    }
    EXPECT_EQ(figures.largest_error, of_fresh.largest_error);
    kept += chunks_of(frames).size() - frames.changes().added.size() - frames.changes().changed.size();
    if (first_chunks.empty()) {
      first = wanted;
      first_chunks = chunks_of(frames);
    }
  }
  EXPECT_GT(stopped, 3u);
  EXPECT_GT(kept, 20u);
  frames.refine(first);
  expect_same(chunks_of(frames), first_chunks);
  set_thread_limit(0);
}

TEST_P(FrameChunks, AreThoseFromScratch) { fly(MemoryVolume<std::uint8_t>({51, 44, 34}, hills()), true); }

TEST_P(FrameChunks, AreThoseFromScratchOfWordsOnAGridOfUnequalSpacing) {
  fly(MemoryVolume<std::int16_t>({40, 36, 50}, hills(), {1, 0.7, 1.4}, {-3, 1e3, 7}), true);
}

TEST_P(FrameChunks, AreThoseFromScratchWhereSamplesAreNoNumbers) {
  auto with_holes = [value = hills()](LatticePoint p) mutable {
    const double sample = value(p);
    return p.i % 23 == 5 && p.j % 17 == 3 ? std::numeric_limits<double>::quiet_NaN() : sample;
  };
  fly(MemoryVolume<float>({44, 40, 37}, with_holes), false);
}

INSTANTIATE_TEST_SUITE_P(Seeds, FrameChunks, testing::Range(0u, 2u));

TEST(PagedFrames, KeepTheEndsOfEdgesForAnotherIsovalueBetweenTheSameSamples) {
  const MemoryVolume<std::uint8_t> volume({100, 60, 50}, [](LatticePoint p) {
    return 100 + 60 * std::sin(0.35 * p.i + 0.2 * p.k) * std::cos(0.3 * p.j);
  });
  OpenStore<std::uint8_t> store(volume), other(volume);
  PagedFrames<std::uint8_t> frames(store.pages(), 1 << 20, SurfaceForm::kEdgeEnds);
  Path path(volume.grid.box(), 3);
  FrameRequest wanted;
  wanted.viewpoint = path.next();
  for (const double isovalue : {90.5, 90.75, 90.01, 90.99, 91.5, 90.5}) {
    const bool is_between_same = std::ceil(isovalue) == std::ceil(wanted.isovalue);
    wanted.isovalue = isovalue;
    const Chunks before = chunks_of(frames);
    frames.refine(wanted);
    const Chunks now = chunks_of(frames);
    PagedFrames<std::uint8_t> fresh(other.pages());
    fresh.refine(wanted);
    expect_ends(now, chunks_of(fresh), isovalue);
    std::size_t same = 0, whole = 0;
    for (const auto& [id, chunk] : now) {
      if (chunk.ends.empty()) continue;
      ++whole;
      const auto known = before.find(id);
      same += known != before.end() && known->second.revision == chunk.revision ? 1 : 0;
    }
    ASSERT_GT(whole, 30u);
    // Chunks that the border of the data cuts are made anew.
    if (is_between_same) {
      EXPECT_GT(same, whole / 4);
    }
  }
}

TEST(PagedFrames, ForgetPagesThatAreOutOfSight) {
  const MemoryVolume<std::uint8_t> volume({200, 40, 40}, [](LatticePoint p) {
    return 100 + 60 * std::sin(0.35 * p.i + 0.2 * p.k) * std::cos(0.3 * p.j);
  });
  OpenStore<std::uint8_t> store(volume);
  PagedFrames<std::uint8_t> all(store.pages()), few(store.pages(), 0);
  FrameRequest wanted;
  wanted.isovalue = 80.5;
  wanted.viewpoint.up = {0, 0, 1};
  wanted.viewpoint.field_of_view = 0.3;
  for (int n = 0; n < 40; ++n) {
    wanted.viewpoint.eye = {5.0 * n, -60, 20};
    wanted.viewpoint.target = {5.0 * n, 20, 20};
    all.refine(wanted);
    few.refine(wanted);
    expect_same(chunks_of(few), chunks_of(all));
  }
  EXPECT_LT(few.known_bytes(), all.known_bytes() / 2);
}

TEST(PageViews, SayOfDiamondsWhatViewsSayOfTheirBoxes) {
  const MemoryVolume<std::uint8_t> volume({67, 50, 41}, [](LatticePoint p) { return p.i + p.j; });
  OpenStore<std::uint8_t> store(volume);
  ViewedDiamonds<std::uint8_t> diamonds(store.pages());
  Path path(volume.grid.box(), 5);
  std::size_t hidden = 0, whole = 0, cut = 0;
  for (int n = 0; n < 200; ++n) {
    const View view(path.next());
    const int lod = static_cast<int>(path.number(3) == 0 ? path.number(5) : 0);
    const LatticePoint reach = diamonds.grid().reach(lod), blocks{reach.i / 16, reach.j / 16, reach.k / 16};
    const auto one_of = [&](std::int32_t last) {
      return static_cast<std::int32_t>(path.number(static_cast<std::uint32_t>(last) + 1));
    };
    const LatticePoint block{one_of(blocks.i), one_of(blocks.j), one_of(blocks.k)};
    const PageView page(view, LodPlaces(diamonds.domain(), diamonds.lattice_step(lod), reach), block);
    hidden += page.is_hidden() ? 1 : 0;
    whole += page.is_whole() ? 1 : 0;
    for (std::uint16_t place = 0; place < PageGrid::kPoints; ++place) {
      const LatticePoint u = 16 * block + CrossedPage::point(place);
      if (u.i > reach.i || u.j > reach.j || u.k > reach.k || ((u.i | u.j | u.k) & 1) == 0) continue;
      const Diamond diamond(diamonds.lattice_step(lod) * u);
      const CentredBox box{diamonds.domain().position(diamond.point()),
                           nested_half(diamonds.domain(), diamond.scale(), diamond.phase())};
      const double depth = page.depth(place, diamond.phase());
      EXPECT_EQ(depth, view.depth(box));
      EXPECT_LE(page.least_depth(diamond.phase()), depth);
      EXPECT_GE(page.greatest_depth(diamond.phase()), depth);
      if (page.is_hidden()) {
        EXPECT_FALSE(view.is_visible(box));
      } else {
        EXPECT_EQ(page.is_visible(place, diamond.phase()), view.is_visible(box));
        cut += view.is_visible(box) ? 0 : 1;
      }
      if (page.is_whole()) {
        EXPECT_TRUE(view.is_visible(box));
      }
    }
  }
  EXPECT_GT(hidden, 10u);
  EXPECT_GT(whole, 10u);
  EXPECT_GT(cut, 100u);
}

TEST(ViewedDiamonds, HaveAClassUpToADepth) {
  const MemoryVolume<std::uint8_t> volume({67, 50, 41}, [](LatticePoint p) { return p.i + p.j; });
  OpenStore<std::uint8_t> store(volume);
  ViewedDiamonds<std::uint8_t> diamonds(store.pages());
  Path path(volume.grid.box(), 7);
  for (int n = 0; n < 20; ++n) {
    const View view(path.next());
    diamonds.set_view(view);
    for (const double error : {1e-6, 0.01, 0.37, 1.0, 25.0}) {
      for (int view_class = 1; view_class <= ViewedDiamonds<std::uint8_t>::kClasses; ++view_class) {
        const double farthest = diamonds.farthest(error, view_class);
        const auto class_at = [&](double depth) { return diamonds.view_class(view.pixels_at(error, depth)); };
        if (std::isinf(farthest)) {
          EXPECT_GE(class_at(std::numeric_limits<double>::max()), view_class);
        } else if (farthest < 0) {
          EXPECT_LT(class_at(1e-3), view_class);
        } else {
          EXPECT_GE(class_at(farthest), view_class);
          EXPECT_LT(class_at(std::nextafter(farthest, std::numeric_limits<double>::infinity())), view_class);
        }
      }
    }
  }
}

}  // namespace
}  // namespace adamas
