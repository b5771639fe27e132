// Tests reading in a process of its own: what is reported of its end, and that other threads do not disturb
// it.

#include "core/io/reader_program.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <thread>

#include "adamas/stopping_signals.h"
#include "core/io/grid_file.h"
#include "tests/support/scratch.h"

namespace adamas {

using namespace io;

namespace {

using test::error_of;
using test::says;

constexpr const char* kVariable = "ADAMAS_READER_PROGRAM";

/// Returns the text of a file that VTK reads.
std::string legacy_text() {
  std::string text =
      "# vtk DataFile Version 3.0\nt\nASCII\nDATASET STRUCTURED_POINTS\nDIMENSIONS 10 10 10\nSPACING 1 1 1\n"
      "ORIGIN 0 0 0\nPOINT_DATA 1000\nSCALARS s float\nLOOKUP_TABLE default\n";
  for (int i = 0; i < 1000; ++i) text += std::to_string(i) + "\n";
  return text;
}

/// A file to read, and shell scripts that take the place of the program.
class ReaderProgram : public ::testing::Test {
 protected:
  ReaderProgram() : program(std::getenv(kVariable)), file(scratch / "data.vtk") {
    test::put_bytes(file, legacy_text());
  }
  ~ReaderProgram() override { ::setenv(kVariable, program.c_str(), 1); }

  void replace_by(const std::string& body) const {
    const auto script = scratch / "script";
    test::put_bytes(script, "#!/bin/sh\n" + body + "\n");
    ::chmod(script.c_str(), 0755);
    ::setenv(kVariable, script.c_str(), 1);
  }
  [[nodiscard]] std::string error_with(const std::string& body) const {
    replace_by(body);
    return error_of([&] { read_grid_file(file); });
  }
  [[nodiscard]] std::string begun(const std::string& rest) const { return file.string() + rest; }

