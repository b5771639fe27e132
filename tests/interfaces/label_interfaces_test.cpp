// Tests the interfaces of labels against those that the lattice of values gives, of which they are a fast
// way.

#include "interfaces/reconstruction/label_interfaces.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <utility>

#include "adamas/progress.h"
#include "core/distance/closest_point_tree.h"
#include "core/geometry/plane.h"
#include "datasets/random_numbers.h"
#include "interfaces/cross_section/cross_section.h"
#include "interfaces/reconstruction/grid_sites.h"
#include "interfaces/reconstruction/label_parts.h"
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
    if (c.materials == 4) continue;
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
    if (c.sites[2] != 18 || c.stretched || c.materials != (c.centering == Centering::kCells ? 6u : 3u))
      continue;
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

/// Sites of points on the border have cells of half the size, which rounding of coordinates may change.
TEST(LabelInterfaces, RoundedCoordinatesAreEvenlySpaced) {
  MultiMaterialData data = random_labels({.sites = {9, 8, 10}, .centering = Centering::kPoints});
  const auto make = [&] {
    return LabelInterfaces::make(data, data.volumes(), false, SilentProgress::instance());
  };
  // One material at the border leaves no pieces there that another owns alone.
  const GridSites sites(data.grid);
  for (std::size_t site = 0; site < data.labels.size(); ++site) {
    const auto [i, j, k] = sites.indices(site);
    if (std::min({i, j, k}) < 2 || i > 6 || j > 5 || k > 7) data.labels[site] = 0;
  }
  EXPECT_TRUE(make());
  for (auto& nodes : data.grid.nodes) {
    for (std::size_t i = 0; i < nodes.size(); ++i)
      nodes[i] = static_cast<float>(500 + 0.7 * static_cast<double>(i));
  }
  EXPECT_TRUE(LabelLattice(data).has_even_spacing());
  EXPECT_TRUE(make());
  data.grid.nodes[0].back() -= 0.01;
  EXPECT_FALSE(LabelLattice(data).has_even_spacing());
  EXPECT_FALSE(make());
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

/// Random labels in lumps of some voxels, one label at the border, and voxels that are no cubes, whose sides
/// are equal but for round-off.
MultiMaterialData labels_in_a_frame(std::uint64_t seed, Centering centering) {
  MultiMaterialData data;
  data.source = "labels";
  data.grid.centering = centering;
  RandomNumbers random(seed);
  const std::array<std::size_t, 3> sites{13, 11, 12};
  const Vec3 voxel{1, 0.7, 2};
  for (std::size_t a = 0; a < 3; ++a) {
    const std::size_t nodes = sites[a] + (centering == Centering::kCells ? 1 : 0);
    for (std::size_t i = 0; i < nodes; ++i)
      data.grid.nodes[a].push_back(-2 + voxel[static_cast<int>(a)] * static_cast<double>(i));
  }
  const std::size_t materials = 2 + random.below(5), lump = 1 + random.below(3);
  for (std::size_t m = 0; m < materials; ++m) data.materials.push_back(std::string(1, "cadbfe"[m]));
  std::vector<std::uint16_t> lumps(13 * 13 * 13);
  for (std::uint16_t& label : lumps) label = static_cast<std::uint16_t>(random.below(materials));
  data.labels.resize(data.grid.site_count());
  for (std::size_t k = 2; k + 2 < sites[2]; ++k) {
    for (std::size_t j = 2; j + 2 < sites[1]; ++j) {
      for (std::size_t i = 2; i + 2 < sites[0]; ++i)
        data.labels[data.grid.site_index(i, j, k)] = lumps[i / lump + 13 * (j / lump) + 169 * (k / lump)];
    }
  }
  return data;
}

/// Returns planes through a box: on its sides, on and between planes of the grid, and oblique ones.
std::vector<Plane> planes_through(const RectilinearGrid& grid, std::uint64_t seed) {
  const Box3 box = grid.domain();
  std::vector<Plane> planes;
  for (std::size_t a = 0; a < 3; ++a) {
    const int axis = static_cast<int>(a);
    Vec3 normal;
    normal[axis] = 1;
    const auto& x = grid.nodes[a];
    for (const double at : {x.front(), x.back(), x[3], x[4] + 0.1, 0.5 * (x[2] + x[3])}) {
      Vec3 origin = box.center();
      origin[axis] = at;
      planes.push_back({origin, normal});
      planes.push_back({origin, -3 * normal});
    }
  }
  RandomNumbers random(seed);
  const auto any = [&] { return random.uniform() - 0.5; };
  for (int n = 0; n < 12; ++n) planes.push_back({random.point(box), {any(), any(), any()}});
  planes.push_back({box.center(), {1e-7, 1, 0}});
  planes.push_back({box.center(), {1, 1e-14, 1e-9}});
  planes.push_back({box.min, {1, -1, 0}});
  planes.push_back({box.center(), {1, 0, -1}});
  return planes;
}

/// What a plane cuts out of the interfaces near it is to the last bit what it cuts out of all of them.
TEST(LabelParts, HaveTheSectionOfTheWhole) {
  std::size_t layers = 0, all = 0, segments = 0, fewer = 0;
  const auto compare = [&](const MultiMaterialData& data, std::uint64_t seed) {
    const std::vector<Plane> planes = planes_through(data.grid, seed);
    all += planes.size();
    const auto parts = LabelParts::make(data, SilentProgress::instance());
    if (!parts) return;
    const Reconstruction whole(data);
    for (const Plane& plane : planes) {
      const InterfaceMesh layer = parts->near_plane(data, plane);
      ++layers;
      SCOPED_TRACE(to_string(plane));
      const auto expected = section_edges(whole.mesh(), plane, data.grid.domain());
      EXPECT_EQ(section_edges(layer, plane, data.grid.domain()), expected);
      segments += expected.size();
      fewer += 2 * layer.triangles.size() < whole.mesh().triangles.size() ? 1 : 0;
    }
  };
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    SCOPED_TRACE(seed);
    compare(labels_in_a_frame(seed, seed % 2 == 0 ? Centering::kCells : Centering::kPoints), seed);
  }
  EXPECT_GT(layers, 9 * all / 10);
  EXPECT_GT(fewer, layers / 2);
  EXPECT_GT(segments, 10000u);
  // Up to the border, where there are often pieces that a material owns alone.
  const std::size_t in_frames = layers;
  for (const Case& c : cases()) {
    if (c.smooth || std::ranges::min(c.sites) != 7) continue;
    SCOPED_TRACE(describe(c));
    compare(random_labels(c), c.seed);
  }
  EXPECT_GT(layers, in_frames);
  EXPECT_LT(layers, all);
}

