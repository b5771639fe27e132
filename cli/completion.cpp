#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <string>

#include "cli/command.h"

namespace adamas {

namespace {

/// The values an option may have, as "a b c"; empty where they are not a list.
std::string choices(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  const std::size_t open = type.find('{'), close = type.find('}');
  if (open == std::string::npos || close == std::string::npos) return {};
  std::string list = type.substr(open + 1, close - open - 1);
  for (char& c : list) {
    if (c == ',') c = ' ';
  }
  return list;
}

/// The case of one command, and those of its own commands.
void append_cases(const CLI::App& command, const std::string& name, std::string& script) {
  std::string words, values;
  for (const CLI::App* sub : command.get_subcommands([](const CLI::App*) { return true; })) {
    words += sub->get_name() + " ";
    append_cases(*sub, name + " " + sub->get_name(), script);
  }
  for (const CLI::Option* option : command.get_options()) {
    const std::string list = choices(*option);
    if (option->get_group().empty()) continue;
    for (const std::string& long_name : option->get_lnames()) {
      words += "--" + long_name + " ";
      if (!list.empty()) values += "        --" + long_name + ") words=\"" + list + "\" ;;\n";
    }
    if (option->get_positional() && !list.empty()) words += list + " ";
  }
  script += "    \"" + name + "\")\n      words=\"" + words + "\"\n";
  if (!values.empty()) script += "      case \"$previous\" in\n" + values + "      esac\n";
  script += "      ;;\n";
}

std::string bash_script(const CLI::App& root) {
  std::string cases;
  append_cases(root, "adamas", cases);
  return "# bash completion of adamas; made by: adamas completion bash\n"
         "_adamas() {\n"
         "  local current=\"${COMP_WORDS[COMP_CWORD]}\" previous=\"${COMP_WORDS[COMP_CWORD-1]}\"\n"
         "  local command=adamas words=\"\" i\n"
         "  for ((i = 1; i < COMP_CWORD && i < 3; i++)); do\n"
         "    case \"$command ${COMP_WORDS[i]}\" in\n" +
         [&root] {
           std::string names;
           for (const CLI::App* sub : root.get_subcommands([](const CLI::App*) { return true; })) {
             names += (names.empty() ? "" : "|") + ("\"adamas " + sub->get_name() + "\"");
             for (const CLI::App* inner : sub->get_subcommands([](const CLI::App*) { return true; })) {
               names += "|\"adamas " + sub->get_name() + " " + inner->get_name() + "\"";
             }
           }
           return "      " + names + ") command=\"$command ${COMP_WORDS[i]}\" ;;\n";
         }() +
         "    esac\n"
         "  done\n"
         "  case \"$command\" in\n" +
         cases +
         "  esac\n"
         "  COMPREPLY=($(compgen -W \"$words\" -- \"$current\"))\n"
         "}\n"
         "complete -o default -F _adamas adamas\n";
}

}  // namespace

void add_completion(CLI::App& app, Session& session) {
  CLI::App* parent = app.add_subcommand("completion", "Print a script that completes command lines");
  parent->require_subcommand(1);
  parent->footer("Example:\n  source <(adamas completion bash)");
  add_command(*parent, session, "bash", "Completion for bash", "source <(adamas completion bash)",
              [&app, &session] { session.console.write(bash_script(app)); });
}

}  // namespace adamas
