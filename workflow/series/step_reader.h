#pragma once

#include <string>

#include "adamas/read_input.h"
#include "adamas/resample.h"
#include "workflow/input/left_out_steps.h"
#include "workflow/input/read_input.h"

namespace adamas::workflow {

/// Describes how steps of a series, or a single input, are read in order to be resampled.
struct StepReader {
  const InputOptions& input;  ///< options for reading; their path is not used
  const ResampleOptions& resampling;
  /// An option of volume fractions because of which labels and given interfaces are refused; empty: none.
  const std::string& fraction_option;
  InputCheck check;  ///< throws where the options do not suit the data that were read

  /// Reads a file. Throws Error as load_input() does.
  [[nodiscard]] LoadedInput read(const std::filesystem::path& file, Progress& progress) const;
  /// Reads the file of a step, and returns whether it could be read whole (LeftOutSteps::read).
  bool read_step(std::size_t step, const std::filesystem::path& file, LeftOutSteps& left_out,
                 LoadedInput& input_read, Progress& progress) const;
};

}  // namespace adamas::workflow
