#include "program.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <sstream>

namespace adamas::test {

namespace {

[[noreturn]] void become_program(const std::filesystem::path& folder,
                                 const std::vector<std::string>& arguments, const RunOptions& options,
                                 int out, int err) {
  std::vector<char*> argv;
  std::string name = "adamas";
  argv.push_back(name.data());
  std::vector<std::string> copies = arguments;
  for (std::string& a : copies) argv.push_back(a.data());
  argv.push_back(nullptr);
  if (chdir(folder.c_str()) != 0) _exit(126);
  if (options.file_size_limit) {
    const rlimit limit{*options.file_size_limit, *options.file_size_limit};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  if (options.address_space) {
    const rlimit limit{*options.address_space, *options.address_space};
    setrlimit(RLIMIT_AS, &limit);
  }
  const int in = open("/dev/null", O_RDONLY);
  dup2(in, STDIN_FILENO);
  dup2(out, STDOUT_FILENO);
  dup2(err, STDERR_FILENO);
  if (!options.stdout_file.empty()) dup2(open(options.stdout_file.c_str(), O_WRONLY), STDOUT_FILENO);
  if (options.no_stdout) close(STDOUT_FILENO);
  // The process that runs the tests may ignore signals.
  for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGQUIT})
    signal(number, number == options.ignored ? SIG_IGN : SIG_DFL);
  // scripts/output_digests runs a program of its own in between.
  const char* const instead = std::getenv("ADAMAS_TEST_PROGRAM");
  execv(instead != nullptr ? instead : ADAMAS_PROGRAM, argv.data());
  _exit(127);
}

/// Returns the rest of the line of /proc/PID/status that begins with this text; empty where there is none.
std::string status_line(pid_t process, const std::string& beginning) {
  std::ifstream status("/proc/" + std::to_string(process) + "/status");
  for (std::string line; std::getline(status, line);) {
    if (line.rfind(beginning, 0) == 0) return line.substr(beginning.size());
  }
  return "";
}

char state_of(pid_t process) {
  const std::string state = status_line(process, "State:\t");
  return state.empty() ? 'X' : state[0];
}

/// Returns whether a signal is in a set of /proc/PID/status.
bool is_in(pid_t process, const std::string& set, int number) {
  const std::string members = status_line(process, set + ":\t");
  return !members.empty() && (std::stoull(members, nullptr, 16) >> (number - 1) & 1) != 0;
}

}  // namespace

bool is_running(pid_t process) {
  const char state = state_of(process);
  return state != 'X' && state != 'Z';
}

void wait_until_stopped(pid_t process) {
  while (is_running(process) && state_of(process) != 'T') usleep(100);
}

void wait_until_gone(pid_t process) {
  while (is_running(process)) usleep(100);
}

void wait_until_deferred(pid_t process, int number) {
  while (is_running(process) && !is_in(process, "SigBlk", number) && !is_in(process, "SigCgt", number))
    usleep(20);
}

namespace {

/// Collects the output of both pipes, and interrupts the child where that was asked for.
void collect(pid_t child, int out, int err, const RunOptions& options, RunResult& result) {
  std::array<pollfd, 2> ends{pollfd{out, POLLIN, 0}, pollfd{err, POLLIN, 0}};
  bool interrupt = !options.interrupt_at.empty() || options.interrupt_when;
  while (ends[0].fd >= 0 || ends[1].fd >= 0) {
    poll(ends.data(), ends.size(), options.interrupt_when ? 1 : -1);
    for (std::size_t i = 0; i < 2; ++i) {
      if (ends[i].fd < 0 || ends[i].revents == 0) continue;
      std::array<char, 4096> buffer;
      const ssize_t n = ::read(ends[i].fd, buffer.data(), buffer.size());
      if (n <= 0) {
        ends[i].fd = -1;
        continue;
      }
      (i == 0 ? result.out : result.err).append(buffer.data(), static_cast<std::size_t>(n));
    }
    if (interrupt && (options.interrupt_when ? options.interrupt_when()
                                             : result.err.find(options.interrupt_at) != std::string::npos)) {
      interrupt = false;
      if (options.act) options.act(child);
      for (int i = 0; !options.act && i < options.interrupts; ++i) {
        kill(child, SIGINT);
        // Several signals of a kind that are pending together would become one.
        while (is_running(child) && is_in(child, "ShdPnd", SIGINT)) usleep(100);
      }
    }
  }
}

}  // namespace

