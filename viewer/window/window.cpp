#include "viewer/window/window.h"

#include <dlfcn.h>
// This comes before GLFW, which would include another header of OpenGL.
#include <epoxy/gl.h>
// clang-format off
#include <GLFW/glfw3.h>
#include <imgui.h>
#include <backends/imgui_impl_glfw.h>
// clang-format on

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>
#include <vector>

#include "core/base/error.h"
#include "core/picture/canvas.h"
#include "core/picture/picture_file.h"
#include "viewer/gl/picture_target.h"
#include "viewer/gl/renderer.h"
#include "viewer/window/free_name.h"
#include "viewer/window/overlay.h"
#include "viewer/window/panel_context.h"
#include "viewer/window/panels.h"
#include "viewer/window/session_picture.h"
#include "viewer/window/step_export.h"
#include "viewer/window/window_input.h"

namespace adamas::viewer {

using namespace isosurface;
using namespace picture;

namespace {

/// The last error message of GLFW.
std::string& glfw_complaint() {
  static std::string text;
  return text;
}

/// GLFW between initialisation and termination, with a window of OpenGL 4.5.
class GlfwWindow {
 public:
  GlfwWindow(int width, int height, const std::string& title) {
    // Without this check epoxy would end the program if there is no OpenGL.
    if (dlopen("libGL.so.1", RTLD_LAZY | RTLD_LOCAL) == nullptr)
      fail("view: expected OpenGL, found no libGL.so.1");
    glfwSetErrorCallback([](int, const char* text) { glfw_complaint() = text; });
    if (glfwInit() != GLFW_TRUE)
      fail("view: expected a display for a window, found none ({}); --offscreen draws without",
           glfw_complaint());
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 4);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 5);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    glfwWindowHint(GLFW_CONTEXT_ROBUSTNESS, GLFW_LOSE_CONTEXT_ON_RESET);
    glfwWindowHint(GLFW_SCALE_TO_MONITOR, GLFW_TRUE);
    window_ = glfwCreateWindow(width, height, title.c_str(), nullptr, nullptr);
    if (window_ == nullptr) {
      glfwTerminate();
      fail("view: expected a window with OpenGL 4.5, found none ({}); --offscreen draws without",
           glfw_complaint());
    }
    glfwMakeContextCurrent(window_);
    glfwSwapInterval(1);
  }
  GlfwWindow(const GlfwWindow&) = delete;
  GlfwWindow& operator=(const GlfwWindow&) = delete;
  /// GLFW itself stays: drivers are not made to be unloaded.
  ~GlfwWindow() { glfwDestroyWindow(window_); }

  [[nodiscard]] GLFWwindow* get() const { return window_; }
  [[nodiscard]] float scale() const {
    float x = 1, y = 1;
    glfwGetWindowContentScale(window_, &x, &y);
    return std::max(x, y);
  }

 private:
  GLFWwindow* window_ = nullptr;
};

/// Mouse and keys for the panels by GLFW, as long as both exist.
class PanelInput {
 public:
  explicit PanelInput(GLFWwindow* window) { ImGui_ImplGlfw_InitForOpenGL(window, true); }
  PanelInput(const PanelInput&) = delete;
  PanelInput& operator=(const PanelInput&) = delete;
  ~PanelInput() { ImGui_ImplGlfw_Shutdown(); }
};

/// The name of a key in kKeyBindings.
std::string key_name(int key) {
  switch (key) {
    case GLFW_KEY_ENTER:
    case GLFW_KEY_KP_ENTER:
      return "Enter";
    case GLFW_KEY_SPACE:
      return "Space";
    case GLFW_KEY_TAB:
      return "Tab";
    case GLFW_KEY_ESCAPE:
      return "Escape";
    case GLFW_KEY_F12:
      return "F12";
    case GLFW_KEY_COMMA:
      return ",";
    case GLFW_KEY_PERIOD:
      return ".";
    case GLFW_KEY_HOME:
      return "Home";
    case GLFW_KEY_END:
      return "End";
    default:
      break;
  }
  if (key >= GLFW_KEY_KP_0 && key <= GLFW_KEY_KP_9) return fmt::format("{}", key - GLFW_KEY_KP_0);
  if ((key >= GLFW_KEY_A && key <= GLFW_KEY_Z) || (key >= GLFW_KEY_0 && key <= GLFW_KEY_9))
    return {static_cast<char>(key)};
  return "";
}

class Viewer {
 public:
  Viewer(ViewSession& session, const WindowOptions& options)
      : session_(session),
        options_(options),
        window_(options.width, options.height, title(session)),
        panels_(window_.scale()),
        input_(session) {
    glfwSetWindowUserPointer(window_.get(), this);
    set_callbacks();
    panel_input_ = std::make_unique<PanelInput>(window_.get());
    panels_.use_opengl();
    panel_state_.drawn_by = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
  }

