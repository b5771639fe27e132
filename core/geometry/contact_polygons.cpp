#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

#include "core/geometry/partition.h"

namespace adamas {

namespace {

constexpr std::uint32_t kFaceTag = 0x80000000u;

/// A corner of the polygon under construction and the line of the edge that leaves it: `line` is a function
/// that equals the two that make the polygon, or kFaceTag + the face opposite to a vertex.
struct Corner {
  ContactPolygon::Corner data;
  std::uint32_t line;
};
using Polygon = std::vector<Corner>;

class ContactFinder {
 public:
  ContactFinder(const OwnershipProblem& problem, std::vector<ContactPolygon>& out)
      : problem_(problem), out_(out) {}

  void run() {
    const auto& cs = problem_.candidates;
    for (std::size_t a = 0; a < cs.size(); ++a) {
      for (std::size_t b = a + 1; b < cs.size(); ++b) {
        for (std::uint32_t f = cs[a].first; f < cs[a].first + cs[a].count; ++f) {
          for (std::uint32_t g = cs[b].first; g < cs[b].first + cs[b].count; ++g) contact(a, b, f, g);
        }
      }
    }
  }

 private:
  [[nodiscard]] const LinearFunction& function(std::uint32_t f) const { return problem_.functions[f]; }
  [[nodiscard]] double difference(std::uint32_t f, std::uint32_t g, const Weights& w) const {
    double sum = 0;
    for (std::size_t i = 0; i < 4; ++i) sum += (function(f).values[i] - function(g).values[i]) * w[i];
    return sum;
  }
  /// Whether f counts as greater than g where they differ by d; exact ties go to the smaller key.
  [[nodiscard]] bool greater(std::uint32_t f, std::uint32_t g, double d) const {
    return d > 0 ||
           (d == 0 && (function(f).key < function(g).key || (function(f).key == function(g).key && f < g)));
  }

  void contact(std::size_t a, std::size_t b, std::uint32_t f, std::uint32_t g) {
    f_ = f, g_ = g;
    Polygon polygon = section();
    if (polygon.size() < 3) return;
    const auto& cs = problem_.candidates;
    for (const std::size_t own : {a, b}) {
      const std::uint32_t least = own == a ? f : g;
      for (std::uint32_t h = cs[own].first; h < cs[own].first + cs[own].count; ++h) {
        if (h == least) continue;
        polygon = clip(polygon, h, true);
        if (polygon.size() < 3) return;
      }
    }
    leave_to_others(std::move(polygon), a, b, 0);
  }

  /// Removes what candidates c, c + 1, ... own; what is left goes to the output.
  void leave_to_others(Polygon polygon, std::size_t a, std::size_t b, std::size_t c) {
    const auto& cs = problem_.candidates;
    for (; c < cs.size(); ++c) {
      if (c == a || c == b) continue;
      Polygon rest = polygon;
      for (std::uint32_t h = cs[c].first; h < cs[c].first + cs[c].count; ++h) {
        Polygon lower = clip(rest, h, false);
        if (lower.size() == rest.size() && lower.size() >= 3 && same(lower, rest)) {
          rest = std::move(lower);
          break;  // h stays below all over what is left
        }
        if (lower.size() >= 3) leave_to_others(std::move(lower), a, b, c + 1);
        rest = clip(rest, h, true);
        if (rest.size() < 3) return;
        if (h + 1 == cs[c].first + cs[c].count) return;  // c owns the rest
      }
      polygon = std::move(rest);
    }
    emit(polygon, a, b);
  }

  static bool same(const Polygon& x, const Polygon& y) {
    return std::equal(x.begin(), x.end(), y.begin(),
                      [](const Corner& p, const Corner& q) { return p.data.weights == q.data.weights; });
  }

  void emit(const Polygon& polygon, std::size_t a, std::size_t b) {
    ContactPolygon& contact = out_.emplace_back();
    contact.front = problem_.candidates[a].owner;
    contact.back = problem_.candidates[b].owner;
    for (const Corner& corner : polygon) contact.corners.push_back(corner.data);
  }

