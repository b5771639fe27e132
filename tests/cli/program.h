#pragma once

#include <gtest/gtest.h>
#include <sys/types.h>

#include <cstddef>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace adamas::test {

/// The result of one run of the program.
struct RunResult {
  int status = -1;  ///< exit status; 1000 + N for signal N
  std::string out, err;
  /// Returns the lines of `err`.
  [[nodiscard]] std::vector<std::string> err_lines() const;
};

struct RunOptions {
  std::optional<std::size_t> file_size_limit;
  std::optional<std::size_t> address_space;  ///< limit for the program, in bytes
  /// SIGINT is sent as soon as stderr contains this text.
  std::string interrupt_at;
  /// SIGINT is sent as soon as this returns true.
  std::function<bool()> interrupt_when;
  int interrupts = 1;  ///< how often SIGINT is sent
  /// This is called instead of sending SIGINT, with the id of the program's process.
  std::function<void(pid_t)> act;
  int ignored = 0;            ///< a signal that is ignored when the program starts
  bool close_stdout = false;  ///< nobody reads what the program prints
  bool no_stdout = false;     ///< the program is started without standard output
  std::string stdout_file;    ///< the file that standard output goes to
};

/// Returns whether a process exists and runs; one that ended but was not waited for does not run.
bool is_running(pid_t process);
/// Waits for the effect of a signal, if need be until the tests' own time limit.
void wait_until_stopped(pid_t process);
void wait_until_gone(pid_t process);
/// Waits until a signal does not end the process at once, since it is blocked or has a handler.
void wait_until_deferred(pid_t process, int number);

/// Runs the built program in a folder.
RunResult run_program(const std::filesystem::path& folder, const std::vector<std::string>& arguments,
                      const RunOptions& options = {});

/// A test with a folder of its own, in which the program runs.
class ProgramTest : public ::testing::Test {
 protected:
  ProgramTest();
  ~ProgramTest() override;

  RunResult run(const std::vector<std::string>& arguments, const RunOptions& options = {}) const {
    return run_program(folder_, arguments, options);
  }
  /// Runs the program, and expects status 0 and nothing on stderr.
  RunResult run_well(const std::vector<std::string>& arguments) const;
  /// Runs the program, and expects status 1, one line on stderr that has all the `parts`, and no new file.
  void expect_failure(const std::vector<std::string>& arguments, const std::vector<std::string>& parts,
                      const RunOptions& options = {}) const;
  /// Runs the program, and expects status 2, a line on stderr that has all the `parts`, a second line with a
  /// hint at --help, and no new file.
  void expect_wrong_usage(const std::vector<std::string>& arguments,
                          const std::vector<std::string>& parts) const;

  void write(const std::string& name, const std::string& content) const;
  [[nodiscard]] std::string read(const std::string& name) const;
  [[nodiscard]] nlohmann::json read_json(const std::string& name) const;
  [[nodiscard]] std::set<std::string> files() const;
  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }

  /// Writes an NRRD image of floats with values at points that are one unit apart; x runs fastest.
  void write_image(const std::string& name, std::size_t n,
                   const std::function<float(std::size_t)>& value) const;
  /// Makes a scene as scene.vtr.
  void make_scene(const std::string& scene, std::size_t cells = 10) const;

 private:
  std::filesystem::path folder_;
};

}  // namespace adamas::test
