#include "workflow/input/left_out_steps.h"

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

std::vector<LeftOutStep> LeftOutSteps::all() const {
  std::vector<LeftOutStep> steps;
  for (const auto& [step, problem] : problems_) steps.push_back({step, problem});
  return steps;
}

void LeftOutSteps::check(std::size_t steps) const {
  if (problems_.size() == steps) fail("{}", problems_.begin()->second);
}

}  // namespace adamas::workflow
