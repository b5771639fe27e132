#include "interfaces/selection/selection.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <random>
#include <set>

#include "core/base/error.h"
#include "interfaces/resampling/nested_errors.h"
#include "interfaces/resampling/resampler.h"
#include "interfaces/selection/saved_hierarchy_file.h"
#include "tests/interfaces/resampler_scenes.h"

namespace adamas {

using namespace datasets;
using namespace interfaces;

namespace {

constexpr std::size_t kSmooth = 2;

/// A hierarchy with fields, and the scene that it was taken from.
struct Saved {
  explicit Saved(const std::string& name, double error = 0.05) : scene(make_case(name, error)) {
    hierarchy = take_hierarchy(*scene.resampler);
  }
  static test::SceneCase make_case(const std::string& name, double error) {
    test::SceneCase c;
    c.name = name;
    c.fields = true;
    c.cells = 7;
    c.options.interface_error = error;
    c.options.field_errors.resize(6);
    c.options.field_errors[kSmooth] = 0.8;
    return c;
  }
  test::ResampledScene scene;
  SavedHierarchy hierarchy;
};

double power(std::mt19937_64& random, double low, double high) {
  return low * std::pow(high / low, std::uniform_real_distribution<double>(0, 1)(random));
}

SelectionTargets random_targets(const SavedHierarchy& hierarchy, std::mt19937_64& random) {
  SelectionTargets targets;
  const unsigned what = 1 + random() % 7;
  if ((what & 1) != 0) targets.interface_error = power(random, 0.01, 1);
  targets.field_errors.resize(hierarchy.tree.fields.size());
  if ((what & 2) != 0) targets.field_errors[random() % targets.field_errors.size()] = power(random, 0.1, 20);
  const std::size_t whole = hierarchy.root_count + hierarchy.split_cells.size();
  if ((what & 4) != 0)
    targets.max_tetrahedra = hierarchy.root_count + random() % (whole - hierarchy.root_count + 100);
  return targets;
}

/// Expects that faces of cells inside the box are shared by two of them, and that the cells fill the box.
void expect_conforming(const ResampledMesh& mesh) {
  std::map<std::array<std::uint32_t, 3>, int> faces;
  double volume = 0;
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    const auto x = mesh.corners(c);
    volume += signed_volume(x[0], x[1], x[2], x[3]);
    for (std::size_t opposite = 0; opposite < 4; ++opposite) {
      std::array<std::uint32_t, 3> face{};
      for (std::size_t i = 0, n = 0; i < 4; ++i) {
        if (i != opposite) face[n++] = mesh.cells[c].vertices[i];
      }
      std::sort(face.begin(), face.end());
      ++faces[face];
    }
  }
  EXPECT_NEAR(volume, mesh.box.volume(), 1e-12 * mesh.box.volume());
  for (const auto& [face, count] : faces) {
    bool on_box = false;
    for (int axis = 0; axis < 3; ++axis) {
      for (const double wall : {mesh.box.min[axis], mesh.box.max[axis]})
        on_box = on_box ||
                 std::all_of(face.begin(), face.end(), [&](auto v) { return mesh.points[v][axis] == wall; });
    }
    ASSERT_EQ(count, on_box ? 1 : 2);
  }
}

void expect_equal(const VertexRecord& a, const VertexRecord& b) {
  EXPECT_EQ(a.distances.body, b.distances.body);
  EXPECT_EQ(a.distances.flagged, b.distances.flagged);
  EXPECT_EQ(a.distances.radius, b.distances.radius);
  EXPECT_EQ(a.distances.bodies, b.distances.bodies);
  ASSERT_EQ(a.distances.near.size(), b.distances.near.size());
  for (std::size_t i = 0; i < a.distances.near.size(); ++i) {
    EXPECT_EQ(a.distances.near[i].interface, b.distances.near[i].interface);
    EXPECT_EQ(a.distances.near[i].distance, b.distances.near[i].distance);
  }
}

TEST(SavedHierarchies, HoldTheWholeMesh) {
  for (const char* name : {"tjunction", "reflex"}) {
    const Saved saved(name);
    saved.hierarchy.validate("saved");
    const ResampledMesh mesh = whole_mesh(saved.hierarchy), expected = resampled_mesh(*saved.scene.resampler);
    EXPECT_EQ(mesh.points, expected.points);
    ASSERT_EQ(mesh.cells.size(), expected.cells.size());
    for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
      EXPECT_EQ(mesh.cells[c].vertices, expected.cells[c].vertices);
      EXPECT_EQ(mesh.cells[c].level, expected.cells[c].level);
      EXPECT_EQ(mesh.cells[c].phase, expected.cells[c].phase);
    }
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
      expect_equal(mesh.vertices[v], expected.vertices[v]);
    for (const auto& [v, body] : needed_rows(expected)) {
      const auto row = mesh.vertices[v].row(body), wanted = expected.vertices[v].row(body);
      if (row.size() != wanted.size() || mesh.vertices[v].distances.body != body) continue;
      for (std::size_t c = 0; c < row.size(); ++c) EXPECT_EQ(row[c], wanted[c]);
    }
  }
}

