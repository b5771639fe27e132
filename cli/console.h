#pragma once

#include <fmt/format.h>

#include <chrono>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/progress.h"

namespace adamas {

/// What the user sees of a run: results on stdout, notes and progress on stderr. Progress is a bar where
/// stderr is a terminal, a line per stage with `verbose`, else nothing.
class Console final : public Progress {
 public:
  bool quiet = false;
  bool verbose = false;

  /// Results; left out with `quiet`.
  template <class... Args>
  void print(fmt::format_string<Args...> format, Args&&... args) {
    if (!quiet) write(fmt::format(format, std::forward<Args>(args)...));
  }
  /// Something odd that does not stop the run; left out with `quiet`.
  template <class... Args>
  void note(fmt::format_string<Args...> format, Args&&... args) {
    if (!quiet) write_note(fmt::format(format, std::forward<Args>(args)...));
  }
  /// What a result lacks since the input is damaged: a note whatever `quiet` says, and another exit status.
  template <class... Args>
  void note_damage(fmt::format_string<Args...> format, Args&&... args) {
    write_note(fmt::format(format, std::forward<Args>(args)...));
    damage_noted_ = true;
  }
  [[nodiscard]] bool damage_noted() const { return damage_noted_; }
  /// Columns of text, the first one to the left and the others to the right.
  void table(const std::vector<std::vector<std::string>>& rows);
  /// To stdout, whatever `quiet` says.
  void write(std::string_view text);
  /// Throws Error where stdout could not take everything, a closed pipe apart.
  void flush();

  void report(std::string_view stage, double fraction) override;
  [[nodiscard]] bool cancelled() const override;
  /// Takes the bar away.
  void clear();
  /// Seconds since the program started.
  [[nodiscard]] double seconds() const;

 private:
  using Clock = std::chrono::steady_clock;
  void write_note(const std::string& text);

  Clock::time_point start_ = Clock::now(), drawn_{};
  std::string stage_;
  bool bar_ = false, damage_noted_ = false;
};

}  // namespace adamas
