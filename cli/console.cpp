#include "cli/console.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>

#include "cli/interrupt.h"

namespace adamas::cli {

namespace {

constexpr std::size_t kBarWidth = 24;
constexpr std::chrono::milliseconds kBarInterval{100};
/// The interval at which the bar is drawn anew although nothing was reported, for its seconds.
constexpr std::chrono::milliseconds kTickInterval{500};
/// The interval at which a long stage is printed again where there is no bar.
constexpr std::chrono::seconds kLineInterval{10};

std::string percentage(double fraction) {
  return fraction < 0 ? "" : fmt::format("  {:.0f}%", 100 * fraction);
}

/// Returns the number of characters of UTF-8 text.
std::size_t width(std::string_view text) {
  const auto starts = [](char c) { return (static_cast<unsigned char>(c) & 0xC0u) != 0x80u; };
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), starts));
}

void to_stderr(const std::string& text) { std::fwrite(text.data(), 1, text.size(), stderr); }

}  // namespace

void occupy_closed_streams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (::fcntl(stream, F_GETFD) >= 0) continue;
    // This call gets the lowest free number, which is this one, since those below are occupied.
    static_cast<void>(::open("/dev/null", stream == STDIN_FILENO ? O_WRONLY : O_RDONLY));
  }
}

void Console::table(std::vector<std::vector<std::string>> rows) {
  for (auto& row : rows) std::transform(row.begin(), row.end(), row.begin(), visible_text);
  std::vector<std::size_t> widths;
  for (const auto& row : rows) {
    widths.resize(std::max(widths.size(), row.size()));
    for (std::size_t c = 0; c < row.size(); ++c) widths[c] = std::max(widths[c], width(row[c]));
  }
  for (const auto& row : rows) {
    std::string line = "  ";
    for (std::size_t c = 0; c < row.size(); ++c) {
      const std::string space(widths[c] - width(row[c]), ' ');
      line += c == 0 ? row[c] + space : "  " + space + row[c];
    }
    line.erase(line.find_last_not_of(' ') + 1);
    print("{}\n", line);
  }
}

void Console::write(std::string_view text) {
  clear();
  errno = 0;
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() && write_error_ == 0)
    write_error_ = errno;
}

/// The first error is kept, since a later call may succeed although earlier text is lost.
void Console::push_out() {
  errno = 0;
  if (std::fflush(stdout) != 0 && write_error_ == 0) write_error_ = errno;
}

void Console::write_note(const std::string& text) {
  clear();
  push_out();
  // Many notes begin with the name of their file already.
  const std::string name = about.empty() ? "" : visible_text(about) + ": ";
  to_stderr("adamas: note: " + (text.starts_with(name) ? "" : name) + text + "\n");
}

void Console::flush() {
  push_out();
  if (write_error_ != 0 && write_error_ != EPIPE)
    fail("standard output: could not be written: {}", std::strerror(write_error_));
}

/// Takes the part that is done, which never falls within a stage.
void Console::take_part(double fraction) {
  if (fraction < 0) {
    part_ = -1;
    return;
  }
  part_ = std::max(part_, std::min(fraction, 1.0));
  time_left_.add(seconds(), part_);
}

/// Returns ", about 40 s left", of the present stage; empty where that is not known.
std::string Console::time_left() const {
  if (part_ < 0) return "";
  const std::optional<double> left = time_left_.left(seconds());
  return left ? ", " + duration_text(*left) + " left" : "";
}

void Console::report(std::string_view stage, double fraction) {
  // A stage counts as the same one as before if it differs only after the colon.
  const std::string_view name = stage.substr(0, stage.find(':'));
  const bool again = fraction == 0 && part_ > 0;
  const bool is_new = name != stage_ || again;
  if (is_new) {
    stage_ = name;
    part_ = -1;
    time_left_.start(seconds());
  }
  take_part(fraction);
  if (quiet) return;
  shown_ = stage;
  const bool has_bar = isatty(STDERR_FILENO) != 0;
  if (verbose && (is_new || (!has_bar && Clock::now() - drawn_ >= kLineInterval))) {
    clear();
    const std::string part = is_new ? "" : percentage(part_) + time_left();
    to_stderr(fmt::format("adamas: {:8.2f} s  {}{}\n", seconds(), visible_text(is_new ? name : stage), part));
    if (!has_bar) drawn_ = Clock::now();
  }
  if (has_bar && Clock::now() - drawn_ >= kBarInterval) draw_bar();
}

void Console::draw_bar() const {
  std::string bar;
  if (part_ >= 0) {
    const auto full = static_cast<std::size_t>(part_ * static_cast<double>(kBarWidth));
    bar = fmt::format("[{:<{}}] {:3.0f}%  ", std::string(full, '#'), kBarWidth, 100 * part_);
  }
  to_stderr(fmt::format("\r\033[K{}{}{}  {:.1f} s", bar, visible_text(shown_), time_left(), seconds()));
  bar_ = true;
  drawn_ = Clock::now();
}

void Console::note(NoteKind kind, std::string_view text) {
  const std::string shown = visible_text(text);
  switch (kind) {
    case NoteKind::kRemark:
      if (!quiet) write_note(shown);
      break;
    case NoteKind::kLoss:
      write_loss(shown);
      break;
    case NoteKind::kIncomplete:
      write_note(shown);
      incomplete_ = true;
      break;
  }
}

/// Writes a note about a loss once, whatever `quiet` says.
void Console::write_loss(const std::string& text) {
  if (losses_.insert(text).second) write_note(text);
}

/// Loops ask this more often than they report.
bool Console::cancelled() const {
  if (bar_ && Clock::now() - drawn_ >= kTickInterval) draw_bar();
  return interrupted();
}

void Console::clear() {
  if (bar_) to_stderr("\r\033[K");
  bar_ = false;
}

double Console::seconds() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

}  // namespace adamas::cli
