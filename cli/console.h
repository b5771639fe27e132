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
#include "cli/usage.h"

namespace adamas::cli {

/// Opens the null device for each of the three standard streams that is closed, so that no file of the
/// program gets its number: nothing can be read from it or written to it.
void occupy_closed_streams();

/// What the user sees of a run: results on stdout, notes and progress on stderr. Progress is a bar where
/// stderr is a terminal, a line per stage with `verbose`, else nothing. Texts that are put into messages,
/// which may be names of files and what files hold, cannot act on a terminal (visible_text).
class Console final : public Progress {
 public:
  bool quiet = false;
  bool verbose = false;
  /// Of several things that are done one after another, which one: put before notes that do not begin
  /// with it; empty for none.
  std::string about;

  /// Results; left out with `quiet`.
  template <class... Args>
  void print(fmt::format_string<Args...> format, Args&&... args) {
    if (!quiet) write(text<Args...>(format, args...));
  }
  /// Something odd that does not stop the run; left out with `quiet`.
  template <class... Args>
  void note(fmt::format_string<Args...> format, Args&&... args) {
    if (!quiet) write_note(text<Args...>(format, args...));
  }
  /// What a result lacks since the input is damaged, or an error that was wanted and not reached: a note
  /// whatever `quiet` says, and another exit status.
  template <class... Args>
  void note_incomplete(fmt::format_string<Args...> format, Args&&... args) {
    write_note(text<Args...>(format, args...));
    incomplete_ = true;
  }
  /// Whether the result is not all that was wanted.
  [[nodiscard]] bool incomplete() const { return incomplete_; }
  /// Columns of text, the first one to the left and the others to the right.
  void table(std::vector<std::vector<std::string>> rows);
  /// To stdout as it is, whatever `quiet` says.
  void write(std::string_view text);
  /// Throws Error where stdout has not taken everything since the program started, a closed pipe apart.
  void flush();

  void report(std::string_view stage, double fraction) override;
  void note(NoteKind kind, std::string_view text) override;
  [[nodiscard]] bool wants_all_notes() const override { return verbose; }
  [[nodiscard]] bool cancelled() const override;
  /// Takes the bar away.
  void clear();
  /// What is being done, as it was last reported; empty before.
  [[nodiscard]] const std::string& stage() const { return stage_; }
  /// Seconds since the program started.
  [[nodiscard]] double seconds() const;

 private:
  using Clock = std::chrono::steady_clock;
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

  Clock::time_point start_ = Clock::now(), drawn_{};
  std::string stage_;
  std::set<std::string> losses_;
  bool bar_ = false, incomplete_ = false;
  int write_error_ = 0;  ///< errno of the first write to stdout that failed
};

}  // namespace adamas::cli
