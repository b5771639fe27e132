#include <algorithm>
#include <numbers>

#include "datasets/scene.h"
#include "datasets/shortest_side.h"

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

}  // namespace

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

Vec3 Scene::field_gradient(SceneField field, MaterialId m, const Vec3& p) const {
  const double scale = 1 / shortest_side(data_.box);
  switch (field) {
    case SceneField::kConstant:
      break;
    case SceneField::kLinear:
      return (kSlope * scale) * direction(m);
    case SceneField::kSmooth: {
      const Vec3 w = phase(m, scale * (p - data_.box.center()));
      const double a = kSlope * scale;
      return {3 * a * std::cos(w.x) * std::cos(w.y) * std::cos(w.z),
              -4 * a * std::sin(w.x) * std::sin(w.y) * std::cos(w.z),
              -5 * a * std::sin(w.x) * std::cos(w.y) * std::sin(w.z)};
    }
  }
  return {};
}

}  // namespace adamas::datasets
