#include "core/geometry/partition.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/geometry/contenders.h"

namespace adamas {

namespace {

Weights between(const Weights& a, const Weights& b, double t) {
  if (t <= 0) return a;
  if (t >= 1) return b;
  Weights w;
  for (std::size_t i = 0; i < 4; ++i) w[i] = (1 - t) * a[i] + t * b[i];
  return w;
}

using TetrahedronCorners = std::array<Weights, 4>;
using PolygonCorners = std::vector<Weights>;

/// The contenders' values at the corners of a piece.
class ValueTable {
 public:
  template <class Corners>
  ValueTable(const OwnershipProblem& problem, const Corners& corners,
             const std::vector<Contender>& contenders)
      : corners_(corners.size()) {
    for (const Contender& contender : contenders) {
      for (const std::uint32_t f : contender.functions) {
        place_.emplace_back(f, values_.size());
        for (const Weights& w : corners) values_.push_back(evaluate(problem.functions[f].values, w));
      }
    }
    std::sort(place_.begin(), place_.end());
  }
  [[nodiscard]] std::size_t corners() const { return corners_; }
  /// The values of a function, corner by corner.
  [[nodiscard]] const double* row(std::uint32_t f) const {
    const auto found = std::lower_bound(place_.begin(), place_.end(), std::pair(f, std::size_t{0}));
    return values_.data() + found->second;
  }
  [[nodiscard]] double greatest(std::uint32_t f) const {
    return *std::max_element(row(f), row(f) + corners_);
  }
  [[nodiscard]] double smallest(std::uint32_t f) const {
    return *std::min_element(row(f), row(f) + corners_);
  }
  /// Whether g <= f all over the piece; equal functions are ordered by `first`.
  [[nodiscard]] bool at_most(std::uint32_t g, std::uint32_t f, bool first) const {
    const double *a = row(g), *b = row(f);
    bool strict = false;
    for (std::size_t c = 0; c < corners_; ++c) {
      if (a[c] > b[c]) return false;
      strict = strict || a[c] < b[c];
    }
    return strict || first;
  }
  /// Value of a contender at a corner.
  [[nodiscard]] double least(const Contender& contender, std::size_t corner) const {
    double value = std::numeric_limits<double>::infinity();
    for (const std::uint32_t f : contender.functions) value = std::min(value, row(f)[corner]);
    return value;
  }

