#pragma once

#include <CLI/App.hpp>
#include <filesystem>
#include <string>

#include "cli/command.h"
#include "core/io/volume_reader.h"

namespace adamas {

/// The options that say which volume is the input and, where the file does not, what it holds.
struct VolumeInput {
  std::string path;
  bool stack = false;
  std::string array, scratch;
  std::string dimensions, type, spacing, origin, endian, header_bytes;
};

void add_volume_input(CLI::App& command, VolumeInput& input);

/// Opens it. Throws UsageError where options do not go together.
VolumeReader open_volume_input(const VolumeInput& input, Session& session);

}  // namespace adamas
