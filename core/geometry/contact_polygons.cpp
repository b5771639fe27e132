#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "core/geometry/determinant_sign.h"
#include "core/geometry/ownership_problem.h"
#include "core/geometry/part_round_off.h"
#include "core/geometry/touching_pairs.h"

namespace adamas::inline core {

namespace {

/// A corner of the polygon in which a plane cuts a tetrahedron: the edge of vertices i < j, and the vertex
/// opposite to the face along which the polygon leaves the corner.
struct CutEdge {
  std::uint8_t i, j, face;
};

/// The edges that a plane cuts, counter-clockwise seen from the side of the vertices above it.
struct CutEdges {
  std::size_t count = 0;
  std::array<CutEdge, 4> edges{};
};

/// Whether the polygon is counter-clockwise seen from vertex `apex` of a positively oriented tetrahedron. The
/// corners are taken to be the midpoints of their edges, as the test is to be combinatorial.
bool seen_counter_clockwise(const CutEdges& polygon, std::size_t apex) {
  const auto corner = [&](std::size_t c) {
    std::array<double, 3> x{};
    for (const std::size_t v : {polygon.edges[c].i, polygon.edges[c].j}) {
      if (v > 0) x[v - 1] += 0.5;
    }
    return x;
  };
  std::array<double, 3> top{};
  if (apex > 0) top[apex - 1] = 1;
  const auto a = corner(0), b = corner(1), c = corner(2);
  const auto minus = [](const auto& u, const auto& v) {
    return std::array{u[0] - v[0], u[1] - v[1], u[2] - v[2]};
  };
  const auto u = minus(b, a), v = minus(c, a), w = minus(top, a);
  return u[0] * (v[1] * w[2] - v[2] * w[1]) - u[1] * (v[0] * w[2] - v[2] * w[0]) +
             u[2] * (v[0] * w[1] - v[1] * w[0]) >
         0;
}

void reverse(CutEdges& polygon) {
  std::reverse(polygon.edges.begin(), polygon.edges.begin() + static_cast<std::ptrdiff_t>(polygon.count));
  // After the reversal each corner has the face of the edge that arrives at it.
  const std::uint8_t first = polygon.edges[0].face;
  for (std::size_t c = 0; c + 1 < polygon.count; ++c) polygon.edges[c].face = polygon.edges[c + 1].face;
  polygon.edges[polygon.count - 1].face = first;
}

/// Finds the edges that a plane cuts. `above`: bit i is set if vertex i lies above it.
CutEdges cut_edges(unsigned above) {
  std::array<std::uint8_t, 4> p{}, n{};
  std::size_t np = 0, nn = 0;
  for (std::uint8_t v = 0; v < 4; ++v) ((above >> v & 1u) != 0 ? p[np++] : n[nn++]) = v;
  CutEdges polygon;
  if (np == 0 || nn == 0) return polygon;
  const auto add = [&](std::uint8_t i, std::uint8_t j, std::uint8_t face) {
    polygon.edges[polygon.count++] = {std::min(i, j), std::max(i, j), face};
  };
  if (np == 2) {
    add(p[0], n[0], p[1]), add(p[0], n[1], n[0]), add(p[1], n[1], p[0]), add(p[1], n[0], n[1]);
  } else {
    const std::uint8_t alone = np == 1 ? p[0] : n[0];
    const auto& others = np == 1 ? n : p;
    add(alone, others[0], others[2]), add(alone, others[1], others[0]), add(alone, others[2], others[1]);
  }
  if (!seen_counter_clockwise(polygon, p[0])) reverse(polygon);
  return polygon;
}

const std::array<CutEdges, 16>& all_cut_edges() {
  static const auto kAll = [] {
    std::array<CutEdges, 16> made;
    for (unsigned above = 0; above < 16; ++above) made[above] = cut_edges(above);
    return made;
  }();
  return kAll;
}

/// A value that is less by this part of the greatest one is surely less, however a corner is rounded.
constexpr double kSurely = 1e-4;
constexpr std::uint32_t kFaceTag = 0x80000000u;

/// A corner of the polygon under construction: where `equal` functions are equal, on the face of the vertices
/// that are not in `zeros`.
struct Corner {
  Weights weights;
  std::array<std::uint32_t, 4> equal;
  std::uint8_t count;  ///< number of functions in `equal`, and of vertices of the face
  std::uint8_t zeros;  ///< bit i: weight i is zero
  std::uint32_t line;  ///< the line of the edge that leaves this corner: another function that is equal
                       ///< there, or kFaceTag + the opposite vertex
};
using Polygon = std::vector<Corner>;

class ContactFinder {
 public:
  ContactFinder(const OwnershipProblem& problem, std::vector<ContactPolygon>& out)
      : problem_(problem),
        out_(out),
        margin_(kSurely * greatest_size(problem)),
        last_below_(problem.candidates.size(), 0),
        order_(problem.candidates.size()) {}