  void run() {
    double before = glfwGetTime();
    while (glfwWindowShouldClose(window_.get()) == GLFW_FALSE && !session_.wants_end &&
           !options_.is_ended()) {
      // While nothing moves by itself, pictures need not be drawn continuously.
      constexpr double kSecondsOfSleep = 0.5, kSecondsOfWait = 0.01;
      if (session_.is_playing() || session_.clock().is_playing() || session_.is_recording() ||
          frames_to_draw_ > 0) {
        glfwPollEvents();
      } else {
        const bool is_waiting = export_ || !session_.report().is_current;
        glfwWaitEventsTimeout(is_waiting ? kSecondsOfWait : kSecondsOfSleep);
      }
      frames_to_draw_ = std::max(0, frames_to_draw_ - 1);
      const double now = glfwGetTime();
      frame(std::min(now - before, 0.25));
      before = now;
    }
  }

 private:
  static std::string title(const ViewSession& session) {
    std::string names;
    for (const auto& document : session.documents())
      names += (names.empty() ? "" : ", ") + document->facts().name;
    return names.empty() ? "adamas" : names + " - adamas";
  }

  static Viewer& viewer_of(GLFWwindow* window) {
    return *static_cast<Viewer*>(glfwGetWindowUserPointer(window));
  }

  /// These are set before those of the panels, which call them after their own.
  void set_callbacks() {
    GLFWwindow* const window = window_.get();
    glfwSetMouseButtonCallback(window, [](GLFWwindow* w, int button, int action, int mods) {
      viewer_of(w).button(button, action == GLFW_PRESS, mods);
    });
    glfwSetCursorPosCallback(window, [](GLFWwindow* w, double, double) { viewer_of(w).moved(); });
    glfwSetScrollCallback(window, [](GLFWwindow* w, double, double steps) { viewer_of(w).wheel(steps); });
    glfwSetKeyCallback(window, [](GLFWwindow* w, int key, int, int action, int) {
      if (action == GLFW_PRESS) viewer_of(w).key(key);
    });
    glfwSetDropCallback(window, [](GLFWwindow* w, int count, const char** paths) {
      for (int n = 0; n < count; ++n) viewer_of(w).open(paths[n]);
    });
    glfwSetWindowRefreshCallback(window, [](GLFWwindow* w) { viewer_of(w).wake(); });
    glfwSetFramebufferSizeCallback(window, [](GLFWwindow* w, int, int) { viewer_of(w).wake(); });
  }

  /// Panels need some frames to settle.
  void wake() { frames_to_draw_ = 3; }

  /// The position of the mouse, in pixels of the picture.
  [[nodiscard]] std::array<double, 2> mouse() const {
    double x = 0, y = 0;
    glfwGetCursorPos(window_.get(), &x, &y);
    int width = 1, pixels = 1;
    glfwGetWindowSize(window_.get(), &width, nullptr);
    glfwGetFramebufferSize(window_.get(), &pixels, nullptr);
    const double scale = width > 0 ? static_cast<double>(pixels) / width : 1;
    return {scale * x, scale * y};
  }

  void button(int button, bool is_pressed, int mods) {
    wake();
    const auto [x, y] = mouse();
    if (!is_pressed) {
      input_.release(x, y);
      return;
    }
    if (ImGui::GetIO().WantCaptureMouse) return;
    const MouseButton which = button == GLFW_MOUSE_BUTTON_RIGHT    ? MouseButton::kRight
                              : button == GLFW_MOUSE_BUTTON_MIDDLE ? MouseButton::kMiddle
                                                                   : MouseButton::kLeft;
    input_.press(which, (mods & GLFW_MOD_SHIFT) != 0, x, y);
  }

  void moved() {
    wake();
    const auto [x, y] = mouse();
    input_.move(x, y);
  }

  void wheel(double steps) {
    wake();
    if (!ImGui::GetIO().WantCaptureMouse) input_.wheel(steps);
  }

  void key(int key) {
    wake();
    if (!ImGui::GetIO().WantTextInput) input_.key(key_name(key));
  }

  void fly(double seconds) {
    const auto held = [&](int key) { return glfwGetKey(window_.get(), key) == GLFW_PRESS ? 1.0 : 0.0; };
    const double forward = held(GLFW_KEY_UP) - held(GLFW_KEY_DOWN),
                 right = held(GLFW_KEY_RIGHT) - held(GLFW_KEY_LEFT),
                 up = held(GLFW_KEY_PAGE_UP) - held(GLFW_KEY_PAGE_DOWN);
    if (forward == 0 && right == 0 && up == 0) return;
    wake();
    input_.fly(forward, right, up, seconds);
  }

