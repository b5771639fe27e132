#include "viewer/window/window_input.h"

#include <cmath>

#include "viewer/session/camera_control.h"
#include "viewer/session/picking.h"
#include "viewer/window/key_bindings.h"

namespace adamas::viewer {

using namespace isosurface;

namespace {

/// The distance from the plane's handle within which the mouse grabs it, and the greatest movement in a
/// click, in pixels.
constexpr double kHandleRadius = 14, kClickWay = 4;
/// The number of wheel steps per pixel of movement with the right button.
constexpr double kStepsPerPixel = 0.05;

bool is_at_handle(const ViewSession& session, double x, double y) {
  if (!session.state().cut.is_on) return false;
  const auto handle = in_picture(session.state().viewpoint, session.cut_handle());
  return handle && std::hypot((*handle)[0] - x, (*handle)[1] - y) < kHandleRadius;
}

}  // namespace

void WindowInput::press(MouseButton button, bool has_shift, double x, double y) {
  x_ = x;
  y_ = y;
  way_ = 0;
  if (button == MouseButton::kRight) {
    drag_ = Drag::kZoom;
  } else if (button == MouseButton::kMiddle || has_shift) {
    drag_ = Drag::kPan;
  } else {
    drag_ = is_at_handle(session_, x, y) ? Drag::kCut : Drag::kTurn;
  }
}

void WindowInput::move(double x, double y) {
  const double right = x - x_, down = y - y_;
  x_ = x;
  y_ = y;
  if (drag_ == Drag::kNone) return;
  way_ += std::hypot(right, down);
  Viewpoint& viewpoint = session_.state().viewpoint;
  switch (drag_) {
    case Drag::kTurn:
      viewpoint = rotated(viewpoint, session_.state().camera_mode, right, down);
      break;
    case Drag::kPan:
      viewpoint = panned(viewpoint, right, down);
      break;
    case Drag::kZoom:
      viewpoint = zoomed(viewpoint, -kStepsPerPixel * down);
      break;
    case Drag::kCut:
      session_.drag_cut(right, down);
      break;
    case Drag::kNone:
      break;
  }
}

void WindowInput::release(double x, double y) {
  const bool is_click = drag_ == Drag::kTurn && way_ < kClickWay;
  drag_ = Drag::kNone;
  if (is_click) picked_ = session_.pick(x, y);
}

bool WindowInput::complete_picked() {
  if (picked_) session_.complete(*picked_);
  return picked_ && picked_->reading.is_pending;
}

void WindowInput::wheel(double steps) {
  Viewpoint& viewpoint = session_.state().viewpoint;
  viewpoint = zoomed(viewpoint, steps);
}

bool WindowInput::key(std::string_view name) {
  for (const KeyBinding& binding : kKeyBindings) {
    if (binding.key != name) continue;
    session_.act(binding.action);
    return true;
  }
  return false;
}

void WindowInput::fly(double forward, double right, double up, double seconds) {
  if (session_.state().camera_mode != CameraMode::kFly) return;
  Viewpoint& viewpoint = session_.state().viewpoint;
  viewpoint = flown(viewpoint, seconds * forward, seconds * right, seconds * up);
}

}  // namespace adamas::viewer
