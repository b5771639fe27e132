#include "cli/config_file.h"

#include <CLI/Config.hpp>
#include <string>
#include <vector>

namespace adamas {

namespace {

/// The innermost subcommand that the command line named, and the names that lead to it.
CLI::App& chosen(CLI::App& app, std::vector<std::string>& names) {
  const auto parsed = app.get_subcommands();
  if (parsed.empty()) return app;
  names.push_back(parsed.front()->get_name());
  return chosen(*parsed.front(), names);
}

bool names_command(CLI::App& root, const std::vector<std::string>& names) {
  CLI::App* app = &root;
  for (const std::string& name : names) {
    const auto found = app->get_subcommands([&name](CLI::App* sub) { return sub->get_name() == name; });
    if (found.empty()) return false;
    app = found.front();
  }
  return true;
}

}  // namespace

std::vector<CLI::ConfigItem> ConfigFile::from_config(std::istream& input) const {
  std::vector<std::string> names;
  CLI::App& command = chosen(root_, names);
  std::vector<CLI::ConfigItem> result;
  for (CLI::ConfigItem& item : CLI::ConfigBase::from_config(input)) {
    if (item.name == "++" || item.name == "--") continue;
    if (item.parents.empty()) item.parents = names;
    if (item.parents != names) {
      if (names_command(root_, item.parents)) continue;
      throw CLI::ConfigError("--config: expected sections named as commands, found '" +
                                 CLI::detail::join(item.parents, ".") + "'",
                             CLI::ExitCodes::ConfigError);
    }
    const CLI::Option* option = command.get_option_no_throw("--" + item.name);
    if (option == nullptr) option = command.get_option_no_throw(item.name);
    if (option == nullptr || !option->get_configurable()) {
      throw CLI::ConfigError("--config: expected options of adamas " + CLI::detail::join(names, " ") +
                                 ", found '" + item.name + "'",
                             CLI::ExitCodes::ConfigError);
    }
    // "4,4,4" is one value to us.
    if (option->get_items_expected_max() == 1) item.inputs = {CLI::detail::join(item.inputs, ",")};
    result.push_back(std::move(item));
  }
  return result;
}

}  // namespace adamas
