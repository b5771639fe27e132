#pragma once

#include <memory>

namespace CLI {  // NOLINT(readability-identifier-naming): it is that library's
class App;
class Config;
}  // namespace CLI

namespace adamas::cli {

/// Reads files of `--config`: lines "NAME = VALUE" are options of the command that is run; those in a section
/// "[COMMAND]" are for that command alone, so that one file can serve several. Throws CLI::ConfigError at
/// names that the command has not. `root` is the whole command line and has to outlive the result.
std::shared_ptr<CLI::Config> config_file(CLI::App& root);

}  // namespace adamas::cli