std::vector<std::string> RunResult::err_lines() const {
  std::vector<std::string> lines;
  std::istringstream stream(err);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

RunResult run_program(const std::filesystem::path& folder, const std::vector<std::string>& arguments,
                      const RunOptions& options) {
  std::array<int, 2> out{}, err{};
  if (pipe2(out.data(), O_CLOEXEC) != 0 || pipe2(err.data(), O_CLOEXEC) != 0) return {};
  const pid_t child = fork();
  if (child == 0) {
    if (options.close_stdout) close(out[0]);
    become_program(folder, arguments, options, out[1], err[1]);
  }
  close(out[1]);
  close(err[1]);
  RunResult result;
  if (options.close_stdout) {
    close(out[0]);
    out[0] = -1;
  }
  collect(child, out[0], err[0], options, result);
  int status = 0;
  waitpid(child, &status, 0);
  result.status = WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status);
  if (out[0] >= 0) close(out[0]);
  close(err[0]);
  return result;
}

ProgramTest::ProgramTest() {
  std::string name = (std::filesystem::temp_directory_path() / "adamas-cli-XXXXXX").string();
  folder_ = mkdtemp(name.data());
}

ProgramTest::~ProgramTest() {
  std::error_code code;
  std::filesystem::remove_all(folder_, code);
}

RunResult ProgramTest::run_well(const std::vector<std::string>& arguments) const {
  RunResult result = run(arguments);
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(result.err, "");
  return result;
}

void ProgramTest::expect_failure(const std::vector<std::string>& arguments,
                                 const std::vector<std::string>& parts, const RunOptions& options) const {
  const auto before = files();
  const RunResult result = run(arguments, options);
  EXPECT_EQ(result.status, 1) << result.err;
  const auto lines = result.err_lines();
  ASSERT_EQ(lines.size(), 1u) << result.err;
  EXPECT_EQ(lines[0].rfind("adamas: error: ", 0), 0u) << lines[0];
  for (const std::string& part : parts)
    EXPECT_NE(lines[0].find(part), std::string::npos) << part << "\n" << lines[0];
  EXPECT_EQ(lines[0].find(".partial"), std::string::npos) << lines[0];
  EXPECT_EQ(files(), before);
}

void ProgramTest::expect_wrong_usage(const std::vector<std::string>& arguments,
                                     const std::vector<std::string>& parts) const {
  const auto before = files();
  const RunResult result = run(arguments);
  EXPECT_EQ(result.status, 2) << result.err;
  const auto lines = result.err_lines();
  ASSERT_EQ(lines.size(), 2u) << result.err;
  EXPECT_EQ(lines[0].rfind("adamas: error: ", 0), 0u) << lines[0];
  for (const std::string& part : parts)
    EXPECT_NE(lines[0].find(part), std::string::npos) << part << "\n" << lines[0];
  EXPECT_NE(lines[1].find("--help"), std::string::npos);
  EXPECT_EQ(files(), before);
}

void ProgramTest::write(const std::string& name, const std::string& content) const {
  std::ofstream(folder_ / name, std::ios::binary) << content;
}

std::string ProgramTest::read(const std::string& name) const {
  std::ifstream stream(folder_ / name, std::ios::binary);
  EXPECT_TRUE(stream.good()) << name;
  return {std::istreambuf_iterator<char>(stream), {}};
}

nlohmann::json ProgramTest::read_json(const std::string& name) const {
  return nlohmann::json::parse(read(name));
}

std::set<std::string> ProgramTest::files() const {
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder_)) {
    names.insert(std::filesystem::relative(entry.path(), folder_).string());
  }
  return names;
}

void ProgramTest::write_image(const std::string& name, std::size_t n,
                              const std::function<float(std::size_t)>& value) const {
  const std::string side = std::to_string(n);
  std::string content = "NRRD0004\ntype: float\ndimension: 3\nsizes: " + side + " " + side + " " + side +
                        "\nspacings: 1 1 1\ncenters: node node node\nendian: little\nencoding: raw\n\n";
  for (std::size_t i = 0; i < n * n * n; ++i) {
    const float v = value(i);
    std::array<char, sizeof v> bytes;
    std::memcpy(bytes.data(), &v, sizeof v);
    content.append(bytes.data(), bytes.size());
  }
  write(name, content);
}

void ProgramTest::make_scene(const std::string& scene, std::size_t cells) const {
  const std::string n = std::to_string(cells);
  run_well({"generate", "scene", scene, "--dimensions", n + "," + n + "," + n, "-o", "scene.vtr"});
}

}  // namespace adamas::test
