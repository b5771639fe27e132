#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace adamas {

/// One step of a series: its time, and its file's name as seen from the series' folder.
struct SeriesEntry {
  double time = 0;
  std::string file;
};

/// Writes a .pvd, the list of files that ParaView and VisIt read as a series. Throws Error where it cannot be
/// written in full.
void write_series(const std::filesystem::path& path, const std::vector<SeriesEntry>& entries);

}  // namespace adamas
