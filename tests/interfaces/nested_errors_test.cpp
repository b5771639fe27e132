#include "interfaces/errors/nested_errors.h"

#include <random>

#include "tests/interfaces/resampler_scenes.h"

namespace adamas {
namespace {

/// Calls fn(t) for all tetrahedra of the tree.
template <class Fn>
void for_each_tetrahedron(const HierarchyTopology& hierarchy, Fn&& fn) {
  std::vector<TetrahedronId> stack = hierarchy.roots();
  while (!stack.empty()) {
    const TetrahedronId t = stack.back();
    stack.pop_back();
    fn(t);
    if (hierarchy.is_leaf(t)) continue;
    for (const TetrahedronId child : hierarchy.children(t)) stack.push_back(child);
  }
}

/// Greatest direct error of a tetrahedron and its descendants, by walking down.
double greatest_below(const HierarchyTopology& hierarchy, const std::vector<double>& direct,
                      TetrahedronId t) {
  double greatest = direct[t.value];
  if (!hierarchy.is_leaf(t)) {
    for (const TetrahedronId child : hierarchy.children(t))
      greatest = std::max(greatest, greatest_below(hierarchy, direct, child));
  }
  return greatest;
}

/// The same for a diamond, through all tetrahedra of its child diamonds.
double greatest_below(const HierarchyTopology& hierarchy, const std::vector<double>& direct, DiamondId d) {
  double greatest = 0;
  for (const TetrahedronId t : hierarchy.tetrahedra(d)) {
    greatest = std::max(greatest, direct[t.value]);
    if (hierarchy.is_leaf(t)) continue;
    for (const TetrahedronId child : hierarchy.children(t))
      greatest = std::max(greatest, greatest_below(hierarchy, direct, hierarchy.diamond(child)));
  }
  return greatest;
}

void expect_monotone(const HierarchyTopology& hierarchy, const NestedErrors& nested) {
  for_each_tetrahedron(hierarchy, [&](TetrahedronId t) {
    ASSERT_GE(nested[hierarchy.diamond(t)], nested[t]);
    if (hierarchy.is_leaf(t)) return;
    for (const TetrahedronId child : hierarchy.children(t)) {
      ASSERT_GE(nested[t], nested[child]);
      ASSERT_GE(nested[hierarchy.diamond(t)], nested[hierarchy.diamond(child)]);
    }
  });
}

TEST(NestedErrors, AreTheLeastThatCoverAllBelow) {
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    std::mt19937_64 random(seed);
    Hierarchy<> hierarchy(Domain({{0, 0, 0}, {1, 2, 1}}, {1, 2, 1}));
    std::vector<Split> splits;
    for (int i = 0; i < 40; ++i) {
      std::vector<TetrahedronId> leaves;
      hierarchy.for_each_leaf([&](TetrahedronId t) { leaves.push_back(t); });
      const TetrahedronId t = leaves[random() % leaves.size()];
      if (hierarchy.level(t) < 2) hierarchy.split(t, splits);
    }
    std::vector<double> direct(hierarchy.tetrahedron_slots());
    for (double& error : direct) error = static_cast<double>(random() % 1000);
    const NestedErrors nested = nest_errors(hierarchy, [&](TetrahedronId t) { return direct[t.value]; });
    expect_monotone(hierarchy, nested);
    for_each_tetrahedron(hierarchy, [&](TetrahedronId t) {
      ASSERT_EQ(nested[t], greatest_below(hierarchy, direct, t));
      const DiamondId d = hierarchy.diamond(t);
      ASSERT_EQ(nested[d], greatest_below(hierarchy, direct, d));
    });
  }
}

TEST(NestedErrors, CoverWhatAResamplerMeasured) {
  test::SceneCase c;
  c.name = "sphere";
  c.fields = true;
  c.options.interface_error = 0.05;
  c.options.certify = false;
  const test::ResampledScene resampled(c);
  const auto& hierarchy = resampled.resampler->hierarchy();
  const NestedErrors interfaces = nest_interface_errors(*resampled.resampler);
  const NestedErrors field = nest_field_errors(*resampled.resampler, 1);
  expect_monotone(hierarchy, interfaces);
  expect_monotone(hierarchy, field);
  double measured = 0;
  for_each_tetrahedron(hierarchy, [&](TetrahedronId t) {
    ASSERT_GE(interfaces[t], hierarchy.payload(t).interface.distance);
    if (!hierarchy.is_leaf(t)) return;
    ASSERT_EQ(interfaces[t], hierarchy.payload(t).interface.distance);
    ASSERT_EQ(field[t], hierarchy.payload(t).fields[1].max);
    measured = std::max(measured, hierarchy.payload(t).fields[1].max);
  });
  ASSERT_GT(measured, 0);
  double most = 0;
  for (const TetrahedronId root : hierarchy.roots()) most = std::max(most, field[root]);
  EXPECT_GE(most, measured);
}

TEST(NestedErrors, CorrectionsAreNeverTighterAndVanishForLinearFields) {
  test::SceneCase c;
  c.name = "tjunction";
  c.fields = true;
  c.options.interface_error = 0.03;
  c.options.certify = false;
  c.options.ghost = GhostMode::kLinear;
  test::ResampledScene resampled(c);
  resampled.resampler->complete_fields();
  const auto& hierarchy = resampled.resampler->hierarchy();
  const auto& fields = resampled.source.fields->fields();
  for (std::size_t f = 0; f < fields.size(); ++f) {
    const bool smooth = fields[f].name == "smooth", linear = fields[f].name == "linear";
    if (!smooth && !linear) continue;
    const CorrectedErrors corrected = correct_field_errors(*resampled.resampler, f);
    double sum = 0;
    for_each_tetrahedron(hierarchy, [&](TetrahedronId t) {
      double below = hierarchy.is_leaf(t) ? hierarchy.payload(t).fields[f].max : 0;
      if (!hierarchy.is_leaf(t)) {
        for (const TetrahedronId child : hierarchy.children(t))
          below = std::max(below, corrected.of_tetrahedra[child.value]);
      }
      ASSERT_GE(corrected.of_tetrahedra[t.value], below);
      sum += corrected.of_tetrahedra[t.value] - below;
    });
    EXPECT_LT(corrected.undefined, hierarchy.leaf_count());
    // Values are stated as float.
    if (linear) {
      EXPECT_LT(sum, 1e-3);
    } else {
      EXPECT_GT(sum, 1);
    }
  }
}

}  // namespace
}  // namespace adamas
