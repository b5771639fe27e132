#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <random>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

#include "isosurface/view/paged_frames.h"
#include "tests/isosurface/contour_checks.h"
#include "tests/isosurface/frame_checks.h"
#include "tests/isosurface/surface_checks.h"

namespace adamas {

using namespace isosurface;
using test::IndexedHierarchy;

namespace {

using Sample = std::uint8_t;
using test::CameraPath;
using test::chunks_of;
using test::expect_same;
using test::MemoryVolume;
using test::OpenStore;

constexpr std::int32_t kSide = PageGrid::kSide;
constexpr std::uint64_t kPages = 585;  ///< the greatest number of a page in four LODs

/// A set of pages, as their numbers.
using PageSet = std::set<std::uint64_t>;

/// Returns the page that has a cube's points. A cube without a page of its own has its only point on a
/// coarser page.
PageId page_with_points(const PageGrid& grid, PageId id) {
  while (!grid.contains(id)) id = {id.lod + 1, {id.block.i / 2, id.block.j / 2, id.block.k / 2}};
  return id;
}

class ResidentFrames : public testing::TestWithParam<unsigned> {
 protected:
  MemoryVolume<Sample> volume{
      test::Dimensions{GetParam() % 2 == 0 ? 51u : 33u, 44, 34},
      [noise = GetParam() % 2 == 0 ? 2.0 : 40.0, random = std::mt19937(6)](LatticePoint p) mutable {
        return 100 + 60 * std::sin(0.35 * p.i + 0.2 * p.k) * std::cos(0.3 * p.j) +
               noise * static_cast<double>(random() % 1024) / 1024;
      }};
  OpenStore<Sample> whole{volume}, some{volume};
  const PageGrid& grid = whole.pages().grid();
  ViewedDiamonds<Sample> diamonds{whole.pages()};
  test::DiamondTable<Sample> table{whole};
  CameraPath path{volume.grid.box(), GetParam()};
  PageSet in_memory{grid.number({grid.top(), {}})};
  double isovalue = 80.5;

  FrameRequest request() {
    FrameRequest result;
    result.viewpoint = path.next();
    if (path.number(3) == 0) change_isovalue();
    result.isovalue = isovalue;
    result.pixels = 0.5 * (1 + path.number(6));
    result.resident_only = true;
    return result;
  }
  /// Changes the isovalue. What was found for the last isovalue is forgotten, and bounds may have left memory
  /// since then.
  void change_isovalue() {
    const double before = std::exchange(isovalue, 80.5 + 20 * path.number(3));
    if (isovalue == before) return;
    for (std::uint64_t n = 1; n <= kPages; ++n) {
      if (grid.contains(grid.page(n)) && !some.pages().has(grid.page(n), PageParts::kAll)) in_memory.erase(n);
    }
  }
  /// Puts a page into memory, with its bounds or without them.
  bool put(const PageId& id, bool with_bounds = true) {
    Page<Sample> page;
    EXPECT_TRUE(whole.pages().copy(id, page));
    if (with_bounds) in_memory.insert(grid.number(id));
    return some.pages().put(id, page, with_bounds ? &page : nullptr, 0);
  }
  void put_some(unsigned of) {
    for (std::uint64_t n = 1; n <= kPages; ++n) {
      const PageId id = grid.page(n);
      if (!grid.contains(id)) continue;
      static_cast<void>(some.file().entry(0, id));
      if (path.number(of) == 0) put(id);
    }
  }
  /// Puts missing pages into memory, at most `most` of them.
  void put_missing(const PagedFrames<Sample>& frames, std::size_t most) {
    const std::vector<MissingPage>& missing = frames.missing_pages();
    for (std::size_t n = 0; n < std::min(most, missing.size()); ++n) {
      const auto& [id, part, view_class, depth, step] = missing[n];
      if (part == MissingPage::Part::kDirectory) {
        some.file().take_over(whole.file().directory_part(0, id));
      } else {
        put(id, part == MissingPage::Part::kAll);
      }
    }
  }

