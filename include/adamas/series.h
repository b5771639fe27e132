#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "adamas/export.h"
#include "adamas/progress.h"

namespace adamas ADAMAS_API {

/// One step of a series: its time, and its file's name as seen from the series' folder.
struct SeriesEntry {
  double time = 0;
  std::string file;
};

/// Writes a .pvd, the list of files that ParaView and VisIt read as a series. Throws Error where it cannot be
/// written in full, or not so that read_series gives the same.
void write_series(const std::filesystem::path& path, const std::vector<SeriesEntry>& entries);

/// The name of a step's file beside the list of a series: F_0007.vti of F.pvd. Throws Error where a list
/// cannot hold it.
std::string step_file(const std::filesystem::path& list, std::size_t step, const std::string& ending);

/// Returns the time from one of several steps to the next where all follow each other at that distance, to
/// such a part of it; none otherwise.
std::optional<double> even_spacing(const std::vector<double>& times, double tolerance);

/// Reads the steps of a .pvd, in the order of their times, with whole paths. Throws Error, with the file's
/// name, where it is no such list, has several files for one time, none of one among several, or no files.
std::vector<SeriesEntry> read_series(const std::filesystem::path& path);

/// The steps that inputs of a command stand for: those of a .pvd; the files that fit a pattern (match_stack),
/// or several files in the order given, at the times 0, 1, 2 and so on. Nothing where there is one file
/// alone, which is no .pvd. Throws Error as read_series and match_stack do.
std::vector<SeriesEntry> find_series(const std::vector<std::string>& inputs);

/// The steps of find_series, all of whose files must be there: throws Error for the first one that is not.
std::vector<SeriesEntry> series_steps(const std::vector<std::string>& inputs);

/// Steps of a series, from the first to the last, both included, by their numbers from 0 on.
struct StepRange {
  std::uint32_t first = 0, last = 0;
};

/// Throws Error (kUsage), in the name of --steps, where a series of `count` steps does not have such steps,
/// or the first one comes after the last one. `series`: what messages call it.
void check_steps(const StepRange& steps, std::size_t count, const std::string& series);

/// Reads "A,B": two of the `count` steps of a series, with A up to B. Throws Error as check_steps() does.
StepRange parse_steps(const std::string& text, std::size_t count, const std::string& series);

/// A step that was left out because its file is damaged.
struct LeftOutStep {
  std::size_t number = 0;  ///< its number in the whole series
  std::string problem;     ///< the message of the reader, which begins with the file's name

  /// Returns the line that says this.
  [[nodiscard]] std::string text() const;
};

/// Notes steps that were left out (NoteKind::kIncomplete).
void note_left_out(const std::vector<LeftOutStep>& steps, Progress& progress);

/// A step in titles: "time 0.25, step 3".
std::string step_title(double time, std::size_t step);

/// Ascending numbers of steps in messages: "step 3", "steps 3 to 9, 12 and 14".
std::string steps_text(const std::vector<std::uint32_t>& steps);

}  // namespace adamas
