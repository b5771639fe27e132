#pragma once

#include <string_view>

namespace adamas::viewer {

// In view coordinates the eye is at the origin and looks along -z. Places are relative to the origin of their
// mesh; each command for a mesh gives that origin relative to the target, and the style of the mesh.
inline constexpr std::string_view kVersion = "#version 450 core\n";

/// The input of meshes that have vertices.
inline constexpr std::string_view kPointVertices = R"(
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
inline constexpr std::string_view kEdgeVertices = R"(
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

inline constexpr std::string_view kVertexShader = R"(
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

inline constexpr std::string_view kFragmentShader = R"(
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

}  // namespace adamas::viewer
