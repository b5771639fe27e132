#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "core/base/parallel.h"
#include "core/geometry/plane.h"
#include "core/geometry/tetrahedron.h"
#include "datasets/scene.h"
#include "datasets/scene_interfaces.h"
#include "datasets/scene_sampling.h"
#include "interfaces/input/grid_source.h"
#include "interfaces/mesh/resampled_mesh.h"
#include "interfaces/resampling/resampler.h"

namespace adamas::test {

using namespace datasets;
using namespace interfaces;

/// The exact fields of a scene: "linear", "smooth", a vector "flow" that is linear too, and "first", which
/// only material 0 has. Values are stated at the sites of a grid.
class SceneFields final : public FieldSource {
 public:
  SceneFields(const Scene& scene, const RectilinearGrid& grid) : scene_(scene) {
    fields_ = {{"linear", "", 1, 0, 0, 0},
               {"smooth", "", 1, 1, 0, 0},
               {"flow", "", 3, 2, 0, 0},
               {"first", "", 1, 5, 0, 0}};
    for (std::size_t k = 0; k < grid.sites(2); ++k) {
      for (std::size_t j = 0; j < grid.sites(1); ++j) {
        for (std::size_t i = 0; i < grid.sites(0); ++i)
          elements_.push_back(
              {grid.site(i, j, k), scene.owner(grid.site(i, j, k)), ElementKind::kPure, elements_.size()});
      }
    }
  }
  [[nodiscard]] const std::vector<FieldInfo>& fields() const override { return fields_; }
  [[nodiscard]] std::size_t row_size() const override { return 6; }
  void values(MaterialId m, const Vec3& p, std::span<double> row) const override {
    const double linear = scene_.field(SceneField::kLinear, m, p);
    row[0] = linear;
    row[1] = scene_.field(SceneField::kSmooth, m, p);
    for (std::size_t c = 0; c < 3; ++c) row[2 + c] = factor(c) * linear;
    row[5] = m == MaterialId(0) ? linear : std::numeric_limits<double>::quiet_NaN();
  }
  void values_and_gradients(MaterialId m, const Vec3& p, std::span<double> row,
                            std::span<Vec3> gradients) const override {
    values(m, p, row);
    gradients[0] = gradients[5] = gradient(SceneField::kLinear, m, p);
    gradients[1] = gradient(SceneField::kSmooth, m, p);
    for (std::size_t c = 0; c < 3; ++c) gradients[2 + c] = factor(c) * gradients[0];
  }
  void fitted_values(MaterialId m, const Vec3& p, const Vec3&, std::span<double> row) const override {
    values(m, p, row);
  }
  [[nodiscard]] const std::vector<NativeElement>& native_elements() const override { return elements_; }
  void native_values(const NativeElement& element, std::span<double> row) const override {
    values(element.material, element.position, row);
  }
  [[nodiscard]] bool interpolates(const NativeElement&, std::size_t) const override { return true; }
  /// Returns component c of "flow" as a multiple of "linear"; the squares of the factors add up to 9.
  static double factor(std::size_t c) { return std::array<double, 3>{2, -2, 1}[c]; }

 private:
  /// Returns the gradient of a field by differences of the fourth order, which are exact for linear fields.
  [[nodiscard]] Vec3 gradient(SceneField field, MaterialId m, const Vec3& p) const {
    const double h = 0.01;
    Vec3 result;
    for (int axis = 0; axis < 3; ++axis) {
      const auto difference = [&](double step) {
        Vec3 aside;
        aside[axis] = step;
        return (scene_.field(field, m, p + aside) - scene_.field(field, m, p - aside)) / (2 * step);
      };
      result[axis] = (4 * difference(h) - difference(2 * h)) / 3;
    }
    return result;
  }

