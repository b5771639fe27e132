#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace adamas::timevarying {

/// The step that comes after the last one: none, the first one, or the one before.
enum class Repeat : std::uint8_t { kOnce, kLoop, kThereAndBack };

/// The slowest and the fastest that steps are played, in steps per second.
inline constexpr double kSlowest = 0.5, kFastest = 60;

/// How steps are played.
struct StepPace {
  double steps_per_second = 10;  ///< kSlowest to kFastest
  Repeat repeat = Repeat::kLoop;
  bool is_backward = false;
  /// The seconds that a step stays longer than its own time while the next one is not ready.
  double patience = 0.5;

  bool operator==(const StepPace&) const = default;
};

/// Tells which step of a series is to be shown as time goes by. No step is left out: where steps are not
/// ready in time, or pictures take longer than a step, the series goes more slowly.
class StepClock {
 public:
  /// Sets the number of steps, at least one.
  void set_steps(std::uint32_t steps) { steps_ = steps; }
  [[nodiscard]] StepPace& pace() { return pace_; }
  [[nodiscard]] const StepPace& pace() const { return pace_; }

  [[nodiscard]] bool is_playing() const { return is_playing_; }
  void pause() { is_playing_ = false; }
  /// Returns the step to begin with: the one that is shown, unless nothing comes after it.
  std::uint32_t play(std::uint32_t shown);
  /// The step to be shown when `seconds` more have passed. `is_ready` says that all of the next step is
  /// there; if it is not, the step comes after a while all the same.
  std::uint32_t advance(std::uint32_t shown, double seconds, bool is_ready);
  /// The steps that come after one, each once and the next one first, at most `most` of them.
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
  double shown_for_ = 0;  ///< seconds
};

}  // namespace adamas::timevarying
