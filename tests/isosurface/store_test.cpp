#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "isosurface/compression/page_order.h"
#include "isosurface/volume/samples.h"
#include "tests/support/volume_store.h"
#include "timevarying/verify_store.h"

namespace adamas {

using namespace isosurface;
using namespace timevarying;

namespace {

using test::Dimensions;
using test::MemoryVolume;

enum class Kind { kRandom, kEqual, kExtremes, kSmooth };

template <class Sample>
MemoryVolume<Sample> volume_of(const Dimensions& dimensions, Kind kind) {
  std::mt19937 random(static_cast<unsigned>(dimensions[0] * 289 + dimensions[1] * 17 + dimensions[2]));
  return {dimensions, [&](LatticePoint p) {
            using Limits = std::numeric_limits<Sample>;
            switch (kind) {
              case Kind::kEqual:
                return Sample{42};
              case Kind::kExtremes:
                return ((p.i + p.j + p.k) & 1) != 0 ? Limits::max() : Limits::lowest();
              case Kind::kSmooth:
                return static_cast<Sample>(60 + 40 * std::sin(0.2 * p.i) * std::cos(0.3 * p.j + 0.1 * p.k));
              default:
                return from_ordered<Sample>(static_cast<OrderedWord<Sample>>(random()));
            }
          }};
}

/// Expects that a store of the volume is whole, verifies as whole, and restores the volume.
template <class Sample>
void expect_back(const MemoryVolume<Sample>& volume, SampleCoding coding) {
  SCOPED_TRACE(testing::Message() << volume.grid.dimensions[0] << " x " << volume.grid.dimensions[1] << " x "
                                  << volume.grid.dimensions[2] << " " << sample_name(volume.grid.type)
                                  << ", coding " << static_cast<int>(coding));
  const test::Scratch folder;
  const StoreFigures figures = test::build(folder / "a.adm", volume, {coding});
  StoreFile file(folder / "a.adm");
  ASSERT_EQ(figures.file_bytes, file.size());
  ASSERT_EQ(figures.pages, file.grid().page_count());
  ASSERT_EQ(file.header().grid.dimensions, volume.grid.dimensions);
  ASSERT_EQ(test::restored<Sample>(file), test::bits_of(volume.samples));
  const VerifiedStore verified = verify_store(file, 0, SilentProgress::instance());
  ASSERT_EQ(verified.pages, figures.pages);
  ASSERT_EQ(verified.bad_pages + verified.bad_copies, 0u) << verified.problems.front().what;
}

template <class Sample>
void expect_back_all_ways(const MemoryVolume<Sample>& volume) {
  for (const SampleCoding coding :
       {SampleCoding::kSplitEdge, SampleCoding::kInterpolation, SampleCoding::kPlain})
    expect_back(volume, coding);
}

TEST(LongStore, GivesBackVolumesOfEverySize) {
  int turn = 0;
  for (std::uint64_t x = 1; x <= 9; ++x) {
    for (std::uint64_t y = 1; y <= 9; ++y) {
      for (std::uint64_t z = 1; z <= 9; ++z, ++turn) {
        const auto coding = turn % 2 == 0 ? SampleCoding::kInterpolation : SampleCoding::kSplitEdge;
        expect_back(volume_of<std::uint8_t>({x, y, z}, turn % 4 == 1 ? Kind::kSmooth : Kind::kRandom),
                    coding);
        ASSERT_FALSE(HasFatalFailure());
      }
    }
  }
}

template <class Sample>
class StoreOf : public testing::Test {};
using Samples = testing::Types<std::uint8_t, std::uint16_t, std::int16_t, float>;
TYPED_TEST_SUITE(StoreOf, Samples);

TYPED_TEST(StoreOf, SmallVolumesComeBack) {
  for (const Dimensions& box : std::vector<Dimensions>{{1, 1, 1},
                                                       {2, 1, 1},
                                                       {1, 3, 1},
                                                       {1, 1, 5},
                                                       {2, 2, 2},
                                                       {9, 1, 4},
                                                       {3, 17, 2},
                                                       {17, 16, 15},
                                                       {5, 9, 33}})
    for (const Kind kind : {Kind::kRandom, Kind::kEqual, Kind::kExtremes})
      expect_back_all_ways(volume_of<TypeParam>(box, kind));
}

TYPED_TEST(StoreOf, SeveralPagesAndLodsComeBack) {
  expect_back_all_ways(volume_of<TypeParam>({70, 33, 40}, Kind::kSmooth));
  expect_back(volume_of<TypeParam>({40, 35, 34}, Kind::kRandom), SampleCoding::kInterpolation);
  expect_back(volume_of<TypeParam>({40, 35, 34}, Kind::kExtremes), SampleCoding::kSplitEdge);
  expect_back(volume_of<TypeParam>({200, 3, 18}, Kind::kEqual), SampleCoding::kInterpolation);
}

TEST(Store, NumbersThatAreNoneComeBack) {
  const auto number = [](std::uint32_t word) { return std::bit_cast<float>(word); };
  const std::vector<float> specials{number(0x7fc00000), number(0x7f800001),
                                    number(0xffc12345), number(0xffffffff),
                                    number(0x7fffffff), number(0x80000000),
                                    number(0),          number(1),
                                    number(0x807fffff), number(0x7f800000),
                                    number(0xff800000), number(0x7f7fffff),
                                    number(0xff7fffff), 1.5f};
  std::mt19937 random(5);
  const auto pick = [&](LatticePoint) { return specials[random() % specials.size()]; };
  for (const Dimensions& box : std::vector<Dimensions>{{1, 1, 1}, {4, 5, 6}, {33, 20, 18}})
    expect_back_all_ways(MemoryVolume<float>(box, pick));
  for (const float special : specials)
    expect_back(MemoryVolume<float>({9, 9, 9}, [&](LatticePoint) { return special; }),
                SampleCoding::kInterpolation);
  const auto few = [&](LatticePoint p) {
    return random() % 50 == 0 ? pick(p) : 0.25f * static_cast<float>(p.i);
  };
  expect_back_all_ways(MemoryVolume<float>({33, 20, 18}, few));
}

TYPED_TEST(StoreOf, FewDifferentSamplesAreCodedByTheirRanks) {
  using Sample = TypeParam;
  const MemoryVolume<Sample> volume({40, 33, 35}, [](LatticePoint p) {
    return static_cast<Sample>(3 *
                               std::round(20 + 12 * std::sin(0.1 * p.i) * std::cos(0.1 * p.j + 0.2 * p.k)));
  });
  expect_back_all_ways(volume);
  const test::Scratch folder;
  test::build(folder / "a.adm", volume, {SampleCoding::kInterpolation});
  StoreFile file(folder / "a.adm");
  EXPECT_EQ(file.header().coding, sizeof(Sample) > 1 ? SampleCoding::kRanks : SampleCoding::kInterpolation);
}

TYPED_TEST(StoreOf, PlainPagesAreAsLargeAsTheirSamples) {
  for (const Kind kind : {Kind::kEqual, Kind::kSmooth, Kind::kRandom}) {
    const auto volume = volume_of<TypeParam>({40, 35, 34}, kind);
    const test::Scratch folder;
    const StoreFigures figures = test::build(folder / "a.adm", volume, {SampleCoding::kPlain});
    StoreFile file(folder / "a.adm");
    EXPECT_EQ(file.header().coding, SampleCoding::kSplitEdge);
    const PageGrid& grid = file.grid();
    std::uint64_t bytes = file.header().sample_tables.size();
    for (std::uint64_t number = 1; number < std::uint64_t{2} << (3 * grid.top()); ++number) {
      const PageId id = grid.page(number);
      // Each page begins with a byte for its kind.
      if (grid.contains(id)) bytes += 1 + own_points(page_shape(grid, id)) * sizeof(TypeParam);
    }
    EXPECT_EQ(figures.bytes.samples, bytes);
    EXPECT_GE(bytes, volume.grid.bytes());
  }
}

TYPED_TEST(StoreOf, LodsAreEverySoManyOfTheSamples) {
  for (const Dimensions& box : std::vector<Dimensions>{{70, 33, 40}, {17, 18, 1}, {33, 1, 64}, {16, 65, 2}}) {
    const auto volume = volume_of<TypeParam>(box, Kind::kRandom);
    const test::Scratch folder;
    test::build(folder / "a.adm", volume);
    StoreFile file(folder / "a.adm");
    for (int lod = 0; lod <= file.grid().top(); ++lod) {
      const auto part_of = [&](std::uint64_t n) { return ((n - 1) >> lod) + 1; };
      const MemoryVolume<TypeParam> part({part_of(box[0]), part_of(box[1]), part_of(box[2])},
                                         [&](LatticePoint p) { return volume.at((1 << lod) * p); });
      ASSERT_EQ(test::restored<TypeParam>(file, lod), test::bits_of(part.samples)) << lod;
    }
    EXPECT_THROW(test::restored<TypeParam>(file, file.grid().top() + 1), Error);
    EXPECT_THROW(test::restored<TypeParam>(file, -1), Error);
  }
}

TYPED_TEST(StoreOf, RegionsAreTheSamplesInThem) {
  auto volume = volume_of<TypeParam>({70, 33, 40}, Kind::kRandom);
  volume.grid.spacing = {0.5, 2, 1};
  volume.grid.origin = {-3, 10, 0.25};
  const test::Scratch folder;
  test::build(folder / "a.adm", volume);
  StoreFile file(folder / "a.adm");
  const auto place = [&](LatticePoint p) {
    return volume.grid.origin +
           Vec3{p.i * volume.grid.spacing.x, p.j * volume.grid.spacing.y, p.k * volume.grid.spacing.z};
  };
  std::mt19937 random(3);
  for (int turn = 0; turn < 30; ++turn) {
    const int lod = turn % 3;
    LatticePoint low{}, high{}, first{}, count{};
    for (int axis = 0; axis < 3; ++axis) {
      const auto n = static_cast<std::int32_t>(volume.grid.dimensions[static_cast<std::size_t>(axis)]);
      low[axis] = static_cast<std::int32_t>(random() % static_cast<unsigned>(n));
      high[axis] = low[axis] + static_cast<std::int32_t>(random() % static_cast<unsigned>(n));
      first[axis] = (low[axis] + (1 << lod) - 1) >> lod;
      count[axis] = (std::min(high[axis], n - 1) >> lod) - first[axis] + 1;
    }
    const Box3 region{place(low), place(high)};
    if (std::min({count.i, count.j, count.k}) <= 0) {
      EXPECT_THROW(test::restored<TypeParam>(file, lod, region), Error);
      continue;
    }
    const RestoredPart part = restored_part(volume.grid, lod, region, "a.adm");
    EXPECT_LT(distance(part.grid.origin, place((1 << lod) * first)), 1e-12);
    const auto size = [](std::int32_t n) { return static_cast<std::uint64_t>(n); };
    const MemoryVolume<TypeParam> wanted({size(count.i), size(count.j), size(count.k)},
                                         [&](LatticePoint p) { return volume.at((1 << lod) * (first + p)); });
    ASSERT_EQ(test::restored<TypeParam>(file, lod, region), test::bits_of(wanted.samples));
  }
}

TEST(Store, RegionsReadFewerPages) {
  const auto volume = volume_of<std::uint8_t>({100, 100, 100}, Kind::kRandom);
  const test::Scratch folder;
  test::build(folder / "a.adm", volume);
  StoreFile file(folder / "a.adm");
  const auto counts = [&](const std::optional<Box3>& region) {
    return test::restore(file, restored_part(volume.grid, 0, region, "a.adm"), 1 << 24,
                         [](std::span<const std::byte>) {});
  };
  const PageReads few = counts(Box3{{40, 40, 40}, {47, 47, 47}}), all = counts({});
  EXPECT_EQ(few.pages, 1u);
  EXPECT_LT(few.predictors, 20u);
  EXPECT_GE(all.pages, 7u * 7 * 7);
}

TYPED_TEST(StoreOf, TheSameBytesOnAnyNumberOfThreads) {
  const auto volume = volume_of<TypeParam>({120, 70, 50}, Kind::kSmooth);
  const test::Scratch folder;
  for (const unsigned threads : {1u, 2u, 3u}) {
    set_thread_limit(threads);
    test::build(folder / std::to_string(threads), volume);
  }
  set_thread_limit(0);
  const std::string alone = test::bytes_of(folder / "1");
  EXPECT_EQ(test::bytes_of(folder / "2"), alone);
  EXPECT_EQ(test::bytes_of(folder / "3"), alone);
  EXPECT_LT(alone.size(), volume.grid.bytes());
}

TEST(Store, LittleMemoryIsEnough) {
  const auto volume = volume_of<std::uint16_t>({130, 120, 90}, Kind::kSmooth);
  const test::Scratch folder;
  test::build(folder / "a.adm", volume);
  for (const Paging paging : {Paging::kRead, Paging::kMap}) {
    StoreFile file(folder / "a.adm", paging);
    const auto wanted = test::bits_of(volume.samples);
    EXPECT_EQ((test::restored<std::uint16_t>(file, 0, {}, 0)), wanted);
    EXPECT_EQ(verify_store(file, 0, SilentProgress::instance()).bad_pages, 0u);
  }
}

TEST(Store, LeavesNothingInTheScratchFolder) {
  const test::Scratch folder, scratch;
  StoreOptions options;
  options.scratch = scratch.folder();
  test::build(folder / "a.adm", volume_of<std::uint8_t>({33, 20, 18}, Kind::kRandom), options);
  EXPECT_EQ(scratch.entries(), 0);
  EXPECT_EQ(folder.entries(), 1);
  options.scratch = folder / "missing";
  EXPECT_THROW(test::build(folder / "b.adm", volume_of<std::uint8_t>({3, 2, 1}, Kind::kRandom), options),
               Error);
}

}  // namespace
}  // namespace adamas
