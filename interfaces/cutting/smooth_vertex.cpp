#include <algorithm>
#include <cmath>
#include <limits>

#include "interfaces/cutting/local_changes.h"

namespace adamas::interfaces {

namespace {

constexpr int kMostSteps = 6;

/// The quality of a cell with one of its vertices at p.
double quality_if_moved(const LabelledMesh& mesh, std::uint32_t cell, std::uint32_t v, const Vec3& p) {
  const auto& corners = mesh.cell(cell).vertices;
  std::array<Vec3, 4> x;
  for (std::size_t i = 0; i < 4; ++i) x[i] = corners[i] == v ? p : mesh.point(corners[i]);
  return least_dihedral_sine(x[0], x[1], x[2], x[3]);
}

class Smoothing {
 public:
  Smoothing(LabelledMesh& mesh, const InterfaceTarget& target, std::uint32_t v)
      : mesh_(mesh), target_(target), v_(v), sides_(mesh.sides(v)), bodies_(sides_.bodies()) {
    size_ = longest_edge(mesh, v);
    astray_ = !target.allows(sides_, mesh.point(v));
  }

  bool run() {
    bool moved = false;
    for (int step = 0; step < kMostSteps; ++step) {
      if (!climb()) break;
      moved = true;
    }
    return moved;
  }

 private:
  Vec3 gradient(std::uint32_t c) const {
    const double h = 1e-4 * size_;
    const Vec3& p = mesh_.point(v_);
    Vec3 result;
    for (int axis = 0; axis < 3; ++axis) {
      Vec3 up = p, down = p;
      up[axis] += h;
      down[axis] -= h;
      result[axis] = (quality_if_moved(mesh_, c, v_, up) - quality_if_moved(mesh_, c, v_, down)) / (2 * h);
    }
    return result;
  }

  /// The place closest to p, nearly, on the interface or the line that the vertex lies on.
  std::optional<Vec3> placed(const Vec3& p) const {
    Vec3 q = p;
    for (int round = 0; round < (bodies_ > 1 ? 2 : 1); ++round) {
      if (bodies_ > 1 && !astray_ && stays_) {
        const auto near = target_.closest(sides_, q, 2 * size_);
        if (!near) return std::nullopt;
        q = *near;
      }
      for (int axis = 0; axis < 3; ++axis) {
        if ((mesh_.walls(v_) >> (2 * axis) & 3u) != 0) q[axis] = mesh_.point(v_)[axis];
      }
    }
    return q;
  }

  /// Whether the interfaces round the vertex, if it were at p, are where they may be.
  bool allowed(const Vec3& p) const {
    if (bodies_ < 2) return true;
    if (!target_.allows(sides_, p, astray_)) return false;
    thread_local std::vector<LabelledMesh::InterfaceFace> faces;
    mesh_.interface_faces(v_, faces);
    for (const auto& [pair, ends] : faces) {
      const Vec3 &x = mesh_.point(ends[0]), &y = mesh_.point(ends[1]);
      if (!target_.allows(pair, 0.5 * (p + x), astray_) || !target_.allows(pair, 0.5 * (p + y), astray_) ||
          !target_.allows(pair, (1.0 / 3) * (p + x + y), astray_))
        return false;
    }
    return true;
  }

  bool try_move(const Vec3& p, double before) {
    const auto place = placed(p);
    if (!place) return false;
    if (!(quality_at(mesh_, v_, *place, before) > before * (1 + 1e-3) + 1e-6) || !allowed(*place))
      return false;
    mesh_.move(v_, *place);
    return true;
  }

  bool climb() {
    const auto star = mesh_.star(v_);
    const double before = least_quality(mesh_, star);
    // The worst cells' gradients, and their mean direction.
    std::vector<std::uint32_t> worst(star.begin(), star.end());
    std::sort(worst.begin(), worst.end(), [&](std::uint32_t x, std::uint32_t y) {
      return mesh_.quality(x) != mesh_.quality(y) ? mesh_.quality(x) < mesh_.quality(y) : x < y;
    });
    std::vector<Vec3> directions{normalized(gradient(worst[0]))};
    if (worst.size() > 1) {
      const Vec3 second = normalized(gradient(worst[1]));
      directions.push_back(normalized(directions[0] + second));
    }
    const Vec3 p = mesh_.point(v_);
    // The vertex moves along its interface first, and away from it only where that does not help.
    for (stays_ = true;; stays_ = false) {
      for (const double step : {0.3, 0.1, 0.03}) {
        for (const Vec3& direction : directions) {
          if (try_move(p + step * size_ * direction, before)) return true;
        }
        if (step == 0.3 && try_move(middle(), before)) return true;
      }
      if (bodies_ < 2 || astray_ || !stays_) return false;
    }
  }

  /// The mean of the vertices round this one.
  Vec3 middle() const {
    Vec3 sum;
    double count = 0;
    for (const std::uint32_t c : mesh_.star(v_)) {
      for (const std::uint32_t w : mesh_.cell(c).vertices) {
        if (w != v_) sum += mesh_.point(w), ++count;
      }
    }
    return (1 / count) * sum;
  }

  LabelledMesh& mesh_;
  const InterfaceTarget& target_;
  std::uint32_t v_;
  LabelledMesh::Sides sides_;
  std::size_t bodies_;
  double size_ = 0;
  bool stays_ = true;    ///< moves end where the bodies meet, not near it
  bool astray_ = false;  ///< the vertex is not where it should be
};

}  // namespace

double quality_at(const LabelledMesh& mesh, std::uint32_t v, const Vec3& p, double bound) {
  double least = std::numeric_limits<double>::infinity();
  for (const std::uint32_t c : mesh.star(v)) {
    least = std::min(least, quality_if_moved(mesh, c, v, p));
    if (least <= bound) break;
  }
  return least;
}

double longest_edge(const LabelledMesh& mesh, std::uint32_t v) {
  double longest = 0;
  for (const std::uint32_t c : mesh.star(v)) {
    for (const std::uint32_t w : mesh.cell(c).vertices)
      longest = std::max(longest, squared_norm(mesh.point(w) - mesh.point(v)));
  }
  return std::sqrt(longest);
}

bool smooth_vertex(LabelledMesh& mesh, const InterfaceTarget& target, std::uint32_t v) {
  return Smoothing(mesh, target, v).run();
}

}  // namespace adamas::interfaces
