#include "viewer/gl/renderer.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numeric>
#include <span>
#include <vector>

#include "core/base/error.h"
#include "core/picture/colour_map.h"
#include "viewer/gl/mesh_buffers.h"

namespace adamas::viewer {

using namespace isosurface;
using namespace picture;

namespace {

// In view coordinates the eye is at the origin and looks along -z. Places are relative to the origin of their
// mesh; each command for a mesh gives that origin relative to the target, and the style of the mesh.
constexpr std::string_view kVersion = "#version 450 core\n";

/// The input of meshes that have vertices.
constexpr std::string_view kPointVertices = R"(
layout(location = 0) in vec3 place;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 values;
void find_vertex(vec4 along, float least, out vec3 at, out vec3 towards, out vec2 on_sides) {
  at = place;
  towards = normal;
  on_sides = values;
}
)";

/// The input of meshes that have ends of edges, as in EdgeEnds: `along` has the steps and the isovalue.
/// Values are halved so that differences do not overflow.
constexpr std::string_view kEdgeVertices = R"(
layout(location = 0) in uint points;
layout(location = 1) in vec2 samples;
layout(location = 2) in vec4 descents;
layout(location = 4) in vec2 last_descents;
void find_vertex(vec4 along, float least, out vec3 at, out vec3 towards, out vec2 on_sides) {
  float t = clamp((0.5 * along.w - 0.5 * samples.x) / (0.5 * samples.y - 0.5 * samples.x), least, 1.0 - least);
  uvec3 first = uvec3(points, points >> 5, points >> 10) & 31u;
  uvec3 second = uvec3(points >> 15, points >> 20, points >> 25) & 31u;
  at = along.xyz * mix(vec3(first), vec3(second), t);
  vec3 descent = mix(descents.xyz, vec3(descents.w, last_descents), t);
  float steepness = dot(descent, descent);
  towards = steepness > 0.0 ? descent * inversesqrt(steepness) : vec3(0.0);
  on_sides = vec2(intBitsToFloat(0x7fc00000));
}
)";

constexpr std::string_view kVertexShader = R"(
layout(location = 3) in uint draw_number;
struct Draw { vec4 origin; uvec4 style; vec4 along; };
layout(std430, binding = 0) readonly buffer Draws { Draw draws[]; };
layout(location = 0) uniform mat4 to_view;
layout(location = 1) uniform mat4 to_picture;
layout(location = 2) uniform vec4 clip;
out vec3 view_place;
out vec3 view_normal;
out vec2 side_values;
flat out uint style;
void main() {
  Draw draw = draws[draw_number];
  vec3 place_in_mesh, towards;
  find_vertex(draw.along, draw.origin.w, place_in_mesh, towards, side_values);
  vec3 from_target = place_in_mesh + draw.origin.xyz;
  vec4 at = to_view * vec4(from_target, 1.0);
  view_place = at.xyz;
  view_normal = mat3(to_view) * towards;
  style = draw.style.x;
  gl_Position = to_picture * at;
  gl_ClipDistance[0] = draw.style.y != 0u ? -(dot(clip.xyz, from_target) + clip.w) : 1.0;
}
)";

