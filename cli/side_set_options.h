#pragma once

#include <string>

#include "adamas/input.h"
#include "cli/command.h"

namespace adamas::cli {

/// Adds --side-sets, the file of the surfaces of side sets and node sets.
void add_side_sets_option(const Command& command, std::string& file);
void declare_side_sets(const std::string& file, Session& session);
/// Writes the surfaces of the sets of an input, unless `file` is empty. Throws Error (kUsage) where the input
/// has none.
void write_side_sets(const std::string& file, const Input& input, Session& session);

}  // namespace adamas::cli