  using Wanted = std::pair<LatticePoint, int>;
  struct OfPage {
    std::vector<std::tuple<double, int, LatticePoint>> crossed;  ///< minus the error, phase, point in samples
  };
  /// Returns the diamonds that a contour crosses, by LOD and page.
  std::map<std::pair<int, LatticePoint>, OfPage> crossed() {
    std::map<std::pair<int, LatticePoint>, OfPage> result;
    for (const auto& [p, values] : table.diamonds()) {
      if (!values.is_crossed(isovalue) || !(values.error > 0)) continue;
      const int lod = trailing_zeros(p);
      const LatticePoint u{p.i >> lod, p.j >> lod, p.k >> lod},
          block = lod < grid.top() ? LatticePoint{u.i / kSide, u.j / kSide, u.k / kSide} : LatticePoint{};
      result[{lod, block}].crossed.emplace_back(-values.error, Diamond(diamonds.lattice_step(0) * p).phase(),
                                                p);
    }
    for (auto& [page, of] : result)
      std::ranges::sort(of.crossed, {},
                        [](const auto& one) { return std::pair(std::get<0>(one), std::get<1>(one)); });
    return result;
  }
  /// Returns whether the samples round a diamond, one step along each axis, are in memory.
  bool has_members(LatticePoint p) {
    const int lod = trailing_zeros(p);
    if (lod >= grid.top()) return true;
    const LatticePoint u{p.i >> lod, p.j >> lod, p.k >> lod}, end = grid.extent(lod);
    for (std::int32_t n = 0; n < 27; ++n) {
      const LatticePoint at = u + LatticePoint{n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1};
      if (std::min({at.i, at.j, at.k}) < 0 || at.i > end.i || at.j > end.j || at.k > end.k) continue;
      const PageId id = page_with_points(grid, {lod, {at.i / kSide, at.j / kSide, at.k / kSide}});
      if (!some.pages().has(id, PageParts::kSamples)) return false;
    }
    return true;
  }
  /// Returns the diamonds whose samples and errors are in memory, for which the same holds for all diamonds
  /// of greater errors on their pages.
  std::set<LatticePoint> usable() {
    std::set<LatticePoint> result;
    for (const auto& each : crossed()) {
      const auto& [lod, block] = each.first;
      const OfPage& of = each.second;
      if (lod < grid.top() && !in_memory.contains(grid.number({lod, block}))) continue;
      for (std::size_t begin = 0, end = 0; begin < of.crossed.size(); begin = end) {
        const auto group = [&](std::size_t n) {
          return std::pair(std::get<0>(of.crossed[n]), std::get<1>(of.crossed[n]));
        };
        while (end < of.crossed.size() && group(end) == group(begin)) ++end;
        bool all = true;
        for (std::size_t n = begin; n < end; ++n) all = all && has_members(std::get<2>(of.crossed[n]));
        if (!all) break;
        for (std::size_t n = begin; n < end; ++n) result.insert(std::get<2>(of.crossed[n]));
      }
    }
    return result;
  }
  /// Returns the mesh of a request, found by a search of all diamonds, coarse ones first. `largest` becomes
  /// the greatest error of those that are not split.
  IndexedHierarchy mesh(const FrameRequest& wanted, double& largest) {
    diamonds.set_contour(wanted.isovalue);
    diamonds.set_view(View(wanted.viewpoint));
    const std::set<LatticePoint> in_use = usable();
    std::vector<LatticePoint> points;
    for (const auto& [p, values] : table.diamonds()) points.push_back(p);
    std::ranges::stable_sort(points, {}, [&](LatticePoint p) {
      const Diamond diamond(diamonds.lattice_step(0) * p);
      return 3 * diamond.level() + diamond.phase();
    });
    IndexedHierarchy result(diamonds.domain(), diamonds.lods());
    std::vector<LatticePoint> done;
    largest = 0;
    const int least = std::max(1, diamonds.view_class(wanted.pixels));
    for (const LatticePoint p : points) {
      const LatticePoint q = diamonds.lattice_step(0) * p;
      const double pixels = diamonds.pixels(q);
      const auto parents = Diamond(q).parents(diamonds.domain());
      const bool is_split = diamonds.view_class(pixels) >= least && in_use.contains(p) &&
                            std::ranges::all_of(parents, [&](LatticePoint parent) {
                              return !diamonds.is_stored(parent) || result.is_split(parent);
                            });
      if (is_split) {
        result.split(q, done);
      } else {
        largest = std::max(largest, pixels);
      }
    }
    return result;
  }
  std::set<test::Edge> edges_of(const Contour& contour) {
    std::set<test::Edge> edges;
    for (const EdgePoint& p : contour.edge_points) edges.insert({p.first, p.second});
    return edges;
  }
  void expect_right(const PagedFrames<Sample>& frames, const FrameRequest& wanted,
                    const FrameFigures& figures) {
    const int lods = grid.depth();
    double largest = 0;
    const Contour expected = extract_contour(mesh(wanted, largest), test::field_of(volume, lods),
                                             wanted.isovalue, test::options_of(volume, lods, 1.0 / 1024));
    test::expect_sound(frames.contour(), volume.grid.box());
    EXPECT_EQ(edges_of(frames.contour()), edges_of(expected));
    EXPECT_EQ(figures.triangles, expected.triangles.size());
    EXPECT_GE(figures.largest_error * (1 + 1e-12), largest);
  }
};

TEST_P(ResidentFrames, SplitWhatIsInMemoryAndSharpenUntilTheyAreThoseThatWait) {
  // With one parameter nothing is in memory at first, not even what the directory states of pages.
  if (GetParam() != 2) put_some(4);
  PagedFrames<Sample> frames(some.pages());
  std::size_t coarser = 0, steps = 0;
  for (int n = 0; n < 4; ++n) {
    const FrameRequest wanted = request();
    const std::uint64_t read = some.file().bytes_read();
    FrameFigures figures = frames.refine(wanted);
    if (n > 0) {
      EXPECT_EQ(some.file().bytes_read(), read);
    }
    for (;; figures = frames.refine(wanted)) {
      expect_right(frames, wanted, figures);
      EXPECT_EQ(figures.pages_missing, frames.missing_pages().size());
      if (figures.pages_missing == 0) break;
      coarser += figures.largest_error > wanted.pixels ? 1 : 0;
      ++steps;
      put_missing(frames, 1 + path.number(12));
      ASSERT_LT(steps, 1000u);
    }
    PagedFrames<Sample> fresh(whole.pages());
    FrameRequest all = wanted;
    all.resident_only = false;
    const FrameFigures expected = fresh.refine(all);
    expect_same(chunks_of(frames), chunks_of(fresh));
    EXPECT_EQ(figures.largest_error, expected.largest_error);
    EXPECT_EQ(figures.triangles, expected.triangles);
  }
  EXPECT_GT(steps, 5u);
  EXPECT_GT(coarser, 2u);
}

TEST_P(ResidentFrames, AreThoseFromScratchWithTheSamePages) {
  put_some(3);
  PagedFrames<Sample> frames(some.pages());
  OpenStore<Sample> other(volume);
  for (int n = 0; n < 8; ++n) {
    const FrameRequest wanted = request();
    frames.refine(wanted);
    put_missing(frames, 3);
    const FrameFigures figures = frames.refine(wanted);
    other.open();
    for (std::uint64_t number = 1; number <= kPages; ++number) {
      if (grid.contains(grid.page(number))) static_cast<void>(other.file().entry(0, grid.page(number)));
    }
    for (const auto& held : some.pages().held_pages()) {
      Page<Sample> page;
      ASSERT_TRUE(whole.pages().copy(held.id, page));
      other.pages().put(held.id, page, in_memory.contains(grid.number(held.id)) ? &page : nullptr, 0);
    }
    PagedFrames<Sample> fresh(other.pages());
    const FrameFigures of_fresh = fresh.refine(wanted);
    EXPECT_EQ(fresh.contour(), frames.contour());
    EXPECT_EQ(of_fresh.largest_error, figures.largest_error);
    EXPECT_EQ(fresh.missing_pages(), frames.missing_pages());
  }
}

TEST_P(ResidentFrames, MissPagesThatAFrameWhichWaitsReads) {
  PagedFrames<Sample> frames(some.pages());
  put_some(3);
  std::size_t missing = 0;
  for (int n = 0; n < 12; ++n) {
    const FrameRequest wanted = request();
    const FrameFigures figures = frames.refine(wanted);
    OpenStore<Sample> other(volume);
    PagedFrames<Sample> fresh(other.pages());
    FrameRequest all = wanted;
    all.resident_only = false;
    fresh.refine(all);
    const std::vector<MissingPage>& pages = frames.missing_pages();
    for (std::size_t m = 0; m < pages.size(); ++m) {
      const MissingPage& page = pages[m];
      const bool has_bounds = page.part == MissingPage::Part::kAll;
      EXPECT_FALSE(some.pages().has(page.id, has_bounds ? PageParts::kAll : PageParts::kSamples));
      if (m > 0) {
        EXPECT_GE(std::pair(pages[m - 1].view_class, -pages[m - 1].depth),
                  std::pair(page.view_class, -page.depth));
      }
      // Pages of class 0 are wanted for normals alone.
      if (page.view_class == 0) continue;
      ++missing;
      EXPECT_NE(other.pages().held(page.id), nullptr);
      EXPECT_GE(page.view_class, frames.diamonds().view_class(wanted.pixels));
      EXPECT_LE(frames.diamonds().most_pixels(page.view_class), figures.largest_error);
    }
  }
  EXPECT_GT(missing, 10u);
}

TEST_P(ResidentFrames, AreClosedWithinTheirBudgetWhereverTheWorkIsStopped) {
  put_some(6);
  PagedFrames<Sample> frames(some.pages());
  std::size_t stopped = 0, lacking = 0;
  for (int n = 0; n < 60; ++n) {
    FrameRequest wanted = request();
    wanted.pixels = 0.1;
    wanted.max_triangles = 400 + path.number(6000);
    wanted.resident_only = path.number(5) != 0;
    const std::uint32_t steps = 1 + path.number(60);
    std::uint32_t done = 0;
    if (n % 2 == 0) wanted.stop = [&] { return ++done == steps; };
    const FrameFigures figures = frames.refine(wanted);
    stopped += figures.stopped ? 1 : 0;
    lacking += figures.pages_missing > 0 ? 1 : 0;
    EXPECT_EQ(figures.triangles, frames.contour().triangles.size());
    EXPECT_LE(figures.triangles, *wanted.max_triangles);
    test::expect_sound(frames.contour(), volume.grid.box());
    if (n % 7 == 0) put_missing(frames, 2);
  }
  EXPECT_GT(stopped, 5u);
  EXPECT_GT(lacking, 5u);
}

INSTANTIATE_TEST_SUITE_P(Seeds, ResidentFrames, testing::Range(0u, 2u));

}  // namespace
}  // namespace adamas