constexpr std::string_view kFragmentShader = R"(
in vec3 view_place;
in vec3 view_normal;
in vec2 side_values;
flat in uint style;
struct Style { vec4 front; vec4 back; vec4 range; uvec4 flags; };
layout(std430, binding = 1) readonly buffer Styles { Style styles[]; };
layout(location = 3) uniform int shading;
layout(location = 4) uniform int is_parallel;
layout(location = 5) uniform int is_edges;
layout(binding = 0) uniform sampler1D colour_map;
out vec4 colour;
void main() {
  Style s = styles[style];
  vec3 base = gl_FrontFacing ? s.front.rgb : s.back.rgb;
  float value = gl_FrontFacing ? side_values.x : side_values.y;
  if (s.flags.x != 0u && !isnan(value)) {
    float t = clamp((value - s.range.x) / max(s.range.y - s.range.x, 1e-30), 0.0, 1.0);
    base = texture(colour_map, (t * 255.0 + 0.5) / 256.0).rgb;
  }
  if (is_edges != 0) {
    colour = vec4(0.5 * base, s.front.a);
    return;
  }
  if (s.flags.y != 0u) {
    colour = vec4(base, s.front.a);
    return;
  }
  vec3 flat_normal = normalize(cross(dFdx(view_place), dFdy(view_place)));
  vec3 normal = dot(view_normal, view_normal) > 0.0 ? normalize(view_normal) : flat_normal;
  vec3 to_eye = is_parallel != 0 ? vec3(0.0, 0.0, 1.0) : normalize(-view_place);
  // Both sides are lit.
  float facing = dot(normal, to_eye);
  normal = facing < 0.0 ? -normal : normal;
  facing = abs(facing);
  vec3 light = normalize(vec3(-0.35, 0.45, 1.0));
  float diffuse = max(dot(normal, light), 0.0);
  float gloss = pow(max(dot(reflect(-light, normal), to_eye), 0.0), 24.0);
  vec3 lit = base * (0.22 + 0.78 * diffuse) + vec3(0.18 * gloss);
  if (shading == 1) {
    // A sphere with a warm top and a cool bottom, dark where the surface turns away; colours tint it.
    vec3 sky = mix(vec3(0.30, 0.36, 0.46), vec3(0.98, 0.93, 0.84), 0.5 + 0.5 * normal.y);
    vec3 tint = base / max(max(base.r, base.g), max(base.b, 1e-3));
    float edge = smoothstep(0.12, 0.42, facing);
    lit = mix(vec3(0.08, 0.07, 0.09), (gl_FrontFacing ? 1.0 : 0.7) * sky * tint * (0.45 + 0.55 * facing), edge) +
          vec3(0.12 * gloss);
  }
  colour = vec4(pow(clamp(lit, 0.0, 1.0), vec3(1.0 / 1.1)), s.front.a);
}
)";

/// Whether triangles of a part are blended with what lies behind them.
bool is_transparent(const DrawnPart& part) { return part.style.opacity < 1 && !part.mesh->is_lines; }

/// Triangles of transparent parts, from far to near.
class SortedTriangles {
 public:
  SortedTriangles(std::span<const DrawnPart> parts, const isosurface::Viewpoint& viewpoint) {
    const Vec3 forward = normalized(viewpoint.target - viewpoint.eye);
    for (std::size_t p = 0; p < parts.size(); ++p) {
      if (!is_transparent(parts[p])) continue;
      const DrawnMesh& mesh = *parts[p].mesh;
      const auto origin = static_cast<float>(dot(mesh.origin - viewpoint.eye, forward));
      for (std::size_t t = 0; 3 * t + 2 < mesh.indices.size(); ++t) {
        float depth = 3 * origin;
        for (std::size_t c = 0; c < 3; ++c) {
          const Vec3 place = mesh.place(mesh.indices[3 * t + c], parts[p].isovalue);
          depth += static_cast<float>(dot(forward, place));
        }
        triangles_.push_back({depth, static_cast<std::uint32_t>(p), static_cast<std::uint32_t>(t)});
      }
    }
    std::ranges::stable_sort(triangles_, std::greater<>{}, &Triangle::depth);
  }

  struct Triangle {
    float depth;
    std::uint32_t part, triangle;
  };
  [[nodiscard]] const std::vector<Triangle>& all() const { return triangles_; }

 private:
  std::vector<Triangle> triangles_;
};

using Matrix = std::array<float, 16>;  ///< in column-major order

constexpr GLsizei kMapColours = 256;

// These structures match those of the shaders.
struct Draw {
  std::array<float, 4> origin;
  std::array<std::uint32_t, 4> style;  ///< its number, whether the mesh is clipped
  std::array<float, 4> along;          ///< for ends of edges: steps, and the isovalue
};
struct Style {
  std::array<float, 4> front, back, range;
  std::array<std::uint32_t, 4> flags;  ///< coloured by value, flat
};
/// A command of OpenGL for indirect drawing.
struct Command {
  std::uint32_t count, instances, first_index, base_vertex, base_instance;
};

