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

namespace adamas {

namespace {

constexpr int kGreatestSide = 16384;
constexpr double kGreatestRate = 240;

/// Encoders on a fixed number of threads, since their bytes depend on it, and nothing of the clock or the
/// version in the file.
std::vector<std::string> arguments(const std::string& extension, const std::filesystem::path& output,
                                   int width, int height, double rate) {
  std::vector<std::string> all{"-loglevel",
                               "error",
                               "-nostdin",
                               "-y",
                               "-f",
                               "rawvideo",
                               "-pixel_format",
                               "rgb24",
                               "-video_size",
                               fmt::format("{}x{}", width, height),
                               "-framerate",
                               fmt::format("{}", rate),
                               "-i",
                               "pipe:0"};
  const auto add = [&all](std::initializer_list<const char*> more) {
    all.insert(all.end(), more.begin(), more.end());
  };
  if (extension == ".mp4")
    add({"-c:v", "libx264", "-preset", "medium", "-crf", "18", "-pix_fmt", "yuv420p", "-movflags",
         "+faststart"});
  if (extension == ".webm") add({"-c:v", "libvpx-vp9", "-crf", "24", "-b:v", "0", "-pix_fmt", "yuv420p"});
  // One palette for all frames, without dots, so that areas of one colour stay so.
  if (extension == ".gif")
    add({"-filter_complex", "split[a][b];[a]palettegen=stats_mode=full[p];[b][p]paletteuse=dither=none"});
  add({"-threads", "2", "-fflags", "+bitexact", "-flags:v", "+bitexact", "-map_metadata", "-1"});
  // A name that begins with a dash, or looks like an address, is still a file's.
  all.push_back("file:" + std::filesystem::absolute(output).string());
  return all;
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
  /// What ffmpeg has said, in one line.
  [[nodiscard]] std::string complaint() const {
    const std::vector<char> content = messages.content();
    std::string text(content.begin(), content.end());
    text.erase(text.find_last_not_of(" \n") + 1);
    return text.empty() ? "without a word" : text.substr(text.find_last_of('\n') + 1);
  }
  [[noreturn]] void fail_ended() {
    close_pipe();
    child->wait();
    fail("{}: ffmpeg could not make the film: {}", path.string(), complaint());
  }

  std::filesystem::path path;
  OutputFile output;
  int width = 0, height = 0;  ///< of the film
  std::size_t frames = 0;
  std::vector<char> bytes;  ///< of a frame
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
  // A pair of sockets: writing to one whose other end is closed is an error then, and no signal.
  std::array<int, 2> ends{};
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0)
    fail("{}: no pipe to ffmpeg: {}", p.path.string(), std::strerror(errno));
  p.pipe = ends[0];
  ChildSetup setup;
  try {
    setup.program = film_maker(p.path);
    setup.arguments =
        arguments(lower_extension(p.path), p.output.temporary(), p.width, p.height, frames_per_second);
    setup.complaint = p.path.string() + ": no process for ffmpeg";
    setup.streams = {ends[1], -1, p.messages.descriptor()};
    p.child.emplace(setup);
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
  const int status = p.child->wait();
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
    fail("{}: ffmpeg could not make the film: {}", p.path.string(), p.complaint());
  p.output.commit();
}

}  // namespace adamas
