#include "cli/growing_store.h"

#include <cmath>
#include <utility>

#include "cli/figures.h"
#include "cli/usage.h"

namespace adamas::cli {

using namespace interfaces;
using namespace io;
using namespace isosurface;
using namespace timevarying;

namespace {

const char* option_word(SampleCoding coding) {
  return coding == SampleCoding::kSplitEdge ? "split-edge" : "interpolation";
}

/// Whether these are 0, 1, 2 and so on.
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
  has_ = {coding_of_bytes(file.header().coding), file.header().group_pages, file.header().gradients};
}

void GrowingStore::check(const AskedOfStore& asked) const {
  if (asked.gradients && !has_.gradients)
    wrong_usage("--gradients: expected none, since {} has none, found the option", path_);
  if (asked.group_pages && asked.group_pages != has_.group_pages)
    wrong_usage("--group-pages: expected {}, as {} has, found {}", *has_.group_pages, path_,
                *asked.group_pages);
  if (asked.coding && *asked.coding != SampleCoding::kPlain && asked.coding != has_.coding)
    wrong_usage("--coding: expected {}, as {} has, or none, found {}", option_word(*has_.coding), path_,
                option_word(*asked.coding));
}

std::vector<InputStep> GrowingStore::later_steps(InputSteps input, const std::string& name,
                                                 Session& session) const {
  if (input.times != StepTimes::kAbsolute) return behind(std::move(input), name, session);
  const std::size_t given = input.steps.size();
  std::erase_if(input.steps, [this](const InputStep& step) { return step.time <= times_.back(); });
  const std::size_t left_out = given - input.steps.size();
  if (left_out > 0)
    session.console.note("{}: {} of {} not later than the last one of {}, at {}{}", name, left_out,
                         given == 1 ? "1 step is" : fmt::format("{} steps are", given), path_, times_.back(),
                         left_out == given ? ": nothing is added" : "");
  return std::move(input.steps);
}

std::vector<InputStep> GrowingStore::behind(InputSteps input, const std::string& name,
                                            Session& session) const {
  std::vector<InputStep>& steps = input.steps;
  const double last = times_.back();
  const bool spaced = input.times == StepTimes::kSpaced;
  const double first = spaced ? last + steps[1].time - steps[0].time : std::floor(last) + 1;
  for (InputStep& step : steps) step.time += first;
  if (steps.size() > 1 || !are_counted(times_)) {
    const std::string taken = steps.size() == 1 ? fmt::format("1 step, taken to be at {}", first)
                                                : fmt::format("{} steps, taken to be at {} to {}",
                                                              steps.size(), first, steps.back().time);
    session.console.note("{}: {}: {}, behind the last one of {} at {}", name,
                         spaced ? "a time between steps but none of the first" : "no times", taken, path_,
                         last);
  }
  return std::move(steps);
}

StoreFigures GrowingStore::add(StoredSteps& steps, const StoreOptions& options, Session& session) {
  const auto keep = [&] {
    const std::uint32_t added = StoreFile(path_).steps() - this->steps();
    session.kept = fmt::format("{} of {} were added", added, counted(steps.count(), "step"));
  };
  try {
    const StoreFigures figures = append_series(lock_, steps.source(), options, session.console);
    keep();
    return figures;
  } catch (...) {
    keep();
    throw;
  }
}

}  // namespace adamas::cli
