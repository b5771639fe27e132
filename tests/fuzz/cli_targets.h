#pragma once

#include <CLI/CLI.hpp>
#include <sstream>

#include "cli/config_file.h"
#include "tests/fuzz/targets.h"

namespace adamas::fuzz {

/// The bytes are a file of options for a command that has single values, lists and flags.
inline void config_file(std::string_view bytes) {
  CLI::App app("fuzz", "fuzz");
  CLI::App* command = app.add_subcommand("mesh", "");
  app.add_subcommand("slice", "");
  std::string text;
  double number = 0;
  std::vector<std::string> list;
  bool flag = false;
  command->add_option("--dimensions", text, "");
  command->add_option("--error", number, "");
  command->add_option("--plane", list, "");
  command->add_flag("--tolerant", flag, "");
  app.parse("mesh", false);
  std::istringstream input{std::string(bytes)};
  try {
    for (const CLI::ConfigItem& item : adamas::cli::config_file(app)->from_config(input)) {
      const bool known = command->get_option_no_throw("--" + item.name) != nullptr ||
                         command->get_option_no_throw(item.name) != nullptr;
      require(known, "an option that the command has not");
    }
  } catch (const CLI::Error& error) {
    fail("{}", error.what());
  }
}

}  // namespace adamas::fuzz
