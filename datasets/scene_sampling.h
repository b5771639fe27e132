#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "adamas/generate.h"  // FractionBlur
#include "adamas/progress.h"
#include "core/base/error.h"
#include "core/data/multi_material_data.h"
#include "datasets/scene.h"
#include "datasets/scene_integral.h"

namespace adamas::datasets {

struct SamplingOptions {
  /// The number of divisions of a cell that curved interfaces cross, 1 to 8: errors fall by a factor of
  /// sixteen with each (see CellFractions).
  int depth = 3;
  /// Whether to add the fields besides the volume fractions.
  bool fields = true;
  /// The blur and the noise that are then applied to the fractions.
  FractionBlur blur = {};
  std::uint64_t noise_seed = 0;
};

/// Samples a scene: its volume fractions on dims[0] x dims[1] x dims[2] equal cells, and its fields:
/// "constant", "linear" and "smooth" per material, with the value at the cell's centre wherever the material
/// has a fraction (zero elsewhere), and "mixed constant", "mixed linear" and "mixed smooth", averaged by
/// volume. Fractions are as normalise() leaves them: those below kFractionTrace are zero. If they are blurred
/// or noisy, the fields follow from the new ones by the same rule. `integral`, if given, receives the volumes
/// before that and before rounding to float, and their errors. Throws Error for zero dimensions, options out
/// of range and more data than the machine's memory.
MultiMaterialData sample_scene(const Scene& scene, const std::array<std::size_t, 3>& dims,
                               const SamplingOptions& options = {},
                               Progress& progress = SilentProgress::instance(),
                               SceneIntegral* integral = nullptr);

}  // namespace adamas::datasets
