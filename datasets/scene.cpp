#include "datasets/scene.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/assert.h"
#include "core/base/error.h"
#include "datasets/scene_integral.h"

namespace adamas::datasets {

namespace {

// Materials lie kJump apart and vary by at most kSlope times the distance in units of the box's shortest
// side, which keeps a jump at every interface.
constexpr double kJump = 10;
constexpr double kSlope = 2;

double level(MaterialId m) { return kJump * (1 + static_cast<double>(m.value)); }

/// A direction for each material, spread over the sphere by the golden angle.
Vec3 direction(MaterialId m) {
  const double golden = std::numbers::pi * (3 - std::sqrt(5.0));
  const double k = static_cast<double>(m.value);
  const double height = 0.9 * std::cos(1 + 2 * k), around = golden * k + 0.4;
  const double radius = std::sqrt(1 - height * height);
  return {radius * std::cos(around), radius * std::sin(around), height};
}

/// The phase of the smooth field, which has a wave of its own along each axis.
Vec3 phase(MaterialId m, const Vec3& q) {
  const Vec3 d = direction(m);
  return {3 * q.x + d.x, 4 * q.y + d.y, 5 * q.z + d.z};
}

// The grid and depth for integrating volumes that are not known.
constexpr std::size_t kVolumeCells = 16;
constexpr int kVolumeDepth = 3;
constexpr double kRoundOff = 1e-12;

struct Binding {
  double value;
  std::uint32_t function;
};

Binding binding(const SceneDescription& data, const SceneCandidate& candidate, const Vec3& p) {
  Binding least{data.functions[candidate.functions.front()].value(p), candidate.functions.front()};
  for (const std::uint32_t index : candidate.functions) {
    const double value = data.functions[index].value(p);
    if (value < least.value) least = {value, index};
  }
  return least;
}

bool finite_with_volume(const Box3& box) {
  for (int axis = 0; axis < 3; ++axis) {
    const double size = box.max[axis] - box.min[axis];
    if (!std::isfinite(box.min[axis]) || !std::isfinite(size) || !(size > 0)) return false;
  }
  return true;
}

}  // namespace

Scene::Scene(SceneDescription description)
    : data_(std::move(description)), integrated_(std::make_shared<Integrated>()) {
  const Box3& box = data_.box;
  if (!finite_with_volume(box)) {
    fail("scene {}: expected a box with volume, found [{},{}]x[{},{}]x[{},{}]", data_.name, box.min.x,
         box.max.x, box.min.y, box.max.y, box.min.z, box.max.z);
  }
  if (data_.candidates.empty()) fail("scene {}: expected at least one candidate, found none", data_.name);
  for (SceneCandidate& candidate : data_.candidates) {
    std::sort(candidate.functions.begin(), candidate.functions.end());
    if (candidate.owner.value >= data_.materials.size()) {
      fail("scene {}: expected an owner below {}, found {}", data_.name, data_.materials.size(),
           candidate.owner.value);
    }
    if (candidate.functions.empty() || candidate.functions.back() >= data_.functions.size()) {
      fail("scene {}: expected candidates with functions below {}", data_.name, data_.functions.size());
    }
  }
  planar_ = std::all_of(data_.functions.begin(), data_.functions.end(),
                        [](const SceneFunction& f) { return f.is_linear(); });
}

MaterialId Scene::owner(const Vec3& p) const {
  Binding best{};
  MaterialId result;
  for (const SceneCandidate& candidate : data_.candidates) {
    const Binding b = binding(data_, candidate, p);
    const bool better = b.value > best.value || (b.value == best.value && b.function < best.function);
    if (!result.valid() || better) {
      best = b;
      result = candidate.owner;
    }
  }
  return result;
}

double Scene::value(MaterialId m, const Vec3& p) const {
  double greatest = -std::numeric_limits<double>::infinity();
  for (const SceneCandidate& candidate : data_.candidates) {
    if (candidate.owner == m) greatest = std::max(greatest, binding(data_, candidate, p).value);
  }
  return greatest;
}

const Scene::Integrated& Scene::integrated() const {
  std::call_once(integrated_->once, [this] {
    SceneIntegral integral =
        integrate_scene(*this, uniform_grid(data_.box, {kVolumeCells, kVolumeCells, kVolumeCells}),
                        kVolumeDepth, [](std::size_t, const std::vector<double>&) {});
    integrated_->volumes = std::move(integral.volumes);
    integrated_->errors = std::move(integral.errors);
  });
  return *integrated_;
}

double Scene::volume(MaterialId m) const {
  ADAMAS_ASSERT(m.value < data_.materials.size());
  return data_.volumes.empty() ? integrated().volumes[m] : data_.volumes[m];
}

double Scene::volume_error(MaterialId m) const {
  ADAMAS_ASSERT(m.value < data_.materials.size());
  const double round_off = kRoundOff * data_.box.volume();
  return data_.volumes.empty() ? std::max(integrated().errors[m], round_off) : round_off;
}

const std::array<std::pair<SceneField, std::string_view>, 3>& scene_fields() {
  static const std::array<std::pair<SceneField, std::string_view>, 3> kFields{
      {{SceneField::kConstant, "constant"},
       {SceneField::kLinear, "linear"},
       {SceneField::kSmooth, "smooth"}}};
  return kFields;
}

double Scene::field(SceneField field, MaterialId m, const Vec3& p) const {
  const Vec3 q = (1 / shortest_side(data_.box)) * (p - data_.box.center());
  switch (field) {
    case SceneField::kConstant:
      break;
    case SceneField::kLinear:
      return level(m) + kSlope * dot(direction(m), q);
    case SceneField::kSmooth: {
      const Vec3 w = phase(m, q);
      return level(m) + kSlope * std::sin(w.x) * std::cos(w.y) * std::cos(w.z);
    }
  }
  return level(m);
}

}  // namespace adamas::datasets
