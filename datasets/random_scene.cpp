#include "datasets/random_scene.h"

#include <algorithm>

#include "core/base/error.h"
#include "datasets/random_numbers.h"
#include "datasets/shortest_side.h"

namespace adamas::datasets {

namespace {

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

}  // namespace

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

}  // namespace adamas::datasets
