#include <algorithm>
#include <array>
#include <string>
#include <utility>
#include <vector>

#include "adamas/version.h"
#include "cli/command.h"
#include "cli/exit_status.h"
#include "cli/help.h"

namespace adamas::cli {

namespace {

/// The environment variables that the program reads, besides those of the system.
constexpr std::array<std::pair<const char*, const char*>, 2> kVariables{{
    {"ADAMAS_READER_PROGRAM",
     "The program that reads files by the libraries of others, where it is not beside adamas or in "
     "../libexec."},
    {"ADAMAS_REFERENCE_PROGRAM",
     "The program that runs other mesh generators for compare, where it is not beside adamas or in "
     "../libexec."},
}};

/// Returns the text escaped for roff, so that no line is a request and hyphens can be copied from the page.
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

void append_option(const OptionDescription& option, std::string& page) {
  page += ".TP\n.B " + roff(option.head) + "\n" + roff(option.text) + "\n";
}

/// Appends a paragraph whose lines stay as they are, for examples.
void append_lines(const std::string& text, std::string& page) {
  page += ".PP\n.nf\n" + roff(text) + "\n.fi\n";
}

/// Appends the section of a command: its description, its own options, its example.
void append_command(const CommandDescription& command, const std::string& name, std::string& page) {
  page += ".SS " + roff(name) + "\n" + roff(command.description) + ".\n";
  for (const OptionDescription& option : command.options) {
    if (option.positional) append_option(option, page);
  }
  for (const std::string& group : command.groups()) {
    if (group.empty() || group == kCommonGroup) continue;
    for (const OptionDescription& option : command.options) {
      if (option.group == group && !option.positional &&
          option.long_names != std::vector<std::string>{"help"})
        append_option(option, page);
    }
  }
  if (command.commands.empty() && !command.footer.empty()) append_lines(command.footer, page);
  for (const CommandDescription& inner : command.commands) {
    append_command(inner, name + " " + inner.name, page);
  }
}

/// Appends the section of the common options, which are taken from one command.
void append_common_options(const CommandDescription& any, std::string& page) {
  page += ".SH COMMON OPTIONS\n";
  for (const OptionDescription& option : any.options) {
    if (option.group == kCommonGroup) append_option(option, page);
  }
}

std::string man_page(const CommandDescription& app) {
  std::string page = std::string(".TH ADAMAS 1 \"\" \"adamas ") + version() + "\" \"User Commands\"\n.ad l\n";
  page += ".SH NAME\nadamas \\- " + roff(app.description) + "\n";
  page += ".SH SYNOPSIS\n.B adamas\n.I COMMAND\n[\n.I INPUT\n\\&... ] [\n.I options\n]\n";
  page += ".SH DESCRIPTION\n" +
          roff(
              "Results go to standard output; notes, progress and errors to standard error. Outputs get "
              "their names "
              "when they are whole. Errors are absolute by default, or parts with %.") +
          "\n";
  append_lines(app.footer, page);
  page += ".SH COMMANDS\n";
  for (const CommandDescription& command : app.commands) append_command(command, command.name, page);
  append_common_options(
      *std::find_if(app.commands.begin(), app.commands.end(),
                    [](const CommandDescription& command) { return command.name == "info"; }),
      page);
  page += ".SH EXIT STATUS\n";
  for (const auto& [status, meaning] : kExitStatuses)
    page += ".TP\n.B " + std::to_string(status) + "\n" + roff(meaning) + "\n";
  page += ".SH ENVIRONMENT\n";
  for (const auto& [variable, meaning] : kVariables)
    page += ".TP\n.B " + std::string(variable) + "\n" + roff(meaning) + "\n";
  return page;
}

}  // namespace

void add_man(const Command& root, Session& session) {
  root.add_command("man", "Print the manual page", "adamas man | man -l -", [root, &session] {
    session.run = [root, &session] { session.console.write(man_page(describe(root))); };
  });
}

}  // namespace adamas::cli
