#include "viewer/gl/picture_target.h"

#include <epoxy/gl.h>

#include <limits>
#include <vector>

#include "core/base/error.h"

namespace adamas::viewer {

using namespace isosurface;
using namespace picture;

PictureTarget::PictureTarget(int width, int height) : width_(width), height_(height) {
  GLint most = 0;
  glGetIntegerv(GL_MAX_RENDERBUFFER_SIZE, &most);
  if (width < 1 || height < 1 || width > most || height > most)
    fail("pictures by OpenGL: expected sides of 1 to {} pixels, found {} x {}", most, width, height);
  make();
  for (const GLuint frame : {drawn_, resolved_}) {
    if (glCheckNamedFramebufferStatus(frame, GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE) continue;
    free();
    fail("pictures by OpenGL: no picture of {} x {} pixels can be had", width, height);
  }
}

PictureTarget::~PictureTarget() { free(); }

void PictureTarget::make() {
  constexpr GLsizei kSamples = 4;
  for (GLuint* const buffer : {&colour_, &depth_, &resolved_colour_, &resolved_depth_})
    glCreateRenderbuffers(1, buffer);
  glNamedRenderbufferStorageMultisample(colour_, kSamples, GL_RGBA8, width_, height_);
  glNamedRenderbufferStorageMultisample(depth_, kSamples, GL_DEPTH_COMPONENT32F, width_, height_);
  glNamedRenderbufferStorage(resolved_colour_, GL_RGBA8, width_, height_);
  glNamedRenderbufferStorage(resolved_depth_, GL_DEPTH_COMPONENT32F, width_, height_);
  glCreateFramebuffers(1, &drawn_);
  glNamedFramebufferRenderbuffer(drawn_, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, colour_);
  glNamedFramebufferRenderbuffer(drawn_, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depth_);
  glCreateFramebuffers(1, &resolved_);
  glNamedFramebufferRenderbuffer(resolved_, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, resolved_colour_);
  glNamedFramebufferRenderbuffer(resolved_, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, resolved_depth_);
}

void PictureTarget::free() {
  glDeleteFramebuffers(1, &drawn_);
  glDeleteFramebuffers(1, &resolved_);
  for (const GLuint buffer : {colour_, depth_, resolved_colour_, resolved_depth_})
    glDeleteRenderbuffers(1, &buffer);
}

Raster PictureTarget::read() const {
  glBlitNamedFramebuffer(drawn_, resolved_, 0, 0, width_, height_, 0, 0, width_, height_, GL_COLOR_BUFFER_BIT,
                         GL_NEAREST);
  const auto width = static_cast<std::size_t>(width_), height = static_cast<std::size_t>(height_);
  std::vector<std::uint8_t> bytes(4 * width * height);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, resolved_);
  glReadPixels(0, 0, width_, height_, GL_RGBA, GL_UNSIGNED_BYTE, bytes.data());
  if (const GLenum error = glGetError(); error != GL_NO_ERROR)
    fail("pictures by OpenGL: a picture failed (error {:#x}): is the graphics memory full?", error);
  Raster raster(width_, height_);
  for (int y = 0; y < height_; ++y) {
    for (int x = 0; x < width_; ++x) {
      // OpenGL's first row is the lowest.
      const std::uint8_t* from = bytes.data() + 4 * (static_cast<std::size_t>(height_ - 1 - y) * width +
                                                     static_cast<std::size_t>(x));
      raster.at(x, y) = {from[0], from[1], from[2], 255};
    }
  }
  return raster;
}

std::vector<float> PictureTarget::depths(const Viewpoint& viewpoint, double far) const {
  glBlitNamedFramebuffer(drawn_, resolved_, 0, 0, width_, height_, 0, 0, width_, height_, GL_DEPTH_BUFFER_BIT,
                         GL_NEAREST);
  const auto width = static_cast<std::size_t>(width_), height = static_cast<std::size_t>(height_);
  std::vector<float> stored(width * height), result;
  glBindFramebuffer(GL_READ_FRAMEBUFFER, resolved_);
  glReadPixels(0, 0, width_, height_, GL_DEPTH_COMPONENT, GL_FLOAT, stored.data());
  result.reserve(stored.size());
  const double near = viewpoint.near;
  for (std::size_t y = 0; y < height; ++y) {
    for (std::size_t x = 0; x < width; ++x) {
      const double depth = stored[(height - 1 - y) * width + x];
      // A perspective depth is a linear function of the reciprocal of the distance.
      const double distance =
          viewpoint.height > 0 ? near + depth * (far - near) : near * far / (far - depth * (far - near));
      result.push_back(depth < 1 ? static_cast<float>(distance) : std::numeric_limits<float>::infinity());
    }
  }
  return result;
}

void PictureTarget::show() const {
  glBlitNamedFramebuffer(drawn_, resolved_, 0, 0, width_, height_, 0, 0, width_, height_, GL_COLOR_BUFFER_BIT,
                         GL_NEAREST);
  glBlitNamedFramebuffer(resolved_, 0, 0, 0, width_, height_, 0, 0, width_, height_, GL_COLOR_BUFFER_BIT,
                         GL_NEAREST);
}

}  // namespace adamas::viewer
