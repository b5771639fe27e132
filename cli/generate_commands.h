#pragma once

#include "cli/command.h"

namespace adamas {

// The kinds of data that `adamas generate` makes, each in the file of its name.
void add_generate_scene(CLI::App& generate, Session& session);
void add_generate_impact(CLI::App& generate, Session& session);
void add_generate_buckyball(CLI::App& generate, Session& session);

}  // namespace adamas
