#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "adamas/export.h"
#include "adamas/grid_data.h"
#include "adamas/progress.h"
#include "adamas/volume.h"

namespace adamas ADAMAS_API {

// Data whose truth is known (docs/generated_data.md).

/// A scene of several materials on a grid.
struct GeneratedScene {
  OwnedGridData data;           ///< volume fractions and fields, on cells
  std::vector<double> volumes;  ///< the true volume of each material, in the unit cube
};

/// Blur and noise, which make the volume fractions of a scene like measured ones.
struct FractionBlur {
  /// They are convolved with a Gaussian of this standard deviation, in cells along each axis: from 0 to 16.
  double blur = 0;
  /// Blurred fractions from 0.0001 to 0.9999 get normally distributed noise of this standard deviation: from
  /// 0 to 1. They are clipped to [0, 1], and those of a cell are scaled to add up to 1.
  double noise = 0;
};

/// The names that generate_scene() knows.
std::vector<std::string> scene_names();

/// A scene in the unit cube on so many cells along x, y and z. `seed` chooses among scenes of one kind.
/// Throws Error for an unknown name, no cells, and more than the machine's memory holds.
GeneratedScene generate_scene(std::string_view name, const std::array<std::size_t, 3>& cells,
                              std::uint64_t seed = 0, Progress& progress = SilentProgress::instance());

/// Makes a scene with blurred and noisy fractions; the volumes remain the true ones. `seed` chooses the noise
/// too. Throws Error also where a value of `blur` is out of range.
GeneratedScene generate_scene(std::string_view name, const std::array<std::size_t, 3>& cells,
                              const FractionBlur& blur, std::uint64_t seed = 0,
                              Progress& progress = SilentProgress::instance());

/// A sum of Gaussians at the 60 atoms of a truncated icosahedron; values from 0 to 1, or from 0 to the
/// greatest of a type of whole numbers. Throws Error where an axis has no sample, or more than 65536.
Volume generate_buckyball(const std::array<std::uint64_t, 3>& samples, SampleType type = SampleType::kUint8);

}  // namespace adamas