  /// Tries all pairs.
  void run() {
    const auto& cs = problem_.candidates;
    std::iota(order_.begin(), order_.end(), std::uint32_t{0});
    for (std::size_t a = 0; a < cs.size(); ++a) {
      for (std::size_t b = a + 1; b < cs.size(); ++b) {
        for (std::uint32_t f = cs[a].first; f < cs[a].first + cs[a].count; ++f) {
          for (std::uint32_t g = cs[b].first; g < cs[b].first + cs[b].count; ++g) {
            f_ = f, g_ = g;
            if (!is_surely_hidden(a, b)) contact(a, b, {});
          }
        }
      }
    }
  }

  /// Finds the polygons of these pairs. What is near them is cut off first, which leaves
  /// little to be compared with the rest.
  void run(const TouchingPairs& found) {
    std::vector<char> is_near(problem_.candidates.size());
    std::uint32_t part = ~std::uint32_t{0};
    for (const TouchingPairs::Pair& p : found.pairs) {
      const std::span<const NearFunction> near = found.near_part(p.part);
      if (std::exchange(part, p.part) != p.part) {
        std::ranges::fill(is_near, 0);
        for (const NearFunction& n : near) is_near[n.candidate] = 1;
        std::iota(order_.begin(), order_.end(), std::uint32_t{0});
        std::stable_partition(order_.begin(), order_.end(), [&](std::uint32_t c) { return is_near[c] != 0; });
      }
      f_ = p.pair.functions[0], g_ = p.pair.functions[1];
      contact(p.pair.candidates[0], p.pair.candidates[1], near);
    }
  }

 private:
  /// A polygon divided where h is equal to f.
  struct Divided {
    Polygon above, below;
  };

  [[nodiscard]] const LinearFunction& function(std::uint32_t f) const { return problem_.functions[f]; }
  /// Whether f has the greater infinitesimal.
  [[nodiscard]] bool comes_first(std::uint32_t f, std::uint32_t g) const {
    return function(f).key < function(g).key || (function(f).key == function(g).key && f < g);
  }
  /// Whether f is greater than g where they differ by d.
  [[nodiscard]] bool greater(std::uint32_t f, std::uint32_t g, double d) const {
    return d > 0 || (d == 0 && comes_first(f, g));
  }

  /// Finds the polygons where candidates a and b touch and f and g are their least functions. The functions
  /// `near` are tried first.
  void contact(std::size_t a, std::size_t b, std::span<const NearFunction> near) {
    Polygon polygon = section();
    if (polygon.size() < 3) return;
    const auto cut = [&](std::uint32_t h) {
      if (h != f_ && h != g_) polygon = divide(std::move(polygon), h).above;
      return !polygon.empty();
    };
    tried_.clear();
    for (const NearFunction& n : near) {
      if (n.candidate != a && n.candidate != b) continue;
      if (!cut(n.function)) return;
      tried_.push_back(n.function);
    }
    for (const std::size_t own : {a, b}) {
      const auto& candidate = problem_.candidates[own];
      for (std::uint32_t h = candidate.first; h < candidate.first + candidate.count; ++h) {
        if (std::ranges::find(tried_, h) == tried_.end() && !cut(h)) return;
      }
    }
    leave_to_others(polygon, a, b, 0);
  }

