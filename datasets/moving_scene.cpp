#include "datasets/moving_scene.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "datasets/half_space_clipping.h"
#include "datasets/shortest_side.h"

namespace adamas::datasets {

namespace {

using std::numbers::pi;

constexpr MaterialId kSurrounding(0), kLeft(1), kRight(2), kBubble(3), kPool(4);

double between(double from, double to, double time) { return from + (to - from) * time; }

double ball_volume(double radius) { return 4.0 / 3 * pi * radius * radius * radius; }

/// The volume of the intersection of two equal balls.
double lens_volume(double radius, double apart) {
  const double depth = std::max(0.0, 2 * radius - apart);
  return pi / 12 * depth * depth * (4 * radius + apart);
}

}  // namespace

SceneDescription moving_scene(const Box3& box, double time) {
  SceneDescription d;
  d.name = "moving";
  d.box = box;
  for (const char* name : {"surrounding", "left drop", "right drop", "bubble", "pool"})
    d.materials.push_back(name);
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

}  // namespace adamas::datasets
