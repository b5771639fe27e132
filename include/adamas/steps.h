#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "adamas/export.h"
#include "adamas/progress.h"

namespace adamas ADAMAS_API {

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
