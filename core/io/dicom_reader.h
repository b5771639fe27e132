#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "adamas/file_summary.h"
#include "core/io/grid_file.h"

namespace adamas::io {

/// The name of the format.
inline constexpr std::string_view kDicom = "DICOM";

/// Whether a file is one of DICOM, by its first bytes.
bool is_dicom_file(const std::filesystem::path& path);
/// Whether a folder holds a file of DICOM.
bool is_dicom_folder(const std::filesystem::path& path);

/// Reads DICOM in this process: a file with several frames, or the slices of one series that lie in a folder.
/// Slices are ordered by their places; values are scaled as each slice says. A segmentation becomes labels
/// with the names of its segments or, if it is of fractions, a volume fraction for each segment. `series`:
/// the description or the UID of a series if the folder has several; usually empty. Throws Error, with the
/// file's name, if files differ in size or orientation or lack places, and if a folder has several series.
GridFile read_dicom(const std::filesystem::path& path, const std::string& series = {});

/// The series in a folder (folder_series()), in this process.
std::vector<SeriesSummary> list_dicom_series(const std::filesystem::path& path);

/// Reads series of a folder in this process, as arrays of one grid: those whose description or UID, which is
/// the name of the array then, is among `wanted`. A file, or a folder of one series, is read as read_dicom()
/// does. Throws Error as that, where no series of several is wanted, and where their grids differ.
GridFile read_dicom_series(const std::filesystem::path& path, const std::vector<std::string>& wanted);

}  // namespace adamas::io
