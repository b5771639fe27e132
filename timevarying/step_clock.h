#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace adamas::timevarying {

/// What comes after the last step: nothing, the first step, or the step before.
enum class Repeat : std::uint8_t { kOnce, kLoop, kThereAndBack };

/// The slowest and the fastest pace, in steps per second.
inline constexpr double kSlowest = 0.5, kFastest = 60;

/// How steps are played.
struct StepPace {
  double steps_per_second = 10;  ///< kSlowest to kFastest
  Repeat repeat = Repeat::kLoop;
  bool is_backward = false;
  /// The greatest number of seconds to wait beyond a step's own time for the next one to be ready.
  double patience = 0.5;

  bool operator==(const StepPace&) const = default;
};

/// Determines which step of a series is to be shown as time passes. No step is skipped: if steps are not
/// ready in time, or pictures take longer than a step, the series plays more slowly.
class StepClock {
 public:
  /// Sets the number of steps, at least one.
  void set_steps(std::uint32_t steps) { steps_ = steps; }
  [[nodiscard]] StepPace& pace() { return pace_; }
  [[nodiscard]] const StepPace& pace() const { return pace_; }

  [[nodiscard]] bool is_playing() const { return is_playing_; }
  void pause() { is_playing_ = false; }
  /// Returns the step to begin with: the one that is shown, unless no step follows it.
  std::uint32_t play(std::uint32_t shown);
  /// Returns the step to be shown when `seconds` more have passed. `is_ready` says whether all of the next
  /// step is in memory; if it is not, the step is still shown after a while.
  std::uint32_t advance(std::uint32_t shown, double seconds, bool is_ready);
  /// The steps that follow a step, each once and the next one first, at most `most` of them.
  [[nodiscard]] std::vector<std::uint32_t> following(std::uint32_t step, std::size_t most) const;

 private:
  struct Place {
    std::uint32_t step;
    bool is_backward;
  };
  [[nodiscard]] std::optional<Place> after(Place place) const;

  std::uint32_t steps_ = 1;
  StepPace pace_;
  bool is_playing_ = false;
  double shown_for_ = 0;  ///< in seconds
};

}  // namespace adamas::timevarying