  [[nodiscard]] ContactPolygon::Corner corner(const Weights& weights, std::uint8_t zero,
                                              std::span<const std::uint32_t> equal) const {
    ContactPolygon::Corner result;
    result.weights = weights;
    result.zero_weights = zero;
    result.functions.fill(~std::uint64_t{0});
    for (std::size_t i = 0; i < equal.size() && i < 4; ++i) result.functions[i] = function(equal[i]).key;
    std::sort(result.functions.begin(), result.functions.end());
    return result;
  }

  /// Where f = g inside the tetrahedron, counter-clockwise seen from the side of f.
  Polygon section() const {
    const bool swapped = function(g_).key < function(f_).key;
    const auto& first = function(swapped ? g_ : f_).values;
    const auto& second = function(swapped ? f_ : g_).values;
    std::array<double, 4> d;
    std::array<std::size_t, 4> p{}, n{};
    std::size_t np = 0, nn = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      d[i] = first[i] - second[i];
      (greater(f_, g_, swapped ? -d[i] : d[i]) ? p[np++] : n[nn++]) = i;
    }
    if (np == 0 || nn == 0) return {};
    const std::array<std::uint32_t, 2> equal{f_, g_};
    const auto on_edge = [&](std::size_t i, std::size_t j, std::size_t next_face) {
      if (i > j) std::swap(i, j);
      Weights w{};
      const double t = d[i] / (d[i] - d[j]);
      w[i] = 1 - t;
      w[j] = t;
      const auto zero = static_cast<std::uint8_t>(0xfu & ~(1u << i) & ~(1u << j));
      return Corner{corner(w, zero, equal), kFaceTag + static_cast<std::uint32_t>(next_face)};
    };
    Polygon polygon;
    if (np == 2) {
      polygon = {on_edge(p[0], n[0], p[1]), on_edge(p[0], n[1], n[0]), on_edge(p[1], n[1], p[0]),
                 on_edge(p[1], n[0], n[1])};
    } else {
      const bool lone_p = np == 1;
      const std::size_t a = lone_p ? p[0] : n[0];
      const auto& o = lone_p ? n : p;
      polygon = {on_edge(a, o[0], o[2]), on_edge(a, o[1], o[0]), on_edge(a, o[2], o[1])};
    }
    if (!seen_counter_clockwise(polygon, p[0])) reverse(polygon);
    return polygon;
  }

  /// Orientation seen from corner `apex` of a positively oriented tetrahedron.
  static bool seen_counter_clockwise(const Polygon& polygon, std::size_t apex) {
    // Combinatorial, so that it does not depend on the cut's position: corners moved to their edges'
    // midpoints.
    const auto vertex = [&](std::size_t c) {
      std::array<double, 3> x{};
      for (std::size_t i = 0; i < 4; ++i) {
        const double w = (polygon[c].data.zero_weights >> i & 1u) != 0u ? 0 : 0.5;
        if (i > 0) x[i - 1] += w;
      }
      return x;
    };
    std::array<double, 3> top{};
    if (apex > 0) top[apex - 1] = 1;
    const auto a = vertex(0), b = vertex(1), c = vertex(2);
    const auto minus = [](const auto& u, const auto& v) {
      return std::array{u[0] - v[0], u[1] - v[1], u[2] - v[2]};
    };
    const auto u = minus(b, a), v = minus(c, a), w = minus(top, a);
    return u[0] * (v[1] * w[2] - v[2] * w[1]) - u[1] * (v[0] * w[2] - v[2] * w[0]) +
               u[2] * (v[0] * w[1] - v[1] * w[0]) >
           0;
  }

  static void reverse(Polygon& polygon) {
    std::reverse(polygon.begin(), polygon.end());
    // After the reversal each corner holds the line of the edge that arrives at it.
    const std::uint32_t first = polygon.front().line;
    for (std::size_t c = 0; c + 1 < polygon.size(); ++c) polygon[c].line = polygon[c + 1].line;
    polygon.back().line = first;
  }