/// For one random target after another, the selection is conforming, is the smallest with such errors, and
/// does not depend on the selection before it.
TEST(Selections, AreTheSmallestMeshesWithinTheTargets) {
  const Saved saved("tjunction");
  const SavedHierarchy& hierarchy = saved.hierarchy;
  Selection walking(hierarchy);
  std::mt19937_64 random(3);
  std::set<std::size_t> sizes;
  for (int i = 0; i < 90; ++i) {
    const SelectionTargets targets = random_targets(hierarchy, random);
    walking.select(targets);
    Selection fresh(hierarchy);
    fresh.select(targets);
    const auto cells = walking.cells();
    EXPECT_EQ(cells, fresh.cells());
    EXPECT_EQ(cells.size(), walking.size());
    sizes.insert(cells.size());
    if (i % 6 == 0) expect_conforming(walking.mesh());
    if (targets.max_tetrahedra) {
      EXPECT_LE(cells.size(), *targets.max_tetrahedra);
      if (walking.budget_spent()) {
        EXPECT_GE(static_cast<double>(cells.size()) + 8, 0.95 * static_cast<double>(*targets.max_tetrahedra));
      }
    }
    if (walking.budget_spent()) continue;
    // A target wants each diamond that is split, or its split is needed for a neighbour. No target wants
    // splits of the cells that are selected.
    for (std::size_t d = 0; d < hierarchy.diamond_count(); ++d) {
      bool wanted = targets.interface_error && hierarchy.interface_errors[d] > *targets.interface_error;
      bool any = targets.interface_error.has_value();
      for (std::size_t f = 0; f < targets.field_errors.size(); ++f) {
        any = any || targets.field_errors[f];
        wanted =
            wanted || (targets.field_errors[f] && hierarchy.field_errors[f][d] > *targets.field_errors[f]);
      }
      const std::uint32_t member = hierarchy.split_cells[hierarchy.first_cells[d]];
      const bool chosen = std::find(cells.begin(), cells.end(), member) != cells.end();
      if (wanted || !any) {
        EXPECT_FALSE(chosen);
      }
    }
  }
  EXPECT_GT(sizes.size(), 15u);
}

/// Nested errors of fields are never below the errors that were measured in the cells of any selection.
TEST(Selections, NestedErrorsCoverMeasuredOnes) {
  for (const char* name : {"tjunction", "sphere"}) {
    const Saved saved(name);
    const SavedHierarchy& hierarchy = saved.hierarchy;
    Selection selection(hierarchy);
    std::mt19937_64 random(8);
    for (int i = 0; i < 500; ++i) {
      const SelectionTargets targets = random_targets(hierarchy, random);
      selection.select(targets);
      std::vector<double> errors(hierarchy.tree.fields.size(), 0.0);
      for (const std::uint32_t cell : selection.cells()) {
        for (std::size_t f = 0; f < errors.size(); ++f)
          errors[f] = std::max(errors[f], hierarchy.measured[f][cell].reducible);
      }
      for (std::size_t f = 0; f < errors.size(); ++f) EXPECT_GE(selection.field_error(f), errors[f]);
    }
  }
}

TEST(Selections, RefuseTooSmallLimits) {
  const Saved saved("sphere", 0.2);
  Selection selection(saved.hierarchy);
  SelectionTargets targets;
  targets.max_tetrahedra = 3;
  EXPECT_THROW(selection.select(targets), Error);
  targets.max_tetrahedra = saved.hierarchy.root_count;
  selection.select(targets);
  EXPECT_EQ(selection.size(), saved.hierarchy.root_count);
  EXPECT_TRUE(selection.budget_spent());
}

TEST(SavedHierarchies, ComeBackFromArrays) {
  const Saved saved("tjunction");
  const auto arrays = to_arrays(saved.hierarchy);
  const SavedHierarchy again = from_arrays(arrays, "a.h5");
  const auto second = to_arrays(again);
  ASSERT_EQ(arrays.size(), second.size());
  for (std::size_t i = 0; i < arrays.size(); ++i) {
    EXPECT_EQ(arrays[i].name, second[i].name);
    if (arrays[i].name == "known/source" || arrays[i].name.rfind("known/vertex rows") == 0 ||
        arrays[i].name == "built for/field errors" || arrays[i].name == "certified/distances")
      continue;  // NaN differs from itself
    EXPECT_EQ(arrays[i].values, second[i].values) << arrays[i].name;
  }
}

/// Returns the arrays with these names, in which '#' stands for a number.
std::vector<NamedArray> with_names(const std::vector<NamedArray>& arrays,
                                   const std::vector<std::string>& names) {
  std::vector<NamedArray> result;
  for (const NamedArray& array : arrays) {
    std::string name = array.name;
    for (char& c : name) {
      if (c >= '0' && c <= '9') c = '#';
    }
    if (std::ranges::find(names, name) != names.end()) result.push_back(array);
  }
  return result;
}

/// The numbers as bytes, so that NaN is equal to itself.
std::vector<std::uint64_t> bytes_of(const std::vector<double>& values) {
  std::vector<std::uint64_t> result;
  for (const double value : values) result.push_back(std::bit_cast<std::uint64_t>(value));
  return result;
}