GLuint compiled(GLenum kind, const std::string& source) {
  const GLuint shader = glCreateShader(kind);
  const char* const text = source.c_str();
  glShaderSource(shader, 1, &text, nullptr);
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

/// `vertices`: the part of the vertex shader that reads the vertices of a kind of mesh.
GLuint linked_program(std::string_view vertices) {
  const GLuint program = glCreateProgram();
  for (const auto& [kind, source] :
       {std::pair{GL_VERTEX_SHADER, fmt::format("{}{}{}", kVersion, vertices, kVertexShader)},
        std::pair{GL_FRAGMENT_SHADER, fmt::format("{}{}", kVersion, kFragmentShader)}}) {
    const GLuint shader = compiled(static_cast<GLenum>(kind), source);
    glAttachShader(program, shader);
    glDeleteShader(shader);
  }
  glLinkProgram(program);
  GLint done = GL_FALSE;
  glGetProgramiv(program, GL_LINK_STATUS, &done);
  if (done == GL_FALSE) fail("pictures by OpenGL: the shaders do not fit together");
  return program;
}

/// The matrix of the view: its directions, and the position of the target in it.
Matrix view_matrix(const Viewpoint& viewpoint) {
  const auto [forward, right, up] = ViewAxes(viewpoint);
  const Vec3 eye = viewpoint.eye - viewpoint.target;
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

/// The distance of the farthest point of the parts behind the near plane, along the line of sight.
double far_plane(const Viewpoint& viewpoint, std::span<const DrawnPart> parts) {
  const Vec3 forward = normalized(viewpoint.target - viewpoint.eye);
  double far = 2 * viewpoint.near;
  for (const DrawnPart& part : parts) {
    if (part.mesh->indices.empty()) continue;
    for (const Vec3& corner : part.mesh->box.corners())
      far = std::max(far, 1.01 * dot(corner - viewpoint.eye, forward));
  }
  return far;
}

std::array<float, 4> in_single(const Colour& colour, double opacity) {
  return {static_cast<float>(colour.r), static_cast<float>(colour.g), static_cast<float>(colour.b),
          static_cast<float>(opacity)};
}

std::array<float, 4> in_single(const Vec3& v, double last) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z),
          static_cast<float>(last)};
}

Style style_of(const PartStyle& style) {
  return {in_single(style.front, style.opacity),
          in_single(style.back, style.opacity),
          {static_cast<float>(style.low), static_cast<float>(style.high), 0, 0},
          {style.is_coloured_by_value ? 1u : 0u, style.is_flat ? 1u : 0u, 0, 0}};
}

/// A buffer that is filled again for each picture.
class StreamBuffer {
 public:
  StreamBuffer() { glCreateBuffers(1, &name_); }
  StreamBuffer(const StreamBuffer&) = delete;
  StreamBuffer& operator=(const StreamBuffer&) = delete;
  ~StreamBuffer() { glDeleteBuffers(1, &name_); }

  [[nodiscard]] GLuint name() const { return name_; }
  template <class T>
  void fill(const std::vector<T>& values) const {
    // It has at least one element, since empty buffers cannot be bound.
    const T none{};
    glNamedBufferData(name_, static_cast<GLsizeiptr>(std::max<std::size_t>(1, values.size()) * sizeof(T)),
                      values.empty() ? &none : values.data(), GL_STREAM_DRAW);
  }

 private:
  GLuint name_ = 0;
};

}  // namespace

struct Renderer::Objects {
  GLuint point_program = linked_program(kPointVertices), edge_program = linked_program(kEdgeVertices);
  GLuint map_texture = 0;
  std::string map_name;
  MeshBuffers meshes;
  StreamBuffer draws, styles, commands, numbers, sorted_indices;
  std::vector<MeshBuffers::Place> places;  ///< places of the parts of the picture
  DrawFigures figures;

