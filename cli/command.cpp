#include "cli/command.h"

#include <fmt/format.h>

#include <CLI/App.hpp>
#include <algorithm>

#include "adamas/text.h"
#include "cli/option_values.h"
#include "cli/usage.h"

namespace adamas::cli {

namespace {

/// A greater number of threads is regarded as a typing error.
constexpr std::size_t kMostThreads = 4096;

/// Returns a check whose description lists the allowed words, as "{a,b}".
CLI::Validator word_check(const std::vector<std::string>& words) {
  return {[words](std::string& value) {
            return std::find(words.begin(), words.end(), value) != words.end()
                       ? std::string()
                       : fmt::format("expected {}, found '{}'", listed(words, "or"), value);
          },
          "{" + fmt::format("{}", fmt::join(words, ",")) + "}"};
}

/// Returns the command line's root, which handles the `--config FILE` of every subcommand.
CLI::App& root_of(CLI::App& app) { return app.get_parent() == nullptr ? app : root_of(*app.get_parent()); }

void add_common_options(const Command& command, Session& session) {
  const Command common = command.in_group("Common");
  common.add_option("--json", "FILE", "Write the figures of the run: .json", session.json);
  common.add_value("--threads", "N", "Number of threads (default: all cores)", session.threads, parse_count);
  common.add_flag("--quiet,-q", "Print nothing but errors and what the result lacks of what was wanted",
                  session.console.quiet);
  common.add_flag("--verbose,-v", "Print a line per stage of the work", session.console.verbose);
  CLI::Option* config = root_of(command.app()).get_config_ptr();
  command.app()
      .add_option_function<std::string>(
          "--config,-c",
          [config, &session](const std::string& file) {
            config->add_result(file);
            session.config = file;
          },
          "Read options from a file of lines NAME = VALUE; those given here win")
      ->trigger_on_parse()
      ->configurable(false)
      ->type_name("FILE")
      ->group("Common");
}

}  // namespace

void Session::begin() {
  if (console.quiet && console.verbose)
    wrong_usage("--quiet and --verbose: expected one of them, found both");
  if (threads > kMostThreads) wrong_usage("--threads: expected at most {}, found {}", kMostThreads, threads);
  set_thread_limit(static_cast<unsigned>(threads));
  outputs.protect_other(config);
  outputs.declare("--json", json, {".json"});
}

void Session::commit() {
  console.flush();
  outputs.commit();
}

CommandOption CommandOption::required() {
  option_->required();
  return *this;
}

CommandOption CommandOption::one_value_each() {
  option_->allow_extra_args(false);
  return *this;
}

CommandOption CommandOption::show_default() {
  option_->capture_default_str();
  return *this;
}

CommandOption CommandOption::one_of(const std::vector<std::string>& words) {
  option_->check(word_check(words));
  return *this;
}

namespace {

/// Returns the name of an option in messages: "--output" for "-o,--output".
std::string long_name(const std::string& names) {
  const std::size_t at = names.find("--");
  return at == std::string::npos ? names : names.substr(at, names.find(',', at) - at);
}

}  // namespace

CommandOption Command::finish(CLI::Option& option, const std::string& type) const {
  if (!type.empty()) option.type_name(type);
  if (!group_.empty()) option.group(group_);
  return CommandOption(option);
}

CommandOption Command::add_option(const std::string& name, const std::string& type,
                                  const std::string& description, std::string& value) const {
  return finish(*app_->add_option(name, value, description), type);
}

CommandOption Command::add_option(const std::string& name, const std::string& type,
                                  const std::string& description, std::vector<std::string>& values) const {
  return finish(*app_->add_option(name, values, description), type);
}

CommandOption Command::add_converted(const std::string& name, const std::string& type,
                                     const std::string& description, Conversion convert,
                                     const std::string& text) const {
  const auto value = std::make_shared<std::string>(text);
  conversions_->push_back([name = long_name(name), value, convert = std::move(convert)] {
    if (!value->empty()) convert(name, *value);
  });
  CommandOption option = add_option(name, type, description, *value);
  return text.empty() ? option : option.show_default();
}

CommandOption Command::add_converted_each(const std::string& name, const std::string& type,
                                          const std::string& description, Conversion convert) const {
  const auto values = std::make_shared<std::vector<std::string>>();
  conversions_->push_back([name = long_name(name), values, convert = std::move(convert)] {
    for (const std::string& value : *values) convert(name, value);
  });
  return add_option(name, type, description, *values).one_value_each();
}

CommandOption Command::add_file(const std::string& name, const std::string& type,
                                const std::string& description, std::filesystem::path& file) const {
  return add_value(name, type, description, file,
                   [](const std::string&, const std::string& text) { return text; });
}

CommandOption Command::add_flag(const std::string& name, const std::string& description, bool& value) const {
  return finish(*app_->add_flag(name, value, description), {});
}

CommandOption Command::add_flag(const std::string& name, const std::string& description,
                                std::function<void()> take) const {
  const auto given = std::make_shared<bool>(false);
  conversions_->push_back([given, take = std::move(take)] {
    if (*given) take();
  });
  return add_flag(name, description, *given);
}

Command Command::in_group(const std::string& name) const {
  Command grouped = *this;
  grouped.group_ = name;
  return grouped;
}

void Command::convert() const {
  for (const std::function<void()>& each : *conversions_) each();
}

Command Command::add_command(const std::string& name, const std::string& description,
                             const std::string& example, std::function<void()> chosen) const {
  CLI::App* command = app_->add_subcommand(name, description);
  command->set_help_flag("--help,-h", "Print this and stop");
  command->footer("Example:\n  " + example);
  if (chosen) command->final_callback(std::move(chosen));
  return Command(*command);
}

Command Command::add_command_group(const std::string& name, const std::string& description,
                                   const std::string& example) const {
  const Command group = add_command(name, description, example, nullptr);
  group.app().require_subcommand(1);
  return group;
}

Command add_command(const Command& parent, Session& session, const std::string& name,
                    const std::string& description, const std::string& example, std::function<void()> run) {
  Command command = parent.add_command(name, description, example, nullptr);
  command.app().final_callback([&session, command, run = std::move(run)] {
    session.run = [&session, command, run] {
      command.convert();
      session.begin();
      run();
    };
  });
  add_common_options(command, session);
  // The flag is added again, so that it comes last among the common options.
  command.app().set_help_flag("--help,-h", "Print this and stop")->group("Common");
  return command;
}

}  // namespace adamas::cli
