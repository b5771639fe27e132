// Tests the aids for writing command lines: --help and completion.

#include <cstdlib>
#include <sstream>

#include "program.h"

namespace adamas::test {

namespace {

class Help : public ProgramTest {};

/// Returns whether this build has a command.
bool is_built(const std::string& command) { return command != "view" || ADAMAS_WITH_VIEWER != 0; }

TEST_F(Help, HelpAndCompletion) {
  const std::string all = run_well({"--help"}).out;
  EXPECT_EQ(run_well({"--version"}).out.rfind("adamas ", 0), 0u);
  const std::string script = run_well({"completion", "bash"}).out;
  write("completion.bash", script);
  const std::string check = "bash -n '" + (folder() / "completion.bash").string() + "'";
  EXPECT_EQ(std::system(check.c_str()), 0);
  for (const std::string command : {"info", "reconstruct", "resample", "select", "slice", "probe", "store",
                                    "restore", "verify", "isosurface", "view"}) {
    EXPECT_EQ(all.find("  " + command) != std::string::npos, is_built(command)) << command;
    if (!is_built(command)) continue;
    const std::string help = run_well({command, "--help"}).out;
    EXPECT_NE(help.find("Example:\n  adamas " + command), std::string::npos);
    // Every option of the help is completed.
    std::istringstream lines(help);
    for (std::string line; std::getline(lines, line);) {
      const std::size_t at = line.find("--");
      if (line.rfind("  -", 0) != 0 || at == std::string::npos) continue;
      const std::string option = line.substr(at, line.find_first_of(" ,=", at) - at);
      EXPECT_NE(script.find(option + " "), std::string::npos) << option;
    }
  }
  EXPECT_NE(run_well({"generate", "scene", "--help"}).out.find("Example:"), std::string::npos);
}

TEST_F(Help, TheFirstStepsWorkAsTheyStand) {
  const std::string help = run_well({"--help"}).out;
  std::istringstream lines(help.substr(help.find("First steps:\n")));
  std::string line;
  std::getline(lines, line);
  int steps = 0;
  while (std::getline(lines, line)) {
    if (line.find_first_not_of(' ') == std::string::npos) continue;
    std::istringstream words(line);
    std::vector<std::string> arguments;
    for (std::string word; words >> word;) arguments.push_back(word);
    ASSERT_EQ(arguments.front(), "adamas") << line;
    arguments.erase(arguments.begin());
    run_well(arguments);
    ++steps;
  }
  EXPECT_EQ(steps, 5);
  EXPECT_TRUE(files().contains("slice.png"));
}

TEST_F(Help, TheManualKnowsEveryOption) {
  const std::string page = run_well({"man"}).out;
  EXPECT_EQ(page.rfind(".TH ADAMAS 1", 0), 0u);
  std::string plain;
  for (std::size_t i = 0; i < page.size(); ++i) {
    if (page[i] != '\\') plain += page[i];
  }
  for (const std::string command : {"info", "reconstruct", "resample", "select", "compare", "slice", "probe",
                                    "experiment", "store", "restore", "verify", "isosurface", "view"}) {
    const std::size_t section = plain.find(".SS " + command + "\n");
    ASSERT_EQ(section != std::string::npos, is_built(command)) << command;
    if (!is_built(command)) continue;
    std::istringstream lines(run_well({command, "--help"}).out);
    for (std::string line; std::getline(lines, line);) {
      const std::size_t at = line.find("--");
      if (line.rfind("  -", 0) != 0 || at == std::string::npos) continue;
      const std::string option = line.substr(at, line.find_first_of(" ,=", at) - at);
      EXPECT_NE(plain.find(option, option == "--help" ? 0 : section), std::string::npos)
          << command << " " << option;
    }
  }
  for (const char* status : {"0", "1", "2", "3", "130"})
    EXPECT_NE(plain.find(std::string(".B ") + status + "\n"), std::string::npos) << status;
  // The formatter of manual pages prints no warnings.
  write("adamas.1", page);
  const std::string check =
      "cd '" + folder().string() +
      "' && if command -v man > /dev/null; then man --warnings -l adamas.1 2> warnings > "
      "/dev/null; else : > warnings; fi";
  EXPECT_EQ(std::system(check.c_str()), 0);
  EXPECT_EQ(read("warnings"), "");
}

TEST_F(Help, HelpFitsTheScreen) {
  for (const std::string command : {"generate", "info", "reconstruct", "resample", "select", "slice", "probe",
                                    "store", "restore", "verify", "isosurface", "view"}) {
    if (!is_built(command)) continue;
    const std::string help = run_well({command, "--help"}).out;
    std::istringstream lines(help);
    for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 100u) << line;
    // A command's own options come first.
    const std::size_t common = help.find("\nCommon:\n");
    if (command != "generate") {
      EXPECT_LT(help.find("\nPositionals:\n"), common);
      EXPECT_LT(common, help.find("\nExample:\n"));
    }
  }
  const std::string help = run_well({"resample", "--help"}).out;
  EXPECT_NE(help.find("(default 1%)"), std::string::npos) << help;
  EXPECT_NE(help.find("--ghost constant|linear"), std::string::npos) << help;
}

TEST_F(Help, CompletionLeavesFilesToTheShell) {
  write("completion.bash", run_well({"completion", "bash"}).out);
  const auto complete = [this](const std::string& words) {
    const std::string script = "source completion.bash; COMP_WORDS=(" + words +
                               "); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); _adamas; "
                               "echo \"${COMPREPLY[@]}\" > reply";
    const std::string command = "cd '" + folder().string() + "' && bash -c '" + script + "'";
    EXPECT_EQ(std::system(command.c_str()), 0);
    std::string reply = read("reply");
    if (!reply.empty()) reply.pop_back();
    return reply;
  };
  EXPECT_EQ(complete("adamas re"), "reconstruct resample restore");
  EXPECT_EQ(complete("adamas resample \"\""), "");
  EXPECT_EQ(complete("adamas resample x.vtr --gh"), "--ghost");
  EXPECT_EQ(complete("adamas resample x.vtr --ghost \"\""), "constant linear least-squares");
  EXPECT_EQ(complete("adamas resample x.vtr --ghost = li"), "linear");
  for (const std::string option : {"-o", "--output", "--json", "--interface-error"}) {
    EXPECT_EQ(complete("adamas resample x.vtr " + option + " \"\""), "") << option;
  }
  EXPECT_EQ(complete("adamas generate scene ref"), "reflex");
}

}  // namespace

}  // namespace adamas::test
