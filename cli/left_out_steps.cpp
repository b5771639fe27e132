#include "cli/left_out_steps.h"

#include "adamas/notes.h"

namespace adamas::cli {

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

bool LeftOutSteps::read_input(std::size_t step, const InputArguments& from, const workflow::InputCheck& check,
                              Console& console, workflow::LoadedInput& input) {
  return read(step, [&] {
    input = load_input(from, console,
                       [&check](const interfaces::InputFacts& found) { check_step([&] { check(found); }); });
  });
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

void LeftOutSteps::note(Console& console) const {
  note_several(lines(), {"step", "steps"}, console, NoteKind::kIncomplete);
}

}  // namespace adamas::cli
