#include "viewer/window/panel_context.h"

#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <filesystem>

#include "core/base/error.h"

namespace adamas::viewer {

namespace {

constexpr float kFontSize = 15;
/// Latin, Greek and Cyrillic letters, and the signs of tidy numbers.
constexpr std::array<ImWchar, 9> kLetters{0x20, 0x17f, 0x370, 0x52f, 0x2070, 0x209f, 0x2212, 0x2212, 0};

/// Adds a font in which long texts are readable, if the system has it; else the font of ImGui.
void add_font(float size) {
  for (const char* path :
       {"/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf", "/usr/share/fonts/TTF/DejaVuSans.ttf"}) {
    std::error_code code;
    if (!std::filesystem::is_regular_file(path, code)) continue;
    if (ImGui::GetIO().Fonts->AddFontFromFileTTF(path, size, nullptr, kLetters.data()) != nullptr) return;
  }
  ImFontConfig config;
  config.SizePixels = size;
  ImGui::GetIO().Fonts->AddFontDefault(&config);
}

}  // namespace

PanelContext::PanelContext(double scale) : context_(ImGui::CreateContext()) {
  ImGui::SetCurrentContext(context_);
  ImGuiIO& io = ImGui::GetIO();
  // Panels have the same positions at every start: no file of positions is kept.
  io.IniFilename = nullptr;
  io.LogFilename = nullptr;
  const auto factor = static_cast<float>(std::clamp(scale, 0.5, 4.0));
  add_font(kFontSize * factor);
  ImGui::StyleColorsLight();
  ImGuiStyle& style = ImGui::GetStyle();
  style.WindowRounding = 4;
  style.FrameRounding = 3;
  style.Colors[ImGuiCol_WindowBg].w = 0.92F;
  style.ScaleAllSizes(factor);
}

PanelContext::~PanelContext() {
  ImGuiContext* const current = ImGui::GetCurrentContext();
  make_current();
  if (uses_opengl_) ImGui_ImplOpenGL3_Shutdown();
  ImGui::DestroyContext(context_);
  if (current != context_) ImGui::SetCurrentContext(current);
}

void PanelContext::make_current() { ImGui::SetCurrentContext(context_); }

void PanelContext::use_opengl() {
  ImGui::SetCurrentContext(context_);
  if (!ImGui_ImplOpenGL3_Init("#version 450 core")) fail("panels: expected OpenGL by libGL.so.1, found none");
  uses_opengl_ = true;
}

void PanelContext::begin(int width, int height, double seconds) {
  ImGui::SetCurrentContext(context_);
  ImGuiIO& io = ImGui::GetIO();
  io.DisplaySize = {static_cast<float>(width), static_cast<float>(height)};
  io.DeltaTime = static_cast<float>(std::max(seconds, 1e-4));
  if (uses_opengl_) {
    ImGui_ImplOpenGL3_NewFrame();
  } else if (!io.Fonts->IsBuilt()) {
    io.Fonts->Build();
  }
  ImGui::NewFrame();
}

void PanelContext::end() { ImGui::Render(); }

void PanelContext::draw() {
  if (uses_opengl_) ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

}  // namespace adamas::viewer