  Objects() {
    glCreateTextures(GL_TEXTURE_1D, 1, &map_texture);
    glTextureStorage1D(map_texture, 1, GL_RGBA8, kMapColours);
    glTextureParameteri(map_texture, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTextureParameteri(map_texture, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  }
  Objects(const Objects&) = delete;
  Objects& operator=(const Objects&) = delete;
  ~Objects() {
    glDeleteProgram(point_program);
    glDeleteProgram(edge_program);
    glDeleteTextures(1, &map_texture);
  }

  void set_colour_map(const std::string& name) {
    if (name == map_name) return;
    const ColourMap map = ColourMap::by_name(name);
    std::vector<std::array<std::uint8_t, 4>> colours;
    for (GLsizei n = 0; n < kMapColours; ++n) {
      const auto [r, g, b] = to_bytes(map.at(n / static_cast<double>(kMapColours - 1)));
      colours.push_back({r, g, b, 255});
    }
    glTextureSubImage1D(map_texture, 0, 0, kMapColours, GL_RGBA, GL_UNSIGNED_BYTE, colours.data());
    map_name = name;
  }

  /// Copies what is new, and tells the shaders the place and the style of each mesh.
  void take_parts(const PictureContents& contents) {
    std::vector<Draw> all_draws;
    std::vector<Style> all_styles;
    places.clear();
    const PartStyle* last = nullptr;
    for (const DrawnPart& part : contents.parts) {
      places.push_back(meshes.place(part.mesh));
      if (last == nullptr || !(*last == part.style)) all_styles.push_back(style_of(part.style));
      last = &part.style;
      all_draws.push_back(
          {in_single(part.mesh->origin - contents.viewpoint.target, part.mesh->least_parameter),
           {static_cast<std::uint32_t>(all_styles.size() - 1), part.style.is_clipped ? 1u : 0u, 0, 0},
           in_single(part.mesh->step, part.isovalue)});
    }
    draws.fill(all_draws);
    styles.fill(all_styles);
    std::vector<std::uint32_t> all_numbers(std::max<std::size_t>(1, contents.parts.size()));
    std::iota(all_numbers.begin(), all_numbers.end(), 0u);
    numbers.fill(all_numbers);
    for (std::size_t block = 0; block < meshes.blocks(); ++block) {
      const GLuint array = meshes.vertex_array(block);
      // Each command gets its number through an instanced attribute.
      glEnableVertexArrayAttrib(array, 3);
      glVertexArrayAttribIFormat(array, 3, 1, GL_UNSIGNED_INT, 0);
      glVertexArrayAttribBinding(array, 3, 1);
      glVertexArrayBindingDivisor(array, 1, 1);
      glVertexArrayVertexBuffer(array, 1, numbers.name(), 0, sizeof(std::uint32_t));
    }
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, draws.name());
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, styles.name());
  }

  [[nodiscard]] Command command(std::size_t part) const {
    const MeshBuffers::Place& place = places[part];
    return {place.index_count, 1, place.first_index, place.first_vertex, static_cast<std::uint32_t>(part)};
  }

  [[nodiscard]] GLuint program_of(std::size_t block) const {
    return meshes.has_edges(block) ? edge_program : point_program;
  }

  /// Draws the parts that `chosen` accepts, by one command for each block.
  template <class Chosen>
  void draw_parts(std::span<const DrawnPart> parts, GLenum mode, Chosen&& chosen) {
    for (std::size_t block = 0; block < meshes.blocks(); ++block) {
      std::vector<Command> all;
      for (std::size_t p = 0; p < parts.size(); ++p) {
        if (places[p].block == block && places[p].index_count > 0 && chosen(parts[p]))
          all.push_back(command(p));
      }
      if (all.empty()) continue;
      commands.fill(all);
      glUseProgram(program_of(block));
      glBindBuffer(GL_DRAW_INDIRECT_BUFFER, commands.name());
      const GLuint array = meshes.vertex_array(block);
      glVertexArrayElementBuffer(array, meshes.index_buffer(block));
      glBindVertexArray(array);
      glMultiDrawElementsIndirect(mode, GL_UNSIGNED_INT, nullptr, static_cast<GLsizei>(all.size()), 0);
      ++figures.draw_calls;
    }
  }

  /// Draws transparent triangles in their order; triangles of one part that follow each other are drawn by
  /// one command.
  void draw_transparent(const PictureContents& contents) {
    if (std::ranges::none_of(contents.parts, is_transparent)) return;
    const SortedTriangles sorted(contents.parts, contents.viewpoint);
    std::vector<std::uint32_t> indices;
    for (const auto& each : sorted.all()) {
      const auto& from = contents.parts[each.part].mesh->indices;
      for (std::size_t c = 0; c < 3; ++c) indices.push_back(from[3 * std::size_t{each.triangle} + c]);
    }
    sorted_indices.fill(indices);
    glEnable(GL_BLEND);
    glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    glDepthMask(GL_FALSE);
    const auto& all = sorted.all();
    for (std::size_t begin = 0; begin < all.size();) {
      std::size_t end = begin + 1;
      while (end < all.size() && all[end].part == all[begin].part) ++end;
      const MeshBuffers::Place& place = places[all[begin].part];
      const GLuint array = meshes.vertex_array(place.block);
      glUseProgram(program_of(place.block));
      glVertexArrayElementBuffer(array, sorted_indices.name());
      glBindVertexArray(array);
      const std::uintptr_t offset = 3 * begin * sizeof(std::uint32_t);
      glDrawElementsInstancedBaseVertexBaseInstance(
          GL_TRIANGLES, static_cast<GLsizei>(3 * (end - begin)), GL_UNSIGNED_INT,
          reinterpret_cast<const void*>(offset),  // NOLINT(performance-no-int-to-ptr): OpenGL's way
          1, static_cast<GLint>(place.first_vertex), all[begin].part);
      ++figures.draw_calls;
      begin = end;
    }
    glDepthMask(GL_TRUE);
    glDisable(GL_BLEND);
  }