  /// Removes what the candidates from a place on in `order_` own; the rest goes to the output.
  void leave_to_others(const Polygon& polygon, std::size_t a, std::size_t b, std::size_t place) {
    for (; place < order_.size(); ++place) {
      const std::size_t c = order_[place];
      std::vector<Polygon> rest;
      if (c == a || c == b || !owns_part(c, polygon, rest)) continue;
      for (const Polygon& part : rest) leave_to_others(part, a, b, place + 1);
      return;
    }
    emit(polygon, a, b);
  }

  /// 1 if h is greater than f at all corners, -1 if it is less, and not only nearly; else 0. The corners'
  /// weights are found by `weights`.
  template <class Corners, class Projection = std::identity>
  [[nodiscard]] int sure_order(const Corners& corners, std::uint32_t h, Projection weights = {}) const {
    const int first = sure_sign(std::invoke(weights, corners[0]), h);
    const bool same =
        first != 0 && std::ranges::all_of(
                          corners, [&](const Weights& w) { return sure_sign(w, h) == first; }, weights);
    return same ? first : 0;
  }

  /// 1 if h is greater than f at a point, -1 if it is less, and not only nearly; else 0.
  [[nodiscard]] int sure_sign(const Weights& w, std::uint32_t h) const {
    const auto &hs = function(h).values, &fs = function(f_).values;
    const double d =
        (hs[0] - fs[0]) * w[0] + (hs[1] - fs[1]) * w[1] + (hs[2] - fs[2]) * w[2] + (hs[3] - fs[3]) * w[3];
    return d > margin_ ? 1 : d < -margin_ ? -1 : 0;
  }

  /// Whether f = g nowhere or where another function of the two candidates is surely less, or another
  /// candidate surely greater.
  [[nodiscard]] bool is_surely_hidden(std::size_t a, std::size_t b) const {
    std::array<Weights, 4> places;
    const std::span corners = std::span(places).first(edge_crossings(places));
    if (corners.empty()) return true;
    const auto& cs = problem_.candidates;
    for (std::size_t c = 0; c < cs.size(); ++c) {
      bool owns = true;
      for (std::uint32_t h = cs[c].first; h < cs[c].first + cs[c].count; ++h) {
        const int sure = sure_order(corners, h);
        if (sure < 0 && (c == a || c == b)) return true;
        owns = owns && sure > 0;
        if (!owns && c != a && c != b) break;
      }
      if (owns && c != a && c != b) return true;
    }
    return false;
  }

  /// Sets `corners` to the points of the edges where f = g, and returns their number.
  std::size_t edge_crossings(std::array<Weights, 4>& corners) const {
    const auto &fs = function(f_).values, &gs = function(g_).values;
    std::array<double, 4> d;
    unsigned above = 0;
    for (std::size_t v = 0; v < 4; ++v) {
      d[v] = fs[v] - gs[v];
      if (greater(f_, g_, d[v])) above |= 1u << v;
    }
    std::size_t count = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t j = i + 1; j < 4; ++j) {
        if ((above >> i & 1u) == (above >> j & 1u)) continue;
        const double t = d[i] == 0 ? 0 : d[i] / (d[i] - d[j]);
        Weights& w = corners[count++] = {};
        w[i] = 1 - t;
        w[j] = t;
      }
    }
    return count;
  }

