#pragma once

#include "cli/console.h"
#include "cli/input_options.h"
#include "workflow/input/left_out_steps.h"

namespace adamas::cli {

using workflow::check_step;
using workflow::WrongStep;

/// The steps of a series that a run goes on without, since their data are damaged.
class LeftOutInputs : public workflow::LeftOutSteps {
 public:
  /// Reads a step by load_input(from, console, check), as read() does; what `check` throws becomes WrongStep.
  bool read_input(std::size_t step, const InputArguments& from, const workflow::InputCheck& check,
                  Console& console, workflow::LoadedInput& input) {
    return read(step, [&] {
      input = load_input(from, console, [&check](const interfaces::InputFacts& found) {
        check_step([&] { check(found); });
      });
    });
  }
};

using LeftOutSteps = LeftOutInputs;

}  // namespace adamas::cli
