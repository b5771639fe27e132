#pragma once

#include <cstdint>

namespace adamas::viewer {

/// The numbers of triangles and the times of frames that must be ready within a time. A frame that is stopped
/// shows nothing new; so frames of a moving camera have as many triangles as there is time for, and frames of
/// a camera at rest get more triangles and more time, until they are complete.
class FrameBudget {
 public:
  /// Begins a frame. `seconds`: the time for it, 0 for no limit. `most`: the triangles of the complete frame.
  /// A frame of another view begins with the given time.
  void begin(double seconds, std::uint64_t most, bool is_same_view);
  /// The triangles of the frame, and the seconds after which it has to be stopped, 0 for never.
  [[nodiscard]] std::uint64_t triangles() const;
  [[nodiscard]] double seconds() const { return allowed_; }
  /// Notes how many seconds the frame took, and whether it was stopped.
  void note(double seconds, bool is_stopped);
  /// Whether the last frame had all its triangles.
  [[nodiscard]] bool is_whole() const { return is_whole_; }

 private:
  static constexpr std::uint64_t kLeast = 2000;

  double wanted_ = 0, allowed_ = 0;
  std::uint64_t most_ = 0, affordable_ = UINT64_MAX;
  bool is_same_view_ = false, is_whole_ = false;
};

}  // namespace adamas::viewer