 private:
  std::size_t corners_;
  std::vector<std::pair<std::uint32_t, std::size_t>> place_;
  std::vector<double> values_;
};

/// Drops contenders that are below what another surely reaches everywhere.
void drop_low(const ValueTable& values, std::vector<Contender>& contenders) {
  if (contenders.size() < 3) return;
  double surely = -std::numeric_limits<double>::infinity();
  for (const Contender& contender : contenders) {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t c = 0; c < values.corners(); ++c) least = std::min(least, values.least(contender, c));
    surely = std::max(surely, least);
  }
  std::erase_if(contenders, [&](const Contender& contender) {
    return std::any_of(contender.functions.begin(), contender.functions.end(),
                       [&](std::uint32_t f) { return values.greatest(f) < surely; });
  });
}

/// Drops functions that are nowhere the least of their contender.
void drop_redundant(const OwnershipProblem& problem, const ValueTable& values, Contender& contender) {
  auto& fs = contender.functions;
  if (fs.size() > 2) {
    // First those that are above the greatest value of another: that needs no pairs.
    double ceiling = std::numeric_limits<double>::infinity();
    for (const std::uint32_t f : fs) ceiling = std::min(ceiling, values.greatest(f));
    std::erase_if(fs, [&](std::uint32_t f) { return values.smallest(f) > ceiling; });
  }
  const auto key = [&](std::uint32_t f) { return std::pair(problem.functions[f].key, f); };
  for (std::size_t i = 0; i < fs.size() && fs.size() > 1;) {
    const bool redundant = std::any_of(fs.begin(), fs.end(), [&](std::uint32_t g) {
      // Of equal functions the one with the smaller key counts as greater.
      return g != fs[i] && values.at_most(g, fs[i], key(g) > key(fs[i]));
    });
    if (redundant) {
      fs.erase(fs.begin() + static_cast<std::ptrdiff_t>(i));
    } else {
      ++i;
    }
  }
}

/// Whether y is nowhere greater than x: one of its functions is at most each of x's.
bool is_beaten(const OwnershipProblem& problem, const ValueTable& values, const Contender& y,
               const Contender& x) {
  const auto key = [&](std::uint32_t f) { return std::pair(problem.functions[f].key, f); };
  return std::any_of(y.functions.begin(), y.functions.end(), [&](std::uint32_t m) {
    return std::all_of(x.functions.begin(), x.functions.end(),
                       [&](std::uint32_t l) { return values.at_most(m, l, key(l) < key(m)); });
  });
}

bool distinct(const TetrahedronCorners& t) {
  return t[0] != t[1] && t[0] != t[2] && t[0] != t[3] && t[1] != t[2] && t[1] != t[3] && t[2] != t[3];
}

/// The prism between triangles u and v as three tetrahedra; the diagonals of its sides run from the earlier
/// column of u to the later one of v.
void add_prism(const std::array<Weights, 3>& u, const std::array<Weights, 3>& v,
               std::vector<TetrahedronCorners>& out) {
  for (const TetrahedronCorners& t :
       {TetrahedronCorners{u[0], u[1], u[2], v[2]}, TetrahedronCorners{u[0], u[1], v[1], v[2]},
        TetrahedronCorners{u[0], v[0], v[1], v[2]}}) {
    if (distinct(t)) out.push_back(t);
  }
}

/// Cuts a tetrahedron where `d` changes sign; `positive` tells the side of each corner. Diagonals follow the
/// order of the corners, so that two cells whose corners are in one global order agree on their face.
void cut(const TetrahedronCorners& piece, const std::vector<double>& d, const std::vector<bool>& positive,
         std::vector<TetrahedronCorners>& above, std::vector<TetrahedronCorners>& below) {
  std::array<std::size_t, 4> p{}, n{};
  std::size_t np = 0, nn = 0;
  for (std::size_t c = 0; c < 4; ++c) (positive[c] ? p[np++] : n[nn++]) = c;
  const auto point = [&](std::size_t a, std::size_t b) {
    const std::size_t i = std::min(a, b), j = std::max(a, b);
    return between(piece[i], piece[j], d[i] / (d[i] - d[j]));
  };
  if (np == 2) {
    const auto side = [&](const auto& s, const auto& o, auto& out) {
      add_prism({point(s[0], o[0]), point(s[0], o[1]), piece[s[0]]},
                {point(s[1], o[0]), point(s[1], o[1]), piece[s[1]]}, out);
    };
    side(p, n, above);
    side(n, p, below);
    return;
  }
  const bool lone_above = np == 1;
  const std::size_t a = lone_above ? p[0] : n[0];
  const auto& o = lone_above ? n : p;
  const std::array<Weights, 3> section{point(a, o[0]), point(a, o[1]), point(a, o[2])};
  const TetrahedronCorners tip{piece[a], section[0], section[1], section[2]};
  if (distinct(tip)) (lone_above ? above : below).push_back(tip);
  add_prism(section, {piece[o[0]], piece[o[1]], piece[o[2]]}, lone_above ? below : above);
}

/// On a convex polygon a linear function changes sign twice at most. Where it is round-off it may seem to do
/// so more often: the weakest runs of corners on one side then count as zeros of the other side.
void drop_weak_runs(std::vector<double>& d, std::vector<bool>& positive) {
  const std::size_t n = d.size();
  while (true) {
    std::size_t changes = 0, weakest = n, weakest_size = 0;
    double weakest_value = std::numeric_limits<double>::infinity();
    for (std::size_t c = 0; c < n; ++c) {
      if (positive[c] == positive[(c + n - 1) % n]) continue;
      ++changes;
      double greatest = 0;
      std::size_t size = 0;
      for (; size < n && positive[(c + size) % n] == positive[c]; ++size)
        greatest = std::max(greatest, std::abs(d[(c + size) % n]));
      if (greatest < weakest_value) weakest_value = greatest, weakest = c, weakest_size = size;
    }
    if (changes <= 2) return;
    const bool side = !positive[weakest];
    for (std::size_t i = 0; i < weakest_size; ++i) {
      d[(weakest + i) % n] = 0;
      positive[(weakest + i) % n] = side;
    }
  }
}

void cut(const PolygonCorners& piece, std::vector<double> d, std::vector<bool> positive,
         std::vector<PolygonCorners>& above, std::vector<PolygonCorners>& below) {
  drop_weak_runs(d, positive);
  PolygonCorners up, down;
  for (std::size_t c = 0; c < piece.size(); ++c) {
    const std::size_t next = (c + 1) % piece.size();
    (positive[c] ? up : down).push_back(piece[c]);
    if (positive[c] == positive[next]) continue;
    const Weights w = between(piece[c], piece[next], d[c] == 0 ? 0 : d[c] / (d[c] - d[next]));
    up.push_back(w);
    down.push_back(w);
  }
  if (up.size() > 2) above.push_back(std::move(up));
  if (down.size() > 2) below.push_back(std::move(down));
}

/// Cuts a piece where two functions are equal, until one contender is left. Each cut takes a function or a
/// contender away on either side.
template <class Corners, class Emit>
class Divider {
 public:
  Divider(const OwnershipProblem& problem, Emit emit) : problem_(problem), emit_(std::move(emit)) {}