  /// The part of the polygon where h > f (above) or where it is not.
  Polygon clip(const Polygon& polygon, std::uint32_t h, bool above) const {
    Polygon kept;
    // On the polygon f is g, so that a function equal to g is no farther from f than the two keys tell.
    if (function(h).values == function(g_).values) return greater(h, g_, 0) == above ? polygon : kept;
    const std::size_t size = polygon.size();
    std::vector<double> d(size);
    std::vector<bool> inside(size);
    std::size_t count = 0;
    for (std::size_t c = 0; c < size; ++c) {
      d[c] = difference(h, f_, polygon[c].data.weights);
      inside[c] = greater(h, f_, d[c]) == above;
      count += inside[c] ? 1 : 0;
    }
    if (count == size) return polygon;
    if (count == 0) return kept;
    for (std::size_t c = 0; c < size; ++c) {
      const std::size_t next = (c + 1) % size;
      if (inside[c]) kept.push_back(polygon[c]);
      if (inside[c] == inside[next]) continue;
      Corner cut = crossing(polygon[c], polygon[next], d[c], d[next], h);
      if (inside[c]) cut.line = h;  // leaves along the cut
      kept.push_back(cut);
    }
    return kept;
  }

  [[nodiscard]] Corner crossing(const Corner& from, const Corner& to, double d_from, double d_to,
                                std::uint32_t h) const {
    const std::uint32_t line = from.line;
    const double t = d_from / (d_from - d_to);
    Weights w;
    for (std::size_t i = 0; i < 4; ++i) w[i] = (1 - t) * from.data.weights[i] + t * to.data.weights[i];
    if ((line & kFaceTag) == 0) {
      const std::array<std::uint32_t, 4> equal{f_, g_, line, h};
      return {corner(w, 0, equal), line};
    }
    const std::uint32_t face = line & ~kFaceTag;
    w[face] = 0;
    const std::array<std::uint32_t, 3> equal{f_, g_, h};
    if (const auto exact = on_face(equal, face)) w = *exact;
    return {corner(w, static_cast<std::uint8_t>(1u << face), equal), line};
  }

  /// Where three functions are equal on a face, worked out the same way from either cell. None if that is no
  /// point of the face to the accuracy of the arithmetic.
  [[nodiscard]] std::optional<Weights> on_face(std::array<std::uint32_t, 3> equal, std::uint32_t face) const {
    std::sort(equal.begin(), equal.end(), [&](auto x, auto y) { return function(x).key < function(y).key; });
    std::array<std::size_t, 3> v{};
    for (std::size_t i = 0, n = 0; i < 4; ++i) {
      if (i != face) v[n++] = i;
    }
    std::array<double, 3> p, q;
    for (std::size_t i = 0; i < 3; ++i) {
      p[i] = function(equal[0]).values[v[i]] - function(equal[1]).values[v[i]];
      q[i] = function(equal[0]).values[v[i]] - function(equal[2]).values[v[i]];
    }
    const std::array<double, 3> x{p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2],
                                  p[0] * q[1] - p[1] * q[0]};
    const double sum = x[0] + x[1] + x[2];
    const double size = std::abs(x[0]) + std::abs(x[1]) + std::abs(x[2]);
    if (!(std::abs(sum) >= 0.999999 * size) || size == 0) return std::nullopt;
    Weights w{};
    for (std::size_t i = 0; i < 3; ++i) w[v[i]] = std::max(0.0, x[i] / sum);
    return w;
  }

  const OwnershipProblem& problem_;
  std::vector<ContactPolygon>& out_;
  std::uint32_t f_ = 0, g_ = 0;
};

}  // namespace

void contact_polygons(const OwnershipProblem& problem, std::vector<ContactPolygon>& contacts) {
  ContactFinder(problem, contacts).run();
}

}  // namespace adamas
