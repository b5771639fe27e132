#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/error.h"
#include "datasets/half_space_clipping.h"
#include "datasets/moving_scene.h"
#include "datasets/random_numbers.h"
#include "datasets/random_scene.h"
#include "datasets/scene.h"
#include "datasets/shortest_side.h"

namespace adamas::datasets {

namespace {

using std::numbers::pi;

constexpr MaterialId kFirst(0), kSecond(1), kThird(2);

SceneDescription describe(std::string_view name, const Box3& box, std::vector<std::string> materials) {
  SceneDescription d;
  d.name = name;
  d.box = box;
  d.materials.assign(materials.begin(), materials.end());
  return d;
}

double ball_volume(double radius) { return 4.0 / 3 * pi * radius * radius * radius; }

/// The centre of spheres, off the middle of the box, so that no lattice point lies on an axis of symmetry.
Vec3 sphere_center(const Box3& box) { return box.center() + shortest_side(box) * Vec3{0.003, -0.004, 0.007}; }

SceneDescription sphere(const Box3& box) {
  SceneDescription d = describe("sphere", box, {"outside", "inside"});
  const Vec3 c = sphere_center(box);
  const double r = 0.35 * shortest_side(box);
  d.candidates = {{kFirst, {d.add(SceneFunction::linear({}, c))}},
                  {kSecond, {d.add(SceneFunction::sphere(c, r))}}};
  d.volumes = {box.volume() - ball_volume(r), ball_volume(r)};
  d.spheres = {{c, r, kSecond, kFirst}};
  return d;
}

/// Concentric spheres closer than a cell of a usual grid; `core` and the outside may be one material.
SceneDescription shell(std::string_view name, const Box3& box, std::vector<std::string> materials,
                       MaterialId core) {
  SceneDescription d = describe(name, box, std::move(materials));
  const Vec3 c = sphere_center(box);
  const double inner = 0.3 * shortest_side(box), outer = 0.31 * shortest_side(box);
  const SceneFunction in = SceneFunction::sphere(c, inner), out = SceneFunction::sphere(c, outer);
  const std::uint32_t within = d.add(out), beyond = d.add(in.negated());
  d.candidates = {{kFirst, {d.add(out.negated())}}, {kSecond, {within, beyond}}, {core, {d.add(in)}}};
  d.volumes.resize(d.materials.size());
  d.volumes[kFirst] += box.volume() - ball_volume(outer);
  d.volumes[kSecond] += ball_volume(outer) - ball_volume(inner);
  d.volumes[core] += ball_volume(inner);
  d.spheres = {{c, inner, core, kSecond}, {c, outer, kSecond, kFirst}};
  return d;
}

SceneDescription plate(const Box3& box) {
  SceneDescription d = describe("plate", box, {"surrounding", "plate"});
  const double scale = shortest_side(box);
  const Vec3 center = box.center() + scale * Vec3{0.013, -0.007, 0.011};
  const Vec3 u = normalized({0.9, 0.3, 0.2}), w = normalized(cross(u, {0.1, 0.8, -0.3})), v = cross(w, u);
  const std::array<Vec3, 3> axes{u, v, w};
  const std::array<double, 3> half{0.31 * scale, 0.27 * scale, 0.011 * scale};
  SceneCandidate inside{kSecond, {}};
  for (std::size_t i = 0; i < 3; ++i) {
    inside.functions.push_back(d.add(SceneFunction::linear(axes[i], center, half[i])));
    inside.functions.push_back(d.add(SceneFunction::linear(-axes[i], center, half[i])));
  }
  d.candidates = {{kFirst, {d.add(SceneFunction::linear({}, center))}}, inside};
  const double volume = 8 * half[0] * half[1] * half[2];
  d.volumes = {box.volume() - volume, volume};
  return d;
}

/// Two planes, the first one whole, the second on the negative side of the first.
SceneDescription tjunction(const Box3& box) {
  SceneDescription d = describe("tjunction", box, {"a", "b", "c"});
  const SceneFunction first = SceneFunction::linear(normalized({0.5, 0.5, 0}), box.center());
  const SceneFunction second = SceneFunction::linear(normalized({0.5, 0.025, -0.375}), box.center());
  const std::uint32_t p = d.add(first), n = d.add(first.negated());
  const std::uint32_t q = d.add(second), m = d.add(second.negated());
  d.candidates = {{kFirst, {p}}, {kSecond, {n, q}}, {kThird, {n, m}}};
  d.volumes = {clipped_volume(box, {first}), clipped_volume(box, {first.negated(), second}),
               clipped_volume(box, {first.negated(), second.negated()})};
  return d;
}

/// Regions of 240, 60 and 60 degrees round an oblique line.
SceneDescription reflex(const Box3& box) {
  SceneDescription d = describe("reflex", box, {"wide", "first", "second"});
  const double scale = shortest_side(box);
  const Vec3 origin = box.center() + scale * Vec3{0.017, 0.023, -0.012};
  const Vec3 line = normalized({0.15, 0.22, 1}), u = normalized(cross(line, {0.3, 1, 0.1})),
             v = cross(line, u);
  // A sheet is the half-plane that starts at the line in direction `degrees`; it is positive on the side of
  // growing angles.
  const auto sheet = [&](double degrees) {
    const double a = degrees * pi / 180;
    return SceneFunction::linear(std::cos(a) * v - std::sin(a) * u, origin);
  };
  const SceneFunction s0 = sheet(0), s60 = sheet(60), s120 = sheet(120);
  // Within the two regions of 60 degrees one function is that of the outer sheet; the other two functions are
  // equal at 60 degrees, and negative at the other region's outer sheet.
  const std::uint32_t outer0 = d.add(s0), inner0 = d.add(sheet(110).negated());
  const std::uint32_t outer120 = d.add(s120.negated()), inner120 = d.add(sheet(10));
  d.candidates = {{kFirst, {d.add(SceneFunction::linear({}, origin))}},
                  {kSecond, {outer0, inner0}},
                  {kThird, {outer120, inner120}}};
  const double first = clipped_volume(box, {s0, s60.negated()}),
               second = clipped_volume(box, {s60, s120.negated()});
  d.volumes = {box.volume() - first - second, first, second};
  return d;
}

SceneDescription voronoi(const Box3& box, std::uint64_t seed) {
  constexpr std::size_t kCells = 10;
  std::vector<std::string> names;
  for (std::size_t i = 0; i < kCells; ++i) names.push_back("cell" + std::to_string(i));
  SceneDescription d = describe("voronoi10", box, std::move(names));
  RandomNumbers random(seed);
  std::vector<SceneFunction> powers;
  // The nearest seed has the greatest value of 2 s.p - |s|^2, from the box's centre.
  for (std::size_t i = 0; i < kCells; ++i) {
    const Vec3 s = random.point(box) - box.center();
    powers.push_back(SceneFunction::linear(2.0 * s, box.center(), -squared_norm(s)));
    d.candidates.push_back({MaterialId(i), {d.add(powers.back())}});
  }
  for (std::size_t i = 0; i < kCells; ++i) {
    std::vector<SceneFunction> nearer;
    for (std::size_t j = 0; j < kCells; ++j) {
      if (j == i) continue;
      nearer.push_back(SceneFunction::linear(powers[i].gradient - powers[j].gradient, box.center(),
                                             powers[i].constant - powers[j].constant));
    }
    d.volumes.push_back(clipped_volume(box, nearer));
  }
  return d;
}

bool has_volume(const Box3& box) {
  const Vec3 size = box.size();
  return std::isfinite(box.volume()) && size.x > 0 && size.y > 0 && size.z > 0;
}

}  // namespace

}  // namespace adamas::datasets

