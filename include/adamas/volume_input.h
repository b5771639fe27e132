#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "adamas/export.h"
#include "adamas/geometry.h"
#include "adamas/progress.h"
#include "adamas/raw_volume.h"
#include "adamas/volume.h"

namespace adamas {
namespace io {
struct UnpackedTimes;
}
}  // namespace adamas

namespace adamas ADAMAS_API {

/// Says which volume is read from which files.
struct VolumeInput {
  std::string path;    ///< a file, or with `stack` a pattern of files
  bool stack = false;  ///< `path` is a pattern of slices, as "ct_*.tif" or "ct_%04d.png"
  std::string array;   ///< the name of the array or data set in a file with several; empty: the file's choice
  std::optional<std::uint64_t> time{};  ///< the number of the time in a file with several times, from 0 on
  RawOptions raw{};                     ///< with `dimensions`, the file has no header
  /// A folder for unpacked samples; empty: the system's folder for temporary files.
  std::filesystem::path scratch{};
  /// Unpacked samples that several times of one file share (find_volume_steps); the library itself uses it.
  std::shared_ptr<io::UnpackedTimes> all_times{};

  /// Returns the command-line name of the first given value, except `path`; empty where there is none.
  [[nodiscard]] std::string option() const;
};

/// Returns the endings of the files that volumes are read from, for help texts: ".vti, .nrrd, ... or .png".
std::string volume_endings();
/// Returns the endings of the files that data on a grid are read from: ".vti,.vtr, ...".
std::string grid_endings();
/// The same of files with data on meshes of cells.
std::string mesh_endings();

/// Reads a volume into memory, as read_volume() of `adamas/files.h` does. Throws Error (kUsage) where values
/// contradict each other, and Error, with the file's name, where a file cannot be used.
Volume read_volume(const VolumeInput& input, Progress& progress = SilentProgress::instance());

/// The origin of the times of a series.
enum class StepTimes : std::uint8_t {
  kCounted,   ///< not stated: 0, 1, 2 and so on
  kSpaced,    ///< spaced evenly from 0 on, by the duration of a step in the file
  kAbsolute,  ///< stated for each step in the file
};

/// One step of a series of volumes.
struct VolumeInputStep {
  double time = 0;
  std::string name;  ///< the name in messages: the file, and the part of it where it holds several steps
  VolumeInput input;
  /// The group of HDF5 whose members are the arrays of the steps; empty where these have one name.
  std::string group{};
};

/// The steps that files hold, in the order of their times.
struct VolumeInputSteps {
  std::vector<VolumeInputStep> steps;
  StepTimes times = StepTimes::kCounted;
  std::string remark{};  ///< a statement of the file about times that is ignored; mostly empty
};

/// Finds the steps of several files, of a pattern or of a list `.pvd` (find_series); or those of the series
/// in one file (NIfTI, HDF5), unless `options` names one of its times; else the one volume. `options` applies
/// to each step, except its path. Throws Error, with the file's name, where a file is damaged, and Error
/// (kUsage) for several stacks.
VolumeInputSteps find_volume_steps(const std::vector<std::string>& inputs, const VolumeInput& options = {});

}  // namespace adamas
