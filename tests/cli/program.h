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

/// How one run of the program ended.
struct RunResult {
  int status = -1;  ///< of the exit; 1000 + N for signal N
  std::string out, err;
  /// The lines of `err`.
  [[nodiscard]] std::vector<std::string> err_lines() const;
};

struct RunOptions {
  std::optional<std::size_t> file_size_limit;
  std::optional<std::size_t> address_space;  ///< the program's, in bytes
  /// Send SIGINT as soon as stderr holds this text.
  std::string interrupt_at;
  /// Or as soon as this is so.
  std::function<bool()> interrupt_when;
  int interrupts = 1;  ///< that many times
  /// What is done instead of sending SIGINT, with the number of the program's process.
  std::function<void(pid_t)> act;
  int ignored = 0;            ///< a signal that the program is started with as ignored
  bool close_stdout = false;  ///< nobody reads what the program prints
  bool no_stdout = false;     ///< the program is started without that stream
  std::string stdout_file;    ///< what the program prints goes there
};

/// Whether a process is there and runs; one that ended but was not waited for does not.
bool is_running(pid_t process);
/// Waits for what a signal does: for ever, or as long as tests may run.
void wait_until_stopped(pid_t process);
void wait_until_gone(pid_t process);
/// Waits until a signal does not end the process at once: it is blocked or has a handler.
void wait_until_deferred(pid_t process, int number);

/// Runs the built program in a folder.
RunResult run_program(const std::filesystem::path& folder, const std::vector<std::string>& arguments,
                      const RunOptions& options = {});

/// A folder of its own for each test, and the program run in it.
class ProgramTest : public ::testing::Test {
 protected:
  ProgramTest();
  ~ProgramTest() override;

  RunResult run(const std::vector<std::string>& arguments, const RunOptions& options = {}) const {
    return run_program(folder_, arguments, options);
  }
  /// Runs, and expects status 0 and nothing on stderr.
  RunResult run_well(const std::vector<std::string>& arguments) const;
  /// Runs, and expects status 1, one line on stderr that has all the `parts`, and no new file.
  void expect_failure(const std::vector<std::string>& arguments, const std::vector<std::string>& parts,
                      const RunOptions& options = {}) const;
  /// The same with status 2 and a hint at --help in a second line.
  void expect_wrong_usage(const std::vector<std::string>& arguments,
                          const std::vector<std::string>& parts) const;

  void write(const std::string& name, const std::string& content) const;
  [[nodiscard]] std::string read(const std::string& name) const;
  [[nodiscard]] nlohmann::json read_json(const std::string& name) const;
  [[nodiscard]] std::set<std::string> files() const;
  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }

  /// A float image with values at points, one apart, as NRRD; x fastest.
  void write_image(const std::string& name, std::size_t n,
                   const std::function<float(std::size_t)>& value) const;
  /// A scene as scene.vtr.
  void make_scene(const std::string& scene, std::size_t cells = 10) const;

 private:
  std::filesystem::path folder_;
};

}  // namespace adamas::test
