#pragma once

#include <CLI/App.hpp>
#include <span>
#include <string>

namespace adamas {

/// The innermost command that was named, as "generate scene"; empty where none was.
std::string named_command(const CLI::App& app);

/// What is wrong with a command line, as "expected ..., found ..." instead of CLI11's own words. `arguments`
/// are those of the program.
std::string usage_message(const CLI::ParseError& error, const CLI::App& app,
                          std::span<char* const> arguments);

}  // namespace adamas
