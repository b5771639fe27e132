#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <array>
#include <string>
#include <utility>
#include <vector>

#include "cli/command.h"
#include "cli/exit_status.h"
#include "cli/help_formatter.h"
#include "cli/version.h"

namespace adamas {

namespace {

/// The variables of the environment that the program reads, beside those of the system.
constexpr std::array<std::pair<const char*, const char*>, 2> kVariables{{
    {"ADAMAS_READER_PROGRAM",
     "The program that reads files by the libraries of others, where it is not beside adamas or in "
     "../libexec."},
    {"ADAMAS_REFERENCE_PROGRAM",
     "The program that runs other mesh generators for compare, where it is not beside adamas or in "
     "../libexec."},
}};

/// Text as roff takes it: no requests, hyphens that can be copied.
std::string roff(const std::string& text) {
  std::string result;
  bool begins_line = true;
  for (const char c : text) {
    if (begins_line && (c == '.' || c == '\'')) result += "\\&";
    if (c == '\\') {
      result += "\\e";
    } else if (c == '-') {
      result += "\\-";
    } else {
      result += c;
    }
    begins_line = c == '\n';
  }
  return result;
}

void append_option(const CLI::Option& option, bool positional, std::string& page) {
  page += ".TP\n.B " + roff(option_head(option, positional)) + "\n" + roff(option_text(option, positional)) +
          "\n";
}

/// A paragraph for examples, line by line as they stand.
void append_lines(const std::string& text, std::string& page) {
  page += ".PP\n.nf\n" + roff(text) + "\n.fi\n";
}

std::vector<const CLI::App*> commands_of(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App*) { return true; });
}

/// A command's section: what it does, its options but for those that all have, its example.
void append_command(const CLI::App& command, const std::string& name, std::string& page) {
  page += ".SS " + roff(name) + "\n" + roff(command.get_description()) + ".\n";
  for (const CLI::Option* option : command.get_options()) {
    if (option->get_positional()) append_option(*option, true, page);
  }
  for (const std::string& group : option_groups(command)) {
    if (group.empty() || group == "Common") continue;
    for (const CLI::Option* option : command.get_options()) {
      if (option->get_group() == group && option->nonpositional() &&
          option->get_lnames() != std::vector<std::string>{"help"})
        append_option(*option, false, page);
    }
  }
  if (commands_of(command).empty() && !command.get_footer().empty()) append_lines(command.get_footer(), page);
  for (const CLI::App* sub : commands_of(command)) append_command(*sub, name + " " + sub->get_name(), page);
}

std::string man_page(const CLI::App& app) {
  std::string page = std::string(".TH ADAMAS 1 \"\" \"adamas ") + kVersion + "\" \"User Commands\"\n.ad l\n";
  page += ".SH NAME\nadamas \\- " + roff(app.get_description()) + "\n";
  page += ".SH SYNOPSIS\n.B adamas\n.I COMMAND\n[\n.I INPUT\n\\&... ] [\n.I options\n]\n";
  page += ".SH DESCRIPTION\n" +
          roff(
              "Results go to standard output; notes, progress and errors to standard error. Outputs get "
              "their names "
              "when they are whole. Errors are absolute by default, or parts with %.") +
          "\n";
  append_lines(app.get_footer(), page);
  page += ".SH COMMANDS\n";
  for (const CLI::App* command : commands_of(app)) append_command(*command, command->get_name(), page);
  page += ".SH COMMON OPTIONS\n";
  const CLI::App* any = app.get_subcommand("info");
  for (const CLI::Option* option : any->get_options()) {
    if (option->get_group() == "Common") append_option(*option, false, page);
  }
  page += ".SH EXIT STATUS\n";
  for (const auto& [status, meaning] : kExitStatuses)
    page += ".TP\n.B " + std::to_string(status) + "\n" + roff(meaning) + "\n";
  page += ".SH ENVIRONMENT\n";
  for (const auto& [variable, meaning] : kVariables)
    page += ".TP\n.B " + std::string(variable) + "\n" + roff(meaning) + "\n";
  return page;
}

}  // namespace

void add_man(CLI::App& app, Session& session) {
  CLI::App* man = app.add_subcommand("man", "Print the manual page");
  man->set_help_flag("--help,-h", "Print this and stop");
  man->footer("Example:\n  adamas man | man -l -");
  man->final_callback(
      [&app, &session] { session.run = [&app, &session] { session.console.write(man_page(app)); }; });
}

}  // namespace adamas
