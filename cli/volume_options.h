#pragma once

#include <string>
#include <vector>

#include "adamas/volume.h"
#include "adamas/volume_input.h"
#include "cli/command.h"
#include "cli/raw_options.h"

namespace adamas::cli {

/// Adds the options that say what a volume is read from. `origin`: the option names for the first sample.
void add_volume_options(const Command& command, VolumeInput& input, const char* origin);

/// Adds the option -o of a command that makes a volume.
void add_volume_output(const Command& command, std::string& output);

/// Returns the names of the sample types that can be made: uint8, uint16 and float32.
std::vector<std::string> sample_type_names();
/// Adds the option --type of a command that makes samples.
CommandOption add_sample_type(const Command& command, std::string& type, const std::string& description);
/// Returns the type of a name that the option allows.
SampleType parse_sample_type(const std::string& name);

}  // namespace adamas::cli