  /// Whether a function of a candidate is surely less than f in a whole polygon. Polygons follow their
  /// neighbours, where it is often the same function.
  [[nodiscard]] bool is_surely_below(std::size_t c, const Polygon& polygon) {
    const auto& candidate = problem_.candidates[c];
    if (sure_order(polygon, candidate.first + last_below_[c], &Corner::weights) < 0) return true;
    for (std::uint32_t i = 0; i < candidate.count; ++i) {
      if (sure_order(polygon, candidate.first + i, &Corner::weights) >= 0) continue;
      last_below_[c] = i;
      return true;
    }
    return false;
  }

  /// Whether a candidate owns a part of a polygon; `rest` becomes the parts that it does not own.
  [[nodiscard]] bool owns_part(std::size_t c, const Polygon& whole, std::vector<Polygon>& rest) {
    if (is_surely_below(c, whole)) return false;
    Polygon polygon = whole;
    const auto& candidate = problem_.candidates[c];
    for (std::uint32_t h = candidate.first; h < candidate.first + candidate.count; ++h) {
      Divided divided = divide(std::move(polygon), h);
      if (divided.above.empty()) return false;
      polygon = std::move(divided.above);
      if (!divided.below.empty()) rest.push_back(std::move(divided.below));
    }
    return true;
  }

  void emit(const Polygon& polygon, std::size_t a, std::size_t b) {
    ContactPolygon& contact = out_.emplace_back();
    contact.front = problem_.candidates[a].owner;
    contact.back = problem_.candidates[b].owner;
    for (const Corner& corner : polygon) {
      ContactPolygon::Corner& result = contact.corners.emplace_back();
      result.weights = corner.weights;
      result.zero_weights = corner.zeros;
      set_keys(std::span(corner.equal).first(corner.count), result.functions);
      std::array<std::uint32_t, 3> line{f_, g_, corner.line};
      const bool on_face = (corner.line & kFaceTag) != 0;
      set_keys(std::span(line).first(on_face ? 2 : 3), result.line_functions);
      result.line_zero_weights = on_face ? static_cast<std::uint8_t>(1u << (corner.line & ~kFaceTag)) : 0;
    }
  }

  template <std::size_t Size>
  void set_keys(std::span<const std::uint32_t> functions, std::array<std::uint64_t, Size>& keys) const {
    keys.fill(~std::uint64_t{0});
    for (std::size_t i = 0; i < functions.size(); ++i) keys[i] = function(functions[i]).key;
    std::sort(keys.begin(), keys.end());
  }

  [[nodiscard]] Corner make_corner(const Weights& weights, std::uint8_t zeros,
                                   std::span<const std::uint32_t> equal, std::uint32_t line) const {
    Corner corner{weights, {}, static_cast<std::uint8_t>(equal.size()), zeros, line};
    std::copy(equal.begin(), equal.end(), corner.equal.begin());
    return corner;
  }

  /// The determinant's rows are the corner's functions and h, at the vertices of the corner's face, and a
  /// column of ones: its sign is that of h - f at the corner, times the sign of the determinant that the
  /// corner's weights are divided by.
  void fill_rows(const Corner& corner, std::uint32_t h, SmallMatrix& rows) const {
    for (std::size_t r = 0; r <= corner.count; ++r) {
      const auto& values = function(r < corner.count ? corner.equal[r] : h).values;
      std::size_t column = 0;
      for (std::size_t v = 0; v < 4; ++v) {
        if ((corner.zeros >> v & 1u) == 0) rows[r][column++] = values[v];
      }
      rows[r][column] = 1;
    }
  }

  /// The sign of the determinant with ones in the row of one function: how the determinant grows with that
  /// function.
  [[nodiscard]] int sign_with_ones(const Corner& corner, std::uint32_t h, std::size_t row) const {
    SmallMatrix rows{};
    fill_rows(corner, h, rows);
    rows[row].fill(1);
    rows[row][corner.count] = 0;
    return determinant_sign(rows, corner.count + std::size_t{1});
  }