  void divide(const Corners& corners, std::vector<Contender> contenders) {
    if (contenders.size() == 1) return emit_(contenders.front().owner, corners);
    const ValueTable values(problem_, corners, contenders);
    drop_low(values, contenders);
    // Two that are greatest somewhere, or the one that is greatest at all corners and another.
    std::size_t x = greatest_at(values, contenders, 0), y = x;
    for (std::size_t c = 1; c < values.corners() && y == x; ++c) y = greatest_at(values, contenders, c);
    drop_redundant(problem_, values, contenders[x]);
    if (y == x) {
      const auto before = static_cast<std::ptrdiff_t>(x);
      const auto beaten = [&](const Contender& other) {
        return &other != &contenders[x] && is_beaten(problem_, values, other, contenders[x]);
      };
      std::vector<Contender> rest;
      for (const Contender& other : contenders) {
        if (!beaten(other)) rest.push_back(other);
      }
      x = static_cast<std::size_t>(std::count_if(contenders.begin(), contenders.begin() + before,
                                                 [&](const Contender& other) { return !beaten(other); }));
      contenders = std::move(rest);
      if (contenders.size() == 1) return emit_(contenders.front().owner, corners);
      y = highest_rival(values, contenders, x);
    }
    drop_redundant(problem_, values, contenders[y]);
    for (const std::size_t i : {x, y}) {
      if (contenders[i].functions.size() > 1) return cut_within(corners, values, contenders, i);
    }
    cut_between(corners, values, contenders, x, y);
  }

 private:
  /// Where which of the two first functions is the least of contender i.
  void cut_within(const Corners& corners, const ValueTable& values, const std::vector<Contender>& contenders,
                  std::size_t i) {
    const std::uint32_t f = contenders[i].functions[0], g = contenders[i].functions[1];
    const auto without = [&](std::uint32_t gone) {
      std::vector<Contender> rest = contenders;
      std::erase(rest[i].functions, gone);
      return rest;
    };
    split(corners, values, f, g, without(f), without(g));
  }

  /// Where which of two linear contenders is greater.
  void cut_between(const Corners& corners, const ValueTable& values, const std::vector<Contender>& contenders,
                   std::size_t x, std::size_t y) {
    const auto without = [&](std::size_t gone) {
      std::vector<Contender> rest = contenders;
      rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(gone));
      return rest;
    };
    split(corners, values, contenders[x].functions[0], contenders[y].functions[0], without(y), without(x));
  }

