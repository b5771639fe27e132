#pragma once

#include <CLI/App.hpp>
#include <string>
#include <vector>

namespace adamas {

/// The pages of --help: lines of at most 100 columns, a command's own options before those that all have.
class HelpFormatter final : public CLI::Formatter {
 public:
  HelpFormatter();
  std::string make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const override;
  std::string make_option(const CLI::Option* option, bool is_positional) const override;
  std::string make_option_usage(const CLI::Option* option) const override;
};

/// "-o,--output FILE", "--ghost constant|linear", "INPUT".
std::string option_head(const CLI::Option& option, bool is_positional);
/// What an option does, what it is by default, and whether it is needed.
std::string option_text(const CLI::Option& option, bool is_positional);
/// The groups of a command's options, those that all commands have last.
std::vector<std::string> option_groups(const CLI::App& command);

}  // namespace adamas
