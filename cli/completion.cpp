#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <string>

#include "cli/command.h"
#include "cli/option_checks.h"

namespace adamas {

namespace {

/// The case of one command, and those of its own commands: `options` are offered where a word begins with
/// '-', `words` elsewhere, and behind an option that takes a value only what that may be. Where nothing is
/// offered, the shell completes names of files.
void append_cases(const CLI::App& command, const std::string& name, std::string& script) {
  std::string options, words, values, others;
  for (const CLI::App* sub : command.get_subcommands([](const CLI::App*) { return true; })) {
    words += sub->get_name() + " ";
    append_cases(*sub, name + " " + sub->get_name(), script);
  }
  for (const CLI::Option* option : command.get_options()) {
    if (option->get_group().empty()) continue;
    const std::string list = CLI::detail::join(choices(*option), " ");
    std::string names;
    for (const std::string& long_name : option->get_lnames()) {
      options += "--" + long_name + " ";
      names += (names.empty() ? "--" : "|--") + long_name;
    }
    for (const std::string& short_name : option->get_snames()) names += "|-" + short_name;
    if (option->get_positional()) {
      if (!list.empty()) words += list + " ";
    } else if (!list.empty()) {
      values += "        " + names + ") options=\"\" words=\"" + list + "\" ;;\n";
    } else if (option->get_type_size() != 0) {
      others += (others.empty() ? "" : "|") + names;
    }
  }
  script += "    \"" + name + "\")\n      options=\"" + options + "\" words=\"" + words + "\"\n";
  if (!others.empty()) values += "        " + others + ") options=\"\" words=\"\" ;;\n";
  if (!values.empty()) script += "      case \"$previous\" in\n" + values + "      esac\n";
  script += "      ;;\n";
}

/// Patterns of a case: all commands, as "adamas generate scene".
std::string command_patterns(const CLI::App& command, const std::string& name) {
  std::string patterns;
  for (const CLI::App* sub : command.get_subcommands([](const CLI::App*) { return true; })) {
    const std::string full = name + " " + sub->get_name();
    const std::string inner = command_patterns(*sub, full);
    patterns += (patterns.empty() ? "\"" : "|\"") + full + "\"" + (inner.empty() ? "" : "|" + inner);
  }
  return patterns;
}

std::string bash_script(const CLI::App& root) {
  std::string cases;
  append_cases(root, "adamas", cases);
  return "# bash completion of adamas; made by: adamas completion bash\n"
         "_adamas() {\n"
         "  local current=\"${COMP_WORDS[COMP_CWORD]}\" previous=\"${COMP_WORDS[COMP_CWORD-1]}\"\n"
         "  local command=adamas options=\"\" words=\"\" i\n"
         "  # The shell makes a word of its own of the = in --option=value.\n"
         "  if [ \"$current\" = = ]; then current=\"\"\n"
         "  elif [ \"$previous\" = = ] && [ \"$COMP_CWORD\" -gt 1 ]; then "
         "previous=\"${COMP_WORDS[COMP_CWORD-2]}\"; fi\n"
         "  for ((i = 1; i < COMP_CWORD && i < 3; i++)); do\n"
         "    case \"$command ${COMP_WORDS[i]}\" in\n"
         "      " +
         command_patterns(root, "adamas") +
         ") command=\"$command ${COMP_WORDS[i]}\" ;;\n"
         "    esac\n"
         "  done\n"
         "  case \"$command\" in\n" +
         cases +
         "  esac\n"
         "  case \"$current\" in -*) words=\"$options\" ;; esac\n"
         "  COMPREPLY=($(compgen -W \"$words\" -- \"$current\"))\n"
         "}\n"
         "complete -o default -F _adamas adamas\n";
}

}  // namespace

void add_completion(CLI::App& app, Session& session) {
  const std::string example = "Example:\n  source <(adamas completion bash)";
  CLI::App* parent = app.add_subcommand("completion", "Print a script that completes command lines");
  parent->require_subcommand(1);
  parent->set_help_flag("--help,-h", "Print this and stop");
  parent->footer(example);
  CLI::App* bash = parent->add_subcommand("bash", "Completion for bash");
  bash->set_help_flag("--help,-h", "Print this and stop");
  bash->footer(example);
  bash->final_callback(
      [&app, &session] { session.run = [&app, &session] { session.console.write(bash_script(app)); }; });
}

}  // namespace adamas
