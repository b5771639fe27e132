#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "adamas/export.h"
#include "adamas/progress.h"

namespace adamas ADAMAS_API {

/// One step of a series: its time, and its file's name relative to the series' folder.
struct SeriesEntry {
  double time = 0;
  std::string file;
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

/// Returns the steps of find_series(). Throws Error for the first step whose file does not exist.
std::vector<SeriesEntry> series_steps(const std::vector<std::string>& inputs);

/// Steps of a series, from the first to the last, both included, by their numbers from 0 on.
struct StepRange {
  std::uint32_t first = 0, last = 0;
};

/// Throws Error (kUsage), in the name of --steps, where a series of `count` steps does not have such steps,
/// or the first one comes after the last one. `series`: what messages call it.
void check_steps(const StepRange& steps, std::size_t count, const std::string& series);

/// Reads "A,B", the numbers of two steps; check_steps() is for those that know the series. Throws Error as
/// that does where the text is not two whole numbers. `count`: called for the message alone, returns the
/// number of steps of the series.
StepRange parse_steps(const std::string& text, const std::function<std::size_t()>& count,
                      const std::string& series);

/// A step that was left out because its file is damaged.
struct LeftOutStep {
  std::size_t number = 0;  ///< its number in the whole series
  std::string problem;     ///< the message of the reader, which begins with the file's name

  /// Returns the line that says this.
  [[nodiscard]] std::string text() const;
};

/// Notes steps that were left out (NoteKind::kIncomplete).
void note_left_out(const std::vector<LeftOutStep>& steps, Progress& progress);

/// Returns a title of a step: "time 0.25, step 3".
std::string step_title(double time, std::size_t step);

/// Returns a text of ascending step numbers for messages: "step 3", "steps 3 to 9, 12 and 14".
std::string steps_text(const std::vector<std::uint32_t>& steps);

}  // namespace adamas
