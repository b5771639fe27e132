// Tests labels as runs against the same labels as a dense array.

#include "core/data/label_array.h"

#include <gtest/gtest.h>

#include <random>
#include <utility>
#include <vector>

#include "core/base/repeated_sum.h"

namespace adamas {
namespace {

using Labels = std::vector<std::uint16_t>;

/// Makes labels of rows of `length` sites that change at a site with this probability.
Labels random_labels(std::size_t length, std::size_t rows, double change, std::mt19937& random) {
  std::bernoulli_distribution changes(change);
  Labels labels;
  std::uint16_t label = 0;
  for (std::size_t site = 0; site < length * rows; ++site) {
    if (changes(random)) label = static_cast<std::uint16_t>(random() % 7);
    labels.push_back(label);
  }
  return labels;
}

/// Adds the labels to a builder, each one more than it is, and returns what it makes of them by numbers.
LabelArray built(const Labels& labels, std::size_t length) {
  LabelBuilder builder(length, labels.size() / length);
  for (std::size_t site = 0; site < labels.size(); ++site) {
    const std::size_t i = site % length;
    if (i == 0 || labels[site] != labels[site - 1])
      builder.add(static_cast<std::uint32_t>(i), static_cast<std::uint16_t>(labels[site] + 1));
  }
  return std::move(builder).finish(Labels{99, 0, 1, 2, 3, 4, 5, 6});
}

void expect_same(const LabelArray& array, const Labels& labels, std::size_t length) {
  ASSERT_EQ(array.size(), labels.size());
  EXPECT_TRUE(array == LabelArray(labels));
  for (std::size_t site = 0; site < labels.size(); ++site) ASSERT_EQ(array[site], labels[site]) << site;
  const auto rows = array.rows(length), expected = LabelArray(labels).rows(length);
  EXPECT_EQ(rows->first, expected->first);
  EXPECT_EQ(rows->starts, expected->starts);
  EXPECT_EQ(rows->labels, expected->labels);
  for (std::size_t row = 0; row < rows->rows(); ++row) {
    std::size_t at = 0;
    array.for_each_run(row, length, [&](std::size_t begin, std::size_t end, std::uint16_t label) {
      ASSERT_EQ(begin, at);
      ASSERT_LT(begin, end);
      for (; at < end; ++at) ASSERT_EQ(labels[row * length + at], label);
    });
    EXPECT_EQ(at, length);
  }
  for (std::size_t least = 0; least < 9; ++least) {
    const auto found =
        std::find_if(labels.begin(), labels.end(), [least](auto label) { return label >= least; });
    const auto site = array.find_from(least);
    ASSERT_EQ(site.has_value(), found != labels.end());
    EXPECT_EQ(site.value_or(labels.size()), static_cast<std::size_t>(found - labels.begin()));
  }
}

TEST(LabelArray, HasTheLabelsOfADenseArray) {
  std::mt19937 random(8);
  std::size_t dense = 0, runs = 0;
  for (const auto& [length, rows] : std::vector<std::pair<std::size_t, std::size_t>>{
           {1, 1}, {1, 40}, {40, 1}, {2, 9}, {33, 17}, {200, 30}}) {
    for (const double change : {0.0, 0.02, 0.2, 1.0}) {
      const Labels labels = random_labels(length, rows, change, random);
      LabelArray array = built(labels, length);
      (array.is_dense() ? dense : runs) += 1;
      expect_same(array, labels, length);
      expect_same(LabelArray(labels).as_runs(length), labels, length);
      array.own()[0] = 8;
      EXPECT_TRUE(array.is_dense());
      Labels changed = labels;
      changed[0] = 8;
      expect_same(array, changed, length);
    }
  }
  // Few changes are kept as runs, and noise is not.
  EXPECT_GT(dense, 5u);
  EXPECT_GT(runs, 5u);
}

TEST(LabelArray, OfOneLabelHasARunForEachRow) {
  const LabelArray array = LabelArray::constant(50, 6, 3);
  EXPECT_FALSE(array.is_dense());
  expect_same(array, Labels(300, 3), 50);
}

TEST(LabelArray, HasParts) {
  std::mt19937 random(3);
  constexpr std::size_t kLength = 40, kRows = 12;
  for (const double change : {0.05, 1.0}) {
    const Labels labels = random_labels(kLength, kRows, change, random);
    for (const bool runs : {false, true}) {
      const LabelArray array = runs ? built(labels, kLength) : LabelArray(labels);
      for (const bool back : {false, true}) {
        for (const auto& [begin, end] :
             std::vector<std::pair<std::size_t, std::size_t>>{{0, kLength}, {0, 1}, {7, 30}, {39, 40}}) {
          const std::vector<std::size_t> rows{11, 0, 5, 5};
          Labels expected;
          for (const std::size_t row : rows) {
            for (std::size_t i = begin; i < end; ++i)
              expected.push_back(labels[row * kLength + (back ? begin + end - 1 - i : i)]);
          }
          expect_same(array.part(kLength, begin, end, rows, back), expected, end - begin);
        }
      }
    }
  }
}

/// All additions one after another are the reference, to the last bit.
TEST(RepeatedSum, IsThatOfAllAdditions) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> exponent(-30, 30), mantissa(1, 2);
  for (int round = 0; round < 3000; ++round) {
    double number = std::ldexp(mantissa(random), static_cast<int>(exponent(random)));
    // Many sums lie halfway between two numbers if a number has few digits.
    if (round % 3 == 0)
      number = std::ldexp(static_cast<double>(1 + random() % 9), -static_cast<int>(random() % 4));
    double sum = round % 2 == 0 ? 0 : std::ldexp(mantissa(random), static_cast<int>(exponent(random)));
    if (round % 3 == 0)
      sum = std::ldexp(1.0, 50 + static_cast<int>(random() % 3)) + static_cast<double>(random() % 8);
    if (round % 7 == 0) sum = -sum;
    const std::uint64_t count = random() % 20000;
    double expected = sum;
    for (std::uint64_t n = 0; n < count; ++n) expected += number;
    ASSERT_EQ(add_repeatedly(sum, number, count), expected) << sum << " " << number << " " << count;
  }
}

TEST(RepeatedSum, OfLengthsIsThatOfAllInTheirOrder) {
  std::mt19937 random(6);
  std::vector<double> lengths;
  while (lengths.size() < 500)
    lengths.insert(lengths.end(), random() % 60, 0.1 + 0.01 * static_cast<double>(random() % 3));
  const AxisLengths axis(lengths);
  for (int round = 0; round < 500; ++round) {
    const std::size_t begin = random() % lengths.size(),
                      end = begin + random() % (lengths.size() - begin + 1);
    double expected = 0.7;
    for (std::size_t i = begin; i < end; ++i) expected += 0.3 * lengths[i];
    ASSERT_EQ(axis.add(0.7, begin, end, [](double length) { return 0.3 * length; }), expected);
  }
}

}  // namespace
}  // namespace adamas
