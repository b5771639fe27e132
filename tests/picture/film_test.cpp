#include "core/picture/film.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <iterator>

#include "core/base/child_process.h"
#include "core/base/error.h"
#include "tests/support/file_size_limit.h"
#include "tests/support/scratch.h"

namespace adamas {

using namespace picture;

namespace {

Raster frame_of(int width, int height, const Colour& left, const Colour& right) {
  Raster frame(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) frame.set(x, y, 2 * x < width ? left : right);
  }
  return frame;
}

std::string content(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// Films, made by the program in PATH; a test may set a PATH of its own.
class Films : public testing::Test {
 protected:
  Films() : path_(std::getenv("PATH")) {}
  ~Films() override { ::setenv("PATH", path_.c_str(), 1); }

  [[nodiscard]] bool can_make() const { return !find_program("ffmpeg").empty(); }
  /// Writes a program ffmpeg with this text, and sets PATH to its folder alone.
  void pretend(const std::string& text, bool executable = true) const {
    std::ofstream(scratch_ / "ffmpeg") << text;
    std::filesystem::permissions(scratch_ / "ffmpeg", std::filesystem::perms::owner_all);
    if (!executable) std::filesystem::permissions(scratch_ / "ffmpeg", std::filesystem::perms::owner_read);
    ::setenv("PATH", scratch_.folder().c_str(), 1);
  }
  void make(const std::filesystem::path& path, int width, int height) const {
    Film film(path, width, height, 5);
    for (const Colour& colour : {Colour{1, 0, 0}, Colour{0, 1, 0}, Colour{0, 0, 1}})
      film.add(frame_of(width, height, colour, {1, 1, 1}));
    EXPECT_FALSE(std::filesystem::exists(path));
    film.finish();
  }
  /// Returns the message of the Error that a film ends in; empty where it succeeds.
  [[nodiscard]] std::string failure(const std::filesystem::path& path, std::size_t frames) const {
    try {
      Film film(path, 64, 48, 5);
      for (std::size_t i = 0; i < frames; ++i) film.add(frame_of(64, 48, {1, 0, 0}, {0, 0, 1}));
      film.finish();
    } catch (const Error& error) {
      return error.what();
    }
    return {};
  }

  std::string path_;
  test::Scratch scratch_;
};

TEST_F(Films, HoldTheirFrames) {
  if (!can_make()) GTEST_SKIP() << "the program ffmpeg is not on PATH";
  for (const std::string ending : film_endings()) {
    const std::filesystem::path film = scratch_ / ("odd" + ending),
                                raw = scratch_ / ("odd" + ending + ".rgb");
    make(film, 65, 47);
    const std::string command = "ffmpeg -loglevel error -nostdin -y -i '" + film.string() +
                                "' -f rawvideo -pix_fmt rgb24 '" + raw.string() + "'";
    ASSERT_EQ(std::system(command.c_str()), 0);
    const std::string bytes = content(raw);
    // The sizes in a film are even numbers.
    ASSERT_EQ(bytes.size(), std::size_t{3 * 3 * 66 * 48}) << ending;
    for (std::size_t n = 0; n < 3; ++n) {
      const std::size_t first = n * 3 * 66 * 48 + 3 * (66 * 20 + 10), last = first + 3 * 40;
      for (std::size_t c = 0; c < 3; ++c) {
        const auto value = [&bytes, c](std::size_t at) { return static_cast<unsigned char>(bytes[at + c]); };
        EXPECT_NEAR(value(first), c == n ? 255 : 0, 30) << ending << " frame " << n << " component " << c;
        EXPECT_NEAR(value(last), 255, 30) << ending << " frame " << n << " component " << c;
      }
    }
    make(scratch_ / ("again" + ending), 65, 47);
    EXPECT_TRUE(content(film) == content(scratch_ / ("again" + ending))) << ending;
  }
}

TEST_F(Films, FramesOfAnotherSizeAreFilledUpOrCut) {
  if (!can_make()) GTEST_SKIP() << "the program ffmpeg is not on PATH";
  Film film(scratch_ / "f.gif", 40, 30, 5);
  for (const int side : {40, 20, 90}) film.add(frame_of(side, side, {1, 0, 0}, {1, 0, 0}));
  film.finish();
  EXPECT_TRUE(std::filesystem::exists(scratch_ / "f.gif"));
}

TEST_F(Films, WhatNoFilmIsIsRefused) {
  EXPECT_TRUE(is_film("a.MP4"));
  EXPECT_FALSE(is_film("a.avi"));
  EXPECT_THROW(Film(scratch_ / "f.avi", 10, 10, 5), Error);
  EXPECT_THROW(Film(scratch_ / "f.mp4", 1, 10, 5), Error);
  EXPECT_THROW(Film(scratch_ / "f.mp4", 10, 100000, 5), Error);
  EXPECT_THROW(Film(scratch_ / "f.mp4", 10, 10, 0), Error);
  EXPECT_EQ(scratch_.entries(), 0);
}

TEST_F(Films, ThereIsNoProgram) {
  ::setenv("PATH", scratch_.folder().c_str(), 1);
  EXPECT_NE(failure(scratch_ / "f.mp4", 1).find("f.mp4: expected the program ffmpeg"), std::string::npos);
  EXPECT_THROW(require_film_maker("f.mp4"), Error);
  // A file that cannot be executed is not taken for the program.
  pretend("#!/bin/sh\n", false);
  EXPECT_THROW(require_film_maker("f.mp4"), Error);
  EXPECT_EQ(scratch_.entries(), 1);
}

TEST_F(Films, AProgramThatFails) {
  // The program ends while frames are written to it, or after the last one. What it has made remains.
  for (const std::string text :
       {"#!/bin/sh\nexit 3\n", "#!/bin/sh\nexec 0<&-\necho 'no such encoder' >&2\nexit 1\n",
        "#!/bin/sh\n/bin/cat > /dev/null\necho 'no such encoder' >&2\nexit 1\n"}) {
    pretend(text);
    for (const std::size_t frames : {1u, 200u}) {
      const std::string message = failure(scratch_ / "f.mp4", frames);
      EXPECT_NE(message.find("f.mp4: ffmpeg could not make the film"), std::string::npos) << message;
      const std::string words =
          text.find("encoder") != std::string::npos ? "no such encoder" : "does not say why";
      EXPECT_NE(message.find(words), std::string::npos) << message;
      EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    }
  }
  EXPECT_EQ(scratch_.entries(), 1);
}

/// Returns a script that does what the real program does, but ends in another way.
std::string disguise(const std::filesystem::path& program, const std::string& end) {
  return "#!/bin/sh\n" + program.string() + " \"$@\"\n" + end;
}

TEST_F(Films, WhatIsSaidOrMissingIsAFailure) {
  const std::filesystem::path program = find_program("ffmpeg");
  if (program.empty()) GTEST_SKIP() << "the program ffmpeg is not on PATH";
  for (const std::string ending : film_endings()) {
    const std::filesystem::path film = scratch_ / ("f" + ending);
    // The program ends with status 0, and prints an error.
    pretend(disguise(program, "echo 'No space left on device' >&2\nexit 0\n"));
    const std::string said = failure(film, 3);
    EXPECT_NE(said.find(film.filename().string() + ": ffmpeg could not make the film: No space left"),
              std::string::npos)
        << said;
    // The program prints nothing, and leaves the first half of the film, or none of it.
    for (const std::string cut : {"/usr/bin/truncate -s $(($(/usr/bin/stat -c %s \"$f\") / 2)) \"$f\"",
                                  "/usr/bin/truncate -s 0 \"$f\""}) {
      pretend(disguise(program, "for f; do :; done\nf=\"${f#file:}\"\n[ \"$f\" = pipe:1 ] || " + cut + "\n"));
      EXPECT_NE(failure(film, 30).find("ffmpeg could not make the film"), std::string::npos) << ending << cut;
    }
    EXPECT_EQ(scratch_.entries(), 1) << ending;
  }
}

TEST_F(Films, AFilmBeyondTheLimitOfFilesIsAFailure) {
  if (!can_make()) GTEST_SKIP() << "the program ffmpeg is not on PATH";
  for (const std::string ending : film_endings()) {
    // EXPECT_EXIT runs in a child process, so that the limit ends with it.
    EXPECT_EXIT(
        {
          const test::FileSizeLimit limit(500);
          std::exit(failure(scratch_ / ("f" + ending), 30).empty() ? 1 : 0);
        },
        testing::ExitedWithCode(0), "")
        << ending;
    EXPECT_EQ(scratch_.entries(), 0) << ending;
  }
}

TEST_F(Films, NothingIsLeftOfAFilmThatIsNotFinished) {
  if (!can_make()) GTEST_SKIP() << "the program ffmpeg is not on PATH";
  {
    Film film(scratch_ / "f.mp4", 64, 48, 5);
    film.add(frame_of(64, 48, {1, 0, 0}, {0, 0, 1}));
  }
  EXPECT_EQ(scratch_.entries(), 0);
  EXPECT_NE(failure(scratch_ / "f.mp4", 0).find("expected a frame or more"), std::string::npos);
  EXPECT_EQ(failure(scratch_ / "f.mp4", 2), "");
  EXPECT_EQ(scratch_.entries(), 1);
}

}  // namespace
}  // namespace adamas
