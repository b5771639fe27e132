#pragma once

#include <functional>
#include <string>

#include "cli/command.h"
#include "cli/slice_input.h"
#include "cli/volume_input.h"

namespace adamas {

/// Where samples that know no materials come from.
enum class SampleOrigin { kNone, kStore, kVolume };

/// A store, what the options say is a volume, a file of one array of samples that is no material's, or an
/// image whose axes run aslant; `original`: the option of that name.
SampleOrigin sample_origin(const InputOptions& input, const VolumeInput& volume, const std::string& original);

/// The samples round the plane, `field` naming the array of an image that has several. `check` looks at what
/// was read. Throws UsageError at options that they do not know, and Error where the plane does not cut them.
SliceInput load_samples(const InputOptions& input, VolumeInput volume, SampleOrigin origin,
                        std::string& field, const Plane& plane,
                        const std::function<void(const SliceInput&)>& check, Session& session);

}  // namespace adamas
