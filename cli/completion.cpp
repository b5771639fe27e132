#include <fmt/format.h>

#include <string>

#include "cli/command.h"
#include "cli/help.h"

namespace adamas::cli {

namespace {

/// Appends the case of a command and those of its subcommands: `options` are offered where a word begins with
/// '-', `words` elsewhere, and behind an option with a value only the words that it may have. Where nothing
/// is offered, the shell completes file names.
void append_cases(const CommandDescription& command, const std::string& name, std::string& script) {
  std::string options, words, values, others;
  for (const CommandDescription& inner : command.commands) {
    words += inner.name + " ";
    append_cases(inner, name + " " + inner.name, script);
  }
  for (const OptionDescription& option : command.options) {
    if (option.group.empty()) continue;
    const std::string list = fmt::format("{}", fmt::join(option.words, " "));
    std::string names;
    for (const std::string& long_name : option.long_names) {
      options += "--" + long_name + " ";
      names += (names.empty() ? "--" : "|--") + long_name;
    }
    for (const std::string& short_name : option.short_names) names += "|-" + short_name;
    if (option.positional) {
      if (!list.empty()) words += list + " ";
    } else if (!list.empty()) {
      values += "        " + names + ") options=\"\" words=\"" + list + "\" ;;\n";
    } else if (option.takes_value) {
      others += (others.empty() ? "" : "|") + names;
    }
  }
  script += "    \"" + name + "\")\n      options=\"" + options + "\" words=\"" + words + "\"\n";
  if (!others.empty()) values += "        " + others + ") options=\"\" words=\"\" ;;\n";
  if (!values.empty()) script += "      case \"$previous\" in\n" + values + "      esac\n";
  script += "      ;;\n";
}

/// Returns the patterns of a case: all commands, as "adamas generate scene".
std::string command_patterns(const CommandDescription& command, const std::string& name) {
  std::string patterns;
  for (const CommandDescription& sub : command.commands) {
    const std::string full = name + " " + sub.name;
    const std::string inner = command_patterns(sub, full);
    patterns += (patterns.empty() ? "\"" : "|\"") + full + "\"" + (inner.empty() ? "" : "|" + inner);
  }
  return patterns;
}

std::string bash_script(const CommandDescription& root) {
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

void add_completion(const Command& root, Session& session) {
  const std::string example = "source <(adamas completion bash)";
  const Command group =
      root.add_command_group("completion", "Print a script that completes command lines", example);
  group.add_command("bash", "Completion for bash", example, [root, &session] {
    session.run = [root, &session] { session.console.write(bash_script(describe(root))); };
  });
}

}  // namespace adamas::cli
