#pragma once

#include <optional>
#include <string_view>

#include "viewer/session/view_session.h"

namespace adamas::viewer {

enum class MouseButton { kLeft, kMiddle, kRight };

/// Applies mouse and keys to a session, as F3D and ParaView do: the left button turns, Shift or the middle
/// button pans, the right button and the wheel zoom; a click without movement picks; the plane's handle can
/// be dragged. Places are in pixels from the upper left corner.
class WindowInput {
 public:
  /// The session must outlive this.
  explicit WindowInput(ViewSession& session) : session_(session) {}

  void press(MouseButton button, bool has_shift, double x, double y);
  void move(double x, double y);
  void release(double x, double y);
  void wheel(double steps);
  /// Does the action of a key, by its name in kKeyBindings. Returns whether it has one.
  bool key(std::string_view name);
  /// Moves the camera while arrows and Page Up and Down are held, in the mode CameraMode::kFly. Speeds are in
  /// distances to the target per second.
  void fly(double forward, double right, double up, double seconds);

  /// The object that the last click picked; empty if it met only the background.
  [[nodiscard]] const std::optional<Picked>& picked() const { return picked_; }
  void forget_picked() { picked_.reset(); }
  /// Completes its reading with values that are known now. Returns whether more is to come.
  bool complete_picked();

 private:
  enum class Drag { kNone, kTurn, kPan, kZoom, kCut };

  ViewSession& session_;
  Drag drag_ = Drag::kNone;
  double x_ = 0, y_ = 0;  ///< the last place of the mouse
  double way_ = 0;        ///< length of the path of the mouse since a button was pressed, in pixels
  std::optional<Picked> picked_;
};

}  // namespace adamas::viewer
