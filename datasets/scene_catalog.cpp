#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "core/base/error.h"
#include "datasets/half_space_clipping.h"
#include "datasets/random_numbers.h"
#include "datasets/scene.h"

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

double between(double from, double to, double time) { return from + (to - from) * time; }

/// The volume of the intersection of two equal balls.
double lens_volume(double radius, double apart) {
  const double depth = std::max(0.0, 2 * radius - apart);
  return pi / 12 * depth * depth * (4 * radius + apart);
}

/// Bodies in a "surrounding" that move and change as `time` goes from 0 to 1: a "left drop" and a "right
/// drop" that come together and press a flat disc between them, a "bubble" that goes round and grows, and a
/// "pool" that rises. Volumes are known exactly at any time.
SceneDescription moving_scene(const Box3& box, double time) {
  constexpr MaterialId kSurrounding(0), kLeft(1), kRight(2), kBubble(3), kPool(4);
  SceneDescription d = describe("moving", box, {"surrounding", "left drop", "right drop", "bubble", "pool"});
  const double scale = shortest_side(box);
  const auto place = [&](const Vec3& p) { return box.center() + scale * p; };
  d.candidates = {{kSurrounding, {d.add(SceneFunction::linear({}, box.center()))}}};

  const double drop = 0.14 * scale, apart = between(0.52, 0.16, time) * scale;
  const Vec3 middle = place({0.011, -0.023, 0.24}), way = normalized({0.93, 0.31, 0.17});
  for (const auto& [owner, side] : {std::pair{kLeft, -0.5}, std::pair{kRight, 0.5}}) {
    d.candidates.push_back({owner, {d.add(SceneFunction::sphere(middle + side * apart * way, drop))}});
  }
  const double around = between(0.3, 0.3 + pi, time), bubble = between(0.08, 0.13, time) * scale;
  const Vec3 round = place({0.25 * std::cos(around), 0.25 * std::sin(around), -0.12});
  d.candidates.push_back({kBubble, {d.add(SceneFunction::sphere(round, bubble))}});
  // The surface is oblique: otherwise all its cells would be cut alike, and the rounding errors of their
  // fractions would add up.
  const Vec3 up = normalized({-0.06, -0.04, 1}), surface = place({0, 0, between(-0.42, -0.3, time)});
  const SceneFunction below = SceneFunction::linear(-up, surface);
  d.candidates.push_back({kPool, {d.add(below)}});

  const double each = ball_volume(drop) - 0.5 * lens_volume(drop, apart);
  const double pool = clipped_volume(box, {below});
  d.volumes = {box.volume() - 2 * each - ball_volume(bubble) - pool, each, each, ball_volume(bubble), pool};
  return d;
}

constexpr std::size_t kLeastMaterials = 2, kMostMaterials = 6, kMostThin = 2;
constexpr std::uint64_t kLatticeCells = 16;
// A material is present when at least kHits of kProbes^3 probed points are its own.
constexpr int kProbes = 16, kHits = 4;
constexpr int kAttempts = 1000;
// The values of thick shapes are capped between these, relative to the shortest side of the box.
constexpr double kLeastCap = 0.003, kGreatestCap = 0.012;

/// A body: the region where all functions are positive.
using Shape = std::vector<SceneFunction>;

class ShapeMaker {
 public:
  ShapeMaker(const Box3& box, RandomNumbers& random)
      : box_(box), random_(random), scale_(shortest_side(box)) {}

  /// Chooses lattice points that the shapes of a scene share, so that their borders meet there.
  void choose_anchors() {
    for (Vec3& anchor : anchors_) {
      for (int axis = 0; axis < 3; ++axis) {
        const double t = static_cast<double>(3 + random_.below(kLatticeCells - 5)) / kLatticeCells;
        anchor[axis] = box_.min[axis] + t * (box_.max[axis] - box_.min[axis]);
      }
    }
  }

  Shape thick() { return random_.chance(0.5) ? Shape{plane()} : Shape{ball(random_.uniform(0.15, 0.4))}; }

  /// A thin layer. Its region is thinner than `thickness` where it runs through a thick shape.
  Shape thin() {
    const double thickness = scale_ * std::pow(10, random_.uniform(-2.2, -1.4));
    Shape shape;
    if (random_.chance(0.3)) {
      const SceneFunction outer = ball(random_.uniform(0.2, 0.4));
      SceneFunction inner = outer;
      inner.radius -= thickness;
      shape = {outer, inner.negated(), plane()};
    } else {
      const SceneFunction lower = plane();
      SceneFunction upper = lower.negated();
      upper.constant += thickness;
      shape = {lower, upper, random_.chance(0.5) ? plane() : ball(random_.uniform(0.2, 0.4))};
    }
    for (SceneFunction& function : shape) function = function.scaled(4 * kGreatestCap * scale_ / thickness);
    return shape;
  }