TEST(SavedHierarchies, TheirTreesHaveTheWholeMesh) {
  for (const char* name : {"tjunction", "sphere"}) {
    const Saved saved(name);
    const auto all = to_arrays(saved.hierarchy), some = with_names(all, names_of_tree_arrays());
    EXPECT_LT(some.size() + 8, all.size());
    const SavedHierarchy tree = tree_from_arrays(some, "a.h5");
    EXPECT_EQ(tree.diamond_count(), saved.hierarchy.diamond_count());
    EXPECT_EQ(tree.interface_target, saved.hierarchy.interface_target);
    const ResampledMesh mesh = whole_mesh(tree), expected = whole_mesh(from_arrays(all, "a.h5"));
    EXPECT_EQ(mesh.points, expected.points);
    ASSERT_EQ(mesh.cells.size(), expected.cells.size());
    for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
      EXPECT_EQ(mesh.cells[c].vertices, expected.cells[c].vertices);
      EXPECT_EQ(mesh.cells[c].interface_error, expected.cells[c].interface_error);
    }
    ASSERT_EQ(mesh.field_errors.size(), expected.field_errors.size());
    for (std::size_t f = 0; f < mesh.field_errors.size(); ++f)
      EXPECT_EQ(mesh.field_errors[f], expected.field_errors[f]);
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
      ASSERT_EQ(mesh.vertices[v].rows.size(), expected.vertices[v].rows.size());
      for (std::size_t r = 0; r < mesh.vertices[v].rows.size(); ++r) {
        EXPECT_EQ(mesh.vertices[v].rows[r].body, expected.vertices[v].rows[r].body);
        EXPECT_EQ(bytes_of(mesh.vertices[v].rows[r].row), bytes_of(expected.vertices[v].rows[r].row));
      }
    }
    // Cells that are no halves of their parents are refused here as well.
    auto changed = some;
    for (NamedArray& array : changed) {
      if (array.name == "diamonds/vertex") ++std::get<std::vector<std::int32_t>>(array.values).back();
    }
    EXPECT_THROW(static_cast<void>(tree_from_arrays(changed, "bad.h5")), Error);
  }
}

/// Errors, distances and volumes that are NaN, infinite or negative are refused.
TEST(SavedHierarchies, NumbersOutOfRangeAreRefused) {
  const Saved saved("sphere", 0.1);
  const auto arrays = to_arrays(saved.hierarchy);
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const std::set<std::string> any_number{"known/vertex rows", "known/field ranges"},
      none_is_nan{"built for/field errors", "certified/distances"};
  std::size_t looked_at = 0;
  for (std::size_t a = 0; a < arrays.size(); ++a) {
    const auto* numbers = std::get_if<std::vector<double>>(&arrays[a].values);
    if (numbers == nullptr || numbers->empty() || any_number.count(arrays[a].name) > 0) continue;
    SCOPED_TRACE(arrays[a].name);
    for (const double value : {-kInfinity, kInfinity, std::nan("")}) {
      if (none_is_nan.count(arrays[a].name) > 0 && std::isnan(value)) continue;
      auto changed = arrays;
      std::get<std::vector<double>>(changed[a].values)[0] = value;
      EXPECT_THROW(static_cast<void>(from_arrays(changed, "bad.h5")), Error) << value;
      ++looked_at;
    }
  }
  EXPECT_GT(looked_at, 30u);
}

/// Arrays that are missing, cut, or have one number changed either come back as a valid hierarchy or are
/// refused with a message that names the file.
TEST(SavedHierarchies, DamagedArraysAreRefused) {
  const Saved saved("sphere", 0.1);
  const auto arrays = to_arrays(saved.hierarchy);
  std::mt19937_64 random(4);
  std::size_t refused = 0;
  const auto try_arrays = [&](const std::vector<NamedArray>& changed) {
    try {
      static_cast<void>(from_arrays(changed, "bad.h5"));
    } catch (const Error& error) {
      ++refused;
      EXPECT_EQ(std::string(error.what()).rfind("bad.h5: ", 0), 0u) << error.what();
    }
  };
  for (std::size_t a = 0; a < arrays.size(); ++a) {
    SCOPED_TRACE(arrays[a].name);
    auto changed = arrays;
    changed.erase(changed.begin() + static_cast<std::ptrdiff_t>(a));
    try_arrays(changed);
    for (int round = 0; round < 4; ++round) {
      changed = arrays;
      std::visit(
          [&](auto& values) {
            using Value = typename std::decay_t<decltype(values)>::value_type;
            if (values.empty()) return;
            const std::size_t at = random() % values.size();
            if (round == 0) {
              values.resize(at);
            } else if constexpr (std::is_same_v<Value, std::string>) {
              values[at] += "x";
            } else {
              values[at] = static_cast<Value>(round == 1 ? -1.0 : round == 2 ? 1e9 : values[at] + 1.0);
            }
          },
          changed[a].values);
      try_arrays(changed);
    }
  }
  EXPECT_GT(refused, arrays.size());
}

}  // namespace
}  // namespace adamas
