#include "viewer/gl/surface_renderer.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "core/base/error.h"

namespace adamas {

namespace {

// Places are relative to the middle of the surface, so that single precision suffices; in the view the eye is
// at the origin and looks along -z.
constexpr const char* kVertexShader = R"(#version 450 core
layout(location = 0) in vec3 place;
layout(location = 1) in vec3 normal;
layout(location = 0) uniform mat4 to_view;
layout(location = 1) uniform mat4 to_picture;
out vec3 view_place;
out vec3 view_normal;
void main() {
  vec4 at = to_view * vec4(place, 1.0);
  view_place = at.xyz;
  view_normal = mat3(to_view) * normal;
  gl_Position = to_picture * at;
}
)";

constexpr const char* kFragmentShader = R"(#version 450 core
in vec3 view_place;
in vec3 view_normal;
layout(location = 2) uniform int shading;
layout(location = 3) uniform int is_parallel;
out vec4 colour;
void main() {
  vec3 flat_normal = cross(dFdx(view_place), dFdy(view_place));
  vec3 normal = dot(view_normal, view_normal) > 0.0 ? normalize(view_normal) : normalize(flat_normal);
  vec3 to_eye = is_parallel != 0 ? vec3(0.0, 0.0, 1.0) : normalize(-view_place);
  // Both sides are lit; the inside is darker.
  float facing = dot(normal, to_eye);
  bool is_inside = facing < 0.0;
  normal = is_inside ? -normal : normal;
  facing = abs(facing);
  vec3 base = is_inside ? vec3(0.62, 0.45, 0.40) : vec3(0.93, 0.85, 0.71);
  vec3 light = normalize(vec3(-0.35, 0.45, 1.0));
  float diffuse = max(dot(normal, light), 0.0);
  vec3 shine = reflect(-light, normal);
  float gloss = pow(max(dot(shine, to_eye), 0.0), 24.0);
  vec3 lit = base * (0.22 + 0.78 * diffuse) + vec3(0.18 * gloss);
  if (shading == 1) {
    // A sphere with a warm top and a cool bottom, dark where the surface turns away.
    vec3 sky = mix(vec3(0.30, 0.36, 0.46), vec3(0.98, 0.93, 0.84), 0.5 + 0.5 * normal.y);
    float edge = smoothstep(0.12, 0.42, facing);
    lit = mix(vec3(0.08, 0.07, 0.09), (is_inside ? 0.7 : 1.0) * sky * (0.45 + 0.55 * facing), edge) + vec3(0.12 * gloss);
  }
  colour = vec4(pow(clamp(lit, 0.0, 1.0), vec3(1.0 / 1.1)), 1.0);
}
)";

using Matrix = std::array<float, 16>;  ///< by columns

struct Vertex {
  std::array<float, 3> place, normal;
};

std::array<float, 3> in_single(const Vec3& v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

GLuint compiled(GLenum kind, const char* source) {
  const GLuint shader = glCreateShader(kind);
  glShaderSource(shader, 1, &source, nullptr);
  glCompileShader(shader);
  GLint done = GL_FALSE;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &done);
  if (done == GL_FALSE) {
    std::array<char, 1024> log{};
    glGetShaderInfoLog(shader, static_cast<GLsizei>(log.size()), nullptr, log.data());
    fail("pictures by OpenGL: a shader was refused: {}", log.data());
  }
  return shader;
}

Matrix view_matrix(const Viewpoint& viewpoint, const Vec3& middle) {
  const Vec3 forward = normalized(viewpoint.target - viewpoint.eye),
             right = normalized(cross(forward, viewpoint.up)), up = cross(right, forward);
  const Vec3 eye = viewpoint.eye - middle;
  const std::array<Vec3, 3> rows{right, up, -forward};
  Matrix m{};
  for (std::size_t r = 0; r < 3; ++r) {
    m[r] = static_cast<float>(rows[r].x);
    m[4 + r] = static_cast<float>(rows[r].y);
    m[8 + r] = static_cast<float>(rows[r].z);
    m[12 + r] = static_cast<float>(-dot(rows[r], eye));
  }
  m[15] = 1;
  return m;
}

