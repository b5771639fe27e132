#include "viewer/contents/plane_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "core/geometry/plane.h"
#include "viewer/contents/mesh_maker.h"

namespace adamas::viewer {

using namespace isosurface;

namespace {

/// A place in the plane, along its two axes.
using Place = std::array<double, 2>;

/// Positive on the left of the line from a to b, and negative on its right.
double side(const Place& a, const Place& b, const Place& p) {
  return (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);
}

/// The part of a convex polygon on the left of the line from a to b.
std::vector<Place> left_of(const std::vector<Place>& polygon, const Place& a, const Place& b) {
  std::vector<Place> result;
  for (std::size_t n = 0; n < polygon.size(); ++n) {
    const Place &p = polygon[n], &q = polygon[(n + 1) % polygon.size()];
    const double at_p = side(a, b, p), at_q = side(a, b, q);
    if (at_p >= 0) result.push_back(p);
    if ((at_p >= 0) == (at_q >= 0)) continue;
    const double t = at_p / (at_p - at_q);
    result.push_back({p[0] + t * (q[0] - p[0]), p[1] + t * (q[1] - p[1])});
  }
  return result;
}

class PlaneMaker {
 public:
  PlaneMaker(const std::vector<Vec3>& polygon, const Vec3& normal, double step,
             const std::function<double(const Vec3&)>& value)
      : normal_(normalized(normal)),
        frame_(plane_frame({polygon[0], normal})),
        step_(step),
        value_(value),
        maker_(polygon[0], MeshMaker::Kind::kTriangles) {
    const auto [x, y] = frame_.coordinates(polygon[0]);
    base_ = polygon[0] - x * frame_.right - y * frame_.up;
    for (const Vec3& corner : polygon) {
      const auto [along, across] = frame_.coordinates(corner);
      border_.push_back({along / step, across / step});
    }
    double area = 0;
    for (std::size_t n = 0; n < border_.size(); ++n) {
      const Place &p = border_[n], &q = border_[(n + 1) % border_.size()];
      area += p[0] * q[1] - p[1] * q[0];
    }
    if (area < 0) border_ = {border_.rbegin(), border_.rend()};
  }

  SharedMesh make() {
    Place low = border_[0], high = border_[0];
    for (const Place& p : border_) {
      for (std::size_t axis = 0; axis < 2; ++axis) {
        low[axis] = std::min(low[axis], p[axis]);
        high[axis] = std::max(high[axis], p[axis]);
      }
    }
    first_column_ = static_cast<std::int64_t>(std::floor(low[0]));
    const auto columns =
        static_cast<std::size_t>(static_cast<std::int64_t>(std::ceil(high[0])) - first_column_);
    numbers_[0].assign(columns + 1, kNone);
    for (auto row = static_cast<std::int64_t>(std::floor(low[1])); static_cast<double>(row) < high[1];
         ++row) {
      numbers_[1].assign(columns + 1, kNone);
      for (std::size_t n = 0; n < columns; ++n) add_square(n, row);
      numbers_[0].swap(numbers_[1]);
    }
    return maker_.finish();
  }

 private:
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

  std::uint32_t add_vertex(const Place& p) {
    const Vec3 place = base_ + (step_ * p[0]) * frame_.right + (step_ * p[1]) * frame_.up;
    const double value = value_(place);
    return maker_.add_vertex(place, normal_, {value, value});
  }

  void add_triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    for (const std::uint32_t n : {a, b, c}) maker_.add_index(n);
  }

  void add_square(std::size_t n, std::int64_t row) {
    const double x = static_cast<double>(first_column_ + static_cast<std::int64_t>(n)),
                 y = static_cast<double>(row);
    const std::array<Place, 4> corners{{{x, y}, {x + 1, y}, {x + 1, y + 1}, {x, y + 1}}};
    std::vector<Place> part(corners.begin(), corners.end());
    for (std::size_t k = 0; k < border_.size() && !part.empty(); ++k) {
      const Place &a = border_[k], &b = border_[(k + 1) % border_.size()];
      if (is_left_of(corners, a, b)) continue;
      part = left_of(part, a, b);
    }
    if (part.size() < 3) return;
    if (part.size() == 4 && std::equal(part.begin(), part.end(), corners.begin())) {
      // Neighbours share the vertices of whole squares.
      const std::array<std::uint32_t, 4> at{shared(0, n, corners[0]), shared(0, n + 1, corners[1]),
                                            shared(1, n + 1, corners[2]), shared(1, n, corners[3])};
      add_triangle(at[0], at[1], at[2]);
      add_triangle(at[0], at[2], at[3]);
      return;
    }
    std::vector<std::uint32_t> at;
    for (const Place& p : part) at.push_back(add_vertex(p));
    for (std::size_t k = 2; k < at.size(); ++k) add_triangle(at[0], at[k - 1], at[k]);
  }

  static bool is_left_of(const std::array<Place, 4>& corners, const Place& a, const Place& b) {
    return std::all_of(corners.begin(), corners.end(), [&](const Place& p) { return side(a, b, p) >= 0; });
  }

  /// The vertex of a corner of the present row's lower or upper side.
  std::uint32_t shared(std::size_t side, std::size_t n, const Place& p) {
    std::uint32_t& number = numbers_[side][n];
    if (number == kNone) number = add_vertex(p);
    return number;
  }

  Vec3 normal_;
  PlaneFrame frame_;
  Vec3 base_;  ///< the point where both coordinates are 0
  double step_;
  const std::function<double(const Vec3&)>& value_;
  MeshMaker maker_;
  std::vector<Place> border_;  ///< counterclockwise, in steps
  std::int64_t first_column_ = 0;
  std::array<std::vector<std::uint32_t>, 2> numbers_;
};

}  // namespace

SharedMesh plane_mesh(const std::vector<Vec3>& polygon, const Vec3& normal, double step,
                      const std::function<double(const Vec3&)>& value) {
  if (polygon.size() < 3) return nullptr;
  return PlaneMaker(polygon, normal, step, value).make();
}

}  // namespace adamas::viewer
