#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "adamas/files.h"  // InputKind
#include "adamas/progress.h"
#include "adamas/volume_input.h"
#include "core/base/error.h"
#include "core/io/grid_file.h"
#include "core/io/image_header.h"
#include "core/io/volume_reader.h"

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

/// The times of the array that volume_of() finds; none if there is only one. Throws Error if there are too
/// many, or if the file is too short for the last one.
VolumeSeries series_of(const ImageHeader& header, const std::string& array, StepTimes times);

/// A format of input files. A new format is a function that returns it, in the file of its reader, and a line
/// in input_formats.cpp.
struct InputFormat {
  std::string_view name;  ///< "NRRD"
  InputKind kind = InputKind::kGrid;
  std::string_view endings;            ///< extensions of file names, as ".nrrd .nhdr", which help texts list
  std::string_view more_endings = {};  ///< further extensions, which are not listed
  /// Whether the first bytes of a file show that it has this format; null if they never do.
  bool (*shown_by)(std::string_view beginning) = nullptr;

  /// Reads the header of a grid. A format with a header needs none of the functions below.
  ImageHeader (*read_header)(const std::filesystem::path& path) = nullptr;
  /// Reads a grid if there is no such header, or if it is not enough; null: no grids of materials.
  GridFile (*read_grid)(const std::filesystem::path& path) = nullptr;
  /// Reads those series of a folder that are named among `wanted`, as arrays of one grid; null if no folder
  /// of the format has several.
  GridFile (*read_series)(const std::filesystem::path& path,
                          const std::vector<std::string>& wanted) = nullptr;
  /// Finds the samples of a volume if there is no header; null: no volumes.
  VolumeSource (*find_volume)(const std::filesystem::path& path, const VolumeOptions& options,
                              Progress& progress) = nullptr;
  /// The series of volumes that the file holds (find_volume_series); null if it never holds one.
  VolumeSeries (*find_series)(const std::filesystem::path& path, const std::string& array) = nullptr;
  /// The files beside it that a header names or implies, whether they exist or not; null if it cannot.
  std::vector<std::filesystem::path> (*referred_files)(const std::filesystem::path& path) = nullptr;
  /// Whether a file may have several arrays, one of which is named for a volume.
  bool several_arrays = false;
  bool several_times = false;
  bool may_be_cells = false;  ///< whether a grid's ending may be that of cells too (is_mesh_by_header)
  /// Whether a folder stands for a file of the format; null if none does.
  bool (*is_folder)(const std::filesystem::path& path) = nullptr;

  [[nodiscard]] bool gives_grids() const { return read_header != nullptr || read_grid != nullptr; }
  [[nodiscard]] bool gives_volumes() const { return read_header != nullptr || find_volume != nullptr; }
  [[nodiscard]] bool has_ending(std::string_view ending) const;
};

/// All formats, in the order in which they are listed.
std::span<const InputFormat> input_formats();

/// The format by a file's extension or, if that is unknown, by its first bytes; null if neither shows one.
const InputFormat* find_input_format(const std::filesystem::path& path);
/// The format by a file's extension; null if there is none.
const InputFormat* find_format_by_name(const std::filesystem::path& path);
/// What a file is that is not read, with the way round, for messages: "a dump of CTH (...)"; "something else"
/// if that is not known.
std::string name_unread_format(const std::filesystem::path& path);
/// The kind of data in a file, by its extension, and by its header if that extension may be of a surface or a
/// network (.ply). Files of unknown extensions are grids.
InputKind kind_by_format(const std::filesystem::path& path);
/// The format of a volume, as find_input_format finds it. Throws Error that lists the known formats if there
/// is none.
const InputFormat& find_volume_format(const std::filesystem::path& path);

/// The extensions of formats for a message, as ".vti, .vtr or .vtk", where "or" is the last word between
/// them.
std::string list_grid_endings(std::string_view last);
std::string list_volume_endings(std::string_view last);
std::string list_mesh_endings(std::string_view last);

/// The series that a file holds. For NIfTI these are its times, in seconds if the header states a unit of
/// time. For HDF5 they are the data sets along three axes in the group `array`, in natural order (9 before
/// 10) or, if each has a number as its attribute `time`, in the order of these; or the data set `array` along
/// four axes, the only one if `array` is empty, whose first axis is time, with its attribute `time` if that
/// has as many numbers. There are no steps if the file is a single volume or of another format. Throws Error,
/// with the file's name, if it is damaged, if a group has no such data set, or if times are not finite or not
/// distinct.
VolumeSeries find_volume_series(const std::filesystem::path& path, const std::string& array);

}  // namespace adamas::io
