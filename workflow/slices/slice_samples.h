#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>

#include "adamas/slice_files.h"
#include "isosurface/storage/store_file.h"
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

/// Reads the samples that a plane's cross section depends on, of a step of an open store: those next to it
/// along each axis, that is, the layers on either side of a plane at right angles to an axis of the grid. A
/// coarser LOD, which a note names, is taken where there would be more samples than a picture shows.
/// `memory`: the number of bytes that decoded pages may take. Throws Error where the plane does not cut the
/// samples.
SliceInput store_samples(isosurface::StoreFile& file, std::uint32_t step, std::size_t memory,
                         const Plane& plane, Progress& progress);
/// Takes such samples of a volume in memory, which has as many as its grid; `name` is for messages.
SliceInput volume_samples(const std::string& name, const Volume& volume, const Plane& plane,
                          Progress& progress);

/// Reads such samples of the input of a request. `field` names the array of an image with several. `check` is
/// called with the samples. Throws Error (kUsage) at options that samples do not have, and Error where the
/// plane does not cut them.
SliceInput load_samples(const SliceRequest& request, SampleOrigin origin, std::string& field,
                        const std::function<void(const SliceInput&)>& check, OutputSet& outputs,
                        Progress& progress);

}  // namespace adamas::workflow
