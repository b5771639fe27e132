#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "adamas/export.h"
#include "adamas/geometry.h"
#include "adamas/grid_data.h"
#include "adamas/meshes.h"
#include "adamas/progress.h"
#include "adamas/volume.h"

namespace adamas ADAMAS_API {

// This header makes data whose truth is known (docs/generated_data.md); flows are in adamas/flows.h.

/// Describes how a named scene is placed.
struct SceneOptions {
  Box3 box{{0, 0, 0}, {1, 1, 1}};
  double time = 1;  ///< the time of the scene `moving`, from 0 to 1, its end
};

/// Blur and noise, which make the volume fractions of a scene like measured ones.
struct FractionBlur {
  /// The standard deviation, in cells along each axis, of the Gaussian that fractions are convolved with:
  /// from 0 to kGreatestBlur.
  double blur = 0;
  /// Blurred fractions from 0.0001 to 0.9999 get normally distributed noise of this standard deviation: from
  /// 0 to 1. They are clipped to [0, 1], and those of a cell are scaled to add up to 1.
  double noise = 0;
};
inline constexpr double kGreatestBlur = 16;

/// A material of a scene, with its volumes in the cube of the unit of length.
struct SceneMaterial {
  std::string name;
  double volume = 0;        ///< the true volume
  double volume_error = 0;  ///< the estimated absolute error of `volume`; round-off for known volumes
  /// The sum over the cells of a grid, before blur, noise and rounding to float, and its estimated absolute
  /// error; none where there is no grid.
  std::optional<double> sampled_volume{}, sampling_error{};
};

/// A scene of several materials on a grid.
struct GeneratedScene {
  OwnedGridData data;  ///< volume fractions and fields, on cells
  std::vector<SceneMaterial> materials;
};

/// Returns the names of all scenes.
std::vector<std::string> scene_names();

/// A box that is divided among materials by an analytic rule, so that owners of points, volumes and
/// interfaces are known. Copies share their contents.
class AnalyticScene {
 public:
  /// `seed` chooses among scenes of one kind: the seeds of `voronoi10`, everything in `random`; other scenes
  /// ignore it. Lengths scale with the shortest side of the box. Throws Error for an unknown name, a box
  /// without volume and a time out of range.
  explicit AnalyticScene(std::string_view name, std::uint64_t seed = 0, const SceneOptions& options = {});

  [[nodiscard]] const std::string& name() const;
  [[nodiscard]] const Box3& box() const;
  /// Returns the materials with their true volumes; those of `random` are integrated at the first call.
  [[nodiscard]] std::vector<SceneMaterial> materials() const;

  /// Samples volume fractions and fields on so many equal cells along x, y and z: "constant", "linear" and
  /// "smooth" for each material, with the value at the cell's centre, and "mixed constant" and so on,
  /// averaged by volume. The noise follows from the seed and the time. Throws Error for no cells, more than
  /// the machine's memory holds, and a value of `blur` that is out of range.
  [[nodiscard]] GeneratedScene sample(const std::array<std::size_t, 3>& cells, const FractionBlur& blur = {},
                                      Progress& progress = SilentProgress::instance()) const;

  /// Samples how far points are inside the bodies, that is, the greatest value of all materials less that of
  /// the first: the signed distance to the nearest surface, positive inside, where the scene is made of
  /// spheres and planes. Distances from -1/4 to 1/4 of the box's shortest side fill the range of types of
  /// whole numbers, as the slope and the intercept of the grid say. Throws Error where an axis has fewer than
  /// two samples, and for kInt16.
  [[nodiscard]] Volume samples(const std::array<std::size_t, 3>& dimensions,
                               SampleType type = SampleType::kUint8) const;

  /// Returns the true interfaces, which end on the box: exact, to round-off, where they are planes, and
  /// elsewhere made of triangles whose size is `resolution`, off by about its square times the curvature.
  /// Throws Error where the resolution is not positive or gives more than 4096 cells along an axis.
  [[nodiscard]] InterfaceTriangles interfaces(double resolution,
                                              Progress& progress = SilentProgress::instance()) const;

 private:
  struct Contents;
  std::shared_ptr<const Contents> contents_;
};

/// Samples a scene in the unit cube: AnalyticScene(name, seed).sample(cells).
GeneratedScene generate_scene(std::string_view name, const std::array<std::size_t, 3>& cells,
                              std::uint64_t seed = 0, Progress& progress = SilentProgress::instance());

/// Samples a scene in the unit cube with blurred and noisy fractions; the volumes remain the true ones.
GeneratedScene generate_scene(std::string_view name, const std::array<std::size_t, 3>& cells,
                              const FractionBlur& blur, std::uint64_t seed = 0,
                              Progress& progress = SilentProgress::instance());

/// Data on a grid by name: a scene in the unit cube, or the impact of adamas/flows.h at its end.
struct GeneratedData {
  std::string name;                                   ///< one of generated_names()
  std::optional<std::array<std::size_t, 3>> cells{};  ///< numbers of cells along x, y and z; scenes need them
  std::optional<std::uint64_t> seed{};                ///< the seed, which only scenes have; none: 0

  /// Throws Error (kUsage) where the values do not go together.
  void check() const;
};

/// Returns the names of data: "impact" and those of all scenes.
std::vector<std::string> generated_names();

/// Makes such data. Throws Error as GeneratedData::check and AnalyticScene do.
OwnedGridData generate_data(const GeneratedData& data, Progress& progress = SilentProgress::instance());

/// Returns a sum of Gaussians at the 60 atoms of a truncated icosahedron; values from 0 to 1, or from 0 to
/// the greatest of a type of whole numbers. Throws Error where an axis has no sample, or more than 65536.
Volume generate_buckyball(const std::array<std::uint64_t, 3>& samples, SampleType type = SampleType::kUint8);

}  // namespace adamas