Matrix picture_matrix(const Viewpoint& viewpoint, double far) {
  const double near = viewpoint.near,
               aspect = static_cast<double>(viewpoint.width_pixels) / viewpoint.height_pixels;
  Matrix m{};
  if (viewpoint.height > 0) {
    m[0] = static_cast<float>(2 / (aspect * viewpoint.height));
    m[5] = static_cast<float>(2 / viewpoint.height);
    m[10] = static_cast<float>(-2 / (far - near));
    m[14] = static_cast<float>(-(far + near) / (far - near));
    m[15] = 1;
    return m;
  }
  const double scale = 1 / std::tan(viewpoint.field_of_view / 2);
  m[0] = static_cast<float>(scale / aspect);
  m[5] = static_cast<float>(scale);
  m[10] = static_cast<float>(-(far + near) / (far - near));
  m[11] = -1;
  m[14] = static_cast<float>(-2 * far * near / (far - near));
  return m;
}

}  // namespace

struct SurfaceRenderer::Objects {
  int width, height;
  GLuint program = 0, array = 0, vertices = 0, triangles = 0;
  GLuint drawn = 0, colour = 0, depth = 0;   ///< with several samples a pixel
  GLuint resolved = 0, resolved_colour = 0;  ///< with one
  GLsizei corners = 0;
  Vec3 middle;
  Box3 box;

  Objects(int w, int h) : width(w), height(h) {}
  Objects(const Objects&) = delete;
  Objects& operator=(const Objects&) = delete;
  ~Objects() {
    glDeleteProgram(program);
    glDeleteVertexArrays(1, &array);
    glDeleteBuffers(1, &vertices);
    glDeleteBuffers(1, &triangles);
    glDeleteFramebuffers(1, &drawn);
    glDeleteFramebuffers(1, &resolved);
    for (const GLuint buffer : {colour, depth, resolved_colour}) glDeleteRenderbuffers(1, &buffer);
  }

  void make_program() {
    program = glCreateProgram();
    for (const auto& [kind, source] :
         {std::pair{GL_VERTEX_SHADER, kVertexShader}, std::pair{GL_FRAGMENT_SHADER, kFragmentShader}}) {
      const GLuint shader = compiled(static_cast<GLenum>(kind), source);
      glAttachShader(program, shader);
      glDeleteShader(shader);
    }
    glLinkProgram(program);
    GLint done = GL_FALSE;
    glGetProgramiv(program, GL_LINK_STATUS, &done);
    if (done == GL_FALSE) fail("pictures by OpenGL: the shaders do not fit together");
  }

  void make_array() {
    glCreateVertexArrays(1, &array);
    for (const GLuint attribute : {0u, 1u}) {
      glEnableVertexArrayAttrib(array, attribute);
      glVertexArrayAttribFormat(array, attribute, 3, GL_FLOAT, GL_FALSE,
                                attribute * static_cast<GLuint>(sizeof(std::array<float, 3>)));
      glVertexArrayAttribBinding(array, attribute, 0);
    }
  }

