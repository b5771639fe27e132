#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>

#include "core/base/error.h"
#include "tests/isosurface/contour_checks.h"
#include "tests/isosurface/surface_checks.h"

namespace adamas {

using namespace isosurface;

namespace {

using test::MemoryVolume;
using test::OpenStore;

constexpr double kIsovalue = 100.5;

SurfaceRequest request_of(bool strict) {
  SurfaceRequest request;
  request.isovalue = kIsovalue;
  request.strict = strict;
  return request;
}

std::string name_of(const PageId& id) {
  return fmt::format("the page of LOD {} at {}, {}, {}", id.lod, id.block.i, id.block.j, id.block.k);
}

/// A store of hills whose surface crosses every page, to be damaged.
class DamagedSurface : public testing::Test {
 protected:
  DamagedSurface()
      : volume_({50, 37, 44},
                [random = std::mt19937(6)](LatticePoint p) mutable {
                  return 100 + 50 * std::sin(0.5 * p.i + 0.2 * p.k) * std::cos(0.4 * p.j) +
                         static_cast<double>(random() % 9);
                }),
        store_(volume_),
        bytes_(test::bytes_of(store_.path())),
        whole_(store_.extract(kIsovalue)) {
    const PageGrid& grid = store_.pages().grid();
    for (std::uint64_t number = 1; number < std::uint64_t{2} << (3 * grid.top()); ++number) {
      if ((std::bit_width(number) - 1) % 3 == 0 && grid.contains(grid.page(number)))
        pages_.push_back(grid.page(number));
    }
    for (const PageId& id : pages_) entries_.push_back(store_.file().entry(0, id).value());
  }

  /// Flips a bit in the middle of these pages, and of their copies.
  void damage(const std::vector<std::size_t>& which) {
    std::string bytes = bytes_;
    for (const std::size_t n : which) {
      for (const std::uint64_t offset : {entries_[n].offset, entries_[n].copy}) {
        if (offset != 0) bytes[offset + entries_[n].size / 2] ^= 4;
      }
    }
    put(bytes);
  }
  void put(const std::string& bytes) {
    test::put_bytes(store_.path(), bytes);
    store_.open();
  }

  /// Expects that, whatever is lost, the rest gives a closed surface of fewer triangles, and that a strict
  /// request throws an Error that names a lost page.
  void expect_coarser() {
    const ExtractedSurface surface = store_.extract(request_of(false));
    if (surface.lost.empty()) {
      EXPECT_EQ(surface.contour, whole_.contour);
      EXPECT_NO_THROW(store_.extract(request_of(true)));
      return;
    }
    test::expect_sound(surface.contour, volume_.grid.box());
    EXPECT_LT(surface.contour.triangles.size(), whole_.contour.triangles.size());
    store_.open();
    const std::string error = test::error_of([&] { store_.extract(request_of(true)); });
    EXPECT_TRUE(test::says(error, name_of(surface.lost.front())));
  }

  MemoryVolume<std::uint8_t> volume_;
  OpenStore<std::uint8_t> store_;
  std::string bytes_;
  ExtractedSurface whole_;
  std::vector<PageId> pages_;
  std::vector<PageEntry> entries_;
};

/// Every page of coarser LODs, and every seventh page of the finest one, is damaged in turn.
TEST_F(DamagedSurface, EveryPageInTurn) {
  std::size_t named = 0, tried = 0;
  for (std::size_t n = 0; n < pages_.size(); ++n) {
    if (pages_[n].lod == 0 && n % 7 != 0) continue;
    SCOPED_TRACE(name_of(pages_[n]));
    ++tried;
    damage({n});
    if (pages_[n].lod == store_.pages().grid().top()) {
      EXPECT_TRUE(test::says(test::error_of([&] { store_.extract(request_of(false)); }), name_of(pages_[n])));
      continue;
    }
    const ExtractedSurface surface = store_.extract(request_of(false));
    for (const PageId& lost : surface.lost) EXPECT_LE(lost.lod, pages_[n].lod);
    if (std::find(surface.lost.begin(), surface.lost.end(), pages_[n]) != surface.lost.end()) ++named;
    store_.open();
    expect_coarser();
    if (HasFailure()) return;
  }
  EXPECT_GT(named, tried / 2);
}

TEST_F(DamagedSurface, SeveralPages) {
  std::mt19937 random(3);
  for (int turn = 0; turn < 12; ++turn) {
    std::vector<std::size_t> which;
    for (int n = 0; n <= turn; ++n) which.push_back(1 + random() % (pages_.size() - 1));
    std::sort(which.begin(), which.end());
    which.erase(std::unique(which.begin(), which.end()), which.end());
    damage(which);
    expect_coarser();
    if (HasFailure()) return;
  }
}

/// An extractor reports the damage that it has met again in later surfaces; a budget or a region does not
/// change that.
TEST_F(DamagedSurface, IsToldEveryTime) {
  std::size_t last = pages_.size();
  while (pages_[--last].block != LatticePoint{1, 1, 1}) {
  }
  damage({last});
  const ExtractedSurface first = store_.extract(request_of(false));
  ASSERT_FALSE(first.lost.empty());
  const ExtractedSurface again = store_.extract(request_of(false));
  EXPECT_EQ(again.contour, first.contour);
  EXPECT_EQ(again.lost, first.lost);
  EXPECT_THROW(store_.extract(request_of(true)), Error);
  SurfaceRequest few = request_of(false);
  few.max_triangles = 1000;
  const ExtractedSurface fewer = store_.extract(few);
  EXPECT_LE(fewer.contour.triangles.size(), 1000u);
  test::expect_sound(fewer.contour, volume_.grid.box());
}

/// Where a part of the directory is damaged, the pages that it describes are lost.
TEST_F(DamagedSurface, PartsOfTheDirectory) {
  const auto all = std::as_bytes(std::span(bytes_));
  const StorePrologue prologue = StorePrologue::parse(all.first(StorePrologue::kBytes), "store");
  const StoreRoot root = StoreRoot::parse(all.subspan(prologue.root.offset), prologue.root.offset, "store");
  ASSERT_GE(root.chunks.size(), 2u);
  for (const DirectoryChunk& chunk : root.chunks) {
    std::string bytes = bytes_;
    bytes[chunk.offset + chunk.size / 2] ^= 4;
    put(bytes);
    if (chunk.first == 0) {
      EXPECT_THROW(store_.extract(request_of(false)), Error);
    } else {
      expect_coarser();
      EXPECT_FALSE(store_.extract(request_of(false)).lost.empty());
    }
  }
}

}  // namespace
}  // namespace adamas
