#include "interfaces/network/network_measures.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/geometry/box_clip.h"

namespace adamas::interfaces {

namespace {

// Points within this distance of a face, relative to the box's diagonal, count as on it.
constexpr double kOnFace = 1e-9;
/// The distance from the box's greatest corner at which its owner is looked up, relative to the box's size:
/// triangles in the faces do not matter there.
constexpr double kInside = 1e-7;

using Polygon = std::vector<Vec3>;

/// Sums the parts of a network; coordinates are relative to the box's lower corner.
class Measure {
 public:
  Measure(const InterfaceNetwork& network, const Box3& box, std::size_t materials)
      : network_(network), box_(box), size_(box.size()), tolerance_(kOnFace * box.diagonal()) {
    result_.volumes = IdVector<MaterialId, double>(materials, 0.0);
    result_.body_volumes = IdVector<BodyId, double>(network.table().body_count(), 0.0);
    result_.areas = IdVector<InterfaceId, double>(network.table().interface_count(), 0.0);
  }

  NetworkMeasures run() {
    Polygon polygon, scratch;
    for (std::uint32_t t = 0; t < network_.triangles().size(); ++t) {
      polygon.clear();
      for (const Vec3& p : network_.triangle_corners(t)) polygon.push_back(snapped(p - box_.min));
      clip_to_box(polygon, {{}, size_}, scratch);
      for (Vec3& p : polygon) p = snapped(p);
      if (polygon.size() >= 3) add(t, polygon);
    }
    const Vec3 corner = box_.max - kInside * size_;
    result_.body_volumes[network_.body_at(corner)] += size_.x * size_.y * size_.z;
    for (BodyId b(0); b.value < result_.body_volumes.size(); ++b.value)
      result_.volumes[network_.table().material(b)] += result_.body_volumes[b];
    return std::move(result_);
  }

 private:
  [[nodiscard]] Vec3 snapped(Vec3 p) const {
    for (int axis = 0; axis < 3; ++axis) {
      if (std::abs(p[axis]) <= tolerance_) p[axis] = 0;
      if (std::abs(p[axis] - size_[axis]) <= tolerance_) p[axis] = size_[axis];
    }
    return p;
  }

  /// Adds a volume to the body in front of a triangle and subtracts it from the one behind.
  void give(std::uint32_t triangle, double volume) {
    const auto& [front, back] = network_.table().sides(network_.interface_of(triangle));
    result_.body_volumes[front] += volume;
    result_.body_volumes[back] -= volume;
  }

  void add(std::uint32_t t, const Polygon& polygon) {
    double area = 0, moment = 0;  // the integral of x over the area projected along x
    for (std::size_t i = 2; i < polygon.size(); ++i) {
      const Vec3 &a = polygon[0], &b = polygon[i - 1], &c = polygon[i];
      const Vec3 twice = cross(b - a, c - a);
      area += 0.5 * norm(twice);
      moment += 0.5 * twice.x * (a.x + b.x + c.x) / 3;
    }
    result_.areas[network_.interface_of(t)] += area;
    // A polygon in the face itself bounds nothing inside the box.
    if (std::all_of(polygon.begin(), polygon.end(), [this](const Vec3& p) { return p.x >= size_.x; })) return;
    give(t, -moment);
    add_on_face(t, polygon);
  }

  /// Adds the volume below the polygon's trace on the face x = max, along y.
  void add_on_face(std::uint32_t t, const Polygon& polygon) {
    const auto inside = [this](const Vec3& p) { return p.x < size_.x; };
    const std::size_t n = polygon.size();
    const Vec3 *out = nullptr, *in = nullptr;
    for (std::size_t i = 0; i < n; ++i) {
      const Vec3 &p = polygon[i], &q = polygon[(i + 1) % n];
      if (inside(p) && !inside(q)) out = &q;
      if (!inside(p) && inside(q)) in = &p;
    }
    if (out == nullptr || in == nullptr || out == in) return;
    const bool from = in->y < size_.y, to = out->y < size_.y;
    if (!from && !to) return;
    // Along the trace from `in` to `out`, the front lies at greater y if z increases.
    give(t, -size_.x * 0.5 * (in->y + out->y) * (out->z - in->z));
    if (from == to) return;
    // The trace ends at the edge y = max. The front lies at greater z there if the trace starts at this edge.
    const double z = from ? out->z : in->z;
    if (z < size_.z) give(t, size_.x * size_.y * (from ? z : -z));
  }

  const InterfaceNetwork& network_;
  const Box3& box_;
  Vec3 size_;
  double tolerance_;
  NetworkMeasures result_;
};

}  // namespace

NetworkMeasures measure_network(const InterfaceNetwork& network, const Box3& box, std::size_t materials) {
  return Measure(network, box, materials).run();
}

}  // namespace adamas::interfaces