  void set_view(const PictureContents& contents, const Viewpoint& viewpoint) const {
    const Plane plane = contents.clip.value_or(Plane{{}, {}});
    const std::array<float, 4> clip =
        in_single(plane.normal, dot(plane.normal, viewpoint.target - plane.origin));
    for (const GLuint program : {edge_program, point_program}) {
      glProgramUniformMatrix4fv(program, 0, 1, GL_FALSE, view_matrix(viewpoint).data());
      glProgramUniformMatrix4fv(program, 1, 1, GL_FALSE, picture_matrix(viewpoint, figures.far).data());
      glProgramUniform4fv(program, 2, 1, clip.data());
      glProgramUniform1i(program, 3, contents.shading == Shading::kSphere ? 1 : 0);
      glProgramUniform1i(program, 4, viewpoint.height > 0 ? 1 : 0);
    }
    set_edges(false);
    glBindTextureUnit(0, map_texture);
  }

  /// Sets whether edges are drawn instead of areas.
  void set_edges(bool are_edges) const {
    for (const GLuint program : {edge_program, point_program})
      glProgramUniform1i(program, 5, are_edges ? 1 : 0);
  }

  void draw_all(const PictureContents& contents) {
    // Filled areas are moved back a little, so that lines on them are visible.
    glEnable(GL_POLYGON_OFFSET_FILL);
    glPolygonOffset(1, 1);
    draw_parts(contents.parts, GL_TRIANGLES,
               [](const DrawnPart& part) { return !part.mesh->is_lines && !is_transparent(part); });
    glDisable(GL_POLYGON_OFFSET_FILL);
    glPolygonMode(GL_FRONT_AND_BACK, GL_LINE);
    set_edges(true);
    draw_parts(contents.parts, GL_TRIANGLES, [](const DrawnPart& part) {
      return !part.mesh->is_lines && !is_transparent(part) && part.style.has_edges;
    });
    set_edges(false);
    glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
    draw_parts(contents.parts, GL_LINES, [](const DrawnPart& part) { return part.mesh->is_lines; });
    draw_transparent(contents);
  }
};

Renderer::Renderer() : objects_(std::make_unique<Objects>()) {}

Renderer::~Renderer() = default;

DrawFigures Renderer::draw(const PictureContents& contents, std::uint32_t framebuffer, int width,
                           int height) {
  Objects& o = *objects_;
  o.figures = {};
  const std::uint64_t copied_before = o.meshes.copied_bytes();
  Viewpoint viewpoint = contents.viewpoint;
  viewpoint.width_pixels = width;
  viewpoint.height_pixels = height;
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  glViewport(0, 0, width, height);
  glEnable(GL_DEPTH_TEST);
  glDisable(GL_SCISSOR_TEST);
  glDisable(GL_CULL_FACE);
  glDisable(GL_BLEND);
  const Colour& background = contents.background;
  glClearColor(static_cast<float>(background.r), static_cast<float>(background.g),
               static_cast<float>(background.b), 1);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  o.meshes.begin_picture();
  if (!contents.parts.empty()) {
    o.figures.far = far_plane(viewpoint, contents.parts);
    o.set_colour_map(contents.colour_map);
    o.take_parts(contents);
    o.set_view(contents, viewpoint);
    if (contents.clip) glEnable(GL_CLIP_DISTANCE0);
    o.draw_all(contents);
    glDisable(GL_CLIP_DISTANCE0);
    glBindVertexArray(0);
  }
  o.meshes.end_picture();
  if (const GLenum error = glGetError(); error != GL_NO_ERROR)
    fail("pictures by OpenGL: a picture failed (error {:#x}): is the graphics memory full?", error);
  for (const DrawnPart& part : contents.parts) {
    if (!part.mesh->is_lines) o.figures.triangles += part.mesh->indices.size() / 3;
  }
  o.figures.copied_bytes = o.meshes.copied_bytes() - copied_before;
  return o.figures;
}

}  // namespace adamas::viewer
