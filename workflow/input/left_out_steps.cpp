#include "workflow/input/left_out_steps.h"

#include "adamas/notes.h"
#include "core/base/error.h"

namespace adamas::workflow {

void check_step(const std::function<void()>& check) {
  try {
    check();
  } catch (const Error& e) {
    if (e.kind() == ErrorKind::kCancelled || e.kind() == ErrorKind::kUsage) throw;
    throw WrongStep(e.what());
  }
}

bool LeftOutSteps::read(std::size_t step, const std::function<void()>& work) {
  try {
    work();
    return true;
  } catch (const WrongStep&) {
    throw;
  } catch (const Error& e) {
    if (e.kind() == ErrorKind::kCancelled || e.kind() == ErrorKind::kUsage) throw;
    problems_.try_emplace(step, e.what());
    return false;
  }
}

std::vector<std::size_t> LeftOutSteps::numbers() const {
  std::vector<std::size_t> steps;
  for (const auto& [step, problem] : problems_) steps.push_back(step);
  return steps;
}

void LeftOutSteps::check(std::size_t steps) const {
  if (problems_.size() == steps) fail("{}", problems_.begin()->second);
}

std::vector<std::string> LeftOutSteps::lines() const {
  std::vector<std::string> lines;
  for (const auto& [step, problem] : problems_)
    lines.push_back(fmt::format("{}: step {} is left out", problem, step));
  return lines;
}

void LeftOutSteps::note(Progress& progress) const {
  note_several(lines(), {"step", "steps"}, progress, NoteKind::kIncomplete);
}

}  // namespace adamas::workflow