  void make_frame() {
    constexpr GLsizei kSamples = 4;
    GLint most = 0;
    glGetIntegerv(GL_MAX_RENDERBUFFER_SIZE, &most);
    if (width < 1 || height < 1 || width > most || height > most)
      fail("pictures by OpenGL: expected sides of 1 to {} pixels, found {} x {}", most, width, height);
    for (GLuint* const buffer : {&colour, &depth, &resolved_colour}) glCreateRenderbuffers(1, buffer);
    glNamedRenderbufferStorageMultisample(colour, kSamples, GL_RGBA8, width, height);
    glNamedRenderbufferStorageMultisample(depth, kSamples, GL_DEPTH_COMPONENT32F, width, height);
    glNamedRenderbufferStorage(resolved_colour, GL_RGBA8, width, height);
    glCreateFramebuffers(1, &drawn);
    glNamedFramebufferRenderbuffer(drawn, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, colour);
    glNamedFramebufferRenderbuffer(drawn, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depth);
    glCreateFramebuffers(1, &resolved);
    glNamedFramebufferRenderbuffer(resolved, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, resolved_colour);
    for (const GLuint frame : {drawn, resolved}) {
      if (glCheckNamedFramebufferStatus(frame, GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
        fail("pictures by OpenGL: no picture of {} x {} pixels can be had", width, height);
    }
  }

  /// How far the surface reaches behind the near plane along the line of sight.
  [[nodiscard]] double far_plane(const Viewpoint& viewpoint) const {
    const Vec3 forward = normalized(viewpoint.target - viewpoint.eye);
    double far = 2 * viewpoint.near;
    for (const Vec3& corner : box.corners()) far = std::max(far, 1.01 * dot(corner - viewpoint.eye, forward));
    return far;
  }
};

SurfaceRenderer::SurfaceRenderer(int width, int height) : objects_(std::make_unique<Objects>(width, height)) {
  objects_->make_program();
  objects_->make_array();
  objects_->make_frame();
}

SurfaceRenderer::~SurfaceRenderer() = default;

void SurfaceRenderer::set_surface(const TriangleSurface& surface) {
  Objects& o = *objects_;
  o.box = {};
  for (const Vec3& p : surface.points) o.box.extend(p);
  o.middle = surface.points.empty() ? Vec3{} : 0.5 * (o.box.min + o.box.max);
  std::vector<Vertex> vertices(surface.points.size());
  for (std::size_t n = 0; n < vertices.size(); ++n) {
    vertices[n].place = in_single(surface.points[n] - o.middle);
    vertices[n].normal = in_single(surface.normals.empty() ? Vec3{} : surface.normals[n]);
  }
  o.corners = static_cast<GLsizei>(3 * surface.triangles.size());
  for (GLuint* const buffer : {&o.vertices, &o.triangles}) {
    glDeleteBuffers(1, buffer);
    glCreateBuffers(1, buffer);
  }
  const auto upload = [](GLuint buffer, const auto& data) {
    if (!data.empty())
      glNamedBufferStorage(buffer, static_cast<GLsizeiptr>(data.size() * sizeof data[0]), data.data(), 0);
  };
  upload(o.vertices, vertices);
  upload(o.triangles, surface.triangles);
  glVertexArrayVertexBuffer(o.array, 0, o.vertices, 0, sizeof(Vertex));
  glVertexArrayElementBuffer(o.array, o.triangles);
}

Raster SurfaceRenderer::draw(const Viewpoint& wanted, Shading shading) {
  const Objects& o = *objects_;
  Viewpoint viewpoint = wanted;
  viewpoint.width_pixels = o.width;
  viewpoint.height_pixels = o.height;
  glBindFramebuffer(GL_FRAMEBUFFER, o.drawn);
  glViewport(0, 0, o.width, o.height);
  glEnable(GL_DEPTH_TEST);
  glClearColor(1, 1, 1, 1);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  if (o.corners > 0) {
    glUseProgram(o.program);
    glUniformMatrix4fv(0, 1, GL_FALSE, view_matrix(viewpoint, o.middle).data());
    glUniformMatrix4fv(1, 1, GL_FALSE, picture_matrix(viewpoint, o.far_plane(viewpoint)).data());
    glUniform1i(2, shading == Shading::kSphere ? 1 : 0);
    glUniform1i(3, viewpoint.height > 0 ? 1 : 0);
    glBindVertexArray(o.array);
    glDrawElements(GL_TRIANGLES, o.corners, GL_UNSIGNED_INT, nullptr);
  }
  glBlitNamedFramebuffer(o.drawn, o.resolved, 0, 0, o.width, o.height, 0, 0, o.width, o.height,
                         GL_COLOR_BUFFER_BIT, GL_NEAREST);
  std::vector<std::uint8_t> bytes(std::size_t{4} * static_cast<std::size_t>(o.width) *
                                  static_cast<std::size_t>(o.height));
  glBindFramebuffer(GL_READ_FRAMEBUFFER, o.resolved);
  glReadPixels(0, 0, o.width, o.height, GL_RGBA, GL_UNSIGNED_BYTE, bytes.data());
  if (const GLenum error = glGetError(); error != GL_NO_ERROR)
    fail("pictures by OpenGL: a picture failed (error {:#x}): is the graphics memory full?", error);
  Raster raster(o.width, o.height);
  for (int y = 0; y < o.height; ++y) {
    for (int x = 0; x < o.width; ++x) {
      // OpenGL's first row is the lowest.
      const std::uint8_t* from =
          bytes.data() + 4 * (static_cast<std::size_t>(o.height - 1 - y) * static_cast<std::size_t>(o.width) +
                              static_cast<std::size_t>(x));
      raster.at(x, y) = {from[0], from[1], from[2], 255};
    }
  }
  return raster;
}

}  // namespace adamas
