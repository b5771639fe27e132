#include "workflow/slices/slice_steps.h"

#include <algorithm>
#include <filesystem>

#include "adamas/series.h"
#include "adamas/text.h"
#include "core/base/error.h"
#include "core/io/input_file.h"
#include "core/io/input_formats.h"
#include "core/io/volume_stack.h"
#include "core/picture/film.h"
#include "timevarying/api/open_store.h"

namespace adamas::workflow {

using namespace io;
using namespace picture;

namespace {

std::vector<SliceStep> steps_of_store(const SliceRequest& request, OutputSet& outputs) {
  const std::string& path = request.inputs[0];
  outputs.protect(path);
  std::vector<SliceStep> steps;
  for (const double time : timevarying::open_store_file(path, {})->times()) {
    const std::size_t number = steps.size();
    steps.push_back({time, number, path + ", step " + std::to_string(number), path, request.volume, number});
  }
  return steps;
}

/// Returns the steps in the single input file.
std::vector<SliceStep> steps_within(const SliceRequest& request, OutputSet& outputs) {
  if (is_store(request.inputs[0])) return steps_of_store(request, outputs);
  std::vector<SliceStep> steps;
  for (VolumeInputStep& step : find_volume_steps(request.inputs, request.volume).steps) {
    steps.push_back(
        {step.time, steps.size(), std::move(step.name), step.input.path, std::move(step.input), {}});
  }
  return steps;
}

/// Returns the first and the last step of --steps A,B or --step N; all steps where neither is given.
std::pair<std::size_t, std::size_t> wanted_steps(const SliceRequest& request, std::size_t count) {
  if (!request.step && request.steps.empty()) return {0, count - 1};
  if (request.step) {
    const std::uint64_t step = *request.step;
    if (step >= count)
      wrong_usage("--step: expected less than the {} steps of {}, found {}", count, request.inputs[0], step);
    return {step, step};
  }
  const auto [first, last] = parse_steps(request.steps, count, request.inputs[0]);
  return {first, last};
}

/// Throws the Error that an option about steps is given for an input that is no series.
[[noreturn]] void refuse_series(const SliceRequest& request, const std::string& option) {
  const std::string input = request.inputs.empty() ? request.input.path.string() : request.inputs[0];
  wrong_usage(
      "{}: expected a series as INPUT (a .pvd, several files, a stored series, or a file with several "
      "times), found {}",
      option, input.empty() ? "none" : input);
}

}  // namespace

bool names_series(const std::string& output) {
  return is_film(output) || file_extension(output) == ".pvd" ||
         !numbered_name(std::filesystem::path(output).filename().string(), 0).empty();
}

SliceSteps find_slice_steps(const SliceRequest& request, const std::string& output, OutputSet& outputs) {
  if (request.step && !request.steps.empty()) wrong_usage("--step and --steps: expected one of them");
  std::vector<SliceStep> steps;
  if (!request.volume.stack) {
    for (const SeriesEntry& entry : series_steps(request.inputs))
      steps.push_back({entry.time, steps.size(), entry.file, entry.file, request.volume, {}});
  }
  const bool several = names_series(output) || !request.steps.empty();
  const bool one_file = request.inputs.size() == 1 && !request.volume.stack;
  if (steps.empty() && several && one_file) {
    check_input_file(request.inputs[0]);
    steps = steps_within(request, outputs);
    if (steps.size() == 1) steps.clear();
  }
  if (steps.empty()) {
    if (several) refuse_series(request, request.steps.empty() ? "-o " + output : "--steps");
    if (!request.step || (one_file && is_store(request.inputs[0]))) return {};
    const InputFormat* format = one_file ? find_format_by_name(request.inputs[0]) : nullptr;
    if (format == nullptr || !format->several_times) refuse_series(request, "--step");
    wrong_usage(
        "--step: expected a stored series or a series of files, found {}: --time says which of its times",
        request.inputs[0]);
  }
  const auto [first, last] = wanted_steps(request, steps.size());
  SliceSteps result{{}, steps.size()};
  for (std::size_t n = first; n <= last; ++n) result.chosen.push_back(std::move(steps[n]));
  return result;
}

}  // namespace adamas::workflow
