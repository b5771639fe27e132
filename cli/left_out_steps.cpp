#include "cli/left_out_steps.h"

namespace adamas {

bool LeftOutSteps::read(std::size_t step, const std::function<void()>& work) {
  try {
    work();
    return true;
  } catch (const Cancelled&) {
    throw;
  } catch (const Error& e) {
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

void LeftOutSteps::note(Console& console) const {
  for (const auto& [step, problem] : problems_) console.note_damage("{}: step {} is left out", problem, step);
}

}  // namespace adamas
