#pragma once

#include <memory>

namespace CLI {  // NOLINT(readability-identifier-naming): the names are those of CLI11
class App;
class Config;
}  // namespace CLI

namespace adamas::cli {

/// Makes a reader of files of `--config`: lines "NAME = VALUE" are options of the command that is run; those
/// in a section "[COMMAND]" are for that command alone, so that one file can serve several. It throws
/// CLI::ConfigError at names that the command does not have. `root` is the whole command line and has to
/// outlive the result.
std::shared_ptr<CLI::Config> config_file(CLI::App& root);

}  // namespace adamas::cli
