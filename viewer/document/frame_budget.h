#pragma once

#include <cstdint>

namespace adamas::viewer {

/// How many triangles frames get, and for how long they are worked on, where each is to be there within a
/// time. A frame that was stopped shows nothing new; so those of a moving camera have as many triangles as
/// there is time for, and those of one that stands still get more, and more time, until they have all.
class FrameBudget {
 public:
  /// `seconds`: for a frame; 0: there is no limit. `most`: triangles of the whole frame. A frame of another
  /// view begins with the time that is wanted.
  void begin(double seconds, std::uint64_t most, bool is_same_view);
  /// For the next frame: its triangles, and after how many seconds it is to be stopped; 0: never.
  [[nodiscard]] std::uint64_t triangles() const;
  [[nodiscard]] double seconds() const { return allowed_; }
  /// How the frame came out: after how many seconds, and whether it was stopped.
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
