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
void add_volume_output(CLI::App& command, std::string& output);

/// Declares the file and, where its samples go to another, that one.
void declare_volume_output(const std::string& output, OutputSet& outputs);

/// Writes the declared files from planes, which `plane(k, samples)` fills in ascending order; returns their
/// bytes.
std::size_t write_volume_output(const std::string& output, const VolumeGrid& grid, const std::string& array,
                                const std::function<void(std::uint64_t, std::span<std::byte>)>& plane,
                                Session& session);

}  // namespace adamas
