#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "adamas/slice_files.h"

namespace adamas::workflow {

/// A step of a series that is to be cut.
struct SliceStep {
  double time = 0;
  std::size_t number = 0;  ///< its number in the whole series
  std::string name;  ///< the name in messages: the file, and the part of it where it holds several steps
  std::string file;
  VolumeInput volume;  ///< the options of `slice`, and the time or data set in a file with several
  std::optional<std::uint64_t> stored{};  ///< for a stored series: the number of the step
  std::optional<std::uint64_t>
      time_number{};  ///< of a file of cells with several times: the number of the time
};

/// The steps that are to be cut.
struct SliceSteps {
  std::vector<SliceStep> chosen;  ///< the steps of --step or --steps; empty where the input is no series
  std::size_t all = 0;            ///< number of steps of the series
};

/// Returns whether a file of that name can only be written for a series: a film, a list of steps or a pattern
/// of names.
bool names_series(const std::string& output);

/// The series that is to be cut: that of several files, of a pattern or a list (series_steps); or, where the
/// options or the output ask for several steps, that of one file: a stored series, or several times of cells
/// (mesh_steps), or several times or data sets of volumes (find_volume_steps). Throws Error (kUsage) at steps
/// that are not there and at options about steps where there is no series, and Error.
SliceSteps find_slice_steps(const SliceRequest& request, const std::string& output);

}  // namespace adamas::workflow