 private:
  /// A point of the box, often close to an anchor.
  Vec3 point() {
    if (random_.chance(0.3))
      return random_.point({box_.min + 0.15 * box_.size(), box_.max - 0.15 * box_.size()});
    const double offset = scale_ * std::pow(10, random_.uniform(-6, -2));
    const Vec3 anchor = anchors_[random_.below(anchors_.size())];
    return anchor + offset * random_.direction();
  }

  /// A normal that is often almost along an axis, or almost at right angles to one.
  Vec3 normal() {
    Vec3 n = random_.direction();
    const double kind = random_.uniform();
    if (kind < 0.4) return n;
    const double tilt = std::pow(10, random_.uniform(-5, -1));
    const int axis = static_cast<int>(random_.below(3));
    if (kind < 0.7) {
      n *= tilt;
      n[axis] += random_.chance(0.5) ? 1 : -1;
    } else {
      n[axis] *= tilt;
    }
    return normalized(n);
  }

  SceneFunction plane() {
    const Vec3 n = normal();
    return SceneFunction::linear(n, point());
  }

  /// A ball whose surface passes through point().
  SceneFunction ball(double relative_radius) {
    const double radius = relative_radius * scale_;
    Vec3 inward = random_.direction();
    const Vec3 touched = point();
    if (dot(inward, box_.center() - touched) < 0) inward = -inward;
    return SceneFunction::sphere(touched + radius * inward, radius);
  }

  Box3 box_;
  RandomNumbers& random_;
  double scale_;
  std::array<Vec3, 2> anchors_;
};

/// Makes a random set of shapes against a background of value zero. Each thick shape is capped at a constant
/// of its own: where two overlap the one with the higher cap owns all but a rim of the other. Thin ones are
/// steep enough to rise above all caps.
void arrange(std::size_t materials, ShapeMaker& make, RandomNumbers& random, double scale,
             SceneDescription& scene) {
  scene.functions.clear();
  scene.candidates.clear();
  make.choose_anchors();
  const auto add = [&](MaterialId owner, const Shape& shape) {
    SceneCandidate& candidate = scene.candidates.emplace_back();
    candidate.owner = owner;
    for (const SceneFunction& function : shape) candidate.functions.push_back(scene.add(function));
  };
  const auto thick = [&] {
    Shape shape = make.thick();
    const double cap = scale * random.uniform(kLeastCap, kGreatestCap);
    shape.push_back(SceneFunction::linear({}, scene.box.center(), cap));
    return shape;
  };
  add(MaterialId(0), {SceneFunction::linear({}, scene.box.center())});
  std::size_t thin = 0;
  for (std::size_t m = 1; m < materials; ++m) {
    const bool is_thin = thin < kMostThin && random.chance(0.5);
    thin += is_thin ? 1 : 0;
    add(MaterialId(m), is_thin ? make.thin() : thick());
  }
  // Sometimes one of the materials gets a second body.
  if (random.chance(0.4)) add(MaterialId(1 + random.below(materials - 1)), thick());
}

bool all_present(const Scene& scene) {
  std::vector<int> hits(scene.materials().size());
  const Vec3 step = (1.0 / kProbes) * scene.box().size();
  for (int k = 0; k < kProbes; ++k) {
    for (int j = 0; j < kProbes; ++j) {
      for (int i = 0; i < kProbes; ++i) {
        const Vec3 p = scene.box().min + Vec3{(i + 0.47) * step.x, (j + 0.51) * step.y, (k + 0.53) * step.z};
        ++hits[scene.owner(p).value];
      }
    }
  }
  return std::all_of(hits.begin(), hits.end(), [](int n) { return n >= kHits; });
}

/// A random scene of 2 to 6 materials, all of them present: half-spaces, balls, and thin layers, plane or
/// round, that end inside the box. Overlaps are decided by the greatest value, as in all scenes. Many shapes
/// pass close to points of the lattice with 16 cells a side, and many planes lie almost along its edges or
/// faces, so that triple lines do too.
SceneDescription random_scene(const Box3& box, std::uint64_t seed) {
  RandomNumbers random(seed);
  ShapeMaker make(box, random);
  SceneDescription scene;
  scene.name = "random";
  scene.box = box;
  const std::size_t count = kLeastMaterials + random.below(kMostMaterials - kLeastMaterials + 1);
  for (std::size_t m = 0; m < count; ++m) scene.materials.push_back("material" + std::to_string(m));
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    arrange(count, make, random, shortest_side(box), scene);
    if (all_present(Scene(scene))) return scene;
  }
  fail("scene random: expected a box where {} materials fit, found none in {} arrangements of seed {}", count,
       kAttempts, seed);
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
  fail("scene: expected one of {}, found '{}'", fmt::join(scene_names(), ", "), name);
}

}  // namespace adamas::datasets