  /// 1 if h is greater than e at all vertices with weights, and so between them, -1 if it is nowhere greater;
  /// else 0.
  [[nodiscard]] int order_on_face(std::uint32_t h, std::uint32_t e, unsigned zeros) const {
    const auto &hs = function(h).values, &es = function(e).values;
    unsigned above = 0;
    for (std::size_t v = 0; v < 4; ++v) {
      if (greater(h, e, hs[v] - es[v])) above |= 1u << v;
    }
    above &= ~zeros;
    return above == 0 ? -1 : above == (0xfu & ~zeros) ? 1 : 0;
  }

  /// 1 if h is greater than f where f = g, -1 if it is nowhere greater there, as far as the vertices tell;
  /// else 0.
  [[nodiscard]] int order_of_all(std::uint32_t h) const {
    const int order = order_on_face(h, f_, 0);
    return order != 0 ? order : order_on_face(h, g_, 0);
  }

  /// Whether h is greater than f at the corner.
  [[nodiscard]] bool above(const Corner& corner, std::uint32_t h) const {
    if (const int sure = sure_sign(corner.weights, h); sure != 0) return sure > 0;
    for (std::size_t i = 0; i < corner.count; ++i) {
      const int order = order_on_face(h, corner.equal[i], corner.zeros);
      if (order != 0) return order > 0;
    }
    SmallMatrix rows{};
    fill_rows(corner, h, rows);
    int sign = determinant_sign(rows, corner.count + std::size_t{1});
    if (sign == 0) {
      // The infinitesimals decide, the greatest first.
      const auto at = [&](std::size_t row) { return row < corner.count ? corner.equal[row] : h; };
      std::array<std::size_t, 5> order{};
      for (std::size_t row = 0; row <= corner.count; ++row) {
        std::size_t place = row;
        for (; place > 0 && comes_first(at(row), at(order[place - 1])); --place)
          order[place] = order[place - 1];
        order[place] = row;
      }
      for (std::size_t i = 0; i <= corner.count && sign == 0; ++i) sign = sign_with_ones(corner, h, order[i]);
    }
    return sign * sign_with_ones(corner, f_, corner.count) > 0;
  }

  /// The polygon where f = g inside the tetrahedron, counter-clockwise seen from the side of f.
  Polygon section() const {
    const TetrahedronSection found = section_between(function(f_), function(g_));
    const std::array<std::uint32_t, 2> equal{f_, g_};
    Polygon polygon;
    polygon.reserve(found.count);
    for (std::size_t c = 0; c < found.count; ++c) {
      const TetrahedronSection::Corner& corner = found.corners[c];
      polygon.push_back(
          make_corner(corner.weights(), corner.zero_weights(), equal, kFaceTag + std::uint32_t{corner.face}));
    }
    return polygon;
  }

  /// Divides a polygon into the parts where h is greater than f and where it is not; empty where there is
  /// none.
  [[nodiscard]] Divided divide(Polygon polygon, std::uint32_t h) const {
    const int sure = sure_order(polygon, h, &Corner::weights);
    const int order = sure != 0 ? sure : order_of_all(h);
    if (order > 0) return {std::move(polygon), {}};
    if (order < 0) return {{}, std::move(polygon)};
    const std::size_t size = polygon.size();
    std::vector<bool> positive(size);
    std::size_t count = 0;
    for (std::size_t c = 0; c < size; ++c) {
      positive[c] = above(polygon[c], h);
      count += positive[c] ? 1 : 0;
    }
    if (count == size) return {std::move(polygon), {}};
    if (count == 0) return {{}, std::move(polygon)};
    Divided divided;
    for (std::size_t c = 0; c < size; ++c) {
      const std::size_t next = (c + 1) % size;
      (positive[c] ? divided.above : divided.below).push_back(polygon[c]);
      if (positive[c] == positive[next]) continue;
      Corner cut = crossing(polygon[c].line, h);
      (positive[c] ? divided.below : divided.above).push_back(cut);
      cut.line = h;  // the part that is left continues along the cut
      (positive[c] ? divided.above : divided.below).push_back(cut);
    }
    return divided;
  }

