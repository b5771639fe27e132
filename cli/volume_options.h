#pragma once

#include <string>
#include <utility>
#include <vector>

#include "adamas/volume.h"
#include "adamas/volume_input.h"
#include "cli/command.h"

namespace adamas::cli {

/// Adds the options that say what files of bare samples hold. `origin`: the names of that for the first
/// sample; `subject`: what spacing and places are of.
void add_raw_options(const Command& command, RawOptions& options, const char* origin, const char* subject);

/// Adds the options that say what a volume is read from. `origin`: the names of that for the first sample.
void add_volume_options(const Command& command, VolumeInput& input, const char* origin);

/// Adds the option -o of a command that makes a volume.
void add_volume_output(const Command& command, std::string& output);

/// The types of samples that are made, by name: uint8, uint16 and float32.
std::vector<std::pair<std::string, SampleType>> made_types();

}  // namespace adamas::cli
