#pragma once

#include <functional>
#include <string>

#include "adamas/slice_files.h"
#include "workflow/slices/slice_input.h"

namespace adamas::workflow {

/// The name of the one field of samples as data on a grid.
inline constexpr const char* kSampleField = "value";

/// Where samples without materials come from.
enum class SampleOrigin { kNone, kStore, kVolume };

/// Finds out whether the input is a store, what the options say is a volume, a file of one array of samples
/// that is no material's, or an image whose axes run aslant. Throws Error (kUsage) for options that
/// contradict the input.
SampleOrigin sample_origin(const SliceRequest& request);

/// Reads the samples that a plane's cross section depends on: those next to it along each axis, so of a plane
/// at right angles to an axis of the grid the layers on either side of it; of a coarser LOD where there would
/// be more than a picture shows, which a note says. `field` names the array of an image that has several.
/// `check` looks at what was read. Throws Error (kUsage) at options that they do not know, and Error where
/// the plane does not cut them.
SliceInput load_samples(const SliceRequest& request, SampleOrigin origin, std::string& field,
                        const std::function<void(const SliceInput&)>& check, OutputSet& outputs,
                        Progress& progress);

}  // namespace adamas::workflow
