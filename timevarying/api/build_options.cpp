#include "timevarying/api/build_options.h"

#include <bit>

#include "core/base/error.h"

namespace adamas::timevarying {

using namespace isosurface;

namespace {

using Prediction = BuildOptions::Prediction;
using Smoothing = BuildOptions::Smoothing;

SampleCoding coding_of(Prediction prediction) {
  switch (prediction) {
    case Prediction::kSplitEdge:
      return SampleCoding::kSplitEdge;
    case Prediction::kNone:
      return SampleCoding::kPlain;
    case Prediction::kInterpolation:
      break;
  }
  return SampleCoding::kInterpolation;
}

const char* option_word(SampleCoding coding) {
  return coding == SampleCoding::kSplitEdge ? "split-edge" : "interpolation";
}

/// Sets how gradients are smoothed.
void set_smoothing(const BuildOptions& options, StoreOptions& store) {
  if (options.smoothing && !options.gradients)
    wrong_usage("--smoothing: expected with --gradients, which are what is smoothed");
  store.gradients = options.gradients;
  if (options.smoothing == Smoothing::kNone) store.smoothing.reset();
  if (options.smoothing == Smoothing::kFirstPhase) store.smoothing->constrained_rounds = 0;
  if (options.smooth_along_time) return;
  if (!options.gradients || !store.smoothing || !store.smoothing->is_along_time())
    wrong_usage("--no-time-smoothing: expected with --gradients that are smoothed by both phases");
  store.smoothing->time_rounds = 0;
}

}  // namespace

StoreOptions store_options(const BuildOptions& options) {
  StoreOptions store;
  store.coding = coding_of(options.prediction.value_or(Prediction::kInterpolation));
  set_smoothing(options, store);
  store.scratch = options.scratch;
  if (options.block_steps < 1 || options.block_steps > kMostBlockSteps)
    wrong_usage("--block-steps: expected from 1 to {}, found {}", kMostBlockSteps, options.block_steps);
  store.block_steps = options.block_steps;
  store.group_pages = options.group_pages.value_or(store.group_pages);
  if (store.group_pages > kMostGroupPages || !std::has_single_bit(store.group_pages))
    wrong_usage("--group-pages: expected a power of two from 1 to {}, found {}", kMostGroupPages,
                store.group_pages);
  return store;
}

void check_options_of_store(const BuildOptions& options, const StoreHeader& store, const std::string& name) {
  if (options.gradients && !store.gradients)
    wrong_usage("--gradients: expected none, since {} has none, found the option", name);
  if (options.group_pages && *options.group_pages != store.group_pages)
    wrong_usage("--group-pages: expected {}, as {} has, found {}", store.group_pages, name,
                *options.group_pages);
  if (!options.prediction || *options.prediction == Prediction::kNone) return;
  const SampleCoding found = coding_of_bytes(store.coding), asked = coding_of(*options.prediction);
  if (asked != found)
    wrong_usage("--coding: expected {}, as {} has, or none, found {}", option_word(found), name,
                option_word(asked));
}

BuildReport build_report(const StoreFigures& figures) {
  return {{figures.bytes.samples, figures.bytes.bounds, figures.bytes.gradients, figures.bytes.remainders},
          figures.pages,
          figures.file_bytes};
}

}  // namespace adamas::timevarying
