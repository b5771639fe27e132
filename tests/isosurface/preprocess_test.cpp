#include "isosurface/preprocessing/preprocess.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <random>
#include <set>
#include <vector>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "isosurface/volume/error_scale.h"
#include "isosurface/volume/samples.h"
#include "tests/support/preprocess_reference.h"

namespace adamas {

using namespace isosurface;

namespace {

using test::PreprocessReference;
using test::ReferenceValues;
using test::ReferenceVolume;

using Dimensions = std::array<std::uint64_t, 3>;

template <class Sample>
SampleType sample_type() {
  if constexpr (std::is_same_v<Sample, std::uint8_t>) return SampleType::kUint8;
  if constexpr (std::is_same_v<Sample, std::uint16_t>) return SampleType::kUint16;
  if constexpr (std::is_same_v<Sample, std::int16_t>) return SampleType::kInt16;
  return SampleType::kFloat32;
}

enum class Kind { kRandom, kSmooth, kConstant, kSteps, kHoles };

template <class Sample>
Sample sample_of(Kind kind, LatticePoint p, std::mt19937& random) {
  const double wave = std::sin(0.4 * p.i + 0.1) * std::cos(0.3 * p.j) + 0.05 * p.k;
  switch (kind) {
    case Kind::kSmooth:
      return static_cast<Sample>(60 + 40 * wave);
    case Kind::kConstant:
      return static_cast<Sample>(7);
    case Kind::kSteps:
      return static_cast<Sample>(p.i + p.j > 9 ? 90 : p.k > 3 ? 20 : 19);
    case Kind::kHoles: {
      constexpr float kInfinity = std::numeric_limits<float>::infinity();
      const std::array<float, 4> holes{kInfinity, -kInfinity, std::numeric_limits<float>::quiet_NaN(),
                                       -std::numeric_limits<float>::quiet_NaN()};
      if (std::is_same_v<Sample, float> && random() % 40 == 0)
        return static_cast<Sample>(holes[random() % 4]);
      return static_cast<Sample>(static_cast<float>(60 + 40 * wave));
    }
    default:
      if constexpr (std::is_same_v<Sample, float>) {
        return std::ldexp(static_cast<float>(random() % 65536) - 3e4f, static_cast<int>(random() % 9) - 4);
      } else {
        return static_cast<Sample>(random());
      }
  }
}

template <class Sample>
struct TestVolume : ReferenceVolume {
  TestVolume(const Dimensions& dimensions, Kind kind, const Vec3& spacing = {1, 1, 1}) {
    grid.dimensions = dimensions;
    grid.type = sample_type<Sample>();
    grid.spacing = spacing;
    std::mt19937 random(static_cast<unsigned>(dimensions[0] * 289 + dimensions[1] * 17 + dimensions[2]));
    for (std::size_t n = 0; n < grid.samples(); ++n) {
      const auto at = [](std::uint64_t x) { return static_cast<std::int32_t>(x); };
      const LatticePoint p{at(n % dimensions[0]), at(n / dimensions[0] % dimensions[1]),
                           at(n / dimensions[0] / dimensions[1])};
      const Sample sample = sample_of<Sample>(kind, p, random);
      samples.push_back(sample);
      values.push_back(sample);
      words.push_back(ordered(sample));
    }
  }
  std::vector<Sample> samples;
};

/// All pages, in the order in which they came.
template <class Sample>
using Pages = std::vector<std::pair<PageId, Page<OrderedWord<Sample>>>>;

template <class Sample>
Pages<Sample> pages_of(const TestVolume<Sample>& volume, NoiseBounds noise = NoiseBounds::kOwn) {
  Pages<Sample> pages;
  const std::uint64_t plane = volume.grid.plane_samples();
  preprocess<Sample>(
      volume.grid,
      [&](std::uint64_t k, std::span<std::byte> samples) {
        ASSERT_EQ(samples.size(), plane * sizeof(Sample));
        std::memcpy(samples.data(), volume.samples.data() + k * plane, samples.size());
      },
      [&](const PageId& id, const Page<OrderedWord<Sample>>& page) { pages.emplace_back(id, page); },
      SilentProgress::instance(), noise);
  return pages;
}

/// What the pages store of one point.
struct Stored {
  std::uint32_t sample, low, high;
  std::uint8_t code;
};

/// Returns what is stored of all points that pages own. Fails the test unless every page and every point
/// comes once.
template <class Sample>
std::map<LatticePoint, Stored> points_of(const TestVolume<Sample>& volume, const Pages<Sample>& pages) {
  const PageGrid grid(volume.grid.dimensions);
  EXPECT_EQ(pages.size(), grid.page_count());
  std::map<LatticePoint, Stored> points;
  std::set<std::uint64_t> numbers;
  for (const auto& [id, page] : pages) {
    EXPECT_TRUE(grid.contains(id));
    EXPECT_TRUE(numbers.insert(grid.number(id)).second);
    const PageShape shape{grid.count(id), grid.is_complete(id), id.lod};
    for (std::int32_t n = 0; n < 4096; ++n) {
      const LatticePoint q{n % 16, n / 16 % 16, n / 256};
      if (!shape.owns(q)) continue;
      const auto at = static_cast<std::size_t>(n);
      const Stored stored{page.samples[at], page.low[at], page.high[at], page.errors[at]};
      EXPECT_TRUE(points.emplace((1 << id.lod) * (16 * id.block + q), stored).second);
    }
  }
  return points;
}

/// Returns whether the diamond lies wholly beyond the data: the coarsest page has such points.
bool is_outside(LatticePoint p, const PageGrid& grid) {
  const int lod = trailing_zeros(p);
  const LatticePoint end = (1 << lod) * grid.reach(lod);
  return p.i > end.i || p.j > end.j || p.k > end.k;
}

/// Compares everything with the definition, and each diamond with its children. Diamonds in noise share their
/// bounds, which have to cover those of the definition; `wider` counts the diamonds with wider bounds.
template <class Sample>
void check(const TestVolume<Sample>& volume, NoiseBounds noise = NoiseBounds::kOwn,
           std::size_t* wider = nullptr) {
  SCOPED_TRACE(testing::Message() << volume.grid.dimensions[0] << " x " << volume.grid.dimensions[1] << " x "
                                  << volume.grid.dimensions[2] << " " << sample_name(volume.grid.type));
  const PreprocessReference reference(volume);
  const auto points = points_of(volume, pages_of(volume, noise));
  const LatticePoint last = volume.last();
  std::size_t seen = 0;
  for (const auto& [p, stored] : points) {
    SCOPED_TRACE(testing::Message() << p.i << " " << p.j << " " << p.k);
    const LatticePoint nearest{std::min(p.i, last.i), std::min(p.j, last.j), std::min(p.k, last.k)};
    ASSERT_EQ(stored.sample, volume.words[volume.index(nearest)]);
    const auto found = reference.diamonds().find(p);
    if (found == reference.diamonds().end()) {
      ASSERT_TRUE(trailing_zeros(p) >= reference.depth() || is_outside(p, PageGrid(volume.grid.dimensions)));
      ASSERT_EQ(stored.code, 0);
      ASSERT_GT(stored.low, stored.high);
      continue;
    }
    ++seen;
    const ReferenceValues& wanted = found->second;
    ASSERT_GE(stored.code, wanted.least_code);
    if (noise == NoiseBounds::kSame) {
      ASSERT_LE(stored.low, wanted.low);
      ASSERT_GE(stored.high, wanted.high);
      if (wider != nullptr && (stored.low < wanted.low || stored.high > wanted.high)) ++*wider;
    } else {
      ASSERT_LE(stored.code, wanted.greatest_code);
      if (wanted.low <= wanted.high) {
        ASSERT_EQ(stored.low, wanted.low);
        ASSERT_EQ(stored.high, wanted.high);
      } else {
        ASSERT_GT(stored.low, stored.high);
      }
    }
    const ErrorScale& scale = reference.scale(trailing_zeros(p));
    for (const LatticePoint child : reference.children(p)) {
      const auto of_child = points.find(child);
      if (of_child == points.end()) continue;
      ASSERT_GE(scale.decode(stored.code),
                reference.scale(trailing_zeros(child)).decode(of_child->second.code));
      if (of_child->second.low > of_child->second.high) continue;
      ASSERT_LE(stored.low, of_child->second.low);
      ASSERT_GE(stored.high, of_child->second.high);
    }
  }
  EXPECT_TRUE(seen > 0 || reference.depth() == 0);
}

TEST(Preprocess, AgreesWithTheDefinitionOnCubesOfEverySize) {
  for (std::uint64_t n = 1; n <= 17; ++n) {
    const Dimensions cube{n, n, n};
    check(TestVolume<std::uint8_t>(cube, Kind::kRandom));
    check(TestVolume<std::int16_t>(cube, Kind::kSmooth, {1, 0.7, 2.5}));
    check(TestVolume<float>(cube, Kind::kHoles));
    if (HasFatalFailure()) return;
  }
}

TEST(Preprocess, AgreesWithTheDefinitionOnBoxes) {
  int turn = 0;
  for (const Dimensions& box : std::vector<Dimensions>{
           {2, 3, 4},   {5, 2, 9},  {3, 17, 2},  {17, 16, 15}, {6, 11, 8}, {9, 1, 1},   {1, 9, 1},
           {1, 1, 17},  {13, 1, 7}, {1, 12, 10}, {17, 17, 1},  {4, 5, 1},  {7, 13, 17}, {16, 9, 5},
           {10, 14, 3}, {2, 2, 17}, {12, 17, 9}, {15, 3, 11},  {8, 8, 17}, {17, 5, 12}}) {
    check(TestVolume<std::uint16_t>(box, Kind::kRandom, {0.3, 2, 1}));
    check(TestVolume<std::uint8_t>(box, turn % 2 == 0 ? Kind::kSteps : Kind::kConstant));
    check(TestVolume<float>(box, turn % 3 == 0 ? Kind::kRandom : Kind::kHoles, {1, 1, 4}));
    check(TestVolume<std::int16_t>(box, Kind::kRandom));
    ++turn;
    if (HasFatalFailure()) return;
  }
}

TEST(Preprocess, AgreesWithTheDefinitionWhereLodsAreCutIntoPages) {
  check(TestVolume<std::uint8_t>({66, 34, 20}, Kind::kSmooth));
  check(TestVolume<std::uint16_t>({18, 17, 65}, Kind::kRandom, {1, 1, 0.4}));
  check(TestVolume<float>({19, 36, 33}, Kind::kHoles));
  check(TestVolume<std::int16_t>({18, 33, 1}, Kind::kSmooth));
  check(TestVolume<std::uint8_t>({1, 34, 40}, Kind::kRandom));
  check(TestVolume<std::uint8_t>({17, 33, 20}, Kind::kSteps));
  // Here scales of 16 bits are not exact in a float.
  check(TestVolume<std::uint16_t>({2, 3, 1025}, Kind::kRandom));
  check(TestVolume<std::uint16_t>({300, 4, 2}, Kind::kSmooth));
}

/// The common bounds of diamonds in noise cover the own bounds of each, and are monotone. Other diamonds keep
/// their own bounds.
TEST(Preprocess, DiamondsInNoiseHaveTheSameBounds) {
  const auto wider_of = [](const auto& volume) {
    std::size_t wider = 0;
    check(volume, NoiseBounds::kSame, &wider);
    return wider;
  };
  EXPECT_GT(wider_of(TestVolume<std::uint8_t>({34, 33, 40}, Kind::kRandom)), 10000u);
  EXPECT_GT(wider_of(TestVolume<std::uint16_t>({18, 17, 65}, Kind::kRandom, {1, 1, 0.4})), 5000u);
  EXPECT_GT(wider_of(TestVolume<std::int16_t>({17, 16, 15}, Kind::kRandom)), 1000u);
  TestVolume<float> normal({20, 40, 24}, Kind::kConstant);
  std::mt19937 random(3);
  std::normal_distribution<float> distribution;
  for (std::size_t n = 0; n < normal.samples.size(); ++n) {
    normal.samples[n] = distribution(random);
    normal.values[n] = normal.samples[n];
    normal.words[n] = ordered(normal.samples[n]);
  }
  EXPECT_GT(wider_of(normal), 5000u);
  for (const Dimensions& box : std::vector<Dimensions>{{33, 17, 40}, {3, 20, 50}, {1, 34, 40}}) {
    for (const Kind kind : {Kind::kSmooth, Kind::kHoles, Kind::kSteps, Kind::kConstant}) {
      EXPECT_EQ(wider_of(TestVolume<float>(box, kind)), 0u);
      EXPECT_EQ(wider_of(TestVolume<std::uint8_t>(box, kind)), 0u);
    }
  }
}

TEST(Preprocess, PagesDoNotDependOnTheNumberOfThreads) {
  const auto compare = [](const auto& volume) {
    set_thread_limit(1);
    const auto alone = pages_of(volume, NoiseBounds::kSame);
    set_thread_limit(3);
    const auto together = pages_of(volume, NoiseBounds::kSame);
    set_thread_limit(0);
    ASSERT_EQ(alone.size(), together.size());
    for (std::size_t n = 0; n < alone.size(); ++n) {
      ASSERT_EQ(alone[n].first, together[n].first);
      const auto &a = alone[n].second, &b = together[n].second;
      const LatticePoint count = PageGrid(volume.grid.dimensions).count(alone[n].first);
      for (std::int32_t m = 0; m < 4096; ++m) {
        if (m % 16 >= count.i || m / 16 % 16 >= count.j || m / 256 >= count.k) continue;
        const auto at = static_cast<std::size_t>(m);
        ASSERT_EQ(a.samples[at], b.samples[at]);
        ASSERT_EQ(a.errors[at], b.errors[at]);
        ASSERT_EQ(a.low[at], b.low[at]);
        ASSERT_EQ(a.high[at], b.high[at]);
      }
    }
  };
  compare(TestVolume<std::uint8_t>({100, 90, 70}, Kind::kRandom));
  compare(TestVolume<float>({60, 70, 40}, Kind::kHoles));
}

TEST(Preprocess, LinearDataHaveNoError) {
  TestVolume<std::uint16_t> volume({33, 33, 33}, Kind::kConstant);
  for (std::size_t n = 0; n < volume.samples.size(); ++n)
    volume.samples[n] =
        static_cast<std::uint16_t>(1000 + 31 * (n % 33) - 7 * (n / 33 % 33) + 500 * (n / 1089));
  for (const auto& [id, page] : pages_of(volume)) {
    const LatticePoint count = PageGrid(volume.grid.dimensions).count(id);
    for (std::int32_t n = 0; n < 4096; ++n) {
      if (n % 16 >= count.i || n / 16 % 16 >= count.j || n / 256 >= count.k) continue;
      ASSERT_EQ(page.errors[static_cast<std::size_t>(n)], 0);
    }
  }
}

TEST(Preprocess, EveryPlaneIsReadInOrderAndCanBeTheLast) {
  const TestVolume<std::uint8_t> volume({20, 18, 50}, Kind::kRandom);
  std::vector<std::uint64_t> order;
  preprocess<std::uint8_t>(
      volume.grid, [&](std::uint64_t k, std::span<std::byte>) { order.push_back(k); },
      [](const auto&, const auto&) {});
  const std::size_t coarse = order.size() - 50;
  EXPECT_LE(coarse, 5u);
  for (std::size_t k = 0; k < 50; ++k) EXPECT_EQ(order[coarse + k], k);

  struct Stopping final : Progress {
    void report(std::string_view, double) override { ++reports; }
    [[nodiscard]] bool cancelled() const override { return reports >= 6; }
    int reports = 0;
  } stopping;
  EXPECT_THROW(
      preprocess<std::uint8_t>(
          volume.grid, [](std::uint64_t, std::span<std::byte>) {}, [](const auto&, const auto&) {}, stopping),
      Cancelled);
}

TEST(Preprocess, ScaleOfALodIsTheGreatestDiameter) {
  EXPECT_DOUBLE_EQ(lod_error_scale({1, 1, 1}, 0).greatest(), 2 * std::sqrt(3));
  EXPECT_DOUBLE_EQ(lod_error_scale({1, 2, 0.5}, 3).greatest(), 16 * std::sqrt(5.25));
}

}  // namespace
}  // namespace adamas
