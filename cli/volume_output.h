#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>

#include "cli/command.h"
#include "core/data/volume.h"

namespace adamas {

/// The option -o of a command that makes a volume.
void add_volume_output(const Command& command, std::string& output);

/// Declares the file and, where its samples go to another, that one.
void declare_volume_output(const std::string& output, OutputSet& outputs);

/// Takes one plane after another.
using PlaneSink = std::function<void(std::span<const std::byte>)>;

/// Writes the declared files from the planes that `make(sink)` gives in ascending order; returns their bytes.
std::size_t write_volume_output(const std::string& output, const VolumeGrid& grid, const std::string& array,
                                const std::function<void(const PlaneSink&)>& make, Session& session);

}  // namespace adamas
