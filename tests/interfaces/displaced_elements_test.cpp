#include <cmath>
#include <limits>
#include <vector>

#include "interfaces/comparison/element_errors.h"
#include "interfaces/mesh/resampled_mesh.h"
#include "interfaces/resampling/resampler.h"
#include "tests/interfaces/mesh_cells.h"
#include "tests/interfaces/resampler_scenes.h"

namespace adamas {

using namespace interfaces;

namespace {

/// The number of samples of a box along each axis.
constexpr int kSamples = 5;
/// All corners of a cell's regions are tried where it has no more planes than this.
constexpr std::size_t kMostPlanes = 40;

/// A plane through a cell, given as the zero of a linear function.
struct Cut {
  Vec3 normal;
  double offset;
};

struct Least {
  double error = std::numeric_limits<double>::infinity();
  bool exact = true;  ///< all corners were tried
};

/// Finds the least difference from a value over the part of a box that a material has in a mesh, from the
/// definition alone. It tries lattice points of the box, the corners of the regions, which are where three
/// planes meet, and the points where the difference is zero between any two of these. The least difference of
/// a linear function on a convex part is at a corner, or it is zero between two corners.
class BruteForce {
 public:
  BruteForce(const ResampledMesh& mesh, std::size_t component)
      : mesh_(mesh), component_(component), cells_(mesh) {}

  /// Returns whether the mesh gives a point to the material.
  [[nodiscard]] bool owns(MaterialId material, const Vec3& p) const {
    const std::size_t cell = cells_.find(p);
    return mesh_.table.material(cells_.owner(cell, cells_.frames[cell].weights(p))) == material;
  }

  [[nodiscard]] Least least(MaterialId material, const Box3& box, double native) const {
    Least result;
    for (std::size_t c = 0; c < cells_.frames.size(); ++c) {
      Box3 bounds;
      for (const Vec3& corner : cells_.frames[c].corners) bounds.extend(corner);
      if (!bounds.touches(box)) continue;
      for (const auto& candidate : cells_.owners[c].problem.candidates) {
        if (mesh_.table.material(BodyId(candidate.owner)) != material) continue;
        look_at(c, candidate, box, native, result);
      }
    }
    return result;
  }

 private:
  using Candidate = OwnershipProblem::Candidate;

  /// Returns whether a body of the cell owns a point, alone or together with others.
  [[nodiscard]] bool owns(std::size_t cell, const Candidate& candidate, const Weights& w) const {
    const auto& problem = cells_.owners[cell].problem;
    if (cells_.owners[cell].pure()) return true;
    const double own = problem.value(candidate, w);
    return std::all_of(problem.candidates.begin(), problem.candidates.end(),
                       [&](const Candidate& other) { return problem.value(other, w) <= own + 1e-12; });
  }

  void look_at(std::size_t cell, const Candidate& candidate, const Box3& box, double native,
               Least& least) const {
    std::vector<std::pair<Vec3, double>> below, above;
    const auto try_point = [&](const Vec3& p) {
      const Weights w = cells_.frames[cell].weights(p);
      if (std::min({w[0], w[1], w[2], w[3]}) < -1e-12 || !owns(cell, candidate, w)) return;
      const double difference = mesh_.value(cell, BodyId(candidate.owner), component_, w) - native;
      least.error = std::min(least.error, std::abs(difference));
      (difference < 0 ? below : above).emplace_back(p, difference);
    };
    const Vec3 step = (1.0 / kSamples) * box.size();
    for (int i = 0; i <= kSamples; ++i) {
      for (int j = 0; j <= kSamples; ++j) {
        for (int k = 0; k <= kSamples; ++k) try_point(box.min + Vec3{i * step.x, j * step.y, k * step.z});
      }
    }
    const std::vector<Cut> cuts = planes(cell, box);
    if (cuts.size() > kMostPlanes) least.exact = false;
    if (cuts.size() <= kMostPlanes) at_corners(cuts, box, try_point);
    for (const auto& [p, low] : std::vector(below)) {
      for (const auto& [q, high] : std::vector(above)) {
        if (least.error < 1e-12) return;
        try_point(p + low / (low - high) * (q - p));
      }
    }
  }

  /// Returns the planes of the cell's faces, of the box, and of points where two functions are equal; not all
  /// of the latter where there are too many.
  [[nodiscard]] std::vector<Cut> planes(std::size_t cell, const Box3& box) const {
    std::vector<Cut> cuts;
    const Tetrahedron& frame = cells_.frames[cell];
    const auto add = [&](const std::array<double, 4>& values) {
      const Vec3 gradient = frame.gradient(values);
      if (!(norm(gradient) > 0)) return;
      const Vec3 normal = (1 / norm(gradient)) * gradient;
      const Cut cut{normal, dot(normal, frame.corners[0]) - values[0] / norm(gradient)};
      const bool known = std::any_of(cuts.begin(), cuts.end(), [&](const Cut& other) {
        const double side = dot(other.normal, normal) < 0 ? -1 : 1;
        return norm(other.normal - side * normal) < 1e-9 &&
               std::abs(other.offset - side * cut.offset) < 1e-12;
      });
      if (!known) cuts.push_back(cut);
    };
    for (std::size_t v = 0; v < 4; ++v) {
      std::array<double, 4> values{};
      values[v] = 1;
      add(values);
    }
    const auto& functions = cells_.owners[cell].problem.functions;
    for (std::size_t f = 0; f < functions.size(); ++f) {
      for (std::size_t g = 0; g < f && cuts.size() <= kMostPlanes; ++g) {
        std::array<double, 4> values{};
        for (std::size_t v = 0; v < 4; ++v) values[v] = functions[f].values[v] - functions[g].values[v];
        add(values);
      }
    }
    for (int axis = 0; axis < 3; ++axis) {
      for (const Vec3& end : {box.min, box.max}) {
        Vec3 normal;
        normal[axis] = 1;
        cuts.push_back({normal, end[axis]});
      }
    }
    return cuts;
  }

