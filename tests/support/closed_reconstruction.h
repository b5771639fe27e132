#pragma once

#include <gtest/gtest.h>

#include "interfaces/reconstruction/reconstruction.h"
#include "tests/support/closed_surface.h"

namespace adamas::test {

using namespace interfaces;

/// Expects that the interfaces are closed.
inline void expect_closed(const Reconstruction& found, const Box3& box) {
  const auto report = check_edges(found.mesh().points, sided_by_material(found.mesh()), box, 1e-9);
  EXPECT_EQ(report.open, 0u) << report.first;
  EXPECT_EQ(report.lonely, 0u) << report.first;
}

/// Expects that the interfaces are closed, and that materials have the volumes of their fractions, less what
/// is dispersed.
inline void expect_closed_with_totals(const Reconstruction& found, const MultiMaterialData& data) {
  const Box3 box = data.grid.domain();
  expect_closed(found, box);
  // Fractions are floats that do not quite add up to 1; all materials share what they exceed it by.
  double beyond = -box.volume();
  double dispersed = 0;
  for (const double volume : found.findings().dispersed) dispersed += volume;
  for (const double volume : found.volume_wanted()) beyond += volume;
  beyond /= static_cast<double>(data.materials.size());
  for (MaterialId m(0); m.value < data.materials.size(); ++m.value) {
    EXPECT_NEAR(found.volume_reconstructed()[m], found.volume_wanted()[m] - beyond, 1e-9 * box.volume());
    EXPECT_NEAR(found.volume_wanted()[m], found.volume_input()[m], 1e-12 + dispersed);
  }
}

}  // namespace adamas::test
