#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "adamas/volume_input.h"

namespace adamas::io {

/// A step of a series of volumes that lies in one file, and what open_volume is told to get it.
struct VolumeStep {
  double time = 0;
  std::string array;                    ///< the name of its data set, where there are several
  std::optional<std::uint64_t> number;  ///< the number of its time, where there are several
};

/// The greatest number of steps; a file with more is taken for damaged.
inline constexpr std::uint64_t kMostVolumeSteps = std::uint64_t{1} << 24;

/// A series in one file.
struct VolumeSeries {
  std::vector<VolumeStep> steps;  ///< in the order of their times; none where the file holds no series
  StepTimes times = StepTimes::kCounted;
  std::string remark{};  ///< what the file says of times and is ignored; mostly empty
};

/// The series that a file holds: the times of NIfTI, in seconds where the header says a unit of time; of HDF5
/// the data sets along three axes in the group `array`, in natural order (9 before 10) or, where each has a
/// number as its attribute `time`, in the order of these; or the data set `array` along four axes, the only
/// one where `array` is empty, whose first axis is time, with its attribute `time` if that has as many
/// numbers. No steps where the file is a single volume or of another format. Throws Error, with the file's
/// name, where it is damaged, a group has no such data set, or times are not finite or come twice.
VolumeSeries find_volume_series(const std::filesystem::path& path, const std::string& array);

}  // namespace adamas::io
