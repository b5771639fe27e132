#pragma once

#include <optional>
#include <string_view>

#include "viewer/session/view_session.h"

namespace adamas::viewer {

enum class MouseButton { kLeft, kMiddle, kRight };

/// What mouse and keys do to a session, as F3D and ParaView have it: left turns, Shift or middle pans, right
/// and the wheel zoom; a click without a way picks; the plane's handle is dragged. Places are in pixels from
/// the upper left corner.
class WindowInput {
 public:
  /// The session must outlive this.
  explicit WindowInput(ViewSession& session) : session_(session) {}

  void press(MouseButton button, bool has_shift, double x, double y);
  void move(double x, double y);
  void release(double x, double y);
  void wheel(double steps);
  /// A key by the name that kKeyBindings has. Returns whether it does something.
  bool key(std::string_view name);
  /// Moves the camera while arrows and Page Up and Down are held, in the camera mode that flies: by parts of
  /// the distance to the target in a second.
  void fly(double forward, double right, double up, double seconds);

  /// What the last click met; none where it met nothing.
  [[nodiscard]] const std::optional<Picked>& picked() const { return picked_; }
  void forget_picked() { picked_.reset(); }
  /// Adds to that what has come to be known by now. Returns whether more is to come.
  bool complete_picked();

 private:
  enum class Drag { kNone, kTurn, kPan, kZoom, kCut };

  ViewSession& session_;
  Drag drag_ = Drag::kNone;
  double x_ = 0, y_ = 0;  ///< where the mouse was last
  double way_ = 0;        ///< in pixels, since a button was pressed
  std::optional<Picked> picked_;
};

}  // namespace adamas::viewer
