#include "cli/usage_message.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <string_view>
#include <vector>

namespace adamas {

namespace {

const CLI::App& innermost_of(const CLI::App& app) {
  const auto parsed = app.get_subcommands();
  return parsed.empty() ? app : innermost_of(*parsed.front());
}

/// Letters to insert, delete or change on the way from one word to the other (Levenshtein).
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t change = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({row[j] + 1, row[j + 1] + 1, change});
    }
  }
  return row[b.size()];
}

/// " (did you mean X?)" for the word nearest to what was found, unless all are far.
std::string suggestion(const std::string& found, const std::vector<std::string>& words) {
  std::size_t least = std::max<std::size_t>(found.size() / 3, 1) + 1;
  std::string nearest;
  for (const std::string& word : words) {
    const std::size_t distance = edit_distance(found, word);
    if (distance < least) least = distance, nearest = word;
  }
  return nearest.empty() ? nearest : fmt::format(" (did you mean {}?)", nearest);
}

std::string expected_command(const CLI::App& app) {
  std::string known;
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    names.push_back(command->get_name());
    known += (known.empty() ? "" : ", ") + names.back();
  }
  const auto rest = app.remaining();
  if (rest.empty()) return fmt::format("expected one of {}, found none", known);
  return fmt::format("expected one of {}, found '{}'{}", known, rest.front(),
                     suggestion(rest.front(), names));
}

/// Of several things too many, the first that looks like an option: what follows may have been its value.
std::string unexpected(const CLI::App& app, const std::string& command) {
  const auto rest = app.remaining();
  const auto is_option = [](const std::string& word) { return word.size() > 1 && word[0] == '-'; };
  const auto option = std::find_if(rest.begin(), rest.end(), is_option);
  if (option == rest.end()) {
    return fmt::format("expected no more arguments, found '{}'", rest.empty() ? "" : rest.front());
  }
  const std::string name = option->substr(0, option->find('='));
  std::vector<std::string> names;
  for (const CLI::Option* known : app.get_options()) {
    for (const std::string& long_name : known->get_lnames()) names.push_back("--" + long_name);
  }
  return fmt::format("expected an option of 'adamas{}', found '{}'{}", command.empty() ? "" : " " + command,
                     name, suggestion(name, names));
}

/// What an option is followed by on the command line; empty where it is the last.
std::string follower(const CLI::Option& option, std::span<char* const> arguments) {
  for (std::size_t i = 0; i + 1 < arguments.size(); ++i) {
    const std::string_view word = arguments[i];
    if (word.starts_with("--") ? option.check_lname(std::string(word.substr(2)))
                               : word.starts_with("-") && option.check_sname(std::string(word.substr(1)))) {
      return arguments[i + 1];
    }
  }
  return {};
}

std::string upper_case(std::string text) {
  for (char& c : text) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return text;
}

/// A missing value, or several where one is expected.
std::string mismatch(const CLI::Option& option, std::span<char* const> arguments) {
  const std::string name = option.get_name();
  std::string found;
  for (const std::string& value : option.results()) found += (found.empty() ? "'" : ", '") + value + "'";
  if (option.results().size() > 1) return fmt::format("{}: expected one value, found {}", name, found);
  const std::string next = follower(option, arguments);
  const std::string expected = fmt::format("{}: expected a value {}", name, option.get_type_name());
  if (next.empty()) return expected + ", found none";
  return fmt::format("{}, found '{}' (a value that begins with '-' is written {}={})", expected, next, name,
                     next);
}

std::string missing(const CLI::Option& option) {
  if (option.get_positional()) return fmt::format("expected {}, found none", upper_case(option.get_name()));
  return fmt::format("expected {} {}, found none", option.get_name(false, true), option.get_type_name());
}

/// The option that CLI11's message begins with.
const CLI::Option* subject(const CLI::App& app, const std::string& message) {
  for (const CLI::Option* option : app.get_options()) {
    const std::string name = option->get_name();
    if (message.starts_with(name) && message.find_first_of(": ", name.size()) == name.size()) return option;
  }
  return nullptr;
}

template <class Kind>
bool is(const CLI::ParseError& error) {
  return dynamic_cast<const Kind*>(&error) != nullptr;
}

}  // namespace

std::string named_command(const CLI::App& app) {
  const auto parsed = app.get_subcommands();
  if (parsed.empty()) return {};
  const std::string inner = named_command(*parsed.front());
  return parsed.front()->get_name() + (inner.empty() ? "" : " " + inner);
}

std::string usage_message(const CLI::ParseError& error, const CLI::App& app,
                          std::span<char* const> arguments) {
  const CLI::App& command = innermost_of(app);
  const std::string message = error.what();
  if (is<CLI::RequiredError>(error) && command.get_require_subcommand_min() > 0) {
    return expected_command(command);
  }
  if (is<CLI::ExtrasError>(error)) return unexpected(command, named_command(app));
  if (is<CLI::FileError>(error)) {
    return fmt::format("--config: expected a file that can be read, found '{}'",
                       message.substr(0, message.find(" was not readable")));
  }
  const std::string conversion = "Could not convert: ";
  if (is<CLI::ConversionError>(error) && message.starts_with(conversion)) {
    const std::string rest = message.substr(conversion.size());
    const std::size_t equals = rest.find(" = ");
    return fmt::format("{}: expected no value, or true or false, found '{}'", rest.substr(0, equals),
                       equals == std::string::npos ? "" : rest.substr(equals + 3));
  }
  const CLI::Option* option = subject(command, message);
  if (option != nullptr && is<CLI::ArgumentMismatch>(error)) return mismatch(*option, arguments);
  if (option != nullptr && is<CLI::RequiredError>(error)) return missing(*option);
  return message;
}

}  // namespace adamas
