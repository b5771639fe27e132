#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "adamas/volume_input.h"

namespace adamas::io {

/// A step of a series of volumes that lies in one file: how open_volume finds it.
struct VolumeStep {
  double time = 0;
  std::string array;                    ///< the name of its data set, if there are several
  std::optional<std::uint64_t> number;  ///< the number of its time, if there are several
};

/// The greatest number of steps; a file with more is taken for damaged.
inline constexpr std::uint64_t kMostVolumeSteps = std::uint64_t{1} << 24;

/// A series in one file.
struct VolumeSeries {
  std::vector<VolumeStep> steps;  ///< in the order of their times; none if the file holds no series
  StepTimes times = StepTimes::kCounted;
  std::string remark{};  ///< what the file says about times and is ignored; usually empty
};

/// The series that a file holds. For NIfTI these are its times, in seconds if the header states a unit of
/// time. For HDF5 they are the data sets along three axes in the group `array`, in natural order (9 before
/// 10) or, if each has a number as its attribute `time`, in the order of these; or the data set `array` along
/// four axes, the only one if `array` is empty, whose first axis is time, with its attribute `time` if that
/// has as many numbers. There are no steps if the file is a single volume or of another format. Throws Error,
/// with the file's name, if it is damaged, if a group has no such data set, or if times are not finite or not
/// distinct.
VolumeSeries find_volume_series(const std::filesystem::path& path, const std::string& array);

}  // namespace adamas::io
