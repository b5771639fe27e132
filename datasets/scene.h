#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "adamas/generate.h"  // scene_names, SceneOptions
#include "adamas/geometry.h"
#include "core/base/typed_id.h"
#include "datasets/scene_function.h"

namespace adamas::datasets {

/// The length of a box's shortest edge, with which scenes scale.
inline double shortest_side(const Box3& box) {
  const Vec3 size = box.size();
  return std::min({size.x, size.y, size.z});
}

/// A part of a material's region: the points where the least of its functions is the greatest over all
/// candidates.
struct SceneCandidate {
  MaterialId owner;
  std::vector<std::uint32_t> functions;  ///< indices in ascending order
};

/// A whole sphere that is a true interface; used if a scene's interfaces are only spheres.
struct SceneSphere {
  Vec3 center;
  double radius = 0;
  MaterialId inside, outside;
};

/// The contents of a scene.
struct SceneDescription {
  std::string name;
  Box3 box;
  IdVector<MaterialId, std::string> materials;
  std::vector<SceneFunction> functions;
  std::vector<SceneCandidate> candidates;
  /// Known volumes; empty if they have to be integrated.
  IdVector<MaterialId, double> volumes;
  /// All interfaces, if they are whole spheres inside the box.
  std::vector<SceneSphere> spheres;

  std::uint32_t add(const SceneFunction& function) {
    functions.push_back(function);
    return static_cast<std::uint32_t>(functions.size() - 1);
  }
};

/// The analytic fields of each material; all have jumps at every interface.
enum class SceneField { kConstant, kLinear, kSmooth };

/// All fields with their names: "constant", "linear", "smooth".
const std::array<std::pair<SceneField, std::string_view>, 3>& scene_fields();

/// A domain divided among materials by an analytic rule: each candidate is the least of its functions, and
/// the owner of a point is the owner of the candidate with the greatest value there (docs/method.md, "Who
/// owns a point of a cell"). Immutable.
class Scene {
 public:
  /// Throws Error if the description has no volume, no candidate or an index out of range.
  explicit Scene(SceneDescription description);

  [[nodiscard]] const std::string& name() const { return data_.name; }
  [[nodiscard]] const Box3& box() const { return data_.box; }
  [[nodiscard]] const IdVector<MaterialId, std::string>& materials() const { return data_.materials; }
  [[nodiscard]] const std::vector<SceneFunction>& functions() const { return data_.functions; }
  [[nodiscard]] const std::vector<SceneCandidate>& candidates() const { return data_.candidates; }
  [[nodiscard]] const std::vector<SceneSphere>& spheres() const { return data_.spheres; }

  /// The owner of a point, which is that of the greatest candidate; exact ties are decided by the smaller
  /// index of the binding function.
  [[nodiscard]] MaterialId owner(const Vec3& p) const;
  /// The greatest value of the material's candidates.
  [[nodiscard]] double value(MaterialId m, const Vec3& p) const;
  /// Whether all functions are linear, so that cutting tetrahedra gives the exact regions.
  [[nodiscard]] bool planar() const { return planar_; }

  /// The volume of the material's region: analytic if the description knows it, else integrated when first
  /// needed.
  [[nodiscard]] double volume(MaterialId m) const;
  /// The estimated absolute error of volume(m); round-off for known volumes.
  [[nodiscard]] double volume_error(MaterialId m) const;

  /// The value of a material's field; the field extends beyond the material's region.
  [[nodiscard]] double field(SceneField field, MaterialId m, const Vec3& p) const;

 private:
  struct Integrated {
    std::once_flag once;
    IdVector<MaterialId, double> volumes, errors;
  };
  const Integrated& integrated() const;

  SceneDescription data_;
  bool planar_ = true;
  std::shared_ptr<Integrated> integrated_;
};

/// A scene by its name. `seed` chooses among scenes of one kind: the seeds of `voronoi10`, everything in
/// `random`; other scenes ignore it. Lengths scale with the shortest side of the box. Throws Error for an
/// unknown name, a box without volume and a time out of range.
Scene make_scene(std::string_view name, std::uint64_t seed = 0, const SceneOptions& options = {});

}  // namespace adamas::datasets
