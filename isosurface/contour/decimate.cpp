#include "isosurface/contour/decimate.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <tuple>
#include <utility>
#include <vector>

#include "isosurface/contour/triangle_stars.h"

namespace adamas::isosurface {

namespace {

using Triangle = TriangleStars::Triangle;
constexpr std::uint32_t kNone = TriangleStars::kNone;

/// A weighted sum of squared distances from planes, as the factors of the products of the coordinates: points
/// are given relative to a place near them, so that little is lost by rounding.
struct Quadric {
  double xx = 0, yy = 0, zz = 0, xy = 0, yz = 0, zx = 0, x = 0, y = 0, z = 0, one = 0, weight = 0;

  /// Returns the quadric of the plane through a point with a normal of length 1.
  static Quadric plane(const Vec3& normal, const Vec3& through, double weight) {
    const double d = -dot(normal, through);
    const Vec3 n = weight * normal;
    return {n.x * normal.x, n.y * normal.y, n.z * normal.z, n.x * normal.y, n.y * normal.z, n.z * normal.x,
            n.x * d,        n.y * d,        n.z * d,        weight * d * d, weight};
  }
  Quadric& operator+=(const Quadric& q) {
    xx += q.xx, yy += q.yy, zz += q.zz, xy += q.xy, yz += q.yz, zx += q.zx;
    x += q.x, y += q.y, z += q.z, one += q.one, weight += q.weight;
    return *this;
  }
  [[nodiscard]] double operator()(const Vec3& p) const {
    const double square = p.x * (xx * p.x + 2 * (xy * p.y + x)) + p.y * (yy * p.y + 2 * (yz * p.z + y)) +
                          p.z * (zz * p.z + 2 * (zx * p.x + z)) + one;
    return std::max(square, 0.0);
  }
};

class Decimator {
 public:
  explicit Decimator(Contour& contour)
      : points_(contour.points),
        triangles_(contour.triangles),
        count_(contour.triangles.size()),
        origin_(points_.front()),
        stars_(triangles_, points_.size()) {}

  Decimation run(std::size_t wanted) {
    find_border();
    find_quadrics();
    // Once no point can be removed, triangles may turn farther.
    for (const double least_cosine : {0.5, 0.0}) {
      if (count_ <= wanted) break;
      least_cosine_ = least_cosine;
      remove_points(wanted);
    }
    std::erase_if(triangles_, [](const Triangle& t) { return t[0] == kNone; });
    return {std::sqrt(greatest_), bodies_};
  }

 private:
  void remove_points(std::size_t wanted) {
    bounds_.assign(points_.size(), kNoBucket);
    for (std::uint32_t p = 0; p < points_.size(); ++p) line_up(p, best_step(p).error);
    while (count_ > wanted && first_ < kBuckets) {
      auto& bucket = queue_[first_];
      if (bucket.empty()) {
        ++first_;
        continue;
      }
      const std::uint32_t next = bucket.back();
      bucket.pop_back();
      if (bounds_[next] == first_) remove_point(next);
    }
  }

  /// The collapse of an edge into one of its ends.
  struct Step {
    float error = std::numeric_limits<float>::infinity();
    std::uint32_t to = kNone;
    bool operator<(const Step& o) const { return std::tie(error, to) < std::tie(o.error, o.to); }
  };
  [[nodiscard]] Vec3 place(std::uint32_t p) const { return points_[p] - origin_; }
  [[nodiscard]] bool on_border(std::uint32_t p) const { return has_border_ && border_[p][0] != kNone; }

  /// Finds the neighbours of each point on the border, where the border passes the point only once.
  void find_border() {
    const std::vector<bool> at_border = border_points(triangles_, points_.size());
    has_border_ = std::find(at_border.begin(), at_border.end(), true) != at_border.end();
    if (!has_border_) return;
    border_.assign(points_.size(), {kNone, kNone});
    is_locked_.assign(points_.size(), false);
    std::vector<std::uint32_t> after, before;
    for (std::uint32_t p = 0; p < points_.size(); ++p) {
      if (!at_border[p]) continue;
      after.clear();
      before.clear();
      stars_.for_each(p, [&](std::uint32_t a, std::uint32_t b) {
        after.push_back(a);
        before.push_back(b);
      });
      const auto is_in = [](const auto& all, std::uint32_t q) {
        return std::find(all.begin(), all.end(), q) != all.end();
      };
      std::size_t edges = 0;
      for (std::size_t n = 0; n < after.size(); ++n) {
        if (!is_in(before, after[n])) border_[p][1] = after[n], ++edges;
        if (!is_in(after, before[n])) border_[p][0] = before[n], ++edges;
      }
      is_locked_[p] = edges != 2;
    }
  }

