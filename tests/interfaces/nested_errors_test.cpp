#include "interfaces/resampling/nested_errors.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>

#include "tests/interfaces/resampler_scenes.h"
#include "tests/support/ownership_problems.h"

namespace adamas {

using namespace datasets;
using namespace interfaces;

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

/// Returns the greatest direct error of a tetrahedron and its descendants.
double greatest_below(const HierarchyTopology& hierarchy, const std::vector<double>& direct,
                      TetrahedronId t) {
  double greatest = direct[t.value];
  if (!hierarchy.is_leaf(t)) {
    for (const TetrahedronId child : hierarchy.children(t))
      greatest = std::max(greatest, greatest_below(hierarchy, direct, child));
  }
  return greatest;
}

/// Returns the greatest direct error of a diamond's tetrahedra and of all those of its child diamonds.
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

/// Returns a random cut through the tree: tetrahedra that fill the box without overlap.
std::vector<TetrahedronId> random_selection(const HierarchyTopology& hierarchy, std::mt19937_64& random) {
  std::vector<TetrahedronId> open = hierarchy.roots(), selection;
  const std::uint64_t stop = 2 + random() % 9;
  while (!open.empty()) {
    const TetrahedronId t = open.back();
    open.pop_back();
    if (hierarchy.is_leaf(t) || random() % stop == 0) {
      selection.push_back(t);
    } else {
      for (const TetrahedronId child : hierarchy.children(t)) open.push_back(child);
    }
  }
  return selection;
}

/// The errors of a selection's cell at its native elements. The field is evaluated at elements whose place
/// the cell gives to their own material; for others the least error in all nearby cells of the selection
/// counts.
class SelectionErrors {
 public:
  SelectionErrors(const Resampler& resampler, const std::vector<TetrahedronId>& selection)
      : resampler_(resampler) {
    for (const TetrahedronId t : selection) {
      cells_.push_back(make_tree_cell(resampler, t));
      boxes_.emplace_back();
      for (const Vec3& corner : cells_.back()->view.frame.corners) boxes_.back().extend(corner);
    }
  }

  [[nodiscard]] double greatest(std::size_t i, TetrahedronId t, std::size_t field,
                                std::size_t& displaced) const {
    const ResamplingSource& source = resampler_.source();
    const CellView& view = cells_[i]->view;
    const std::size_t at = source.fields->fields()[field].offset;
    std::vector<double> native(source.fields->row_size());
    double greatest = 0;
    for (const std::uint32_t e : resampler_.elements(t)) {
      const NativeElement& element = source.fields->native_elements()[e];
      source.fields->native_values(element, native);
      if (std::isnan(native[at]) || !source.fields->interpolates(element, field)) continue;
      const Weights w = view.frame.weights(element.position);
      const auto& problem = view.owners.problem;
      const BodyId body(view.owners.pure() ? problem.candidates[0].owner
                                           : test::brute_owner(problem, w, 0).owner);
      double error = 0;
      if (source.network->table().material(body) == element.material) {
        for (std::size_t v = 0; v < 4; ++v) error += w[v] * view.vertices[v]->row(body)[at];
        error = std::abs(error - native[at]);
      } else if (element.kind != ElementKind::kMinority) {
        // An element has an error in the cell only where the cell itself has some of its material nearby.
        if (!has_part_near(view, e, field)) continue;
        error = displaced_error(view, e, field);
        ++displaced;
      }
      greatest = std::max(greatest, error);
    }
    return greatest;
  }

 private:
  [[nodiscard]] bool has_part_near(const CellView& view, std::uint32_t element, std::size_t field) const {
    const MaterialId wanted = resampler_.source().fields->native_elements()[element].material;
    const InterfaceTable& table = resampler_.source().network->table();
    if (std::none_of(view.parts.begin(), view.parts.end(), [&](const OwnedTetrahedron& part) {
          return table.material(BodyId(part.owner)) == wanted;
        }))
      return false;
    std::vector<FieldError> errors(resampler_.source().fields->fields().size());
    measure_displaced_errors(
        resampler_.source(), view, std::array{element}, resampler_.displacement(),
        [&](const Box3&, MaterialId, const auto& visit) { visit(view); },
        std::vector<double>(errors.size(), 0.0), errors, NoPartNear::kHasNoValue);
    return errors[field].count() > 0;
  }

  [[nodiscard]] double displaced_error(const CellView& view, std::uint32_t element, std::size_t field) const {
    const ResamplingSource& source = resampler_.source();
    std::vector<FieldError> errors(source.fields->fields().size());
    const std::vector<double> limits(errors.size(), 0.0);
    measure_displaced_errors(
        source, view, std::array{element}, resampler_.displacement(),
        [&](const Box3& box, MaterialId, const auto& visit) {
          for (std::size_t i = 0; i < cells_.size(); ++i) {
            if (boxes_[i].touches(box)) visit(cells_[i]->view);
          }
        },
        limits, errors);
    return errors[field].max;
  }

