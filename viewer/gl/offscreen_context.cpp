#include "viewer/gl/offscreen_context.h"

#include <dlfcn.h>
#include <epoxy/egl.h>
#include <epoxy/gl.h>

#include <array>
#include <vector>

#include "core/base/error.h"

namespace adamas::viewer {

struct OffscreenContext::Handles {
  EGLDisplay display = EGL_NO_DISPLAY;
  EGLContext context = EGL_NO_CONTEXT;

  Handles() = default;
  Handles(const Handles&) = delete;
  Handles& operator=(const Handles&) = delete;
  ~Handles() {
    if (display == EGL_NO_DISPLAY) return;
    eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    if (context != EGL_NO_CONTEXT) eglDestroyContext(display, context);
    // The display stays for the next context: drivers are not made to be unloaded.
  }
};

namespace {

/// Whether a renderer draws into memory with the processor.
bool is_software(const std::string& renderer) {
  return renderer.find("llvmpipe") != std::string::npos || renderer.find("softpipe") != std::string::npos ||
         renderer.find("swrast") != std::string::npos || renderer.find("SWR") != std::string::npos;
}

/// Makes a context of a display current. Returns what prevents it, empty if nothing does.
template <class Handles>
std::string open_display(EGLDisplay display, Handles& handles) {
  if (display == EGL_NO_DISPLAY) return "no display";
  if (eglInitialize(display, nullptr, nullptr) == EGL_FALSE) return "cannot be initialised";
  handles.display = display;
  if (eglBindAPI(EGL_OPENGL_API) == EGL_FALSE) return "no OpenGL";
  constexpr std::array<EGLint, 7> kContext{EGL_CONTEXT_MAJOR_VERSION,
                                           4,
                                           EGL_CONTEXT_MINOR_VERSION,
                                           5,
                                           EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                           EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                           EGL_NONE};
  handles.context = eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, kContext.data());
  if (handles.context == EGL_NO_CONTEXT) return "no OpenGL 4.5";
  if (eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, handles.context) == EGL_FALSE)
    return "a context that needs a window";
  return "";
}

struct Candidate {
  EGLDisplay display;
  std::string name;
};

/// Lists devices first, then Mesa without any.
std::vector<Candidate> candidates() {
  std::vector<Candidate> found;
  if (epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_device_enumeration") ||
      epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_device_base")) {
    std::array<EGLDeviceEXT, 16> devices{};
    EGLint count = 0;
    if (eglQueryDevicesEXT(static_cast<EGLint>(devices.size()), devices.data(), &count) == EGL_TRUE) {
      for (EGLint n = 0; n < count; ++n)
        found.push_back(
            {eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, devices[static_cast<std::size_t>(n)], nullptr),
             fmt::format("EGL device {}", n)});
    }
  }
  if (epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_MESA_platform_surfaceless"))
    found.push_back({eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr),
                     "EGL without a device"});
  return found;
}

}  // namespace

OffscreenContext::OffscreenContext() {
  // Without this check epoxy would end the program if there is no EGL.
  void* const library = dlopen("libEGL.so.1", RTLD_LAZY | RTLD_LOCAL);
  if (library == nullptr) fail("pictures by OpenGL: expected EGL, found no libEGL.so.1");
  std::string tried, software;
  const std::vector<Candidate> all = candidates();
  // Software renderers are tried last.
  for (const bool any : {false, true}) {
    for (const Candidate& candidate : all) {
      auto handles = std::make_unique<Handles>();
      const std::string problem = open_display(candidate.display, *handles);
      if (!problem.empty()) {
        if (!any) tried += fmt::format("{}{}: {}", tried.empty() ? "" : ", ", candidate.name, problem);
        continue;
      }
      const std::string renderer = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
      if (!any && is_software(renderer)) continue;
      name_ = fmt::format("{}, {}", candidate.name, renderer);
      handles_ = std::move(handles);
      return;
    }
  }
  fail("pictures by OpenGL: expected OpenGL 4.5 by EGL, found none ({})",
       tried.empty() ? "no display" : tried);
}

OffscreenContext::~OffscreenContext() = default;

}  // namespace adamas::viewer
