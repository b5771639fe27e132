#pragma once

#include <memory>
#include <string>

#include "cli/command.h"

namespace adamas::cli {

/// The whole command line, with all commands.
class CommandLine {
 public:
  /// The session has to outlive it.
  explicit CommandLine(Session& session);
  CommandLine(const CommandLine&) = delete;
  CommandLine& operator=(const CommandLine&) = delete;
  ~CommandLine();

  /// Sets the options and what the session runs. Returns false where the arguments ask for help or the
  /// version, which are on stdout then. Throws Error (kUsage) with one line "..., expected ..., found ...".
  bool parse(int argc, char** argv);
  /// The innermost command that was named, as "generate scene"; empty where none was.
  [[nodiscard]] std::string named_command() const;

 private:
  std::unique_ptr<CLI::App> app_;
  Session& session_;
};

}  // namespace adamas::cli
