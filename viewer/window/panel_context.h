#pragma once

#include "viewer/session/view_session.h"

struct ImGuiContext;

namespace adamas::viewer {

/// A context of Dear ImGui. Panels work in it without OpenGL too, as in tests.
class PanelContext {
 public:
  /// `scale`: the size of texts and panels relative to a plain screen, for screens with small pixels.
  explicit PanelContext(double scale = 1);
  ~PanelContext();
  PanelContext(const PanelContext&) = delete;
  PanelContext& operator=(const PanelContext&) = delete;

  /// Has panels drawn with the OpenGL context that is current. Throws Error where that does not work.
  void use_opengl();
  /// Makes this the context that calls of Dear ImGui concern, as begin() does.
  void make_current();
  /// Begins and ends the panels of a picture of this size, `seconds` after the one before.
  void begin(int width, int height, double seconds);
  void end();
  /// Draws the panels into the framebuffer that is bound.
  void draw();

 private:
  ImGuiContext* context_;
  bool uses_opengl_ = false;
};

}  // namespace adamas::viewer