  const Scene& scene_;
  std::vector<FieldInfo> fields_;
  std::vector<NativeElement> elements_;
};

/// A scene, its sampling, and a mesh that approximates it.
struct SceneMesh {
  std::unique_ptr<Scene> owned;
  const Scene& scene;
  std::unique_ptr<MultiMaterialData> data;
  InterfaceMesh interfaces;
  ResamplingSource source;
  ResampledMesh mesh;
  double distance = 0;  ///< certified distance between the source's interfaces and the mesh's
};

struct SceneMeshOptions {
  std::size_t cells = 8;  ///< number of cells of the sampling along each axis
  double error = 0.05;
  std::size_t most = 2500;  ///< limit on tetrahedra
  GhostMode ghost = GhostMode::kLinear;
  bool given = true;  ///< interfaces are given as meshes, not reconstructed
};

inline SceneMesh make_scene_mesh(std::string_view name, const SceneMeshOptions& options = {}) {
  auto owned = std::make_unique<Scene>(make_scene(name, 3));
  const Scene& scene = *owned;
  SceneMesh result{std::move(owned), scene, nullptr, {}, {}, {}};
  result.data = std::make_unique<MultiMaterialData>(
      sample_scene(result.scene, {options.cells, options.cells, options.cells}));
  if (options.given) {
    result.interfaces = scene_interfaces(result.scene, 0.5 / static_cast<double>(options.cells));
    result.source = make_mesh_source(result.interfaces, result.scene.box(), result.data.get());
  } else {
    result.source = make_grid_source(*result.data);
  }
  result.source.fields = std::make_shared<SceneFields>(scene, result.data->grid);
  ResamplingOptions resampling;
  resampling.interface_error = options.error;
  resampling.max_tetrahedra = options.most;
  resampling.ghost = options.ghost;
  resampling.field_errors.resize(result.source.fields->fields().size());
  Resampler resampler(result.source, resampling);
  resampler.refine();
  if (resampler.certificate()) result.distance = resampler.certificate()->networks.upper;
  result.mesh = resampled_mesh(resampler);
  return result;
}

/// Returns whether the numbers are equal or both are NaN.
inline bool same(double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }

/// The cell that holds a point, found by a search of all cells. Where round-off leaves the point in no cell,
/// its weights are the least wrong ones.
struct FoundCell {
  std::size_t cell = 0;
  Weights weights{};
};

inline FoundCell find_cell(const ResampledMesh& mesh, const Vec3& p) {
  FoundCell found;
  double greatest = -1e300;
  for (std::size_t i = 0; i < mesh.cells.size(); ++i) {
    const auto x = mesh.corners(i);
    const double volume = signed_volume(x[0], x[1], x[2], x[3]);
    Weights w{};
    for (std::size_t v = 0; v < 4; ++v) {
      auto with = x;
      with[v] = p;
      w[v] = signed_volume(with[0], with[1], with[2], with[3]) / volume;
    }
    const double least = *std::min_element(w.begin(), w.end());
    if (least > greatest) greatest = least, found = {i, w};
  }
  return found;
}

/// Returns the owner of a point of a cell.
inline BodyId owner_in(const ResampledMesh& mesh, const FoundCell& at) {
  CellOwnership ownership;
  mesh.ownership(at.cell, ownership);
  return BodyId(ownership.pure() ? ownership.problem.candidates[0].owner
                                 : ownership.problem.owner(at.weights));
}

/// Returns planes at critical places, and `count` random ones through the box [0, 1]^3.
inline std::vector<Plane> trying_planes(std::size_t count, std::uint64_t seed = 1) {
  std::vector<Plane> planes;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double x : {0.0, 1.0, 0.5, 0.25, 0.8125, 1.0 / 3, 1e-15, 0.5 + 1e-16}) {
      Plane plane;
      plane.origin[axis] = x;
      plane.normal[axis] = axis == 1 ? -2.5 : 1;
      planes.push_back(plane);
    }
  }
  const Vec3 center{0.5, 0.5, 0.5};
  for (const Vec3& n : {Vec3{1, -1, 0}, Vec3{1, 1, 0}, Vec3{0, 1, -1}, Vec3{1, 0, 1}, Vec3{1, 1, 1},
                        Vec3{1, 1, -2}, Vec3{-1, 2, 1}, Vec3{1, 1e-16, 0}}) {
    planes.push_back({center, n});
    planes.push_back({{0.5, 0.25, 0.125}, n});
  }
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  std::normal_distribution<double> normal;
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3 origin{unit(random), unit(random), unit(random)};
    planes.push_back({origin, {normal(random), normal(random), normal(random)}});
  }
  return planes;
}

}  // namespace adamas::test
