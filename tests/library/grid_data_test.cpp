#include "core/data/grid_data.h"

#include <gtest/gtest.h>

#include <limits>
#include <numeric>

#include "adamas/generate.h"
#include "core/data/multi_material_data.h"
#include "tests/support/scratch.h"

namespace adamas {
namespace {

/// Two materials on 3 x 2 x 2 cells, with a field.
struct Example {
  std::vector<float> first, second;
  std::vector<double> field;
  GridData data;

  Example() {
    for (std::size_t site = 0; site < 12; ++site) {
      first.push_back(static_cast<float>(site) / 16);
      second.push_back(1 - first.back());
      field.push_back(static_cast<double>(site));
    }
    data.name = "example";
    data.grid = RectilinearGrid::uniform({3, 2, 2}, {1, 2, 3}, {0.5, 0.25, 2});
    data.materials = {"a", "b"};
    data.fractions = {first, second};
    data.fields.push_back({.name = "f", .values = field});
  }
};

template <class Change>
std::string error_after(const Change& change) {
  Example example;
  change(example);
  return test::error_of([&] { check(example.data); });
}

TEST(GridData, ArraysAreReadWhereTheyAre) {
  Example example;
  const MultiMaterialData taken = to_multi_material_data(example.data);
  const auto& fractions = taken.fractions;
  EXPECT_EQ(fractions[MaterialId(0)].data(), example.first.data());
  EXPECT_EQ(fractions[MaterialId(1)].data(), example.second.data());
  EXPECT_EQ(taken.fields[0].values, example.field);
  taken.fields[0].values.visit([&example](const auto& values) {
    EXPECT_EQ(static_cast<const void*>(values.data()), example.field.data());
  });

  const std::vector<std::uint16_t> labels(12, 1);
  example.data.fractions = {};
  example.data.labels = labels;
  const MultiMaterialData labelled = to_multi_material_data(example.data);
  const SiteArray<std::uint16_t> borrowed = labelled.labels.dense();
  EXPECT_EQ(borrowed.data(), labels.data());
}

TEST(GridData, FractionsAreMendedInACopy) {
  Example example;
  example.first[5] = 0.5f;
  example.second[5] = 0.52f;
  const MultiMaterialData taken = to_multi_material_data(example.data);
  const auto& fractions = taken.fractions;
  EXPECT_NE(fractions[MaterialId(0)].data(), example.first.data());
  EXPECT_EQ(example.first[5], 0.5f);
  EXPECT_FLOAT_EQ(fractions[MaterialId(0)][5] + fractions[MaterialId(1)][5], 1);
  EXPECT_EQ(taken.report.renormalised, 1u);
}

TEST(GridData, EveryTypeOfNumbersGivesTheSame) {
  const std::vector<std::uint8_t> bytes{0, 1, 1, 0, 1, 0, 0, 0, 1, 1, 0, 1};
  GridData data = Example().data;
  data.fields = {};
  const auto volumes_of_labels = [&](const auto& labels) {
    data.fractions = {};
    data.labels = labels;
    return material_volumes(data);
  };
  const auto as = [&bytes](auto type) { return std::vector<decltype(type)>(bytes.begin(), bytes.end()); };
  const std::vector<double> wanted = volumes_of_labels(bytes);
  EXPECT_EQ(volumes_of_labels(as(std::uint16_t{})), wanted);
  EXPECT_EQ(volumes_of_labels(as(std::int16_t{})), wanted);
  EXPECT_EQ(volumes_of_labels(as(std::int32_t{})), wanted);
  data.labels = NumberSpan();
  const auto ones = as(double{});
  std::vector<double> others(ones.size());
  std::transform(ones.begin(), ones.end(), others.begin(), [](double v) { return 1 - v; });
  data.fractions = {others, ones};
  EXPECT_EQ(material_volumes(data), wanted);
}

TEST(GridData, TheViewOfDataIsTheData) {
  const GeneratedScene scene = generate_scene("shell3", {6, 5, 4});
  const GridData data = scene.data.view();
  const MultiMaterialData again = to_multi_material_data(data);
  const GridData view_again = view(again);
  ASSERT_EQ(view_again.fractions.size(), data.fractions.size());
  for (std::size_t m = 0; m < data.fractions.size(); ++m)
    EXPECT_EQ(std::get<0>(view_again.fractions[m]).data(), std::get<0>(data.fractions[m]).data());
  ASSERT_EQ(view_again.fields.size(), data.fields.size());
  EXPECT_GT(data.fields.size(), 0u);
  for (std::size_t f = 0; f < data.fields.size(); ++f) {
    EXPECT_EQ(view_again.fields[f].name, data.fields[f].name);
    EXPECT_EQ(view_again.fields[f].material_values.size(), data.fields[f].material_values.size());
  }
}

TEST(GridData, WhatIsWrongIsToldInALine) {
  const auto has = [](const std::string& message, const char* text) {
    EXPECT_TRUE(message.starts_with("example: ")) << message;
    EXPECT_NE(message.find(text), std::string::npos) << message;
  };
  has(error_after([](Example& e) { e.first.pop_back(), e.data.fractions[0] = e.first; }),
      "expected 12 values, found 11");
  has(error_after([](Example& e) { e.first[3] = std::numeric_limits<float>::quiet_NaN(); }),
      "found nan at index 3");
  has(error_after([](Example& e) { e.field[3] = std::numeric_limits<double>::infinity(); }),
      "found inf at index 3");
  has(error_after([](Example& e) { e.first[3] = 0.9f; }), "expected a sum of 1");
  has(error_after([](Example& e) { e.data.fractions.pop_back(); }), "of 2 materials, found 1");
  has(error_after([](Example& e) { e.data.labels = e.first; }), "expected an array of whole numbers");
  has(error_after([](Example& e) { e.data.fields[0].components = 0; }), "at least one component");
  has(error_after([](Example& e) { e.data.fields[0].components = 2; }), "expected 24 values, found 12");
  has(error_after([](Example& e) { e.data.fields[0].values = NumberSpan(); }), "expected values, found none");
  has(error_after([](Example& e) { e.data.fields[0].material_values = {e.first, e.second}; }), "found both");
  has(error_after([](Example& e) { e.data.grid.nodes[1] = {1, 1, 2}; }), "ascending");
  has(error_after([](Example& e) { e.data.grid.nodes[1] = {}; }), "grid with volume");
  const std::vector<std::int32_t> labels{0, 1, 0, 1, 0, 1, 0, 1, 0, -1, 0, 1}, beyond(12, 2);
  const auto labelled = [](const std::vector<std::int32_t>& values) {
    return [&values](Example& e) { e.data.fractions = {}, e.data.labels = values; };
  };
  has(error_after(labelled(labels)), "found -1 at index 9");
  has(error_after(labelled(beyond)), "expected materials below 2");
}

}  // namespace
}  // namespace adamas