/// Distances from interfaces near a point are those from all of them, and bodies have the same numbers.
TEST(LabelParts, KnowDistancesAndBodies) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    SCOPED_TRACE(seed);
    const MultiMaterialData data =
        labels_in_a_frame(seed, seed % 2 == 0 ? Centering::kCells : Centering::kPoints);
    const auto parts = LabelParts::make(data, SilentProgress::instance());
    ASSERT_TRUE(parts);
    Reconstruction whole(data);
    EXPECT_EQ(parts->bodies().body_materials(), whole.body_materials());
    std::vector<ClosestPointTree::Triangle> triangles;
    for (const InterfaceTriangle& t : whole.mesh().triangles) triangles.push_back(t.points);
    const ClosestPointTree tree(whole.mesh().points, triangles);
    RandomNumbers random(seed);
    Box3 wide = data.grid.domain();
    wide.min -= Vec3{3, 3, 3}, wide.max += Vec3{3, 3, 3};
    for (int n = 0; n < 60; ++n) {
      const Vec3 p = random.point(wide);
      EXPECT_EQ(parts->bodies().body_at(p), whole.body_at(p));
      const std::optional<double> distance = parts->interface_distance(p);
      ASSERT_TRUE(distance);
      EXPECT_EQ(*distance, std::sqrt(tree.closest(p)->squared_distance));
    }
  }
  MultiMaterialData one = labels_in_a_frame(2, Centering::kCells);
  one.labels.assign(one.labels.size(), 0);
  const auto parts = LabelParts::make(one, SilentProgress::instance());
  ASSERT_TRUE(parts);
  const std::optional<double> none = parts->interface_distance(one.grid.domain().center());
  ASSERT_TRUE(none);
  EXPECT_TRUE(std::isnan(*none));
}

}  // namespace

}  // namespace adamas