  /// Key of the function that is a contender's least at a corner.
  [[nodiscard]] std::pair<double, std::uint64_t> binding(const ValueTable& values, const Contender& contender,
                                                         std::size_t c) const {
    std::pair<double, std::uint64_t> least{std::numeric_limits<double>::infinity(), 0};
    for (const std::uint32_t f : contender.functions) {
      const double value = values.row(f)[c];
      const std::uint64_t key = problem_.functions[f].key;
      if (value < least.first || (value == least.first && key > least.second)) least = {value, key};
    }
    return least;
  }

  [[nodiscard]] std::size_t greatest_at(const ValueTable& values, const std::vector<Contender>& contenders,
                                        std::size_t c) const {
    std::size_t best = 0;
    auto greatest = binding(values, contenders[0], c);
    for (std::size_t i = 1; i < contenders.size(); ++i) {
      const auto other = binding(values, contenders[i], c);
      if (other.first > greatest.first || (other.first == greatest.first && other.second < greatest.second)) {
        best = i;
        greatest = other;
      }
    }
    return best;
  }

  /// The contender, other than x, that may reach highest.
  [[nodiscard]] static std::size_t highest_rival(const ValueTable& values,
                                                 const std::vector<Contender>& contenders, std::size_t x) {
    std::size_t best = x == 0 ? 1 : 0;
    double highest = -std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < contenders.size(); ++i) {
      double reach = std::numeric_limits<double>::infinity();
      for (const std::uint32_t f : contenders[i].functions) reach = std::min(reach, values.greatest(f));
      if (i != x && reach > highest) best = i, highest = reach;
    }
    return best;
  }

  /// Goes on with `above` where f > g and with `below` elsewhere.
  void split(const Corners& corners, const ValueTable& values, std::uint32_t f, std::uint32_t g,
             std::vector<Contender> above, std::vector<Contender> below) {
    std::vector<double> d(values.corners());
    std::vector<bool> positive(values.corners());
    std::size_t positives = 0;
    const double *a = values.row(f), *b = values.row(g);
    for (std::size_t c = 0; c < d.size(); ++c) {
      d[c] = a[c] - b[c];
      positive[c] = d[c] > 0 || (d[c] == 0 && problem_.functions[f].key < problem_.functions[g].key);
      positives += positive[c] ? 1 : 0;
    }
    if (positives == d.size()) return divide(corners, std::move(above));
    if (positives == 0) return divide(corners, std::move(below));
    std::vector<Corners> up, down;
    cut(corners, d, positive, up, down);
    for (const Corners& piece : up) divide(piece, above);
    for (const Corners& piece : down) divide(piece, below);
  }

  const OwnershipProblem& problem_;
  Emit emit_;
};

template <class Corners, class Emit>
void divide(const OwnershipProblem& problem, const Corners& corners, Emit emit) {
  Divider<Corners, Emit>(problem, std::move(emit)).divide(corners, all_contenders(problem));
}

}  // namespace

void partition_tetrahedron(const OwnershipProblem& problem, std::vector<OwnedTetrahedron>& parts) {
  const TetrahedronCorners whole{Weights{1, 0, 0, 0}, Weights{0, 1, 0, 0}, Weights{0, 0, 1, 0},
                                 Weights{0, 0, 0, 1}};
  divide(problem, whole, [&](std::uint32_t owner, const TetrahedronCorners& corners) {
    parts.push_back({owner, corners});
  });
}

void partition_polygon(const OwnershipProblem& problem, const std::vector<Weights>& polygon,
                       std::vector<OwnedPolygon>& parts) {
  if (polygon.size() < 3) return;
  divide(problem, polygon, [&](std::uint32_t owner, const PolygonCorners& corners) {
    parts.push_back({owner, corners});
  });
}

double volume_fraction(const std::array<Weights, 4>& c) {
  // Edge vectors in the coordinates (w1, w2, w3); the unit tetrahedron has determinant 1.
  std::array<std::array<double, 3>, 3> m{};
  for (std::size_t r = 0; r < 3; ++r) {
    for (std::size_t i = 0; i < 3; ++i) m[r][i] = c[r + 1][i + 1] - c[0][i + 1];
  }
  return std::abs(m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
                  m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
                  m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]));
}

}  // namespace adamas
