#pragma once

#include <CLI/App.hpp>
#include <string>
#include <vector>

namespace adamas {

/// One of these words.
CLI::Validator one_of(const std::vector<std::string>& words);
/// The words of one_of that an option takes; empty for others.
std::vector<std::string> choices(const CLI::Option& option);

/// Gives all options of a command and of those below it the checks that they have in common: no value is
/// empty, and no file or name is another option, whose own value would then be lost.
void add_common_checks(CLI::App& command);

}  // namespace adamas
