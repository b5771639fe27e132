// Tests what is measured of volume fractions: the area of the interfaces of linearly interpolated fractions,
// connected cells that hold a material, gradients, and values of the normal distribution from a table.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <set>
#include <utility>
#include <vector>

#include "core/geometry/ownership_problem.h"
#include "core/geometry/plane.h"
#include "datasets/random_numbers.h"
#include "datasets/scene.h"
#include "datasets/scene_sampling.h"
#include "interfaces/reconstruction/fraction_area.h"
#include "interfaces/reconstruction/grid_sites.h"
#include "interfaces/reconstruction/held_cells.h"
#include "interfaces/reconstruction/interface_planes.h"
#include "interfaces/reconstruction/material_lattice.h"
#include "interfaces/reconstruction/normal_distribution.h"
#include "interfaces/reconstruction/site_values.h"

namespace adamas {

using namespace datasets;
using namespace interfaces;

namespace {

MultiMaterialData sampled(const char* scene, const std::array<std::size_t, 3>& cells) {
  SamplingOptions options;
  options.fields = false;
  options.blur = {.blur = 0.7};
  return sample_scene(make_scene(scene, 3), cells, options);
}

/// Returns the area of all contact polygons of a lattice.
double area_of_contacts(const MaterialLattice& lattice) {
  double area = 0;
  for (MaterialLattice::Index cell{0, 0, 0}; cell[2] + 1 < lattice.points(2); ++cell[2]) {
    for (cell[1] = 0; cell[1] + 1 < lattice.points(1); ++cell[1]) {
      for (cell[0] = 0; cell[0] + 1 < lattice.points(0); ++cell[0]) {
        for (std::size_t path = 0; path < MaterialLattice::kPaths.size(); ++path) {
          const auto corners = lattice.tetrahedron(cell, path);
          OwnershipProblem problem;
          lattice.ownership(corners, problem);
          if (problem.candidates.size() < 2) continue;
          std::vector<ContactPolygon> contacts;
          contact_polygons(problem, contacts);
          for (const ContactPolygon& contact : contacts) {
            std::vector<Vec3> places(contact.corners.size());
            for (std::size_t i = 0; i < places.size(); ++i) {
              for (std::size_t v = 0; v < 4; ++v)
                places[i] += contact.corners[i].weights[v] * lattice.position(corners[v]);
            }
            area += polygon_area(places);
          }
        }
      }
    }
  }
  return area;
}

TEST(FractionArea, IsThatOfTheLatticeOfFractions) {
  for (const char* scene : {"sphere", "voronoi10", "tjunction"}) {
    const MultiMaterialData data = sampled(scene, {14, 11, 9});
    const SiteValues fractions = SiteValues::fractions(data), values(data);
    const MaterialLattice of_fractions(data, fractions), of_values(data, values);
    const double expected = area_of_contacts(of_fractions);
    EXPECT_GT(expected, 0.1) << scene;
    EXPECT_NEAR(interface_area_of_fractions(data, values, of_values), expected, 1e-10 * expected) << scene;
  }
}

TEST(HeldCells, AreTheConnectedOnes) {
  MultiMaterialData data;
  data.grid = RectilinearGrid::uniform({9, 8, 7}, {0, 0, 0}, {1, 1, 1});
  for (const char* name : {"b", "a", "c"}) data.materials.push_back(name);
  data.fractions.assign(3, std::vector<float>(data.grid.site_count(), 0.0f));
  RandomNumbers random(4);
  for (std::size_t site = 0; site < data.grid.site_count(); ++site) {
    const bool first = random.chance(0.12), second = random.chance(0.15);
    data.fractions[MaterialId(0)][site] = first ? 0.25f : 0;
    data.fractions[MaterialId(1)][site] = second ? 0.25f : 0;
    data.fractions[MaterialId(2)][site] = 1 - (first ? 0.25f : 0) - (second ? 0.25f : 0);
  }
  const SiteValues values = SiteValues::fractions(data);
  const HeldCells held(data, values);
  const GridSites sites(data.grid);
  // Cells that a material fills with no other one near are in no group.
  const auto holds = [&](std::size_t site, MaterialId m) {
    return data.fractions[m][site] > 0 && !values.at(site).empty();
  };
  // A group spreads to all neighbours that hold the material, and has no other members.
  std::vector<std::set<std::size_t>> members(held.group_count());
  for (std::uint32_t group = 0; group < members.size(); ++group) {
    held.for_each_cell(group, [&](std::size_t site, double fraction) {
      EXPECT_EQ(fraction, static_cast<double>(data.fractions[held.material(group)][site]));
      EXPECT_EQ(held.group(site, held.material(group)), group);
      EXPECT_TRUE(members[group].insert(site).second);
      return true;
    });
  }
  std::size_t several = 0, count = 0;
  for (MaterialId m(0); m.value < 3; ++m.value) {
    std::set<std::size_t> left;
    for (std::size_t site = 0; site < data.grid.site_count(); ++site) {
      EXPECT_EQ(held.find(site, m) != nullptr, holds(site, m));
      if (holds(site, m)) {
        left.insert(site);
      } else {
        EXPECT_EQ(held.group(site, m), HeldCells::kNone);
      }
    }
    for (; !left.empty(); ++count) {
      std::vector<std::size_t> reached{*left.begin()};
      left.erase(left.begin());
      for (std::size_t next = 0; next < reached.size(); ++next) {
        sites.for_each_neighbour(reached[next], [&](std::size_t other, int, int, int) {
          if (left.erase(other) > 0) reached.push_back(other);
        });
      }
      several += reached.size() > 2 ? 1 : 0;
      EXPECT_EQ(members[held.group(reached[0], m)], std::set<std::size_t>(reached.begin(), reached.end()));
    }
  }
  EXPECT_EQ(count, held.group_count());
  EXPECT_GT(several, 3u);
}

TEST(FractionGradient, IsExactForLinearFunctions) {
  RectilinearGrid grid;
  for (int axis = 0; axis < 3; ++axis) {
    for (int i = 0; i < 6; ++i) grid.nodes[static_cast<std::size_t>(axis)].push_back(i + 0.1 * i * i * axis);
  }
  std::vector<float> values(grid.site_count());
  const GridSites sites(grid);
  for (std::size_t site = 0; site < values.size(); ++site)
    values[site] = static_cast<float>(dot(Vec3{0.5, -2, 1.25}, sites.position(site)));
  for (std::size_t site = 0; site < values.size(); ++site)
    EXPECT_NEAR(distance(fraction_gradient(sites, site, values), {0.5, -2, 1.25}), 0, 2e-5) << site;
}

TEST(NormalTable, IsThatOfTheLibrary) {
  for (double x = -9; x < 9; x += 0.00137) {
    const NormalValue found = NormalTable::instance().at(x);
    EXPECT_NEAR(found.probability, normal_probability(x), 2e-15) << x;
    EXPECT_NEAR(found.density, normal_density(x), 3e-12 * normal_density(x) + 1e-16) << x;
  }
}

}  // namespace

}  // namespace adamas
