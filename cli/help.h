#pragma once

#include <string>
#include <vector>

#include "cli/command.h"

namespace adamas::cli {

/// The name of the group of the common options.
inline constexpr const char* kCommonGroup = "Common";

/// Describes an option or a positional argument for --help, the manual page and the completion.
struct OptionDescription {
  std::string head;  ///< "-o,--output FILE", "--ghost constant|linear", "INPUT"
  std::string text;  ///< its meaning, its default, and whether it is needed
  std::vector<std::string> long_names, short_names;  ///< without their dashes
  std::vector<std::string> words;                    ///< the allowed values; empty where others are possible
  std::string group;                                 ///< the group; empty for a hidden option
  bool positional = false;
  bool takes_value = false;
};

struct CommandDescription {
  std::string name, description, footer;
  std::vector<OptionDescription> options;
  std::vector<CommandDescription> commands;

  /// Returns the groups of the options; the common options come last.
  [[nodiscard]] std::vector<std::string> groups() const;
};

OptionDescription describe(const CLI::Option& option);
/// Describes a command with its options and all its subcommands.
CommandDescription describe(const Command& command);

/// Sets the layout of --help: lines of at most 100 columns, and a command's own options before the common
/// ones. It applies also to commands that are added later.
void lay_out_help(const Command& root);

}  // namespace adamas::cli
