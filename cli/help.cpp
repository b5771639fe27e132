#include "cli/help.h"

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <algorithm>
#include <cctype>
#include <memory>
#include <sstream>

namespace adamas::cli {

namespace {

constexpr std::size_t kLineWidth = 100;
constexpr std::size_t kTextColumn = 34;

std::string upper_case(std::string text) {
  for (char& c : text) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return text;
}

/// Returns the name in a column and the text in the next one, broken between words; the text is below a long
/// name.
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

/// Returns the words of CommandOption::one_of(), whose check describes itself as "{a,b}"; empty for other
/// options.
std::vector<std::string> words_of(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  const std::size_t open = type.find('{'), close = type.find('}');
  if (open == std::string::npos || close == std::string::npos) return {};
  return CLI::detail::split(type.substr(open + 1, close - open - 1), ',');
}

std::string head(const CLI::Option& option, const std::vector<std::string>& words) {
  if (option.get_positional()) return upper_case(option.get_name(true, false));
  const std::string names = option.get_name(false, true);
  if (option.get_type_size() == 0) return names;
  return names + " " + (words.empty() ? option.get_type_name() : CLI::detail::join(words, "|"));
}

std::string text(const CLI::Option& option, const std::vector<std::string>& words) {
  const bool positional = option.get_positional();
  std::string text = option.get_description();
  if (positional && !words.empty()) text += ": " + CLI::detail::join(words, ", ");
  if (!option.get_default_str().empty()) text += " (default " + option.get_default_str() + ")";
  if (option.get_required() && !positional) text += " (required)";
  return text;
}

CommandDescription describe_all(const CLI::App& app) {
  CommandDescription result{app.get_name(), app.get_description(), app.get_footer(), {}, {}};
  for (const CLI::Option* option : app.get_options()) result.options.push_back(describe(*option));
  for (const CLI::App* inner : app.get_subcommands([](const CLI::App*) { return true; })) {
    result.commands.push_back(describe_all(*inner));
  }
  return result;
}

class HelpFormatter final : public CLI::Formatter {
 public:
  HelpFormatter() { column_width(kTextColumn); }

  std::string make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const override {
    std::string text = make_description(app) + make_usage(app, std::move(name)) + make_positionals(app);
    for (const std::string& group : describe_all(*app).groups()) {
      const auto options = app->get_options([&group](const CLI::Option* option) {
        return option->get_group() == group && option->nonpositional();
      });
      if (!group.empty() && !options.empty()) text += make_group(group, false, options);
    }
    return text + make_subcommands(app, mode) + "\n" + make_footer(app);
  }

  std::string make_option(const CLI::Option* option, bool /*is_positional*/) const override {
    const OptionDescription description = describe(*option);
    return columns(description.head, description.text);
  }

  std::string make_option_usage(const CLI::Option* option) const override {
    const std::string name = upper_case(option->get_name(true, false));
    return option->get_required() ? name : "[" + name + "]";
  }
};

}  // namespace

std::vector<std::string> CommandDescription::groups() const {
  std::vector<std::string> result;
  for (const OptionDescription& option : options) {
    if (std::find(result.begin(), result.end(), option.group) == result.end()) result.push_back(option.group);
  }
  std::stable_partition(result.begin(), result.end(),
                        [](const std::string& group) { return group != kCommonGroup; });
  return result;
}

OptionDescription describe(const CLI::Option& option) {
  const std::vector<std::string> words = words_of(option);
  return {
      head(option, words), text(option, words),     option.get_lnames(),        option.get_snames(), words,
      option.get_group(),  option.get_positional(), option.get_type_size() != 0};
}

CommandDescription describe(const Command& command) { return describe_all(command.app()); }

void lay_out_help(const Command& root) { root.app().formatter(std::make_shared<HelpFormatter>()); }

}  // namespace adamas::cli