  /// Tries all points in the box where three planes meet.
  template <class Try>
  static void at_corners(const std::vector<Cut>& cuts, const Box3& box, const Try& try_point) {
    const double margin = 1e-12 * box.diagonal();
    for (std::size_t a = 0; a < cuts.size(); ++a) {
      for (std::size_t b = 0; b < a; ++b) {
        const Vec3 along = cross(cuts[a].normal, cuts[b].normal);
        for (std::size_t c = 0; c < b; ++c) {
          const double det = dot(along, cuts[c].normal);
          if (std::abs(det) < 1e-9) continue;
          const Vec3 p =
              (1 / det) * (cuts[c].offset * along + cuts[a].offset * cross(cuts[b].normal, cuts[c].normal) +
                           cuts[b].offset * cross(cuts[c].normal, cuts[a].normal));
          bool inside = true;
          for (int axis = 0; axis < 3; ++axis)
            inside = inside && p[axis] >= box.min[axis] - margin && p[axis] <= box.max[axis] + margin;
          if (inside) try_point(p);
        }
      }
    }
  }

  const ResampledMesh& mesh_;
  std::size_t component_;
  const test::MeshCells cells_;
};

struct Seen {
  std::size_t displaced = 0, minorities = 0, zero = 0, positive = 0, nowhere = 0;
};

void expect_least(const test::SceneCase& c, std::size_t most, Seen& seen) {
  SCOPED_TRACE(c.name + " " + std::to_string(c.seed));
  test::ResampledScene resampled(c);
  const ResampledMesh mesh = resampled_mesh(*resampled.resampler);
  const FieldSource& fields = *resampled.source.fields;
  const double half_width =
      std::max(c.options.interface_error, resampled.resampler->certificate()->materials.upper);
  const ElementErrors reported = measure_element_errors(resampled.source, measured_cells(mesh), half_width);
  constexpr std::size_t kSmooth = 2;
  const FieldInfo& info = fields.fields()[kSmooth];
  const BruteForce brute(mesh, info.offset);
  std::vector<double> native(fields.row_size());
  std::size_t tried = 0;
  for (std::size_t e = 0; e < fields.native_elements().size() && tried < most; ++e) {
    const NativeElement& element = fields.native_elements()[e];
    fields.native_values(element, native);
    if (std::isnan(native[info.offset]) || brute.owns(element.material, element.position)) continue;
    ++tried;
    const FieldError& error = reported.errors[e * reported.fields + kSmooth];
    const Vec3 reach{half_width, half_width, half_width};
    const Least least = brute.least(element.material, {element.position - reach, element.position + reach},
                                    native[info.offset]);
    ++seen.displaced;
    if (element.kind == ElementKind::kMinority) ++seen.minorities;
    if (std::isinf(least.error)) {
      ++seen.nowhere;
      if (element.kind == ElementKind::kMinority) {
        // The material may have a part that touches the box between samples.
        EXPECT_LE(error.count() + error.without_value, 1u);
      } else {
        EXPECT_LE(error.max, std::max(std::abs(native[info.offset]), info.max - info.min));
      }
      continue;
    }
    ASSERT_EQ(error.count(), 1u);
    EXPECT_EQ(error.displaced, 1u);
    EXPECT_GE(least.error, error.max - 1e-9 * info.max) << "element " << e;
    if (!least.exact) continue;
    EXPECT_NEAR(least.error, error.max, 1e-7 * info.max) << "element " << e;
    ++(error.max > 0 ? seen.positive : seen.zero);
  }
}

/// The errors are those of the definition. The test does without the program's partition of cells, its
/// clipping and its search.
TEST(DisplacedElements, HaveTheLeastErrorOfTheirMaterialsPartOfTheBox) {
  Seen seen;
  test::SceneCase c;
  c.fields = true;
  c.cells = 6;
  c.name = "random";
  for (c.seed = 1; c.seed <= 2; ++c.seed) {
    c.options.interface_error = c.seed % 2 == 0 ? 0.1 : 0.06;
    expect_least(c, 8, seen);
  }
  c.name = "voronoi10";
  c.options.interface_error = 0.06;
  expect_least(c, 8, seen);
  c.name = "sphere";
  c.options.interface_error = 0.15;
  expect_least(c, 12, seen);
  EXPECT_GT(seen.displaced, 25u);
  EXPECT_GT(seen.minorities, 2u);
  EXPECT_GT(seen.zero, 1u);
  EXPECT_GT(seen.positive, 3u);
  EXPECT_LT(seen.nowhere, seen.displaced / 2);
}

}  // namespace
}  // namespace adamas
