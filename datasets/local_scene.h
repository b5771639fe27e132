#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/geometry/ownership_problem.h"
#include "datasets/scene.h"

namespace adamas::datasets {

/// The candidates and functions of a scene that can matter inside a box. By the functions' exact ranges,
/// functions that never bind and candidates that never win are dropped; the rest gives the same owner at
/// every point of the box, also if functions are replaced by linear interpolation between points of the box.
class LocalScene {
 public:
  /// Takes the whole scene.
  explicit LocalScene(const Scene& scene);
  /// Takes the part of `parent` that matters in a box inside the parent's.
  void restrict_to(const LocalScene& parent, const Box3& box);

  /// The owner of the whole box, if one is certain.
  [[nodiscard]] std::optional<MaterialId> sole_owner() const;
  /// Whether all functions are linear in space, so that a partition of a tetrahedron is exact.
  [[nodiscard]] bool linear() const { return linear_; }
  [[nodiscard]] std::span<const SceneCandidate> candidates() const { return {pool_.data(), count_}; }
  /// The indices of the functions in use, ascending.
  [[nodiscard]] const std::vector<std::uint32_t>& functions() const { return functions_; }
  [[nodiscard]] const Scene& scene() const { return *scene_; }

 private:
  [[nodiscard]] std::span<SceneCandidate> in_use() { return {pool_.data(), count_}; }
  void drop_functions_that_never_bind();
  void drop_dominated_candidates();
  void collect_functions();

  const Scene* scene_;
  std::vector<SceneCandidate> pool_;  // the first count_ are in use; the others keep their memory
  std::size_t count_ = 0;
  std::vector<std::uint32_t> functions_;
  std::vector<FunctionRange> ranges_;  // per function; valid for functions in use
  bool linear_ = true;
};

/// The six tetrahedra round a cube's main diagonal by corner number (bit 0: x, bit 1: y, bit 2: z),
/// positively oriented; cubes that share a face divide it alike.
inline constexpr std::array<std::array<std::uint8_t, 4>, 6> kCubeTetrahedra{
    {{0, 1, 3, 7}, {0, 3, 2, 7}, {0, 2, 6, 7}, {0, 6, 4, 7}, {0, 4, 5, 7}, {0, 5, 1, 7}}};

/// The values of a local scene's functions at the corners of a box, and the ownership problems of its six
/// tetrahedra.
class CubeValues {
 public:
  /// Corners are numbered as in kCubeTetrahedra.
  void sample(const LocalScene& local, const std::array<Vec3, 8>& corners);
  /// The value of a function in use at a corner.
  [[nodiscard]] double value(std::uint32_t function, std::size_t corner) const;
  /// The problem on tetrahedron t, with the scene's function indices as keys.
  void problem(const LocalScene& local, std::size_t t, OwnershipProblem& result) const;

 private:
  std::vector<std::array<double, 8>> values_;  // per function
};

}  // namespace adamas::datasets
