#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "adamas/export.h"
#include "adamas/flows.h"
#include "adamas/generate.h"
#include "adamas/output_set.h"
#include "adamas/progress.h"
#include "adamas/series_output.h"
#include "adamas/volume.h"

namespace adamas ADAMAS_API {

// This header writes generated data (adamas/generate.h, adamas/flows.h) to files. Outputs are declared
// before; they get their names when the OutputSet is committed.

/// Options that say what is written of a scene.
struct SceneSampling {
  std::string name;        ///< one of scene_names()
  std::uint64_t seed = 0;  ///< the seed of AnalyticScene
  Box3 box = SceneOptions().box;
  std::array<std::size_t, 3> cells{};  ///< numbers of cells, or with `volume` of samples, along x, y and z
  FractionBlur blur{};                 ///< blur and noise of the volume fractions
  /// The type of samples of how far points are inside the bodies (AnalyticScene::samples), which are written
  /// in place of volume fractions and fields; none: fractions and fields.
  std::optional<SampleType> volume{};
};

/// The materials of a scene at a time.
struct SceneState {
  double time = 0;
  std::vector<SceneMaterial> materials;
};

/// The facts about the data of a scene that were written.
struct WrittenScene {
  std::vector<SceneState> states;   ///< one for each time of the series
  double slope = 1, intercept = 0;  ///< scale of samples: a value is slope * sample + intercept
};

/// Writes a scene at the times of a series (only the scene `moving` has other times than 1): cells as .vtr or
/// .vti, samples as .vti. Throws Error as AnalyticScene does.
WrittenScene write_scene(const SceneSampling& sampling, SeriesOutput& series, OutputSet& outputs,
                         Progress& progress = SilentProgress::instance());

/// Advances a flow to the times of a series, and writes its data there as .vtr or .vti.
void write_flow(ImpactSimulation& flow, SeriesOutput& series, OutputSet& outputs,
                Progress& progress = SilentProgress::instance());
/// Advances a flow to the times of a series, and writes its fields there as arrays of a .vti.
void write_flow(MixingSimulation& flow, SeriesOutput& series, OutputSet& outputs,
                Progress& progress = SilentProgress::instance());

/// A volume that was written, and its size.
struct WrittenVolume {
  VolumeGrid grid;
  std::size_t bytes = 0;  ///< size of all its files
};

/// Declares the files of a volume as declare_volume_output() does, and writes generate_buckyball() plane by
/// plane, so that it need not fit in memory.
WrittenVolume write_buckyball(const std::array<std::uint64_t, 3>& samples, SampleType type,
                              const std::filesystem::path& output, OutputSet& outputs,
                              Progress& progress = SilentProgress::instance());

}  // namespace adamas
