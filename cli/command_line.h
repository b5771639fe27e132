#pragma once

#include <memory>
#include <string>

#include "cli/command.h"

namespace adamas::cli {

/// The whole command line, with all commands.
class CommandLine {
 public:
  /// Adds all commands. The session has to outlive this object.
  explicit CommandLine(Session& session);
  CommandLine(const CommandLine&) = delete;
  CommandLine& operator=(const CommandLine&) = delete;
  ~CommandLine();

  /// Sets the options and the function that the session runs. Returns false where the arguments ask for help
  /// or the version, which are printed on stdout then. Throws Error (kUsage) with one line "..., expected
  /// ..., found ...".
  bool parse(int argc, char** argv);
  /// Returns the innermost command that was named, as "generate scene"; empty where none was named.
  [[nodiscard]] std::string named_command() const;

 private:
  std::unique_ptr<CLI::App> app_;
  Session& session_;
};

}  // namespace adamas::cli
