#include "isosurface/compression/known_errors.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <random>

#include "isosurface/compression/value_fields.h"
#include "isosurface/compression/value_stage.h"
#include "tests/support/prepared_volume.h"

namespace adamas {
namespace {

using Dimensions = std::array<std::uint64_t, 3>;
constexpr Dimensions kDimensions{39, 35, 33};

/// What is stored of the points of a phase that are sure.
template <class Word, class Check>
void for_each_sure(const PageShape& shape, int phase, PhasePoints::Of of, Check check) {
  std::size_t count = 0;
  with_points(shape, phase, of, [&](const PhasePoints& points) {
    for (std::size_t n = 0; n < points.all().size(); ++n) {
      if (points.sure()[n]) check(points.all()[n]);
      count += points.sure()[n] ? 1 : 0;
    }
    ASSERT_EQ(count + points.open().size(), points.all().size());
  });
  // A page of full size: 13 to 49 of 64 along rows of each kind.
  if (shape.count == LatticePoint{16, 16, 16}) {
    ASSERT_GE(count, 343u);
  }
}

/// Of the finest level: own errors, raised by the children that preprocessing found, are what it found.
template <class Sample>
void expect_known(const Dimensions& dimensions, const std::function<Sample(std::size_t)>& sample,
                  const Vec3& spacing) {
  using Word = OrderedWord<Sample>;
  std::vector<Sample> samples;
  for (std::size_t n = 0; n < dimensions[0] * dimensions[1] * dimensions[2]; ++n)
    samples.push_back(sample(n));
  const test::PreparedVolume<Sample> volume(dimensions, samples, spacing);
  const ErrorGeometry geometry(spacing);
  const auto fields = std::make_unique<ValueFields<Word>>();
  const LatticePoint blocks = volume.grid().blocks(0);
  for (int n = 0; n < blocks.i * blocks.j * blocks.k; ++n) {
    const PageId id{0, {n % blocks.i, n / blocks.i % blocks.j, n / blocks.i / blocks.j}};
    if (!volume.grid().contains(id)) continue;
    const PageShape shape = volume.shape(id);
    const Page<Word> page = volume.page(id);
    fields->load(shape, volume.around(id), page);
    fields->load_values(shape, page);
    known_errors(fields->heights, geometry, shape, fields->predicted);
    for (int phase = 0; phase < 3; ++phase) {
      for_each_sure<Word>(shape, phase, PhasePoints::Of::kErrors, [&](std::size_t place) {
        int code = fields->predicted[place];
        const auto side = static_cast<std::size_t>(PaddedGrid<Word>::kSide);
        const std::size_t steps[3] = {1, side, side * side};
        for (std::size_t axis = 0; phase < 2 && axis < 3; ++axis) {
          const std::size_t coordinate = place / steps[axis] % side;
          if (coordinate % 2 != 0) continue;  // one more than the point's
          code = std::max<int>(code, fields->errors[place - steps[axis]]);
          code = std::max<int>(code, fields->errors[place + steps[axis]]);
        }
        ASSERT_EQ(code, fields->errors[place]) << "phase " << phase << " place " << place;
      });
    }
  }
}

const Vec3 kSpacings[] = {{1, 1, 1}, {1, 1, 2.5}, {0.957, 0.31, 1.5}, {1e-9, 3, 1e9}, {0.1, 0.1, 0.1}};

template <class Sample>
class KnownErrorsOf : public testing::Test {};
using Samples = testing::Types<std::uint8_t, std::uint16_t, std::int16_t>;
TYPED_TEST_SUITE(KnownErrorsOf, Samples);

TYPED_TEST(KnownErrorsOf, AreThoseOfPreprocessingOfRandomSamples) {
  for (const Vec3& spacing : kSpacings) {
    std::mt19937_64 random(1);
    expect_known<TypeParam>(
        kDimensions, [&](std::size_t) { return static_cast<TypeParam>(random()); }, spacing);
  }
}

TYPED_TEST(KnownErrorsOf, AreThoseOfPreprocessingOfPlateaus) {
  for (const Vec3& spacing : kSpacings) {
    std::mt19937_64 random(2);
    const auto greatest = std::numeric_limits<TypeParam>::max();
    expect_known<TypeParam>(
        kDimensions,
        [&](std::size_t) {
          const auto number = random() % 40;
          return number == 0 ? greatest : static_cast<TypeParam>(number == 1 ? 1 : 0);
        },
        spacing);
  }
}

TYPED_TEST(KnownErrorsOf, AreThoseOfPreprocessingOfSmoothSamples) {
  for (const Vec3& spacing : kSpacings) {
    const double scale = static_cast<double>(std::numeric_limits<TypeParam>::max()) / 2.1;
    expect_known<TypeParam>(
        kDimensions,
        [&](std::size_t n) {
          const auto i = static_cast<double>(n % kDimensions[0]), j = static_cast<double>(n / kDimensions[0]);
          return static_cast<TypeParam>(scale * (1 + std::sin(0.2 * i) * std::cos(0.05 * j)));
        },
        spacing);
  }
}

TEST(KnownErrors, AreThoseOfPreprocessingInVolumesOfAllSizes) {
  std::mt19937_64 random(3);
  for (const Dimensions dimensions : {Dimensions{17, 16, 32}, {33, 18, 2}, {16, 47, 30}, {20, 1, 40}}) {
    expect_known<std::uint8_t>(
        dimensions, [&](std::size_t) { return static_cast<std::uint8_t>(random() & 7); }, {1, 2, 1});
  }
}

}  // namespace
}  // namespace adamas
