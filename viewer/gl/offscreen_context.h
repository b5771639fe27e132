#pragma once

#include <memory>
#include <string>

namespace adamas::viewer {

/// An OpenGL 4.5 context without a window, current in the thread that made it. A graphics device draws, by
/// EGL, if there is one, otherwise the processor.
class OffscreenContext {
 public:
  /// Throws Error, which says what was tried, if there is no OpenGL 4.5.
  OffscreenContext();
  ~OffscreenContext();
  OffscreenContext(const OffscreenContext&) = delete;
  OffscreenContext& operator=(const OffscreenContext&) = delete;

  /// The source of the context and the renderer: "EGL device 0, llvmpipe (LLVM 15.0.6, 256 bits)".
  [[nodiscard]] const std::string& name() const { return name_; }

 private:
  struct Handles;

  std::unique_ptr<Handles> handles_;
  std::string name_;
};

}  // namespace adamas::viewer
