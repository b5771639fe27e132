#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "adamas/error.h"
#include "adamas/progress.h"

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
  [[nodiscard]] std::vector<std::size_t> numbers() const;
  /// Returns the problem of each step that is left out, by number.
  [[nodiscard]] const std::map<std::size_t, std::string>& problems() const { return problems_; }
  /// Returns a note for each of these steps.
  [[nodiscard]] std::vector<std::string> lines() const;
  /// Throws Error, with the first problem, if none of so many steps is left.
  void check(std::size_t steps) const;
  /// Notes these steps: each of them with `verbose`, otherwise the first and the number of the others.
  void note(Progress& progress) const;

 private:
  std::map<std::size_t, std::string> problems_;
};

}  // namespace adamas::workflow
