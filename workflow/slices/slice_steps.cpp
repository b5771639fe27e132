#include "workflow/slices/slice_steps.h"

#include <algorithm>
#include <filesystem>

#include "adamas/series.h"
#include "adamas/steps.h"
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

std::vector<SliceStep> steps_of_store(const SliceRequest& request) {
  const std::string& path = request.inputs[0];
  std::vector<SliceStep> steps;
  for (const double time : timevarying::open_store_file(path, {})->times()) {
    const std::size_t number = steps.size();
    steps.push_back({time, number, path + ", step " + std::to_string(number), path, request.volume, number});
  }
  return steps;
}

/// The steps of a file of cells, one for each of its times.
std::vector<SliceStep> steps_of_cells(const SliceRequest& request) {
  std::vector<SliceStep> steps;
  for (const SeriesEntry& entry : mesh_steps(request.inputs[0]))
    steps.push_back({entry.time, steps.size(), entry.name(), entry.file, request.volume, {}, entry.number});
  return steps;
}

/// The steps of the one file that is the input.
std::vector<SliceStep> steps_within(const SliceRequest& request) {
  if (is_store(request.inputs[0])) return steps_of_store(request);
  if (kind_by_format(request.inputs[0]) == InputKind::kCells) return steps_of_cells(request);
  std::vector<SliceStep> steps;
  for (VolumeInputStep& step : find_volume_steps(request.inputs, request.volume).steps) {
    steps.push_back(
        {step.time, steps.size(), std::move(step.name), step.input.path, std::move(step.input), {}});
  }
  return steps;
}

/// The steps that are asked for by their numbers; all where none are.
StepRange wanted_steps(const SliceRequest& request, std::size_t count) {
  if (request.step) {
    const std::uint64_t step = *request.step;
    if (step >= count)
      wrong_usage("--step: expected less than the {} steps of {}, found {}", count, request.inputs[0], step);
    return {static_cast<std::uint32_t>(step), static_cast<std::uint32_t>(step)};
  }
  if (!request.steps) return {0, static_cast<std::uint32_t>(count - 1)};
  check_steps(*request.steps, count, request.inputs[0]);
  return *request.steps;
}

/// Throws the Error that an option about steps is given for an input that is no series.
[[noreturn]] void refuse_series(const SliceRequest& request, const std::string& option) {
  const std::string input = request.inputs.empty() ? request.input.path.string() : request.inputs[0];
  wrong_usage(
      "{}: expected a series as INPUT (a .pvd, several files, a stored series, or a file with several "
      "times), found {}",
      option, input.empty() ? "none" : input);
}

/// All steps of a series of files; with `within` also those of the one file that is the input. Empty where
/// the input is no series.
std::vector<SliceStep> all_steps(const SliceRequest& request, bool within) {
  std::vector<SliceStep> steps;
  if (request.volume.stack) return steps;
  for (const SeriesEntry& entry : series_steps(request.inputs))
    steps.push_back({entry.time, steps.size(), entry.file, entry.file, request.volume, {}});
  if (!steps.empty() || !within || request.inputs.size() != 1) return steps;
  check_input_file(request.inputs[0]);
  steps = steps_within(request);
  if (steps.size() == 1) steps.clear();
  return steps;
}

}  // namespace

bool names_series(const std::string& output) {
  return is_film(output) || file_extension(output) == ".pvd" ||
         !numbered_name(std::filesystem::path(output).filename().string(), 0).empty();
}

SliceSteps find_slice_steps(const SliceRequest& request, const std::string& output) {
  if (request.step && request.steps) wrong_usage("--step and --steps: expected one of them");
  const bool several = names_series(output) || request.steps;
  const bool one_file = request.inputs.size() == 1 && !request.volume.stack;
  const auto of_cells = [&] { return one_file && kind_by_format(request.inputs[0]) == InputKind::kCells; };
  if (several && request.input.data.time && of_cells())
    wrong_usage("--time: expected one picture as output, found {}",
                request.steps ? std::string("--steps") : output);
  std::vector<SliceStep> steps = all_steps(request, several);
  if (steps.empty()) {
    if (several) refuse_series(request, request.steps ? "--steps" : "-o " + output);
    if (!request.step || (one_file && is_store(request.inputs[0]))) return {};
    const InputFormat* format = one_file ? find_format_by_name(request.inputs[0]) : nullptr;
    if (!of_cells() && (format == nullptr || !format->several_times)) refuse_series(request, "--step");
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

namespace adamas {

std::vector<SeriesEntry> slice_steps(const SliceRequest& request) {
  const std::vector<workflow::SliceStep> steps = workflow::all_steps(request, true);
  if (steps.empty()) workflow::refuse_series(request, "--steps");
  std::vector<SeriesEntry> entries;
  for (const workflow::SliceStep& step : steps) entries.push_back({step.time, step.name});
  return entries;
}

}  // namespace adamas
