#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "adamas/error.h"
#include "adamas/steps.h"

namespace adamas::workflow {

/// An error in a step that was read whole: it ends the run, which does not go on without the step.
class WrongStep : public Error {
 public:
  using Error::Error;
};

/// Calls `check`, which checks the data of a step. Throws WrongStep in place of other Errors.
void check_step(const std::function<void()>& check);

/// The steps of a series that a run leaves out, since they are damaged.
class LeftOutSteps {
 public:
  /// Calls `work`, which reads a step, and returns whether it succeeded; otherwise its message is kept.
  /// Throws Cancelled, WrongStep, and exceptions other than Errors.
  bool read(std::size_t step, const std::function<void()>& work);
  [[nodiscard]] bool contains(std::size_t step) const { return problems_.contains(step); }
  /// What is wrong with each, by number.
  [[nodiscard]] std::vector<LeftOutStep> all() const;
  /// Throws Error, with what the first one says, where no other step of so many is left.
  void check(std::size_t steps) const;

 private:
  std::map<std::size_t, std::string> problems_;
};

}  // namespace adamas::workflow
