#pragma once

#include <cstdint>
#include <string_view>

#include "adamas/error.h"
#include "adamas/export.h"

namespace adamas ADAMAS_API {

/// The subject of a note.
enum class NoteKind : std::uint8_t {
  kRemark,      ///< something unusual in the input, or something that was assumed
  kLoss,        ///< the output does not have what the input has, such as digits of numbers
  kIncomplete,  ///< the output lacks something because the input is damaged, or misses an error that was
                ///< wanted
};

/// Receives the progress of long work and notes about it, and can stop it. Calls come from one thread at a
/// time.
class Progress {
 public:
  virtual ~Progress() = default;
  /// Receives the progress of a stage. `fraction` is in [0, 1], or negative where the amount of work is not
  /// known; `stage` names what is being done.
  virtual void report(std::string_view stage, double fraction) = 0;
  /// Receives a note of one line that does not stop the work; it is dropped unless this is overridden.
  virtual void note(NoteKind kind, std::string_view text) {
    static_cast<void>(kind);
    static_cast<void>(text);
  }
  /// Returns whether notes about many things of one kind name each of them; otherwise they name one and count
  /// the others.
  [[nodiscard]] virtual bool wants_all_notes() const { return false; }
  [[nodiscard]] virtual bool cancelled() const { return false; }

  /// Throws Cancelled where the user asked to stop.
  void check() const {
    if (cancelled()) throw Cancelled();
  }
  /// Checks for cancellation, and reports the stage.
  void step(std::string_view stage, double fraction) {
    check();
    report(stage, fraction);
  }
};

/// A progress that reports to nobody and never cancels.
class SilentProgress final : public Progress {
 public:
  void report(std::string_view, double) override {}
  /// Returns an instance for default arguments.
  static SilentProgress& instance() {
    static SilentProgress silent;
    return silent;
  }
};

/// Limits the number of threads of each later call of the library, the calling thread included; 0 means all
/// cores. Results do not depend on it. Loops of the library run in arenas of their own: other uses of oneTBB
/// in the process are left as they are, unless more threads are asked for than there are cores.
void set_thread_limit(unsigned threads);
/// Returns the greatest number of threads that later calls take.
unsigned thread_limit();

}  // namespace adamas
