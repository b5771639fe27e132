#pragma once

#include "viewer/session/view_session.h"

struct ImGuiContext;

namespace adamas::viewer {

/// A context of Dear ImGui. Panels also work in it without OpenGL, as in tests.
class PanelContext {
 public:
  /// `scale`: the size of texts and panels relative to a standard screen, for screens with small pixels.
  explicit PanelContext(double scale = 1);
  ~PanelContext();
  PanelContext(const PanelContext&) = delete;
  PanelContext& operator=(const PanelContext&) = delete;

  /// Lets panels be drawn with the current OpenGL context. Throws Error if that fails.
  void use_opengl();
  /// Makes this the context for calls of Dear ImGui, as begin() does.
  void make_current();
  /// These begin and end the panels of a picture of this size, `seconds` after the one before.
  void begin(int width, int height, double seconds);
  void end();
  /// Draws the panels into the bound framebuffer.
  void draw();

 private:
  ImGuiContext* context_;
  bool uses_opengl_ = false;
};

}  // namespace adamas::viewer
