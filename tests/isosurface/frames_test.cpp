#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <random>
#include <set>

#include "core/geometry/plane.h"
#include "isosurface/view/depth_pyramid.h"
#include "isosurface/view/paged_frames.h"
#include "tests/isosurface/contour_checks.h"
#include "tests/isosurface/surface_checks.h"
#include "tests/support/queued_frames.h"

namespace adamas {

using namespace isosurface;

namespace {

using test::IndexedHierarchy;
using test::MemoryVolume;
using test::OpenStore;
using test::QueuedFrames;

MemoryVolume<std::uint8_t> hills(const test::Dimensions& dimensions, double noise) {
  return {dimensions, [noise, random = std::mt19937(6)](LatticePoint p) mutable {
            return 100 + 60 * std::sin(0.35 * p.i + 0.2 * p.k) * std::cos(0.3 * p.j) +
                   noise * static_cast<double>(random() % 1024) / 1024;
          }};
}

/// A path of cameras round and through a box, with jumps.
class Flight {
 public:
  Flight(const Box3& box, unsigned seed) : box_(box), random_(seed) {}

  Viewpoint next() {
    std::uniform_real_distribution<double> unit(-1, 1);
    const auto point = [&](double size) {
      const Vec3 half = 0.5 * size * box_.size();
      return 0.5 * (box_.min + box_.max) +
             Vec3{unit(random_) * half.x, unit(random_) * half.y, unit(random_) * half.z};
    };
    Viewpoint viewpoint;
    viewpoint.eye = random_() % 3 == 0 ? point(1) : point(4);
    viewpoint.target = point(1);
    viewpoint.up = {0.1, 0.2, 1};
    viewpoint.near = 0.5;
    viewpoint.width_pixels = 400;
    viewpoint.height_pixels = 300;
    viewpoint.height = random_() % 5 == 0 ? box_.diagonal() / 2 : 0;
    return viewpoint;
  }
  std::uint32_t number(std::uint32_t below) { return static_cast<std::uint32_t>(random_() % below); }

 private:
  Box3 box_;
  std::mt19937 random_;
};

/// The volume of a store as a field for contours of any mesh.
class Frames : public testing::TestWithParam<unsigned> {
 protected:
  MemoryVolume<std::uint8_t> volume = hills({35, 30, 22}, GetParam() % 2 == 0 ? 2 : 40);
  OpenStore<std::uint8_t> store{volume};
  Flight path{volume.grid.box(), GetParam()};

