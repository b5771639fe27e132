#include "isosurface/preprocessing/own_errors.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <random>

#include "isosurface/compression/bounds/bounds_fields.h"
#include "isosurface/compression/bounds/bounds_stages.h"
#include "isosurface/volume/samples.h"
#include "tests/support/prepared_volume.h"

namespace adamas {

using namespace isosurface;

namespace {

using Dimensions = std::array<std::uint64_t, 3>;
constexpr Dimensions kDimensions{39, 35, 33};

/// Calls check(cell, coordinates in the page) for the points of a parity whose errors are determined.
template <class Check>
void for_each_determined(const PageShape& shape, int parity, Check check) {
  const DeterminedPoints determined(shape, parity, DeterminedPoints::Bound::kErrors);
  const ParityBox box = ParityBox::for_parity(shape.count, parity);
  const LatticePoint odd{parity & 1, parity >> 1 & 1, parity >> 2};
  std::size_t count = 0;
  for (std::int32_t n = 0; n < box.size(); ++n) {
    const LatticePoint c{n % box.ni, n / box.ni % box.nj, n / box.ni / box.nj};
    if ((determined.row(static_cast<std::size_t>(n / box.ni)) >> 8 * c.i & 1) == 0) continue;
    ++count;
    check(kFirstCell + static_cast<std::size_t>(c.i + 11 * (c.j + 11 * c.k)), 2 * c + odd);
  }
  // A page of full size has seven or eight of them along each axis.
  if (shape.count == LatticePoint{16, 16, 16}) {
    ASSERT_GE(count, 343u);
  }
}

/// Expects, on the finest LOD, that own errors raised by the errors of children are the errors that
/// preprocessing found.
template <class Sample>
void expect_found_again(const Dimensions& dimensions, const std::function<Sample(std::size_t)>& sample,
                        const Vec3& spacing) {
  using Word = OrderedWord<Sample>;
  std::vector<Sample> samples;
  for (std::size_t n = 0; n < dimensions[0] * dimensions[1] * dimensions[2]; ++n)
    samples.push_back(sample(n));
  const test::PreparedVolume<Sample> volume(dimensions, samples, spacing);
  const OwnErrorGeometry geometry(spacing);
  const auto fields = std::make_unique<BoundsFields<Word>>();
  const LatticePoint blocks = volume.grid().blocks(0);
  for (int n = 0; n < blocks.i * blocks.j * blocks.k; ++n) {
    const PageId id{0, {n % blocks.i, n / blocks.i % blocks.j, n / blocks.i / blocks.j}};
    if (!volume.grid().contains(id)) continue;
    const PageShape shape = volume.shape(id);
    const Page<Word> page = volume.page(id);
    fields->load(shape, volume.around(id), page);
    fields->predict_errors(shape, geometry);
    for (const int parity : kCodedParities) {
      for_each_determined(shape, parity, [&](std::size_t cell, LatticePoint q) {
        int code = fields->predicted[static_cast<std::size_t>(parity)][cell];
        for (int axis = 0; phase_of(parity) < 2 && axis < 3; ++axis) {
          if (q[axis] % 2 == 0) continue;
          for (const std::int32_t way : {-1, 1}) {
            LatticePoint child = q;
            child[axis] += way;
            code = std::max<int>(code, page.errors[PageGrid::place(child, 0)]);
          }
        }
        ASSERT_EQ(code, page.errors[PageGrid::place(q, 0)])
            << "parity " << parity << " point " << q.i << ", " << q.j << ", " << q.k;
      });
    }
  }
}

const Vec3 kSpacings[] = {{1, 1, 1}, {1, 1, 2.5}, {0.957, 0.31, 1.5}, {1e-9, 3, 1e9}, {0.1, 0.1, 0.1}};

template <class Sample>
class OwnErrorsOf : public testing::Test {};
using Samples = testing::Types<std::uint8_t, std::uint16_t, std::int16_t>;
TYPED_TEST_SUITE(OwnErrorsOf, Samples);

TYPED_TEST(OwnErrorsOf, AreThoseOfPreprocessingOfRandomSamples) {
  for (const Vec3& spacing : kSpacings) {
    std::mt19937_64 random(1);
    expect_found_again<TypeParam>(
        kDimensions, [&](std::size_t) { return static_cast<TypeParam>(random()); }, spacing);
  }
}

TYPED_TEST(OwnErrorsOf, AreThoseOfPreprocessingOfPlateaus) {
  for (const Vec3& spacing : kSpacings) {
    std::mt19937_64 random(2);
    const auto greatest = std::numeric_limits<TypeParam>::max();
    expect_found_again<TypeParam>(
        kDimensions,
        [&](std::size_t) {
          const auto number = random() % 40;
          return number == 0 ? greatest : static_cast<TypeParam>(number == 1 ? 1 : 0);
        },
        spacing);
  }
}

TYPED_TEST(OwnErrorsOf, AreThoseOfPreprocessingOfSmoothSamples) {
  for (const Vec3& spacing : kSpacings) {
    const double scale = static_cast<double>(std::numeric_limits<TypeParam>::max()) / 2.1;
    expect_found_again<TypeParam>(
        kDimensions,
        [&](std::size_t n) {
          const auto i = static_cast<double>(n % kDimensions[0]), j = static_cast<double>(n / kDimensions[0]);
          return static_cast<TypeParam>(scale * (1 + std::sin(0.2 * i) * std::cos(0.05 * j)));
        },
        spacing);
  }
}

TEST(OwnErrors, AreThoseOfPreprocessingInVolumesOfAllSizes) {
  std::mt19937_64 random(3);
  for (const Dimensions dimensions : {Dimensions{17, 16, 32}, {33, 18, 2}, {16, 47, 30}, {20, 1, 40}}) {
    expect_found_again<std::uint8_t>(
        dimensions, [&](std::size_t) { return static_cast<std::uint8_t>(random() & 7); }, {1, 2, 1});
  }
}

}  // namespace
}  // namespace adamas
