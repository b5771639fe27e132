#pragma once

#include <fmt/format.h>

#include <chrono>
#include <set>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "adamas/progress.h"
#include "adamas/text.h"
#include "cli/time_left.h"
#include "cli/usage.h"

namespace adamas::cli {

/// Opens the null device for each closed standard stream, so that no file of the program gets its number:
/// nothing can be read from it or written to it.
void occupy_closed_streams();

/// The output of a run: results on stdout, notes and progress on stderr. Progress is a bar where stderr is a
/// terminal, a line per stage with `verbose`, else nothing. Texts that are put into messages, such as names
/// and contents of files, cannot control a terminal (visible_text).
class Console final : public Progress {
 public:
  bool quiet = false;
  bool verbose = false;
  /// The present one of several things that are done one after another: it is put before notes that do not
  /// begin with it; empty for none.
  std::string about;

  /// Prints results; left out with `quiet`.
  template <class... Args>
  void print(fmt::format_string<Args...> format, Args&&... args) {
    if (!quiet) write(text<Args...>(format, args...));
  }
  /// Prints a note about something unusual that does not stop the run; left out with `quiet`.
  template <class... Args>
  void note(fmt::format_string<Args...> format, Args&&... args) {
    if (!quiet) write_note(text<Args...>(format, args...));
  }
  /// Prints a note that the result lacks something since the input is damaged, or that a wanted error was not
  /// reached. It is printed even with `quiet`, and changes the exit status.
  template <class... Args>
  void note_incomplete(fmt::format_string<Args...> format, Args&&... args) {
    write_note(text<Args...>(format, args...));
    incomplete_ = true;
  }
  /// Returns whether the result lacks something that was wanted.
  [[nodiscard]] bool incomplete() const { return incomplete_; }
  /// Prints columns of text, the first one aligned to the left and the others to the right.
  void table(std::vector<std::vector<std::string>> rows);
  /// Writes a text to stdout as it is, whatever `quiet` says.
  void write(std::string_view text);
  /// Throws Error where stdout has not taken all text since the program started; a closed pipe is no error.
  void flush();

  void report(std::string_view stage, double fraction) override;
  void note(NoteKind kind, std::string_view text) override;
  [[nodiscard]] bool wants_all_notes() const override { return verbose; }
  [[nodiscard]] bool cancelled() const override;
  /// Removes the bar.
  void clear();
  /// Returns the stage that was reported last; empty before.
  [[nodiscard]] const std::string& stage() const { return stage_; }
  /// Returns the seconds since the program started.
  [[nodiscard]] double seconds() const;

 private:
  using Clock = std::chrono::steady_clock;
  void take_part(double fraction);
  [[nodiscard]] std::string time_left() const;
  void draw_bar() const;
  void write_note(const std::string& text);
  void write_loss(const std::string& text);
  void push_out();

  template <class T>
  static decltype(auto) shown(const T& value) {
    if constexpr (std::is_convertible_v<const T&, std::string_view>) {
      return visible_text(value);
    } else {
      return (value);
    }
  }
  template <class... Args>
  static std::string text(fmt::format_string<Args...> format, const std::remove_reference_t<Args>&... args) {
    return fmt::format(fmt::runtime(fmt::string_view(format)), shown(args)...);
  }

  Clock::time_point start_ = Clock::now();
  mutable Clock::time_point drawn_{};
  std::string stage_, shown_;  ///< the name of the stage; its text, with what is after the colon
  double part_ = -1;           ///< the part of the stage that is done; negative where it is not known
  TimeLeft time_left_;
  std::set<std::string> losses_;
  mutable bool bar_ = false;  ///< whether there is a bar on the screen
  bool incomplete_ = false;
  int write_error_ = 0;  ///< errno of the first write to stdout that failed
};

}  // namespace adamas::cli
