#include "adamas/steps.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "adamas/notes.h"
#include "adamas/text.h"
#include "core/base/error.h"

namespace adamas {

namespace {

[[noreturn]] void refuse_steps(const std::string& text, std::size_t count, const std::string& series) {
  wrong_usage("--steps: expected two of the {} steps of {}, from 0 on, A,B with A up to B, found '{}'", count,
              series, text);
}

}  // namespace

void check_steps(const StepRange& steps, std::size_t count, const std::string& series) {
  if (steps.first > steps.last || steps.last >= count)
    refuse_steps(fmt::format("{},{}", steps.first, steps.last), count, series);
}

StepRange parse_steps(const std::string& text, const std::function<std::size_t()>& count,
                      const std::string& series) {
  const std::size_t comma = std::min(text.find(','), text.size());
  const std::string_view all = text;
  StepRange steps;
  const auto read = [](std::string_view part, std::uint32_t& step) {
    const auto value = to_number(part);
    constexpr double kMost = std::numeric_limits<std::uint32_t>::max();
    if (!value || *value < 0 || *value > kMost || *value != std::floor(*value)) return false;
    step = static_cast<std::uint32_t>(*value);
    return true;
  };
  if (comma == text.size() || !read(all.substr(0, comma), steps.first) ||
      !read(all.substr(comma + 1), steps.last))
    refuse_steps(text, count(), series);
  return steps;
}

std::string LeftOutStep::text() const { return fmt::format("{}: step {} is left out", problem, number); }

void note_left_out(const std::vector<LeftOutStep>& steps, Progress& progress) {
  std::vector<std::string> lines;
  for (const LeftOutStep& step : steps) lines.push_back(step.text());
  note_several(lines, {"step", "steps"}, progress, NoteKind::kIncomplete);
}

std::string step_title(double time, std::size_t step) {
  return fmt::format("time {:.6g}, step {}", time, step);
}

std::string steps_text(const std::vector<std::uint32_t>& steps) {
  std::vector<std::string> runs;
  for (std::size_t begin = 0, end = 0; begin < steps.size(); begin = end) {
    end = begin + 1;
    while (end < steps.size() && steps[end] == steps[end - 1] + 1) ++end;
    // A run of two is not shorter than two single entries.
    if (end - begin == 2) --end;
    runs.push_back(end - begin == 1 ? std::to_string(steps[begin])
                                    : fmt::format("{} to {}", steps[begin], steps[end - 1]));
  }
  return (steps.size() == 1 ? "step " : "steps ") + listed(runs);
}

}  // namespace adamas
