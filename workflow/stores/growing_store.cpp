#include "workflow/stores/growing_store.h"

#include <cmath>
#include <utility>

#include "core/base/error.h"
#include "core/base/notes.h"
#include "timevarying/api/build_options.h"

namespace adamas::workflow {

using namespace isosurface;
using namespace timevarying;

namespace {

/// Returns whether the times are 0, 1, 2 and so on.
bool are_counted(const std::vector<double>& times) {
  for (std::size_t n = 0; n < times.size(); ++n) {
    if (times[n] != static_cast<double>(n)) return false;
  }
  return true;
}

}  // namespace

GrowingStore::GrowingStore(const std::string& path) : path_(path), lock_(path) {
  const StoreFile file(path);
  grid_ = file.header().grid;
  times_ = file.times();
  bytes_ = file.last_root().end();
  header_ = file.header();
}

void GrowingStore::check(const BuildOptions& options) const {
  check_options_of_store(options, header_, path_);
}

std::vector<VolumeInputStep> GrowingStore::later_steps(VolumeInputSteps input, const std::string& name,
                                                       Progress& progress) const {
  if (input.times != StepTimes::kAbsolute) return behind(std::move(input), name, progress);
  const std::size_t given = input.steps.size();
  std::erase_if(input.steps, [this](const VolumeInputStep& step) { return step.time <= times_.back(); });
  const std::size_t left_out = given - input.steps.size();
  if (left_out > 0)
    note(progress, "{}: {} of {} not later than the last one of {}, at {}{}", name, left_out,
         given == 1 ? "1 step is" : fmt::format("{} steps are", given), path_, times_.back(),
         left_out == given ? ": nothing is added" : "");
  return std::move(input.steps);
}

std::vector<VolumeInputStep> GrowingStore::behind(VolumeInputSteps input, const std::string& name,
                                                  Progress& progress) const {
  std::vector<VolumeInputStep>& steps = input.steps;
  const double last = times_.back();
  const bool spaced = input.times == StepTimes::kSpaced;
  const double first = spaced ? last + steps[1].time - steps[0].time : std::floor(last) + 1;
  for (VolumeInputStep& step : steps) step.time += first;
  if (steps.size() > 1 || !are_counted(times_)) {
    const std::string taken = steps.size() == 1 ? fmt::format("1 step, taken to be at {}", first)
                                                : fmt::format("{} steps, taken to be at {} to {}",
                                                              steps.size(), first, steps.back().time);
    note(progress, "{}: {}: {}, behind the last one of {} at {}", name,
         spaced ? "a time between steps but none of the first" : "no times", taken, path_, last);
  }
  return std::move(steps);
}

StoreFigures GrowingStore::add(StoredSteps& steps, const StoreOptions& options,
                               const std::function<void(std::uint32_t, std::size_t)>& added,
                               Progress& progress) {
  const auto report_steps = [&] {
    if (added) added(StoreFile(path_).steps() - this->steps(), steps.count());
  };
  try {
    const StoreFigures figures = append_series(lock_, steps.source(), options, progress);
    report_steps();
    return figures;
  } catch (...) {
    report_steps();
    throw;
  }
}

}  // namespace adamas::workflow