  [[nodiscard]] QueuedFrames<std::uint8_t> frames() { return QueuedFrames<std::uint8_t>(store.pages()); }
  FrameRequest request() {
    FrameRequest result;
    result.viewpoint = path.next();
    result.isovalue = 80.5 + path.number(3) * 20;
    result.pixels = 0.5 * (1 + path.number(16));
    return result;
  }
  /// Returns the depths of a picture that has walls in some squares, and nothing elsewhere.
  std::shared_ptr<const DepthPyramid> walls(const Viewpoint& viewpoint) {
    const auto width = static_cast<std::size_t>(viewpoint.width_pixels),
               height = static_cast<std::size_t>(viewpoint.height_pixels);
    constexpr std::size_t kSquare = 50;
    std::vector<float> squares;
    for (std::size_t n = 0; n < (width / kSquare) * (height / kSquare); ++n)
      squares.push_back(path.number(3) == 0 ? std::numeric_limits<float>::infinity()
                                            : 0.1F * static_cast<float>(path.number(400)));
    std::vector<float> depths;
    for (std::size_t y = 0; y < height; ++y) {
      for (std::size_t x = 0; x < width; ++x)
        depths.push_back(squares[y / kSquare * (width / kSquare) + x / kSquare]);
    }
    return std::make_shared<DepthPyramid>(viewpoint, depths);
  }
  Contour contour(const QueuedFrames<std::uint8_t>& of, double isovalue) {
    const int lods = store.pages().grid().depth();
    return extract_contour(of.mesh(), test::field_of(volume, lods), isovalue,
                           test::options_of(volume, lods, 1.0 / 1024));
  }
  void expect_sound(const QueuedFrames<std::uint8_t>& of, const FrameRequest& request,
                    const FrameFigures& figures) {
    of.mesh().validate();
    const Contour found = contour(of, request.isovalue);
    test::expect_sound(found, volume.grid.box());
    EXPECT_EQ(found.triangles.size(), figures.triangles);
  }
  /// Returns the number of triangles of the mesh in which nothing is split.
  std::uint64_t least_triangles(double isovalue) {
    FrameRequest all;
    all.isovalue = isovalue;
    all.stop = [] { return true; };
    auto root = frames();
    return root.refine(all).triangles;
  }
};

TEST_P(Frames, AreTheMeshOfTheWantedErrorWhereverTheyComeFrom) {
  const test::DiamondTable table(store);
  auto found = frames();
  FrameRequest first = request();
  found.refine(first);
  const std::uint64_t first_mesh = found.mesh().checksum();
  for (int n = 0; n < 4; ++n) {
    const FrameRequest wanted = request();
    const FrameFigures figures = found.refine(wanted);
    expect_sound(found, wanted, figures);
    EXPECT_LE(figures.largest_error, wanted.pixels);
    // The same mesh is found from scratch: by the queues, and by a search of all diamonds.
    auto fresh = frames();
    const FrameFigures of_fresh = fresh.refine(wanted);
    EXPECT_EQ(fresh.mesh().checksum(), found.mesh().checksum());
    EXPECT_EQ(of_fresh.merges, 0u);
    EXPECT_EQ(of_fresh.largest_error, figures.largest_error);
    ViewedDiamonds<std::uint8_t> diamonds(store.pages());
    diamonds.set_contour(wanted.isovalue);
    diamonds.set_view(View(wanted.viewpoint));
    IndexedHierarchy direct(diamonds.domain(), diamonds.lods());
    std::vector<LatticePoint> done;
    for (const auto& [p, values] : table.diamonds()) {
      const LatticePoint q = diamonds.lattice_step(0) * p;
      if (diamonds.pixels(q) > wanted.pixels) direct.split(q, done);
    }
    EXPECT_EQ(direct.checksum(), found.mesh().checksum());
  }
  found.refine(first);
  EXPECT_EQ(found.mesh().checksum(), first_mesh);
}

TEST_P(Frames, AreWithinTheirBudgetWhereverTheWorkIsStopped) {
  auto found = frames();
  std::size_t stopped = 0;
  for (int n = 0; n < 36; ++n) {
    FrameRequest wanted = request();
    wanted.pixels = 0.5;
    wanted.max_triangles = 40 + path.number(3000);
    const std::uint32_t steps = path.number(400);
    std::uint32_t done = 0;
    wanted.stop = [&] { return done++ == steps; };
    const FrameFigures figures = found.refine(wanted);
    stopped += figures.stopped ? 1 : 0;
    EXPECT_EQ(figures.splits + figures.merges + 1, done);
    EXPECT_LE(figures.triangles, std::max(*wanted.max_triangles, least_triangles(wanted.isovalue)));
    expect_sound(found, wanted, figures);
  }
  EXPECT_GT(stopped, 10u);
}

TEST_P(Frames, HaveTheSameLargestErrorWithinABudgetWhereverTheyComeFrom) {
  auto found = frames();
  std::size_t limited = 0;
  for (int n = 0; n < 9; ++n) {
    FrameRequest wanted = request();
    wanted.max_triangles = 300 + path.number(3000);
    const FrameFigures figures = found.refine(wanted);
    auto fresh = frames();
    const FrameFigures of_fresh = fresh.refine(wanted);
    EXPECT_EQ(found.diamonds().view_class(figures.largest_error),
              found.diamonds().view_class(of_fresh.largest_error));
    if (figures.largest_error <= wanted.pixels) continue;
    ++limited;
    EXPECT_GE(static_cast<double>(figures.triangles), 0.95 * static_cast<double>(*wanted.max_triangles));
  }
  EXPECT_GT(limited, 3u);
}

TEST_P(Frames, StateNoLessThanASurfaceOfAllSamplesWouldShow) {
  // A diamond that is not split has the error that the store states for it, at its point nearest to the eye.
  auto found = frames();
  FrameRequest wanted = request();
  wanted.max_triangles = 500;
  const FrameFigures figures = found.refine(wanted);
  const View view(wanted.viewpoint);
  StoredDiamonds<std::uint8_t> stored(store.pages());
  stored.set_contour(wanted.isovalue);
  found.mesh().for_each_diamond([&](const Diamond& diamond, std::uint8_t) {
    if (!found.diamonds().is_stored(diamond.point())) return;
    const double error = found.diamonds().error(stored.class_if_crossed(diamond.point()));
    const double scale = diamond.scale();
    const CentredBox box{found.mesh().domain().position(diamond.point()),
                         scale * found.mesh().domain().spacing()};
    if (view.is_visible(box)) {
      EXPECT_LE(view.pixels(error, box), figures.largest_error * (1 + 1e-12));
    }
  });
}

/// Returns the edges of the mesh that the points lie on, without those of points at the border of the data.
std::set<test::Edge> edges_of(const Contour& contour) {
  std::set<test::Edge> edges;
  for (const EdgePoint& p : contour.edge_points) edges.insert({p.first, p.second});
  return edges;
}

TEST_P(Frames, ByPagesAreThoseByQueues) {
  auto queued = frames();
  PagedFrames<std::uint8_t> paged(store.pages());
  std::uint64_t splits = 0, merges = 0;
  for (int n = 0; n < 9; ++n) {
    FrameRequest wanted = request();
    // This is the least error of a class.
    const double least = std::exp2(0.25 * (static_cast<double>(path.number(16)) - 4));
    wanted.pixels = (1 + 1e-9) * least;
    const FrameFigures found = paged.refine(wanted);
    wanted.pixels = (1 - 1e-12) * least;
    const FrameFigures expected = queued.refine(wanted);
    EXPECT_EQ(found.triangles, expected.triangles);
    EXPECT_LE(expected.largest_error, found.largest_error * (1 + 1e-12));
    EXPECT_LE(found.largest_error, (1 + 1e-9) * least);
    const Contour by_queues = contour(queued, wanted.isovalue);
    EXPECT_EQ(paged.contour().points.size(), by_queues.points.size());
    EXPECT_EQ(edges_of(paged.contour()), edges_of(by_queues));
    const test::SurfaceMeasure measure = test::measure(by_queues);
    test::expect_near(test::measure(paged.contour()), measure, 1e-7 * (1 + measure.area));
    test::expect_sound(paged.contour(), volume.grid.box());
    splits += found.splits;
    merges += found.merges;
  }
  EXPECT_GT(splits, 1000u);
  EXPECT_GT(merges, 100u);
}

/// Returns the error of the diamond whose tetrahedron in the mesh holds a place, by a search of all of them;
/// none on the border between two.
std::optional<double> error_by_all_cells(QueuedFrames<std::uint8_t>& frames, const Vec3& place) {
  std::optional<LatticePoint> found;
  const Domain& domain = frames.mesh().domain();
  frames.mesh().for_each_tetrahedron([&](const Diamond& diamond, int slot) {
    std::array<Vec3, 4> corners;
    for (std::size_t n = 0; n < 4; ++n) corners[n] = domain.position(diamond.tetrahedron(slot)[n]);
    for (std::size_t n = 0; n < 4; ++n) {
      const Vec3 &a = corners[(n + 1) % 4], &b = corners[(n + 2) % 4], &c = corners[(n + 3) % 4];
      const Vec3 normal = cross(b - a, c - a);
      if (dot(normal, place - a) * dot(normal, corners[n] - a) <= 0) return;
    }
    found = diamond.point();
  });
  if (!found) return std::nullopt;
  auto& diamonds = frames.diamonds();
  return diamonds.is_stored(*found) ? diamonds.error(diamonds.class_if_crossed(*found)) : 0;
}

TEST_P(Frames, TellTheErrorOfTheCellAtAPlace) {
  PagedFrames<std::uint8_t> paged(store.pages());
  EXPECT_FALSE(paged.error_at(volume.grid.box().center()));
  std::mt19937 random(GetParam());
  std::size_t large = 0;
  for (int frame = 0; frame < 4; ++frame) {
    QueuedFrames<std::uint8_t> queued = frames();
    FrameRequest wanted = request();
    // This is the least error of a class.
    wanted.pixels = (1 - 1e-12) * (4 << frame);
    queued.refine(wanted);
    wanted.pixels = (1 + 1e-9) * (4 << frame);
    paged.refine(wanted);
    const Box3 box = volume.grid.box();
    for (int n = 0; n < 40; ++n) {
      std::uniform_real_distribution<double> part(0, 1);
      const Vec3 size = box.size(),
                 place = box.min + Vec3{part(random) * size.x, part(random) * size.y, part(random) * size.z};
      const auto expected = error_by_all_cells(queued, place);
      if (!expected) continue;
      ASSERT_EQ(paged.error_at(place), expected);
      large += *expected > 0.5 ? 1 : 0;
    }
  }
  EXPECT_GT(large, 10u);
}

TEST_P(Frames, ShowTheCellsThatAPlaneCuts) {
  PagedFrames<std::uint8_t> paged(store.pages());
  const Box3 box = volume.grid.box();
  EXPECT_TRUE(paged.cells_in({box.center(), {1, 0, 0}}).empty());
  for (const Vec3& normal : {Vec3{1, 0, 0}, {0.3, -1, 0.7}}) {
    const Plane plane{box.center() + Vec3{0.13, 0.21, 0.17}, normal};
    QueuedFrames<std::uint8_t> queued = frames();
    FrameRequest wanted = request();
    wanted.pixels = (1 - 1e-12) * 4;
    queued.refine(wanted);
    wanted.pixels = (1 + 1e-9) * 4;
    paged.refine(wanted);
    // Every cell that the plane crosses within the data has a polygon, and the polygons cover the plane once.
    std::size_t cells = 0;
    queued.mesh().for_each_tetrahedron([&](const Diamond& diamond, int slot) {
      int above = 0;
      std::array<Vec3, 4> corners;
      for (std::size_t n = 0; n < 4; ++n) {
        corners[n] = queued.mesh().domain().position(diamond.tetrahedron(slot)[n]);
        above += dot(normal, corners[n] - plane.origin) > 0 ? 1 : 0;
      }
      if (above == 0 || above == 4) return;
      int within = 0;
      for (const Vec3& corner : corners) within += box.contains(corner) ? 1 : 0;
      cells += within == 4 ? 1 : 0;
    });
    const auto polygons = paged.cells_in(plane);
    EXPECT_GE(polygons.size(), cells);
    EXPECT_GT(cells, 100u);
    double area = 0;
    for (const auto& polygon : polygons) area += polygon_area(polygon);
    EXPECT_NEAR(area, polygon_area(clip_plane(plane, box)), 1e-6 * area);
  }
}

TEST_P(Frames, SplitNothingThatAPictureHides) {
  auto queued = frames();
  PagedFrames<std::uint8_t> paged(store.pages());
  const test::DiamondTable table(store);
  std::uint64_t fewer = 0, hidden = 0;
  for (int n = 0; n < 12; ++n) {
    FrameRequest wanted = request();
    const double least = std::exp2(0.25 * (static_cast<double>(path.number(12)) - 4));
    wanted.pixels = (1 + 1e-9) * least;
    const std::uint64_t all = paged.refine(wanted).triangles;
    wanted.depths = walls(wanted.viewpoint);
    const FrameFigures found = paged.refine(wanted);
    EXPECT_LE(found.triangles, all);
    EXPECT_LE(found.hidden, found.depth_tests);
    fewer += found.triangles < all ? 1 : 0;
    hidden += found.hidden;
    test::expect_sound(paged.contour(), volume.grid.box());
    // The same mesh is found by the queues, and by a search of all diamonds.
    wanted.pixels = (1 - 1e-12) * least;
    const FrameFigures expected = queued.refine(wanted);
    expect_sound(queued, wanted, expected);
    EXPECT_EQ(found.triangles, expected.triangles);
    EXPECT_EQ(edges_of(paged.contour()), edges_of(contour(queued, wanted.isovalue)));
    ViewedDiamonds<std::uint8_t> diamonds(store.pages());
    diamonds.set_contour(wanted.isovalue);
    diamonds.set_view(View(wanted.viewpoint, wanted.depths));
    IndexedHierarchy direct(diamonds.domain(), diamonds.lods());
    std::vector<LatticePoint> done;
    for (const auto& [p, values] : table.diamonds()) {
      const LatticePoint q = diamonds.lattice_step(0) * p;
      if (diamonds.pixels(q) > wanted.pixels) direct.split(q, done);
    }
    EXPECT_EQ(direct.checksum(), queued.mesh().checksum());
  }
  EXPECT_GT(fewer, 5u);
  EXPECT_GT(hidden, 100u);
}

TEST_P(Frames, ByPagesAreWithinTheirBudgetWhereverTheWorkIsStopped) {
  PagedFrames<std::uint8_t> paged(store.pages());
  std::size_t stopped = 0, limited = 0;
  for (int n = 0; n < 36; ++n) {
    FrameRequest wanted = request();
    wanted.pixels = 0.5;
    wanted.max_triangles = 40 + path.number(3000);
    const std::uint32_t steps = 1 + path.number(80);
    std::uint32_t done = 0;
    if (n % 2 == 0) wanted.stop = [&] { return ++done == steps; };
    const FrameFigures figures = paged.refine(wanted);
    stopped += figures.stopped ? 1 : 0;
    const std::uint64_t most = std::max(*wanted.max_triangles, least_triangles(wanted.isovalue));
    EXPECT_EQ(figures.triangles, paged.contour().triangles.size());
    test::expect_sound(paged.contour(), volume.grid.box());
    EXPECT_LE(figures.triangles, most);
    if (figures.stopped || figures.largest_error <= wanted.pixels * 1.2) continue;
    ++limited;
    EXPECT_GE(static_cast<double>(figures.triangles) + 16, 0.95 * static_cast<double>(*wanted.max_triangles));
    // The greatest error that is left is that of the queues, up to the width of a class.
    auto queued = frames();
    wanted.stop = nullptr;
    const FrameFigures expected = queued.refine(wanted);
    EXPECT_LE(expected.largest_error, figures.largest_error * (1 + 1e-12));
    EXPECT_LE(figures.largest_error, 1.5 * expected.largest_error);
  }
  EXPECT_GT(stopped, 5u);
  EXPECT_GT(limited, 5u);
}

INSTANTIATE_TEST_SUITE_P(Seeds, Frames, testing::Range(0u, 2u));

}  // namespace
}  // namespace adamas
