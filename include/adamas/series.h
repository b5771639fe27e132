#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "adamas/export.h"

namespace adamas ADAMAS_API {

/// One step of a series: its time, and its file's name relative to the series' folder.
struct SeriesEntry {
  double time = 0;
  std::string file;
  std::optional<std::uint64_t> number{};  ///< the number of the time in a file with several; else none

  /// Returns what messages call it: the file, and the number of the time where it has one.
  [[nodiscard]] std::string name() const;
};

/// Writes a .pvd, the list of files that ParaView and VisIt read as a series. Throws Error where it cannot be
/// written in full, or where read_series() would not give the same entries.
void write_series(const std::filesystem::path& path, const std::vector<SeriesEntry>& entries);

/// Returns the name of a step's file beside the list of a series: F_0007.vti for F.pvd. Throws Error where a
/// list cannot hold the name.
std::string step_file(const std::filesystem::path& list, std::size_t step, const std::string& ending);

/// Returns the time between successive steps where it is the same for all of them, up to this relative
/// tolerance; none otherwise.
std::optional<double> even_spacing(const std::vector<double>& times, double tolerance);

/// Reads the steps of a .pvd, in the order of their times, with whole paths. Throws Error, with the file's
/// name, where it is no such list, has several files for one time, lacks a time among several, or has no
/// files.
std::vector<SeriesEntry> read_series(const std::filesystem::path& path);

/// Returns the steps that inputs of a command stand for: those of a .pvd; the files that fit a pattern
/// (match_stack), or several files in the order given, at the times 0, 1, 2 and so on. The result is empty
/// for a single file other than a .pvd. Throws Error as read_series() and match_stack() do.
std::vector<SeriesEntry> find_series(const std::vector<std::string>& inputs);

/// Returns the times that a file of cells has, in ascending order: those of ExodusII, CGNS, OpenFOAM and
/// Truchas; none for other files. Throws Error, with the file's name, where it cannot be read.
std::vector<double> mesh_times(const std::filesystem::path& path);

/// Returns a step for each time of a file of cells; none where it has fewer than two.
std::vector<SeriesEntry> mesh_steps(const std::filesystem::path& path);

/// Returns the steps of find_series(). Throws Error for the first step whose file does not exist.
std::vector<SeriesEntry> series_steps(const std::vector<std::string>& inputs);

}  // namespace adamas
