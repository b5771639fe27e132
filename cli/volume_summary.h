#pragma once

#include <optional>
#include <string>

#include "cli/command.h"
#include "cli/figures.h"
#include "cli/input_options.h"
#include "cli/volume_input.h"

namespace adamas {

/// The volume that a file is, if it is to be read as one: where the options say so, and where no other reader
/// knows it or all that it may say of places.
std::optional<VolumeReader> find_volume(const InputOptions& input, VolumeInput volume, Session& session);

/// What is in a volume, which is read plane by plane.
Figures print_volume(VolumeReader reader, const std::string& path, Session& session);

}  // namespace adamas