  void find_quadrics() {
    quadrics_.resize(points_.size());
    for (const Triangle& t : triangles_) {
      const Vec3 a = place(t[0]), b = place(t[1]), c = place(t[2]);
      const Vec3 normal = cross(b - a, c - a);
      const double twice_area = norm(normal);
      if (twice_area == 0) continue;
      const Vec3 unit = 1 / twice_area * normal;
      const Quadric own = Quadric::plane(unit, a, twice_area / 6);
      for (const std::uint32_t p : t) quadrics_[p] += own;
      if (has_border_) add_border(t, unit);
    }
  }
  /// Adds the planes through a triangle's border edges, across the surface.
  void add_border(const Triangle& t, const Vec3& normal) {
    for (std::size_t n = 0; n < 3; ++n) {
      const std::uint32_t p = t[n], q = t[(n + 1) % 3];
      if (border_[p][1] != q) continue;
      const Vec3 across = cross(place(q) - place(p), normal);
      const double length = norm(across);
      if (length == 0) continue;
      const Quadric side = Quadric::plane(1 / length * across, place(p), length * length);
      quadrics_[p] += side;
      quadrics_[q] += side;
    }
  }

  /// Returns whether the border allows a point to be moved to its neighbour.
  [[nodiscard]] bool border_allows(std::uint32_t from, std::uint32_t to) const {
    if (!on_border(from)) return true;
    const auto [behind, ahead] = border_[from];
    if (is_locked_[from] || (to != behind && to != ahead)) return false;
    // The border stays in the same side of a box before the point and behind it.
    const Vec3 &p = points_[behind], &q = points_[from], &r = points_[ahead];
    return (p.x == q.x && q.x == r.x) || (p.y == q.y && q.y == r.y) || (p.z == q.z && q.z == r.z);
  }

  [[nodiscard]] Step step(std::uint32_t from, std::uint32_t to) const {
    if (!border_allows(from, to)) return {};
    const Quadric &a = quadrics_[from], &b = quadrics_[to];
    const Vec3 at = place(to);
    const double weight = a.weight + b.weight;
    if (!(weight > 0)) return {};
    return {static_cast<float>(a(at) + b(at)), to};
  }
  Step best_step(std::uint32_t p) {
    Step best;
    stars_.for_each(p, [&](std::uint32_t after, std::uint32_t before) {
      best = std::min(best, step(p, after));
      if (has_border_) best = std::min(best, step(p, before));
    });
    return best;
  }

  /// Returns the bucket of an error. There are eight for each factor of two, so that the greatest error of a
  /// bucket is at most 9/8 of the least.
  static std::uint16_t bucket(float error) {
    constexpr int kShift = 20;
    return static_cast<std::uint16_t>(std::bit_cast<std::uint32_t>(error) >> kShift);
  }
  void line_up(std::uint32_t p, float error) {
    const std::uint16_t place = bucket(error);
    if (place >= bounds_[p]) return;
    bounds_[p] = place;
    queue_[place].push_back(p);
    first_ = std::min<std::size_t>(first_, place);
  }

  /// Removes the point by the best possible collapse, if its error is in the bucket in which the point waits,
  /// or puts it into a later one.
  void remove_point(std::uint32_t from) {
    steps_.clear();
    stars_.for_each(from, [&](std::uint32_t after, std::uint32_t before) {
      steps_.push_back(step(from, after));
      if (on_border(from)) steps_.push_back(step(from, before));
    });
    std::sort(steps_.begin(), steps_.end());
    const std::uint16_t expected = std::exchange(bounds_[from], kNoBucket);
    for (const Step& s : steps_) {
      if (s.to == kNone) break;
      if (!is_possible(from, s.to)) continue;
      if (bucket(s.error) > expected) {
        line_up(from, s.error);
      } else {
        collapse(from, s);
      }
      return;
    }
    remove_body(from, expected);
  }

  /// Removes the body of a point, if it is small and its size is next in the order, or puts the point into a
  /// later bucket.
  void remove_body(std::uint32_t p, std::uint16_t expected) {
    constexpr std::size_t kMostPoints = 12;
    own_.assign(1, p);
    for (std::size_t n = 0; n < own_.size(); ++n) {
      if (own_.size() > kMostPoints) return;
      stars_.for_each(own_[n], [this](std::uint32_t after, std::uint32_t before) {
        for (const std::uint32_t q : {after, before}) {
          if (std::find(own_.begin(), own_.end(), q) == own_.end()) own_.push_back(q);
        }
      });
    }
    const double share = 1 / static_cast<double>(own_.size());
    Vec3 middle;
    for (const std::uint32_t q : own_) middle += share * place(q);
    double mean = 0, weight = 0;
    for (const std::uint32_t q : own_) {
      mean += share * squared_norm(place(q) - middle);
      weight += quadrics_[q].weight;
    }
    const auto error = static_cast<float>(weight * mean);
    if (bucket(error) > expected) {
      line_up(p, error);
      return;
    }
    std::size_t lost = 0;
    for (const std::uint32_t q : own_) lost += stars_.remove(q);
    if (lost == 0) return;  // it has been removed before
    count_ -= lost;
    ++bodies_;
    greatest_ = std::max(greatest_, mean);
  }

