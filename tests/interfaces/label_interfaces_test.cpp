// Tests the interfaces of labels against those that the lattice of values gives, of which they are a fast
// way.

#include "interfaces/reconstruction/label_interfaces.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <set>
#include <string>
#include <tuple>
#include <utility>

#include "adamas/progress.h"
#include "datasets/random_numbers.h"
#include "interfaces/reconstruction/grid_sites.h"
#include "interfaces/reconstruction/label_surfaces.h"
#include "interfaces/reconstruction/label_totals.h"
#include "interfaces/reconstruction/reconstruction.h"
#include "interfaces/reconstruction/site_cell.h"
#include "interfaces/reconstruction/volume_correction.h"
#include "tests/support/closed_reconstruction.h"

namespace adamas {

using namespace datasets;
using namespace interfaces;

namespace {

struct Case {
  std::array<std::size_t, 3> sites;
  std::size_t materials = 2;
  Centering centering = Centering::kCells;
  bool stretched = false, smooth = false;
  std::uint64_t seed = 1;
};

/// Returns random labels in lumps of up to two voxels along each axis, or of single voxels. Names are not in
/// the order of labels.
MultiMaterialData random_labels(const Case& c) {
  MultiMaterialData data;
  data.source = "labels";
  data.grid.centering = c.centering;
  RandomNumbers random(c.seed);
  for (std::size_t a = 0; a < 3; ++a) {
    const std::size_t nodes = c.sites[a] + (c.centering == Centering::kCells ? 1 : 0);
    double x = -1.5;
    for (std::size_t i = 0; i < nodes; ++i) {
      data.grid.nodes[a].push_back(x);
      x += c.stretched ? 0.6 + 0.05 * static_cast<double>(random.below(9)) : 1;
    }
  }
  for (std::size_t m = 0; m < c.materials; ++m) data.materials.push_back(std::string(1, "cadbfe"[m]));
  data.labels.resize(data.grid.site_count());
  const std::size_t lump = 1 + random.below(3);
  std::vector<std::uint16_t> lumps;
  for (std::size_t n = 0; n < 8000; ++n)
    lumps.push_back(static_cast<std::uint16_t>(random.below(3) == 0 ? 0 : random.below(c.materials)));
  for (std::size_t k = 0; k < c.sites[2]; ++k) {
    for (std::size_t j = 0; j < c.sites[1]; ++j) {
      for (std::size_t i = 0; i < c.sites[0]; ++i)
        data.labels[data.grid.site_index(i, j, k)] = lumps[i / lump + 10 * (j / lump) + 100 * (k / lump)];
    }
  }
  return data;
}

std::vector<Case> cases() {
  std::vector<Case> all;
  std::uint64_t seed = 1;
  for (const std::size_t materials : {2, 3, 4, 6}) {
    for (const Centering centering : {Centering::kCells, Centering::kPoints}) {
      for (const bool stretched : {false, true}) {
        for (const bool smooth : {false, true}) {
          const std::size_t least = centering == Centering::kCells ? 1 : 2;
          for (std::array<std::size_t, 3> sites : {std::array<std::size_t, 3>{8, 7, 9},
                                                   {3, 2, 4},
                                                   {5, 6, 1},
                                                   {1, 4, 3},
                                                   {6, 1, 1},
                                                   {2, 2, 2},
                                                   {4, 1, 5},
                                                   {9, 9, 18},
                                                   {3, 2, 70}}) {
            for (std::size_t& n : sites) n = std::max(n, least);
            all.push_back({sites, materials, centering, stretched, smooth, seed++});
          }
        }
      }
    }
  }
  return all;
}

std::string describe(const Case& c) {
  return std::to_string(c.sites[0]) + "x" + std::to_string(c.sites[1]) + "x" + std::to_string(c.sites[2]) +
         " sites, " + std::to_string(c.materials) + " materials, " +
         (c.centering == Centering::kCells ? "cells" : "points") + (c.stretched ? ", stretched" : "") +
         (c.smooth ? ", smooth" : "") + ", seed " + std::to_string(c.seed);
}

/// A triangle by the places of its corners, the least first, with its bodies.
using Placed = std::array<double, 11>;

std::multiset<Placed> placed(const InterfaceMesh& mesh, const std::vector<std::array<BodyId, 2>>& bodies) {
  std::multiset<Placed> result;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    std::array<std::array<double, 3>, 3> corners{};
    for (std::size_t c = 0; c < 3; ++c) {
      const Vec3& p = mesh.points[mesh.triangles[t].points[c]];
      corners[c] = {p.x, p.y, p.z};
    }
    std::rotate(corners.begin(), std::ranges::min_element(corners), corners.end());
    Placed own{};
    for (std::size_t c = 0; c < 3; ++c) std::ranges::copy(corners[c], own.begin() + 3 * static_cast<int>(c));
    own[9] = bodies[t][0].value, own[10] = bodies[t][1].value;
    result.insert(own);
  }
  return result;
}

LabelLattice lattice_of(const MultiMaterialData& data, bool smooth) {
  return smooth ? LabelLattice(data, SiteValues(data, true)) : LabelLattice(data);
}

/// Calls visit(entry, value) for each entry with the value that the lattice has there.
template <class Visit>
void for_each_value(const MultiMaterialData& data, const LabelLattice& lattice, SiteValues& values,
                    Visit&& visit) {
  const std::uint32_t margin = data.grid.centering == Centering::kCells ? 1 : 0;
  const GridSites sites(data.grid);
  for (std::size_t site = 0; site < data.grid.site_count(); ++site) {
    const auto [i, j, k] = sites.indices(site);
    const LabelLattice::Index point{static_cast<std::uint32_t>(i) + margin,
                                    static_cast<std::uint32_t>(j) + margin,
                                    static_cast<std::uint32_t>(k) + margin};
    for (SiteValues::Entry& entry : values.at(site)) visit(entry, lattice.value(point, entry.material));
  }
}

TEST(LabelInterfaces, AreThoseOfTheLatticeOfValues) {
  std::size_t whole = 0, parts = 0;
  for (const Case& c : cases()) {
    SCOPED_TRACE(describe(c));
    const MultiMaterialData data = random_labels(c);
    LabelLattice lattice = lattice_of(data, c.smooth);
    const IdVector<MaterialId, double> volumes =
        close_label_totals(data, data.volumes(), lattice, SilentProgress::instance());
    if (!lattice.labels_stay()) continue;
    SiteValues values(data, c.smooth);
    for_each_value(data, lattice, values,
                   [](SiteValues::Entry& entry, double value) { entry.value = value; });
    const Reconstruction slow(data, values);
    const auto fast = LabelInterfaces::make(data, std::move(lattice), true, SilentProgress::instance());
    if (!fast) continue;
    InterfaceMesh mesh;
    mesh.points = fast->take_points();
    mesh.triangles = fast->take_triangles();
    const auto bodies = fast->take_bodies();
    EXPECT_EQ(fast->body_materials(), slow.body_materials());
    if (fast->left_out() == 0) {
      EXPECT_EQ(mesh.points, slow.mesh().points);
      EXPECT_EQ(mesh.triangles, slow.mesh().triangles);
      EXPECT_EQ(bodies, slow.bodies());
      ++whole;
    } else {
      EXPECT_EQ(mesh.points.size(), slow.mesh().points.size());
      EXPECT_EQ(placed(mesh, bodies), placed(slow.mesh(), slow.bodies()));
      ++parts;
    }
    const double round_off = 1e-12 * data.grid.domain().volume();
    for (MaterialId m(0); m.value < c.materials; ++m.value)
      EXPECT_NEAR(volumes[m], slow.volume_reconstructed()[m], round_off);
    RandomNumbers random(7);
    for (int n = 0; n < 300; ++n) {
      const Vec3 p = random.point(data.grid.domain());
      EXPECT_EQ(fast->body_at(p), slow.body_at(p));
    }
    if (HasFailure()) break;
  }
  EXPECT_GT(whole, 30u);
  EXPECT_GT(parts, 10u);
}

/// Small grids and those with uneven spacing are left out: there totals of fractions are not quite those of
/// the interfaces, which CellVolumes cuts cell by cell. Totals of labels are, which the other tests check.
TEST(LabelInterfaces, TotalsAreClosedAsForFractions) {
  for (const Case& c : cases()) {
    if (std::ranges::min(c.sites) < 7 || c.stretched) continue;
    SCOPED_TRACE(describe(c));
    const MultiMaterialData data = random_labels(c);
    LabelLattice lattice = lattice_of(data, c.smooth);
    close_label_totals(data, data.volumes(), lattice, SilentProgress::instance());
    if (!lattice.labels_stay()) continue;
    SiteValues values(data, c.smooth);
    correct_volumes(data, values, SiteCells(data.grid), SilentProgress::instance());
    double greatest = 0;
    for_each_value(data, lattice, values, [&](const SiteValues::Entry& entry, double value) {
      greatest = std::max(greatest, std::abs(entry.value - value));
    });
    EXPECT_LT(greatest, 1e-5);
    if (HasFailure()) break;
  }
}

TEST(LabelInterfaces, AreTheSameForAnyNumberOfThreadsAndClosed) {
  for (Case c : cases()) {
    // The largest grids, whose layers are made at the same time.
    if (c.sites[2] != 18 || c.materials != (c.centering == Centering::kCells ? 6u : 3u)) continue;
    SCOPED_TRACE(describe(c));
    const MultiMaterialData data = random_labels(c);
    const Reconstruction one(data, {.smooth_labels = c.smooth});
    test::expect_closed_with_totals(one, data);
    set_thread_limit(3);
    const Reconstruction other(data, {.smooth_labels = c.smooth});
    EXPECT_EQ(one.mesh().points, other.mesh().points);
    EXPECT_EQ(one.mesh().triangles, other.mesh().triangles);
    EXPECT_EQ(one.bodies(), other.bodies());
    set_thread_limit(1);
  }
}

/// The surfaces of a box of cells are those that the whole has there, with the same points on the same
/// features.
TEST(LabelSurfaces, OfABoxArePartsOfTheWhole) {
  const MultiMaterialData data = random_labels({.sites = {9, 8, 10}, .materials = 4, .seed = 3});
  const LabelLattice lattice(data);
  using Corner = std::pair<LatticeFeature, std::array<double, 3>>;
  using Triangle = std::tuple<std::array<Corner, 3>, std::uint32_t, std::uint32_t>;
  const auto add = [&](const LabelLattice::Index& first, const LabelLattice::Index& last,
                       std::multiset<Triangle>& found) {
    const LabelSurfaces surfaces = label_surfaces(lattice, first, last);
    for (const InterfaceTriangle& t : surfaces.triangles) {
      std::array<Corner, 3> corners;
      for (std::size_t c = 0; c < 3; ++c) {
        const Vec3& p = surfaces.points[t.points[c]];
        corners[c] = {surfaces.features[t.points[c]], {p.x, p.y, p.z}};
      }
      found.insert({corners, t.front.value, t.back.value});
    }
  };
  const LabelLattice::Index end{lattice.points(0) - 1, lattice.points(1) - 1, lattice.points(2) - 1};
  std::multiset<Triangle> whole, boxes;
  add({0, 0, 0}, end, whole);
  for (std::uint32_t k = 0; k < end[2]; k += 3) {
    for (std::uint32_t j = 0; j < end[1]; j += 4) {
      for (std::uint32_t i = 0; i < end[0]; i += 5)
        add({i, j, k}, {std::min(i + 5, end[0]), std::min(j + 4, end[1]), std::min(k + 3, end[2])}, boxes);
    }
  }
  EXPECT_EQ(whole, boxes);
  EXPECT_GT(whole.size(), 1000u);
}

}  // namespace

}  // namespace adamas
