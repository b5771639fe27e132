#pragma once

#include <string>
#include <vector>

#include "cli/command.h"

namespace adamas::cli {

/// The name of the group of the options that all commands have.
inline constexpr const char* kCommonGroup = "Common";

/// What --help, the manual page and the completion tell of an option or of a positional argument.
struct OptionDescription {
  std::string head;  ///< "-o,--output FILE", "--ghost constant|linear", "INPUT"
  std::string text;  ///< what it does, what it is by default, and whether it is needed
  std::vector<std::string> long_names, short_names;  ///< without their dashes
  std::vector<std::string> words;                    ///< the only values; empty where others are possible
  std::string group;                                 ///< empty for one that is not told of
  bool positional = false;
  bool takes_value = false;
};

struct CommandDescription {
  std::string name, description, footer;
  std::vector<OptionDescription> options;
  std::vector<CommandDescription> commands;

  /// The groups of the options, those that all commands have last.
  [[nodiscard]] std::vector<std::string> groups() const;
};

OptionDescription describe(const CLI::Option& option);
/// The command with its options and all commands below it.
CommandDescription describe(const Command& command);

/// The pages of --help get lines of at most 100 columns, and a command's own options come before those that
/// all have; so for the commands that are added later.
void lay_out_help(const Command& root);

}  // namespace adamas::cli
