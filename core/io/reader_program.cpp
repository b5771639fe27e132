#include "core/io/reader_program.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <new>
#include <utility>

#include "adamas/stopping_signals.h"
#include "core/base/child_process.h"
#include "core/base/error.h"
#include "core/base/sanitizers.h"
#include "core/base/unnamed_file.h"
#include "core/io/array_file_head.h"
#include "core/io/hdf5_layout.h"
#include "core/io/input_file.h"
#include "core/io/spy_dump.h"

namespace adamas::io {

namespace {

/// The memory that the reader of a small file of arrays may take, including its libraries.
constexpr std::uint64_t kReaderBytes = std::uint64_t{2} << 30;

ChildSetup setup_of(const ReaderRequest& request, const MemoryFile& in, int out) {
  ChildSetup setup;
  setup.program = find_own_program(kReaderProgram, kReaderVariable);
  setup.complaint = request.name + ": no process for its reader";
  setup.streams = {in.descriptor(), out, -1};
  if (!ADAMAS_HAS_SHADOW_MEMORY) {
    setup.memory_bytes = static_cast<std::size_t>(::sysconf(_SC_PHYS_PAGES)) *
                         static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
    if (request.reader == LibraryReader::kArrays)
      setup.memory_bytes =
          std::min<std::uint64_t>(setup.memory_bytes, kReaderBytes + most_array_bytes(request.input_bytes));
  }
  setup.alarm_seconds =
      static_cast<unsigned>(std::min<std::uint64_t>(20 + request.input_bytes / 1'000'000, 86'400));
  return setup;
}

[[noreturn]] void fail_stopped(const std::string& name, int status) {
  if (WIFSIGNALED(status)) {
    const int number = WTERMSIG(status);
    const auto& stopping = kStoppingSignals;
    if (std::find(stopping.begin(), stopping.end(), number) != stopping.end()) throw Cancelled();
    if (number == SIGALRM) fail("{}: expected a readable file, found none within the time limit", name);
    fail("{}: expected a readable file, found a corrupt one (its reader ended by signal {}, {})", name,
         number, ::strsignal(number));
  }
  if (WEXITSTATUS(status) == ChildProcess::kTooManyFiles)
    fail("{}: no process for its reader: too many files are open (ulimit -n)", name);
  if (WEXITSTATUS(status) == ChildProcess::kNotStarted) {
    fail("{}: its reader, the program adamas-reader, could not be started", name);
  }
  fail("{}: expected a readable file, found a corrupt one (its reader ended with status {})", name,
       WEXITSTATUS(status));
}

class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() { close(); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  [[nodiscard]] int number() const { return number_; }
  void close() {
    if (number_ >= 0) ::close(std::exchange(number_, -1));
  }

 private:
  int number_;
};

}  // namespace

std::string reader_version() { return ADAMAS_VERSION; }

ReaderRequest request_of(LibraryReader reader, const std::filesystem::path& path) {
  ReaderRequest request{reader, path.string(), check_input_file(path), {path.string()}};
  // These files stand for others beside them.
  const std::string extension = file_extension(path);
  for (const char* whole : {".pvti", ".pvtr", ".pvtu", ".pvts", ".vtm", ".vth", ".vthb", ".silo", ".pdb"}) {
    if (extension == whole) request.input_bytes = size_of_folder(path.parent_path());
  }
  const bool of_cells = reader == LibraryReader::kCells || reader == LibraryReader::kCellTimes;
  if (of_cells && is_spy_dump(path)) request.input_bytes = size_of_folder(path.parent_path());
  request.layout = hdf5_layout_texts();
  return request;
}

void read_in_child(const ReaderRequest& request, const std::function<void(ByteSource&)>& consume) {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0)
    fail("{}: no pipe for its reader: {}", request.name, std::strerror(errno));
  const Descriptor output(ends[0]);
  Descriptor input(ends[1]);
  ::fcntl(input.number(), F_SETPIPE_SZ, static_cast<int>(kFrameBytes));
  const MemoryFile question("adamas-request");
  ByteSink sink(question.descriptor());
  sink.put(reader_version());
  sink.put(request);
  sink.finish();
  ::lseek(question.descriptor(), 0, SEEK_SET);
  ChildProcess child(setup_of(request, question, input.number()));
  input.close();
  try {
    ByteSource source(output.number());
    consume(source);
    source.expect_end();
  } catch (const TruncatedStream&) {
    fail_stopped(request.name, child.wait());
  }
}

}  // namespace adamas::io
