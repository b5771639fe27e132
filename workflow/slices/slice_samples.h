#pragma once

#include <functional>
#include <string>

#include "adamas/slice_files.h"
#include "workflow/slices/slice_input.h"

namespace adamas::workflow {

/// The name of the one field of samples as data on a grid.
inline constexpr const char* kSampleField = "value";

/// The source of samples without materials.
enum class SampleOrigin { kNone, kStore, kVolume };

/// Finds out whether the input is a store, a volume according to the options, a file of one array of samples
/// that is no material's, or an image with oblique axes. Throws Error (kUsage) for options that contradict
/// the input.
SampleOrigin sample_origin(const SliceRequest& request);

/// Reads the samples that a plane's cross section depends on: those next to it along each axis, that is, the
/// layers on either side of a plane at right angles to an axis of the grid. A coarser LOD, which a note
/// names, is taken where there would be more samples than a picture shows. `field` names the array of an
/// image with several. `check` is called with the samples. Throws Error (kUsage) at options that samples do
/// not have, and Error where the plane does not cut them.
SliceInput load_samples(const SliceRequest& request, SampleOrigin origin, std::string& field,
                        const std::function<void(const SliceInput&)>& check, OutputSet& outputs,
                        Progress& progress);

}  // namespace adamas::workflow