  const Resampler& resampler_;
  std::vector<std::unique_ptr<TreeCell>> cells_;
  std::vector<Box3> boxes_;
};

TEST(NestedErrors, CoverWhatAnySelectionHasAtItsElements) {
  std::size_t selected = 0, unmeasured = 0, displaced = 0, positive = 0;
  for (const char* name : {"sphere", "tjunction"}) {
    SCOPED_TRACE(name);
    test::SceneCase c;
    c.name = name;
    c.fields = true;
    c.cells = 7;
    c.options.interface_error = 0.08;
    c.options.certify = false;
    c.options.field_errors.resize(6);
    constexpr std::size_t kSmooth = 2;
    c.options.field_errors[kSmooth] = 0.8;
    const test::ResampledScene resampled(c);
    const auto& hierarchy = resampled.resampler->hierarchy();
    const NestedErrors nested = nest_field_errors(*resampled.resampler, kSmooth);
    expect_monotone(hierarchy, nested);
    std::mt19937_64 random(5);
    for (int i = 0; i < 100; ++i) {
      const auto selection = random_selection(hierarchy, random);
      const SelectionErrors errors(*resampled.resampler, selection);
      // All cells of a selection would take long, so every fourth one is tried, from another beginning each
      // time.
      for (std::size_t s = random() % 4; s < selection.size(); s += 4) {
        const TetrahedronId t = selection[s];
        const double error = errors.greatest(s, t, kSmooth, displaced);
        ASSERT_GE(nested[t], error * (1 - 1e-12) - 1e-12);
        ++selected;
        positive += error > 1e-6 ? 1 : 0;
        unmeasured += hierarchy.payload(t).fields.empty() && error > 1e-6 ? 1 : 0;
      }
    }
    // For the selection of all leaves every cell is tried.
    std::vector<TetrahedronId> leaves;
    hierarchy.for_each_leaf([&](TetrahedronId t) { leaves.push_back(t); });
    const SelectionErrors errors(*resampled.resampler, leaves);
    for (std::size_t s = 0; s < leaves.size(); ++s)
      ASSERT_GE(nested[leaves[s]], errors.greatest(s, leaves[s], kSmooth, displaced) * (1 - 1e-12) - 1e-12);
  }
  EXPECT_GT(selected, 2000u);
  EXPECT_GT(positive, 1000u);
  EXPECT_GT(unmeasured, 100u);
  EXPECT_GT(displaced, 100u);
}

/// If there are two bodies, the distance is that from the zero set of one linear function. It is checked at
/// random points of the input's triangles, in every tetrahedron of the tree that knows the interface at all
/// its vertices.
TEST(NestedErrors, OfInterfacesCoverTheDistancesOfTheirPoints) {
  test::SceneCase c;
  c.name = "sphere";
  c.cells = 12;
  c.options.interface_error = 0.03;
  c.options.certify = false;
  const test::ResampledScene resampled(c);
  const auto& hierarchy = resampled.resampler->hierarchy();
  const InterfaceNetwork& network = *resampled.source.network;
  const std::vector<double> direct = interface_errors_of_tree(*resampled.resampler);
  const NestedErrors nested = nest_errors(hierarchy, [&](TetrahedronId t) { return direct[t.value]; });
  expect_monotone(hierarchy, nested);
  std::mt19937_64 random(6);
  std::uniform_real_distribution<double> part(0, 1);
  std::size_t points = 0, never_looked_at = 0;
  for (int i = 0; i < 20000; ++i) {
    const auto triangle = static_cast<std::uint32_t>(random() % network.triangles().size());
    double a = part(random), b = part(random);
    if (a + b > 1) a = 1 - a, b = 1 - b;
    const auto& corners = network.triangle_corners(triangle);
    const Vec3 p = corners[0] + a * (corners[1] - corners[0]) + b * (corners[2] - corners[0]);
    // A descent begins at the root that holds the point.
    for (const TetrahedronId root : hierarchy.roots()) {
      TetrahedronId t = root;
      while (true) {
        const auto v = hierarchy.vertices(t);
        const Tetrahedron cell({hierarchy.position(v[0]), hierarchy.position(v[1]), hierarchy.position(v[2]),
                                hierarchy.position(v[3])});
        const Weights w = cell.weights(p);
        if (std::min({w[0], w[1], w[2], w[3]}) < 0) break;
        std::array<double, 4> phi{};
        bool known = true;
        for (std::size_t k = 0; k < 4; ++k) {
          const auto& near = hierarchy.payload(v[k]).distances.near;
          known = known && near.size() == 1;
          if (known) phi[k] = near[0].distance;
        }
        if (known) {
          double value = 0;
          for (std::size_t k = 0; k < 4; ++k) value += w[k] * phi[k];
          const double distance = std::min(std::abs(value) / norm(cell.gradient(phi)), cell.diameter());
          ASSERT_GE(nested[t], distance * (1 - 1e-9) - 1e-12);
          ++points;
          const InterfaceError& looked_at = hierarchy.payload(t).interface;
          never_looked_at += distance > 1e-6 && looked_at.distance == 0 && !looked_at.lost ? 1 : 0;
        }
        if (hierarchy.is_leaf(t)) break;
        t = hierarchy.children(t)[w[0] >= w[1] ? 0 : 1];
      }
    }
  }
  EXPECT_GT(points, 20000u);
  EXPECT_GT(never_looked_at, 5u);
}

TEST(NestedErrors, CorrectionsAreNeverTighterAndVanishForLinearFields) {
  test::SceneCase c;
  c.name = "tjunction";
  c.fields = true;
  c.options.interface_error = 0.03;
  c.options.certify = false;
  c.options.ghost = GhostMode::kLinear;
  test::ResampledScene resampled(c);
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
    // The sum is not exactly 0, since values are stated as floats.
    if (linear) {
      EXPECT_LT(sum, 1e-3);
    } else {
      EXPECT_GT(sum, 1);
    }
  }
}

}  // namespace
}  // namespace adamas
