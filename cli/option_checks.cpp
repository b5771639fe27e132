#include "cli/option_checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

namespace adamas {

namespace {

/// "a, b or c".
std::string listed(const std::vector<std::string>& words) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i) {
    text += (i == 0 ? "" : i + 1 == words.size() ? " or " : ", ") + words[i];
  }
  return text;
}

bool looks_like_option(const std::string& text) {
  return text.starts_with("--") ||
         (text.size() > 1 && text[0] == '-' && std::isalpha(static_cast<unsigned char>(text[1])) != 0);
}

/// The description is empty so that the type's name in the help stays what it is.
CLI::Validator not_empty() {
  return {[](std::string& value) { return value.empty() ? "expected a value, found an empty one" : ""; }, ""};
}

CLI::Validator no_option() {
  return {[](std::string& value) {
            return looks_like_option(value) ? fmt::format("expected a value, found the option '{}'", value)
                                            : std::string();
          },
          ""};
}

}  // namespace

CLI::Validator one_of(const std::vector<std::string>& words) {
  return {[words](std::string& value) {
            return std::find(words.begin(), words.end(), value) != words.end()
                       ? std::string()
                       : fmt::format("expected {}, found '{}'", listed(words), value);
          },
          "{" + fmt::format("{}", fmt::join(words, ",")) + "}"};
}

std::vector<std::string> choices(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  const std::size_t open = type.find('{'), close = type.find('}');
  if (open == std::string::npos || close == std::string::npos) return {};
  return CLI::detail::split(type.substr(open + 1, close - open - 1), ',');
}

void add_common_checks(CLI::App& command) {
  for (CLI::Option* option : command.get_options()) {
    if (option->get_type_size() == 0) continue;  // a flag
    const std::string type = option->get_type_name();
    if (type.find("FILE") != std::string::npos || type.find("NAME") != std::string::npos) {
      option->check(no_option());
    }
    option->check(not_empty());
  }
  for (CLI::App* inner : command.get_subcommands([](CLI::App*) { return true; })) add_common_checks(*inner);
}

}  // namespace adamas