  /// The corner where h meets the line of an edge.
  [[nodiscard]] Corner crossing(std::uint32_t line, std::uint32_t h) const {
    if ((line & kFaceTag) == 0) {
      const std::array<std::uint32_t, 4> equal{f_, g_, line, h};
      return make_corner(weights_where(equal, 0), 0, equal, line);
    }
    const std::array<std::uint32_t, 3> equal{f_, g_, h};
    const auto zeros = static_cast<std::uint8_t>(1u << (line & ~kFaceTag));
    return make_corner(weights_where(equal, zeros), zeros, equal, line);
  }

  /// The corner where functions are equal on the face of the vertices that are not in `zeros`: each weight is
  /// the determinant of the functions at the other vertices and a column of ones. On a face the result is the
  /// same from either tetrahedron.
  [[nodiscard]] Weights weights_where(std::span<const std::uint32_t> equal, std::uint8_t zeros) const {
    std::array<std::uint32_t, 4> sorted{};
    std::copy(equal.begin(), equal.end(), sorted.begin());
    const std::size_t count = equal.size();
    std::sort(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(count),
              [&](auto x, auto y) { return comes_first(x, y); });
    std::array<long double, 4> parts{};
    long double sum = 0;
    bool negative = false;
    for (std::size_t vertex = 0; vertex < 4; ++vertex) {
      if ((zeros >> vertex & 1u) != 0) continue;
      SmallMatrix rows{};
      for (std::size_t r = 0; r < count; ++r) {
        std::size_t column = 0;
        for (std::size_t v = 0; v < 4; ++v) {
          if (v != vertex && (zeros >> v & 1u) == 0) rows[r][column++] = function(sorted[r]).values[v];
        }
        rows[r][column] = 1;
      }
      parts[vertex] = determinant_value(rows, count);
      if (negative) parts[vertex] = -parts[vertex];
      negative = !negative;
      sum += parts[vertex];
    }
    Weights w{};
    for (std::size_t v = 0; v < 4; ++v) w[v] = std::max(0.0, static_cast<double>(parts[v] / sum));
    return w;
  }

  const OwnershipProblem& problem_;
  std::vector<ContactPolygon>& out_;
  double margin_;
  /// By candidate: which of its functions was surely below in the last polygon.
  std::vector<std::uint32_t> last_below_;
  std::vector<std::uint32_t> order_;  ///< in which candidates are tried
  std::vector<std::uint32_t> tried_;  ///< functions of a pair's candidates
  std::uint32_t f_ = 0, g_ = 0;
};

}  // namespace

TetrahedronSection section_between(const LinearFunction& f, const LinearFunction& g) {
  std::array<double, 4> d;
  unsigned above = 0;
  for (std::size_t v = 0; v < 4; ++v) {
    d[v] = f.values[v] - g.values[v];
    if (d[v] > 0 || (d[v] == 0 && f.key <= g.key)) above |= 1u << v;
  }
  const CutEdges& cut = all_cut_edges()[above];
  TetrahedronSection section;
  section.count = cut.count;
  for (std::size_t c = 0; c < cut.count; ++c) {
    const auto [i, j, face] = cut.edges[c];
    section.corners[c] = {i, j, face, d[i] == 0 ? 0 : d[i] / (d[i] - d[j])};
  }
  return section;
}

void contact_polygons(const OwnershipProblem& problem, std::vector<ContactPolygon>& contacts) {
  ContactFinder finder(problem, contacts);
  if (problem.functions.size() <= kManyFunctions) return finder.run();
  finder.run(touching_pairs(problem));
}

void keep_owners(OwnershipProblem& problem, std::vector<ContactPolygon>& contacts) {
  const TouchingPairs pairs = keep_owners_and_pairs(problem);
  ContactFinder finder(problem, contacts);
  if (problem.functions.size() <= kManyFunctions) return finder.run();
  finder.run(pairs);
}

}  // namespace adamas::inline core
