#include "workflow/series/step_reader.h"

#include "interfaces/api/input.h"

namespace adamas::workflow {

using namespace interfaces;

LoadedInput StepReader::read(const std::filesystem::path& file, Progress& progress) const {
  InputOptions from = input;
  from.path = file;
  const ReconstructionOptions how{.smooth_labels = resampling.smooth_labels,
                                  .fractions = resampling.fractions};
  if (has_given_interfaces(from)) {
    refuse_reconstruction(how);
    refuse_fraction_option(fraction_option);
  }
  return load_input(from, how, progress, [this](const InputFacts& facts) {
    check(facts);
    check_fraction_option(fraction_option, facts.has_labels, facts.name);
  });
}

bool StepReader::read_step(std::size_t step, const std::filesystem::path& file, LeftOutSteps& left_out,
                           LoadedInput& input_read, Progress& progress) const {
  const StepReader checked{input, resampling, fraction_option,
                           [this](const InputFacts& facts) { check_step([&] { check(facts); }); }};
  return left_out.read(step, [&] { input_read = checked.read(file, progress); });
}

}  // namespace adamas::workflow