  void open(const std::string& path) {
    try {
      session_.open(path, options_.documents, SilentProgress::instance());
      panel_state_.message = path + " is open";
      glfwSetWindowTitle(window_.get(), title(session_).c_str());
    } catch (const Error& error) {
      panel_state_.message = error.what();
    }
    wake();
  }

  void frame(double seconds) {
    int width = 0, height = 0;
    glfwGetFramebufferSize(window_.get(), &width, &height);
    // A minimised window has no pixels.
    if (width < 1 || height < 1) return;
    fly(seconds);
    session_.advance(seconds);
    session_.set_size(width, height);
    if (input_.complete_picked()) wake();
    const PictureContents contents = session_picture(session_);
    const auto before = std::chrono::steady_clock::now();
    if (!target_ || target_->width() != width || target_->height() != height) {
      target_.reset();
      target_.emplace(width, height);
    }
    const DrawFigures figures = renderer_.draw(contents, target_->framebuffer(), width, height);
    if (session_.wants_depths()) {
      session_.set_depths(depths_of(*target_, session_.state().viewpoint, figures));
      wake();
    }
    target_->show();
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glFinish();
    const std::chrono::duration<double, std::milli> drawn = std::chrono::steady_clock::now() - before;
    check_context();
    ImGui_ImplGlfw_NewFrame();
    panels_.begin(width, height, seconds);
    draw_overlay(session_);
    show_panels(session_, input_, panel_state_);
    panels_.end();
    panels_.draw();
    glfwSwapBuffers(window_.get());
    const UpdateReport report = session_.report();
    panel_state_.add({1000 * report.seconds, drawn.count(), report.triangles, report.largest_error_pixels});
    do_what_is_wanted(contents, width, height);
    go_on_with_export(width, height);
  }

  void check_context() {
    if (glGetGraphicsResetStatus() != GL_NO_ERROR)
      fail("view: the graphics device was reset and the picture is lost: start again");
  }

  void do_what_is_wanted(const PictureContents& contents, int width, int height) {
    try {
      if (session_.wants_screenshot) screenshot(contents, width, height);
      if (panel_state_.wants_path_saved) save_path();
    } catch (const Error& error) {
      panel_state_.message = error.what();
    }
    session_.wants_screenshot = panel_state_.wants_path_saved = false;
    if (!std::exchange(panel_state_.wants_open, false)) return;
    open(panel_state_.path);
  }

  /// Saves the picture with the overlay but without the panels.
  void screenshot(const PictureContents& contents, int width, int height) {
    const PictureTarget target(width, height);
    const bool had_panels = std::exchange(session_.has_panels, false);
    draw_session(session_, contents, renderer_, target, panels_);
    session_.has_panels = had_panels;
    const std::filesystem::path path = free_name(options_.pictures, "adamas", ".png");
    write_png(path, target.read());
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    panel_state_.message = path.string() + " was written";
  }

  void save_path() {
    const std::filesystem::path path = free_name(options_.pictures, "adamas-path", ".txt");
    write_bytes(path, path_text(session_.path()));
    panel_state_.message = path.string() + " was written; --camera-path takes it";
  }

  void go_on_with_export(int width, int height) {
    if (const auto form = std::exchange(session_.wants_export, std::nullopt)) {
      const ExportRequest request{*form, width, height, window_.scale()};
      export_ = std::make_unique<StepExport>(session_, request);
      panel_state_.exporting = {};
      session_.is_exporting = true;
    }
    const bool is_stopped = std::exchange(session_.wants_export_end, false);
    if (!export_) return;
    const bool goes_on = !is_stopped && export_->go_on();
    panel_state_.exporting.done = export_->done();
    panel_state_.exporting.steps = export_->steps();
    if (!goes_on) {
      panel_state_.exporting.outcome = is_stopped ? "Stopped: nothing was written" : export_->outcome();
      export_.reset();
      session_.is_exporting = false;
      wake();
    }
    // The export has panels and a framebuffer of its own.
    panels_.make_current();
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
  }

  ViewSession& session_;
  const WindowOptions& options_;
  GlfwWindow window_;
  Renderer renderer_;
  std::optional<PictureTarget> target_;  ///< it has the window's size
  PanelContext panels_;
  std::unique_ptr<PanelInput> panel_input_;
  WindowInput input_;
  PanelState panel_state_;
  std::unique_ptr<StepExport> export_;  ///< null if nothing is being exported
  int frames_to_draw_ = 3;
};

}  // namespace

void show_window(ViewSession& session, const WindowOptions& options) { Viewer(session, options).run(); }

}  // namespace adamas::viewer