  test::Scratch scratch;
  const std::string program;
  const std::filesystem::path file;
};
class LongReaderProgram : public ReaderProgram {};

bool equal(const GridFile& a, const GridFile& b) {
  if (a.nodes != b.nodes || a.arrays.size() != b.arrays.size()) return false;
  for (std::size_t i = 0; i < a.arrays.size(); ++i) {
    if (a.arrays[i].name != b.arrays[i].name || a.arrays[i].values != b.arrays[i].values) return false;
  }
  return true;
}

TEST_F(ReaderProgram, TellsHowItEnded) {
  const std::string corrupt = ": expected a readable file, found a corrupt one (its reader ended ";
  EXPECT_EQ(error_with("kill -SEGV $$"), begun(corrupt + "by signal 11, Segmentation fault)"));
  EXPECT_EQ(error_with("exit 7"), begun(corrupt + "with status 7)"));
  EXPECT_EQ(error_with("kill -ALRM $$"),
            begun(": expected a readable file, found none within the time limit"));
  EXPECT_EQ(error_with("exit 127"), begun(": its reader, the program adamas-reader, could not be started"));
}

TEST_F(ReaderProgram, TellsThatTooManyFilesAreOpen) {
  // This many descriptors are enough for this side of the reader, but not for the program's own streams.
  std::array<int, 3> files{};
  for (int& one : files) one = ::open("/dev/null", O_RDONLY);
  rlimit before{};
  ::getrlimit(RLIMIT_NOFILE, &before);
  const rlimit few{static_cast<rlim_t>(*std::max_element(files.begin(), files.end())) + 1, before.rlim_max};
  for (const int one : files) ::close(one);
  ::setrlimit(RLIMIT_NOFILE, &few);
  const std::string message = error_of([&] { read_grid_file(file); });
  ::setrlimit(RLIMIT_NOFILE, &before);
  EXPECT_EQ(message, begun(": no process for its reader: too many files are open (ulimit -n)"));
}

TEST_F(ReaderProgram, StopsWithItsReader) {
  for (const int number : kStoppingSignals) {
    // The process that started the tests may ignore the signal, and then the reader would too.
    const auto before = ::signal(number, SIG_DFL);
    replace_by("kill -" + std::to_string(number) + " $$; sleep 100");
    EXPECT_THROW(read_grid_file(file), Cancelled) << number;
    ::signal(number, before);
  }
}

TEST_F(ReaderProgram, IsNotBelieved) {
  const std::string corrupt =
      begun(": expected a readable file, found a corrupt one (its reader ended with status 0)");
  EXPECT_EQ(error_with("true"), corrupt);
  EXPECT_EQ(error_with("echo what a library prints"), corrupt);
  // An output that is cut off anywhere is an error, and what comes after its end is ignored.
  for (const int size : {1, 4, 5, 30, 1000, 4000}) {
    EXPECT_EQ(error_with(program + " | head -c " + std::to_string(size)), corrupt) << size;
  }
  replace_by(program + "; echo more");
  EXPECT_EQ(read_grid_file(file).arrays.size(), 1u);
}

TEST_F(ReaderProgram, TakesNoOtherRequest) {
  EXPECT_EQ(WEXITSTATUS(std::system((program + " </dev/null >/dev/null 2>&1").c_str())), 1);
  const auto garbage = scratch / "garbage";
  test::put_bytes(garbage, std::string(100, 'd'));
  EXPECT_EQ(WEXITSTATUS(std::system((program + " <" + garbage.string() + " >/dev/null 2>&1").c_str())), 1);
}

TEST_F(ReaderProgram, IsMissedInOneLine) {
  ::setenv(kVariable, "/nowhere/adamas-reader", 1);
  EXPECT_EQ(error_of([&] { read_grid_file(file); }),
            "ADAMAS_READER_PROGRAM: expected a program, found none at '/nowhere/adamas-reader'");
  ::unsetenv(kVariable);
  const std::string message = error_of([&] { read_grid_file(file); });
  EXPECT_TRUE(says(message, "expected the program 'adamas-reader' in "));
  EXPECT_TRUE(says(message, "(the variable ADAMAS_READER_PROGRAM can name it)"));
}

TEST_F(ReaderProgram, HasOpenNothingButItsStreams) {
  const int open = ::dup(STDERR_FILENO);
  replace_by("ls /proc/self/fd > " + (scratch / "open").string());
  error_of([&] { read_grid_file(file); });
  ::close(open);
  // The fourth descriptor is the folder that is being listed.
  EXPECT_EQ(test::bytes_of(scratch / "open"), "0\n1\n2\n3\n");
}

TEST_F(ReaderProgram, EndsWithThisProcess) {
  const auto pid = scratch / "pid";
  replace_by("echo $$ > " + pid.string() + ".part && mv " + pid.string() + ".part " + pid.string() +
             " && exec sleep 100");
  const pid_t parent = ::fork();
  if (parent == 0) {
    try {
      read_grid_file(file);
    } catch (...) {
    }
    ::_exit(0);
  }
  const auto soon = [](auto&& condition) {
    for (int i = 0; i < 2000 && !condition(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    return condition();
  };
  EXPECT_TRUE(soon([&] { return std::filesystem::exists(pid); }));
  ::kill(parent, SIGKILL);
  ::waitpid(parent, nullptr, 0);
  const int reader = std::stoi(test::bytes_of(pid));
  EXPECT_TRUE(soon([reader] {
    const std::string stat = test::bytes_of("/proc/" + std::to_string(reader) + "/stat");
    return stat.empty() || stat.find(") Z") != std::string::npos;
  }));
}

/// A child that continued with this program's code might wait for ever for a lock, held by a thread that it
/// does not have.
TEST_F(ReaderProgram, DoesNotMindThreadsThatAllocate) {
  std::atomic<bool> stop = false;
  std::vector<std::thread> threads;
  for (unsigned t = 0; t < 2; ++t) {
    threads.emplace_back([&stop, t] {
      std::vector<std::string> kept(64);
      for (std::size_t i = 0; !stop; ++i) kept[i % kept.size()] = std::string(17 * (i % 97) + 31 * t, 'x');
    });
  }
  const GridFile first = read_grid_file(file);
  for (int i = 0; i < 15; ++i) EXPECT_TRUE(equal(read_grid_file(file), first)) << i;
  // Several readers work at once, too.
  std::vector<std::thread> readers;
  std::atomic<int> same = 0;
  for (int t = 0; t < 3; ++t) {
    readers.emplace_back([&] {
      for (int i = 0; i < 3; ++i) same += equal(read_grid_file(file), first) ? 1 : 0;
    });
  }
  for (std::thread& reader : readers) reader.join();
  EXPECT_EQ(same, 9);
  stop = true;
  for (std::thread& thread : threads) thread.join();
}

TEST_F(LongReaderProgram, IsEndedAtItsTime) {
  EXPECT_EQ(error_with("exec sleep 1000"),
            begun(": expected a readable file, found none within the time limit"));
}

}  // namespace
}  // namespace adamas
