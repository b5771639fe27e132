#include "core/picture/ticks.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <set>

namespace adamas {

using namespace picture;

namespace {

// Returns the value of a label in one of the forms "12.5", "−3", "2×10⁻⁵", "10³".
double value_of(std::string label) {
  const auto replace = [&](const std::string& from, const std::string& to) {
    for (std::size_t at; (at = label.find(from)) != std::string::npos;) label.replace(at, from.size(), to);
  };
  const char* digits[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  double mantissa = 1, exponent = 0;
  replace("−", "-");
  replace("⁻", "-");
  for (int d = 0; d < 10; ++d) replace(digits[d], std::to_string(d));
  if (const std::size_t times = label.find("×10"); times != std::string::npos) {
    mantissa = std::stod(label.substr(0, times));
    exponent = std::stod(label.substr(times + 3 + std::string("×").size() - 1));
    return mantissa * std::pow(10, exponent);
  }
  return std::stod(label);
}

TEST(Ticks, LinearTicksAreRoundEvenInsideAndAboutAsManyAsWanted) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> exponent(-8, 8), unit(-1, 1);
  for (int round = 0; round < 2000; ++round) {
    const double scale = std::pow(10, exponent(random));
    double low = scale * unit(random), high = scale * unit(random);
    if (low > high) std::swap(low, high);
    const int wanted = 2 + round % 9;
    const Ticks ticks = linear_ticks(low, high, wanted);
    ASSERT_EQ(ticks.positions.size(), ticks.labels.size());
    EXPECT_LE(ticks.positions.size(), static_cast<std::size_t>(2 * wanted + 1));
    EXPECT_GE(2 * ticks.positions.size() + 2, static_cast<std::size_t>(wanted));
    std::set<std::string> different(ticks.labels.begin(), ticks.labels.end());
    EXPECT_EQ(different.size(), ticks.labels.size());
    const double range = high - low;
    for (std::size_t i = 0; i < ticks.positions.size(); ++i) {
      EXPECT_GE(ticks.positions[i], low - 1e-6 * range);
      EXPECT_LE(ticks.positions[i], high + 1e-6 * range);
      EXPECT_NEAR(value_of(ticks.labels[i]), ticks.positions[i], 1e-6 * range) << ticks.labels[i];
    }
    if (ticks.positions.size() < 2) continue;
    const double step = ticks.positions[1] - ticks.positions[0];
    const double digit = step / std::pow(10, std::floor(std::log10(step * (1 + 1e-9))));
    EXPECT_TRUE(std::abs(digit - 1) < 1e-6 || std::abs(digit - 2) < 1e-6 || std::abs(digit - 5) < 1e-6)
        << digit;
    for (std::size_t i = 2; i < ticks.positions.size(); ++i) {
      EXPECT_NEAR(ticks.positions[i] - ticks.positions[i - 1], step, 1e-6 * range);
    }
  }
}

TEST(Ticks, Labels) {
  EXPECT_EQ(linear_ticks(0, 1, 5).labels, (std::vector<std::string>{"0", "0.2", "0.4", "0.6", "0.8", "1.0"}));
  EXPECT_EQ(linear_ticks(-16, 4.8, 5).labels, (std::vector<std::string>{"−15", "−10", "−5", "0"}));
  EXPECT_EQ(linear_ticks(0, 2e-5, 2).labels, (std::vector<std::string>{"0", "1×10⁻⁵", "2×10⁻⁵"}));
  EXPECT_EQ(linear_ticks(3, 3, 5).labels, (std::vector<std::string>{"3"}));
  EXPECT_EQ(log_ticks(1, 1000, 6).labels, (std::vector<std::string>{"10⁰", "10¹", "10²", "10³"}));
  EXPECT_EQ(log_ticks(1, 30, 6).labels, (std::vector<std::string>{"1", "2", "5", "10", "20"}));
}

TEST(Ticks, LogTicksLieInsideAndAreThinned) {
  for (int decades = 0; decades < 40; ++decades) {
    const double low = 3e-12, high = low * std::pow(10, decades) * 1.5;
    const Ticks ticks = log_ticks(low, high, 6);
    ASSERT_FALSE(ticks.positions.empty());
    EXPECT_LE(ticks.positions.size(), 9u);
    for (const double p : ticks.positions) EXPECT_TRUE(p >= low * (1 - 1e-6) && p <= high * (1 + 1e-6));
    for (const double p : ticks.minor) EXPECT_TRUE(p >= low * (1 - 1e-6) && p <= high * (1 + 1e-6));
  }
}

TEST(Ticks, TidyNumbers) {
  EXPECT_EQ(tidy_number(0), "0");
  EXPECT_EQ(tidy_number(-2.50), "−2.5");
  EXPECT_EQ(tidy_number(0.149), "0.149");
  EXPECT_EQ(tidy_number(11990), "11990");
  EXPECT_EQ(tidy_number(2e-7), "2×10⁻⁷");
  EXPECT_EQ(tidy_number(1e9), "10⁹");
  EXPECT_EQ(tidy_number(NAN), "no data");
}

}  // namespace
}  // namespace adamas
