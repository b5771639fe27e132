#include "core/picture/film.h"

#include <fmt/format.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <optional>
#include <string>
#include <utility>

#include "core/base/child_process.h"
#include "core/base/error.h"
#include "core/base/output_file.h"
#include "core/base/unnamed_file.h"
#include "core/picture/picture_file.h"

namespace adamas::picture {

namespace {

constexpr int kGreatestSide = 16384;
constexpr double kGreatestRate = 240;

/// The path in a form that ffmpeg takes for a file, even if it begins with a dash or looks like an address.
std::string as_file(const std::filesystem::path& path) {
  return "file:" + std::filesystem::absolute(path).string();
}

/// Arguments for ffmpeg: encoders use a fixed number of threads, since their bytes depend on it, and write
/// neither the time nor their version into the file.
std::vector<std::string> arguments(const std::string& extension, const std::filesystem::path& output,
                                   int width, int height, double rate) {
  std::vector<std::string> all;
  const auto add = [&all](std::initializer_list<std::string> more) {
    all.insert(all.end(), more.begin(), more.end());
  };
  add({"-loglevel", "error", "-nostdin", "-y", "-f", "rawvideo", "-pixel_format", "rgb24"});
  add({"-video_size", fmt::format("{}x{}", width, height), "-framerate", fmt::format("{}", rate)});
  add({"-i", "pipe:0"});
  if (extension == ".mp4")
    add({"-c:v", "libx264", "-preset", "medium", "-crf", "18", "-pix_fmt", "yuv420p", "-movflags",
         "+faststart"});
  if (extension == ".webm") add({"-c:v", "libvpx-vp9", "-crf", "24", "-b:v", "0", "-pix_fmt", "yuv420p"});
  // A film in GIF has one palette for all frames, without dithering, so that areas of one colour stay so.
  if (extension == ".gif")
    add({"-filter_complex", "split[a][b];[a]palettegen=stats_mode=full[p];[b][p]paletteuse=dither=none"});
  add({"-threads", "2", "-fflags", "+bitexact", "-flags:v", "+bitexact", "-map_metadata", "-1",
       as_file(output)});
  return all;
}

/// Arguments for ffmpeg to read a finished film and print a line for each of its frames, and lines that begin
/// with #.
std::vector<std::string> reading_arguments(const std::filesystem::path& film) {
  return {"-loglevel", "error", "-nostdin", "-i", as_file(film), "-map",
          "0:v",       "-c",    "copy",     "-f", "framecrc",    "pipe:1"};
}

std::size_t frames_told(const std::vector<char>& lines) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < lines.size(); ++i)
    count += lines[i] != '#' && (i == 0 || lines[i - 1] == '\n') ? 1 : 0;
  return count;
}

/// Returns ", where 12 bytes are free" for a folder whose file system is almost full, else nothing.
std::string where_full(const std::filesystem::path& folder) {
  constexpr std::uintmax_t kPlenty = 1 << 20;
  std::error_code code;
  const std::filesystem::space_info space = std::filesystem::space(folder, code);
  return code || space.available >= kPlenty ? "" : fmt::format(", where {} bytes are free", space.available);
}

std::filesystem::path film_maker(const std::filesystem::path& path) {
  std::filesystem::path found = find_program("ffmpeg");
  if (found.empty())
    fail(
        "{}: expected the program ffmpeg, which makes films, on PATH, found none (Debian: apt install "
        "ffmpeg)",
        path.string());
  return found;
}

}  // namespace

const std::vector<const char*>& film_endings() {
  static const std::vector<const char*> kEndings{".mp4", ".webm", ".gif"};
  return kEndings;
}

bool is_film(const std::filesystem::path& path) {
  const std::string extension = lower_extension(path);
  return std::any_of(film_endings().begin(), film_endings().end(),
                     [&extension](const char* ending) { return extension == ending; });
}

void require_film_maker(const std::filesystem::path& path) { static_cast<void>(film_maker(path)); }

struct Film::Parts {
  explicit Parts(std::filesystem::path name) : path(std::move(name)), output(path) {}
  ~Parts() { close_pipe(); }
  Parts(const Parts&) = delete;
  Parts& operator=(const Parts&) = delete;

