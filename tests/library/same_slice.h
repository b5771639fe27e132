#pragma once

#include <gtest/gtest.h>

#include "adamas/slice.h"

namespace adamas::test {

/// Expects two slices to be the same bit for bit.
inline void expect_same(const Slice& found, const Slice& expected) {
  EXPECT_EQ(found.points, expected.points);
  EXPECT_EQ(found.offsets, expected.offsets);
  EXPECT_EQ(found.polygon_materials, expected.polygon_materials);
  EXPECT_EQ(found.polygon_cells, expected.polygon_cells);
  EXPECT_EQ(found.values, expected.values);
  EXPECT_EQ(found.materials, expected.materials);
  EXPECT_EQ(found.material_areas, expected.material_areas);
  EXPECT_EQ(found.field, expected.field);
}

}  // namespace adamas::test
