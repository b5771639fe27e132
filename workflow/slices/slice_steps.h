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
  std::size_t number = 0;  ///< in the whole series
  std::string name;        ///< for messages: the file, and what of it where that holds several steps
  std::string file;
  VolumeInput volume;  ///< the options of `slice`, and which time or data set of a file that holds several
  std::optional<std::uint64_t> stored{};  ///< of a stored series: the number of the step
};

/// The steps that are to be cut.
struct SliceSteps {
  std::vector<SliceStep> chosen;  ///< by --step or --steps; none where the input is no series
  std::size_t all = 0;            ///< that the series has
};

/// Whether files of that name are written for a series alone: a film, a list of steps or a pattern of names.
bool names_series(const std::string& output);

/// The series that is to be cut: that of several files, of a pattern or a list (series_steps); or, where the
/// options or the output ask for several steps, that of one file: a stored series, or several times or data
/// sets (find_volume_steps). Throws Error (kUsage) at steps that are not there and at options about steps
/// where there is no series, and Error.
SliceSteps find_slice_steps(const SliceRequest& request, const std::string& output);

}  // namespace adamas::workflow