  void close_pipe() {
    if (pipe >= 0) ::close(std::exchange(pipe, -1));
  }
  /// The messages of ffmpeg in one line; empty if there are none.
  [[nodiscard]] std::string message_text() const {
    const std::vector<char> content = messages.content();
    std::string text(content.begin(), content.end());
    text.erase(text.find_last_not_of(" \n") + 1);
    return text.empty() ? text : text.substr(text.find_last_of('\n') + 1);
  }
  [[noreturn]] void fail_ended() {
    close_pipe();
    child->wait();
    fail_with(message_text());
  }
  [[noreturn]] void fail_with(const std::string& words) const {
    const std::filesystem::path folder = output.temporary().parent_path();
    fail("{}: ffmpeg could not make the film{}{}", path.string(),
         words.empty() ? " and does not say why" : ": " + words, where_full(folder.empty() ? "." : folder));
  }
  void start(const std::vector<std::string>& all, std::array<int, 3> streams) {
    ChildSetup setup;
    setup.program = film_maker(path);
    setup.arguments = all;
    setup.complaint = path.string() + ": no process for ffmpeg";
    setup.streams = streams;
    child.emplace(setup);
  }
  /// Waits for the program. Any message of it is a failure: on a full disk it ends with status 0.
  void end_well() {
    const int status = child->wait();
    const std::string found = message_text();
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0 || !found.empty()) fail_with(found);
  }
  /// Reads the film again, since neither status nor messages report everything that a full disk or a limit
  /// cut off.
  void check_whole() {
    const MemoryFile lines("adamas-film");
    start(reading_arguments(output.temporary()), {-1, lines.descriptor(), messages.descriptor()});
    end_well();
    const std::size_t found = frames_told(lines.content());
    if (found != frames) fail_with(fmt::format("of {} frames it has {}", frames, found));
  }

  std::filesystem::path path;
  OutputFile output;
  int width = 0, height = 0;  ///< size of the film
  std::size_t frames = 0;
  std::vector<char> bytes;  ///< samples of a frame
  MemoryFile messages{"adamas-film"};
  int pipe = -1;
  std::optional<ChildProcess> child;
};

Film::Film(std::filesystem::path path, int width, int height, double frames_per_second)
    : parts_(std::make_unique<Parts>(std::move(path))) {
  Parts& p = *parts_;
  if (!is_film(p.path)) fail("{}: expected a film's name, ending in .mp4, .webm or .gif", p.path.string());
  if (width < 2 || height < 2 || width > kGreatestSide || height > kGreatestSide)
    fail("{}: expected frames with sides of 2 to {} pixels, found {} x {}", p.path.string(), kGreatestSide,
         width, height);
  if (!(frames_per_second > 0 && frames_per_second <= kGreatestRate))
    fail("{}: expected up to {} frames per second, found {}", p.path.string(), kGreatestRate,
         frames_per_second);
  p.width = width + width % 2;
  p.height = height + height % 2;
  p.bytes.resize(std::size_t{3} * static_cast<std::size_t>(p.width) * static_cast<std::size_t>(p.height));
  // This is a pair of sockets: writing to one whose other end is closed is an error, not a signal.
  std::array<int, 2> ends{};
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0)
    fail("{}: no pipe to ffmpeg: {}", p.path.string(), std::strerror(errno));
  p.pipe = ends[0];
  try {
    p.start(arguments(lower_extension(p.path), p.output.temporary(), p.width, p.height, frames_per_second),
            {ends[1], -1, p.messages.descriptor()});
  } catch (...) {
    ::close(ends[1]);
    throw;
  }
  ::close(ends[1]);
}

Film::~Film() = default;

void Film::add(const Raster& frame) {
  Parts& p = *parts_;
  std::fill(p.bytes.begin(), p.bytes.end(), static_cast<char>(0xff));
  for (int y = 0; y < std::min(p.height, frame.height()); ++y) {
    char* to =
        p.bytes.data() + std::size_t{3} * static_cast<std::size_t>(y) * static_cast<std::size_t>(p.width);
    for (int x = 0; x < std::min(p.width, frame.width()); ++x) {
      const Raster::Pixel& pixel = frame.at(x, y);
      for (const std::uint8_t value : {pixel.r, pixel.g, pixel.b}) *to++ = static_cast<char>(value);
    }
  }
  for (std::size_t sent = 0; sent < p.bytes.size();) {
    const ssize_t count = ::send(p.pipe, p.bytes.data() + sent, p.bytes.size() - sent, MSG_NOSIGNAL);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) p.fail_ended();
    sent += static_cast<std::size_t>(count);
  }
  ++p.frames;
}

void Film::finish() {
  Parts& p = *parts_;
  if (p.frames == 0) fail("{}: expected a frame or more, found none", p.path.string());
  p.close_pipe();
  p.end_well();
  p.check_whole();
  p.output.commit();
}

}  // namespace adamas::picture
