#pragma once

#include <memory>
#include <string>

namespace adamas::viewer {

/// OpenGL 4.5 without a window, current in the thread that made it: of a graphics device by EGL where there
/// is one, otherwise by the processor.
class OffscreenContext {
 public:
  /// Throws Error that tells what was tried where there is none.
  OffscreenContext();
  ~OffscreenContext();
  OffscreenContext(const OffscreenContext&) = delete;
  OffscreenContext& operator=(const OffscreenContext&) = delete;

  /// How it was had and what draws: "EGL device 0, llvmpipe (LLVM 15.0.6, 256 bits)".
  [[nodiscard]] const std::string& name() const { return name_; }

 private:
  struct Handles;

  std::unique_ptr<Handles> handles_;
  std::string name_;
};

}  // namespace adamas::viewer
