#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "cli/console.h"
#include "cli/input_options.h"

namespace adamas::cli {

/// What is wrong though a step was read whole: the run does not go on without the step, but ends.
class WrongStep : public Error {
 public:
  using Error::Error;
};

/// Calls `check`, which looks at what was read of a step. Throws WrongStep in place of other Errors.
void check_step(const std::function<void()>& check);

/// The steps of a series that a run goes on without, since what there is of them is damaged.
class LeftOutSteps {
 public:
  /// Calls `work`, which reads a step, and returns whether it could; what it says otherwise is kept. Throws
  /// Cancelled, WrongStep, and what is no Error.
  bool read(std::size_t step, const std::function<void()>& work);
  /// Reads a step by load_input(from, console, check) in that way; what `check` throws becomes WrongStep.
  bool read_input(std::size_t step, const InputArguments& from, const workflow::InputCheck& check,
                  Console& console, workflow::LoadedInput& input);
  [[nodiscard]] bool contains(std::size_t step) const { return problems_.contains(step); }
  [[nodiscard]] std::vector<std::size_t> numbers() const;
  /// What there is to tell of each.
  [[nodiscard]] std::vector<std::string> lines() const;
  /// Throws Error, with what the first one says, where no other step of so many is left.
  void check(std::size_t steps) const;
  /// Notes them: with `verbose` each, otherwise the first and how many more there are.
  void note(Console& console) const;

 private:
  std::map<std::size_t, std::string> problems_;
};

}  // namespace adamas::cli