namespace adamas {

std::vector<std::string> scene_names() {
  return {"sphere", "shell3", "shell2", "plate", "tjunction", "reflex", "voronoi10", "random", "moving"};
}

}  // namespace adamas

namespace adamas::datasets {

Scene make_scene(std::string_view name, std::uint64_t seed, const SceneOptions& options) {
  const Box3& box = options.box;
  if (!has_volume(box)) {
    fail("scene {}: expected a box with volume, found [{},{}]x[{},{}]x[{},{}]", name, box.min.x, box.max.x,
         box.min.y, box.max.y, box.min.z, box.max.z);
  }
  if (!(options.time >= 0 && options.time <= 1))
    fail("scene {}: expected a time from 0 to 1, found {}", name, options.time);
  if (name == "sphere") return Scene(sphere(box));
  if (name == "shell3") return Scene(shell(name, box, {"outside", "shell", "core"}, kThird));
  if (name == "shell2") return Scene(shell(name, box, {"surrounding", "shell"}, kFirst));
  if (name == "plate") return Scene(plate(box));
  if (name == "tjunction") return Scene(tjunction(box));
  if (name == "reflex") return Scene(reflex(box));
  if (name == "voronoi10") return Scene(voronoi(box, seed));
  if (name == "random") return Scene(random_scene(box, seed));
  if (name == "moving") return Scene(moving_scene(box, options.time));
  std::string known;
  for (const std::string& each : scene_names()) known += (known.empty() ? "" : ", ") + each;
  fail("scene: expected one of {}, found '{}'", known, name);
}

}  // namespace adamas::datasets
