#pragma once

#include <CLI/App.hpp>

namespace adamas {

/// Reads files of `--config`: lines "NAME = VALUE" are options of the command that is run; those in a section
/// "[COMMAND]" are for that command alone, so that one file can serve several. Throws CLI::ConfigError at
/// names that the command has not.
class ConfigFile final : public CLI::ConfigBase {
 public:
  explicit ConfigFile(CLI::App& root) : root_(root) {}
  std::vector<CLI::ConfigItem> from_config(std::istream& input) const override;

 private:
  CLI::App& root_;
};

}  // namespace adamas
