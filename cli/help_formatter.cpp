#include "cli/help_formatter.h"

#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <algorithm>
#include <cctype>
#include <sstream>

#include "cli/option_checks.h"

namespace adamas {

namespace {

constexpr std::size_t kLineWidth = 100;
constexpr std::size_t kTextColumn = 34;

std::string upper_case(std::string text) {
  for (char& c : text) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return text;
}

/// The text beside its name, or below where the name is long, broken between words.
std::string columns(const std::string& name, const std::string& text) {
  std::string result, line = "  " + name;
  if (line.size() + 1 >= kTextColumn) {
    result = line + "\n";
    line.clear();
  }
  line.resize(kTextColumn, ' ');
  std::istringstream words(text);
  bool first = true;
  for (std::string word; words >> word; first = false) {
    if (!first && line.size() + 1 + word.size() > kLineWidth) {
      result += line + "\n";
      line.assign(kTextColumn, ' ');
      first = true;
    }
    line += (first ? "" : " ") + word;
  }
  return result + line + "\n";
}

}  // namespace

std::string option_head(const CLI::Option& option, bool is_positional) {
  if (is_positional) return upper_case(option.get_name(true, false));
  std::string text = option.get_name(false, true);
  if (option.get_type_size() == 0) return text;
  const std::vector<std::string> words = choices(option);
  return text + " " + (words.empty() ? option.get_type_name() : CLI::detail::join(words, "|"));
}

std::string option_text(const CLI::Option& option, bool is_positional) {
  std::string text = option.get_description();
  const std::vector<std::string> words = choices(option);
  if (is_positional && !words.empty()) text += ": " + CLI::detail::join(words, ", ");
  if (!option.get_default_str().empty()) text += " (default " + option.get_default_str() + ")";
  if (option.get_required() && !is_positional) text += " (required)";
  return text;
}

std::vector<std::string> option_groups(const CLI::App& command) {
  std::vector<std::string> groups = command.get_groups();
  std::stable_partition(groups.begin(), groups.end(), [](const auto& group) { return group != "Common"; });
  return groups;
}

HelpFormatter::HelpFormatter() { column_width(kTextColumn); }

std::string HelpFormatter::make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const {
  std::string text = make_description(app) + make_usage(app, std::move(name)) + make_positionals(app);
  for (const std::string& group : option_groups(*app)) {
    const auto options = app->get_options([&group](const CLI::Option* option) {
      return option->get_group() == group && option->nonpositional();
    });
    if (!group.empty() && !options.empty()) text += make_group(group, false, options);
  }
  return text + make_subcommands(app, mode) + "\n" + make_footer(app);
}

std::string HelpFormatter::make_option(const CLI::Option* option, bool is_positional) const {
  return columns(option_head(*option, is_positional), option_text(*option, is_positional));
}

std::string HelpFormatter::make_option_usage(const CLI::Option* option) const {
  const std::string name = upper_case(option->get_name(true, false));
  return option->get_required() ? name : "[" + name + "]";
}

}  // namespace adamas