  void collapse(std::uint32_t from, const Step& s) {
    quadrics_[s.to] += quadrics_[from];
    greatest_ = std::max(greatest_, s.error / quadrics_[s.to].weight);
    neighbours_.clear();
    stars_.for_each(from, [&](std::uint32_t after, std::uint32_t before) {
      neighbours_.push_back(after);
      if (on_border(from)) neighbours_.push_back(before);
    });
    count_ -= stars_.collapse(from, s.to);
    if (on_border(from)) {
      const auto [behind, ahead] = border_[from];
      border_[behind][1] = s.to == behind ? ahead : s.to;
      border_[ahead][0] = s.to == ahead ? behind : s.to;
    }
    // Points wait in the bucket of an error that is not greater than theirs now: those of collapses into `to`
    // have grown. Only collapses that were not possible before can have less.
    for (const std::uint32_t p : neighbours_) {
      if (p != s.to) line_up(p, step(p, s.to).error);
    }
    line_up(s.to, best_step(s.to).error);
  }

  /// Returns whether the surface stays a surface, by the link condition, and no triangle turns over.
  bool is_possible(std::uint32_t from, std::uint32_t to) {
    std::size_t shared = 0;
    bool possible = true;
    std::array<std::uint32_t, 2> opposite{kNone, kNone};
    own_.clear();
    stars_.for_each(from, [&](std::uint32_t after, std::uint32_t before) {
      own_.push_back(after);
      own_.push_back(before);
      if (after == to || before == to) {
        if (shared < 2) opposite[shared] = after == to ? before : after;
        ++shared;
      } else {
        possible = possible && !turns_over(from, to, after, before);
      }
    });
    if (!possible || shared == 0 || shared > 2 || opposite[0] == opposite[1]) return false;
    if (shared == 1 && (!on_border(from) || !on_border(to))) return false;
    // If two points belong to a single triangle, it is all that is left of a body.
    std::size_t triangles = own_.size() / 2;
    // The only common neighbours may be the opposite points, and these are in no triangle together with `to`.
    stars_.for_each(to, [&](std::uint32_t after, std::uint32_t before) {
      ++triangles;
      const bool after_is_opposite = after == opposite[0] || after == opposite[1];
      const bool before_is_opposite = before == opposite[0] || before == opposite[1];
      if (after_is_opposite && before_is_opposite) possible = false;
      const auto is_common = [&](std::uint32_t q) {
        return q != from && std::find(own_.begin(), own_.end(), q) != own_.end();
      };
      if ((!after_is_opposite && is_common(after)) || (!before_is_opposite && is_common(before)))
        possible = false;
    });
    return possible && triangles > 2;
  }

  [[nodiscard]] bool turns_over(std::uint32_t from, std::uint32_t to, std::uint32_t after,
                                std::uint32_t before) const {
    const Vec3 &a = points_[after], &b = points_[before], &p = points_[from], &q = points_[to];
    const Vec3 old_normal = cross(a - p, b - p), normal = cross(a - q, b - q);
    const double cosine = dot(old_normal, normal);
    const double least = least_cosine_ * least_cosine_ * squared_norm(old_normal) * squared_norm(normal);
    return !(cosine > 0) || cosine * cosine <= least;
  }

  const std::vector<Vec3>& points_;
  std::vector<Triangle>& triangles_;
  std::size_t count_;  ///< number of remaining triangles
  Vec3 origin_;
  TriangleStars stars_;
  std::vector<Quadric> quadrics_;
  bool has_border_ = false;
  std::vector<std::array<std::uint32_t, 2>> border_;
  std::vector<bool> is_locked_;  ///< points of the border that stay
  static constexpr std::size_t kBuckets = 1 << 12;
  static constexpr std::uint16_t kNoBucket = 0xffff;
  /// Points, indexed by the bucket of an error that is not greater than theirs.
  std::array<std::vector<std::uint32_t>, kBuckets> queue_;
  std::size_t first_ = 0;              ///< buckets before it are empty
  std::vector<std::uint16_t> bounds_;  ///< the bucket in which each point waits
  std::vector<Step> steps_;
  std::vector<std::uint32_t> neighbours_, own_;
  double least_cosine_ = 0;  ///< cosine of the greatest angle by which a triangle may turn
  double greatest_ = 0;      ///< the greatest mean square distance that a change has made
  std::size_t bodies_ = 0;   ///< number of bodies that were removed
};

}  // namespace

Decimation decimate_contour(Contour& contour, std::size_t triangles) {
  if (contour.triangles.size() <= triangles) return {};
  const Decimation result = Decimator(contour).run(triangles);
  remove_unused_points(contour);
  return result;
}

}  // namespace adamas::isosurface
