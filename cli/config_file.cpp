#include "cli/config_file.h"

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <sstream>
#include <string>
#include <vector>

namespace adamas::cli {

namespace {

/// Returns the innermost subcommand that the command line named; `names` gets the names that lead to it.
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

[[noreturn]] void refuse(const std::string& message) {
  throw CLI::ConfigError("--config: " + message, CLI::ExitCodes::ConfigError);
}

/// Returns the content of a file. An endless one, as /dev/zero, is refused before it fills the memory.
std::string whole_text(std::istream& input) {
  constexpr std::size_t kMost = std::size_t{1} << 20;
  std::string text(kMost + 1, '\0');
  input.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (input.bad()) refuse("expected a file that can be read whole, found an error in it");
  text.resize(static_cast<std::size_t>(input.gcount()));
  if (text.size() > kMost) refuse("expected a file of at most 1048576 bytes, found more");
  return text;
}

/// Throws for lines that CLI11 would ignore: those too short for a name and a value, and names that are its
/// own marks.
void check_line(const std::string& line) {
  const std::string text = CLI::detail::trim_copy(line.substr(0, line.find('#')));
  if (text.empty() || text[0] == ';' || (text[0] == '[' && text.size() > 2)) return;
  std::string name = CLI::detail::trim_copy(text.substr(0, text.find('=')));
  CLI::detail::remove_quotes(name);
  if (text.size() < 3 || name.empty() || name == "--" || name == "++")
    refuse("expected lines NAME = VALUE, found '" + text + "'");
}

/// Returns the line without its comment. The number of brackets that it opens and does not close is added to
/// `depth`.
std::string array_part(const std::string& line, int& depth) {
  char quote = 0;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (quote != 0) {
      if (c == quote) quote = 0;
    } else if (c == '"' || c == '\'') {
      quote = c;
    } else if (c == '#') {
      return line.substr(0, i);
    } else if (c == '[' || c == ']') {
      depth += c == '[' ? 1 : -1;
    }
  }
  return line;
}

/// Returns the text with each array of TOML on one line, since CLI11 reads line by line.
std::string with_arrays_in_lines(std::istream& input) {
  std::string result, line;
  int depth = 0;
  while (std::getline(input, line)) {
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (depth == 0) check_line(line);
    const std::size_t first = line.find_first_not_of(" \t");
    const bool comment = first != std::string::npos && (line[first] == '#' || line[first] == ';');
    const std::size_t equals = comment ? std::string::npos : line.find('=');
    const std::size_t value =
        equals == std::string::npos ? equals : line.find_first_not_of(" \t", equals + 1);
    const bool starts = value != std::string::npos && line[value] == '[';
    if (starts || depth > 0) line = array_part(line, depth);
    result += line;
    result += depth > 0 ? ' ' : '\n';
  }
  if (depth > 0) refuse("expected ']' at the end of an array, found the end of the file");
  return result;
}

class ConfigFile final : public CLI::ConfigBase {
 public:
  explicit ConfigFile(CLI::App& root) : root_(root) {}
  std::vector<CLI::ConfigItem> from_config(std::istream& input) const override;

 private:
  CLI::App& root_;
};

std::vector<CLI::ConfigItem> ConfigFile::from_config(std::istream& input) const {
  std::istringstream text(whole_text(input));
  std::istringstream lines(with_arrays_in_lines(text));
  std::vector<std::string> names;
  CLI::App& command = chosen(root_, names);
  std::vector<CLI::ConfigItem> result;
  for (CLI::ConfigItem& item : CLI::ConfigBase::from_config(lines)) {
    if (item.name == "++" || item.name == "--") continue;
    if (item.parents.empty()) item.parents = names;
    if (item.parents != names) {
      if (names_command(root_, item.parents)) continue;
      refuse("expected sections named as commands, found '" + CLI::detail::join(item.parents, ".") + "'");
    }
    const CLI::Option* option = command.get_option_no_throw("--" + item.name);
    if (option == nullptr) option = command.get_option_no_throw(item.name);
    if (option == nullptr || !option->get_configurable()) {
      refuse("expected options of adamas " + CLI::detail::join(names, " ") + ", found '" + item.name + "'");
    }
    // CLI11 splits "4,4,4" at its commas, but our options regard it as one value.
    if (option->get_items_expected_max() == 1) item.inputs = {CLI::detail::join(item.inputs, ",")};
    result.push_back(std::move(item));
  }
  return result;
}

}  // namespace

std::shared_ptr<CLI::Config> config_file(CLI::App& root) { return std::make_shared<ConfigFile>(root); }

}  // namespace adamas::cli
