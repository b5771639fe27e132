#include "core/geometry/partition.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace adamas {

namespace {

double evaluate(const std::array<double, 4>& values, const Weights& w) {
  return values[0] * w[0] + values[1] * w[1] + values[2] * w[2] + values[3] * w[3];
}

Weights between(const Weights& a, const Weights& b, double t) {
  if (t <= 0) return a;
  if (t >= 1) return b;
  Weights w;
  for (std::size_t i = 0; i < 4; ++i) w[i] = (1 - t) * a[i] + t * b[i];
  return w;
}

/// A convex piece during the division: corners and what may still own a part of it.
template <class Corners>
struct Piece {
  Corners corners;
};

using TetrahedronCorners = std::array<Weights, 4>;
using PolygonCorners = std::vector<Weights>;

/// What may still own a part of a piece: candidates, each with the functions that may still be its least.
struct Contenders {
  struct Contender {
    std::uint32_t owner;
    std::vector<std::uint32_t> functions;
  };
  std::vector<Contender> list;
};

/// Values of every function at the corners of a piece: row f holds `corners` values.
class ValueTable {
 public:
  template <class Corners>
  ValueTable(const OwnershipProblem& problem, const Corners& corners) : corners_(corners.size()) {
    values_.resize(problem.functions.size() * corners_);
    for (std::size_t f = 0; f < problem.functions.size(); ++f) {
      for (std::size_t c = 0; c < corners_; ++c) {
        values_[f * corners_ + c] = evaluate(problem.functions[f].values, corners[c]);
      }
    }
  }
  [[nodiscard]] std::size_t corners() const { return corners_; }
  [[nodiscard]] double operator()(std::uint32_t f, std::size_t corner) const {
    return values_[f * corners_ + corner];
  }
  /// Whether g <= f all over the piece; equal functions are ordered by `first`.
  [[nodiscard]] bool at_most(std::uint32_t g, std::uint32_t f, bool first) const {
    bool strict = false;
    for (std::size_t c = 0; c < corners_; ++c) {
      if ((*this)(g, c) > (*this)(f, c)) return false;
      strict = strict || (*this)(g, c) < (*this)(f, c);
    }
    return strict || first;
  }

 private:
  std::size_t corners_;
  std::vector<double> values_;
};

/// Drops functions that are nowhere the least of their contender and contenders that are nowhere the
/// greatest.
void prune(const OwnershipProblem& problem, const ValueTable& values, Contenders& contenders) {
  const auto key = [&](std::uint32_t f) { return problem.functions[f].key; };
  for (auto& contender : contenders.list) {
    auto& fs = contender.functions;
    for (std::size_t i = 0; i < fs.size() && fs.size() > 1;) {
      const bool redundant = std::any_of(fs.begin(), fs.end(), [&](std::uint32_t g) {
        return g != fs[i] &&
               values.at_most(g, fs[i], key(g) < key(fs[i]) || (key(g) == key(fs[i]) && g < fs[i]));
      });
      if (redundant) {
        fs.erase(fs.begin() + static_cast<std::ptrdiff_t>(i));
      } else {
        ++i;
      }
    }
  }
  auto& list = contenders.list;
  const auto beaten_by = [&](const Contenders::Contender& y, const Contenders::Contender& x) {
    return std::any_of(y.functions.begin(), y.functions.end(), [&](std::uint32_t m) {
      return std::all_of(x.functions.begin(), x.functions.end(), [&](std::uint32_t l) {
        return values.at_most(m, l, key(l) < key(m) || (key(l) == key(m) && l < m));
      });
    });
  };
  for (std::size_t i = 0; i < list.size() && list.size() > 1;) {
    bool beaten = false;
    for (std::size_t j = 0; j < list.size() && !beaten; ++j) beaten = j != i && beaten_by(list[i], list[j]);
    if (beaten) {
      list.erase(list.begin() + static_cast<std::ptrdiff_t>(i));
    } else {
      ++i;
    }
  }
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

void cut(const PolygonCorners& piece, const std::vector<double>& d, const std::vector<bool>& positive,
         std::vector<PolygonCorners>& above, std::vector<PolygonCorners>& below) {
  PolygonCorners up, down;
  for (std::size_t c = 0; c < piece.size(); ++c) {
    const std::size_t next = (c + 1) % piece.size();
    (positive[c] ? up : down).push_back(piece[c]);
    if (positive[c] == positive[next]) continue;
    const Weights w = between(piece[c], piece[next], d[c] / (d[c] - d[next]));
    up.push_back(w);
    down.push_back(w);
  }
  if (up.size() > 2) above.push_back(std::move(up));
  if (down.size() > 2) below.push_back(std::move(down));
}

/// Cuts where two functions are equal, until one contender is left (see divide).
template <class Corners, class Emit>
class Divider {
 public:
  Divider(const OwnershipProblem& problem, Emit emit) : problem_(problem), emit_(std::move(emit)) {}

  void divide(const Corners& corners, Contenders contenders) {
    const ValueTable values(problem_, corners);
    prune(problem_, values, contenders);
    if (contenders.list.size() <= 1) {
      if (!contenders.list.empty()) emit_(contenders.list.front().owner, corners);
      return;
    }
    for (std::size_t i = 0; i < contenders.list.size(); ++i) {
      if (contenders.list[i].functions.size() > 1) return cut_within(corners, values, contenders, i);
    }
    cut_between(corners, values, contenders);
  }

 private:
  /// Which of its two first functions is the least of contender i.
  void cut_within(const Corners& corners, const ValueTable& values, const Contenders& contenders,
                  std::size_t i) {
    const auto& fs = contenders.list[i].functions;
    const auto without = [&](std::uint32_t f) {
      Contenders rest = contenders;
      std::erase(rest.list[i].functions, f);
      return rest;
    };
    split(corners, values, fs[0], fs[1], without(fs[0]), without(fs[1]));
  }

  /// All contenders are linear now: cuts between the owners of two corners.
  void cut_between(const Corners& corners, const ValueTable& values, const Contenders& contenders) {
    const std::size_t x = greatest_at(values, contenders, 0);
    std::size_t y = x;
    for (std::size_t c = 1; c < values.corners() && y == x; ++c) y = greatest_at(values, contenders, c);
    if (y == x) y = x == 0 ? 1 : 0;
    const auto without = [&](std::size_t gone) {
      Contenders rest = contenders;
      rest.list.erase(rest.list.begin() + static_cast<std::ptrdiff_t>(gone));
      return rest;
    };
    split(corners, values, contenders.list[x].functions[0], contenders.list[y].functions[0], without(y),
          without(x));
  }

  [[nodiscard]] std::size_t greatest_at(const ValueTable& values, const Contenders& contenders,
                                        std::size_t c) const {
    std::size_t best = 0;
    for (std::size_t i = 1; i < contenders.list.size(); ++i) {
      const std::uint32_t f = contenders.list[i].functions[0], g = contenders.list[best].functions[0];
      const double difference = values(f, c) - values(g, c);
      if (difference > 0 || (difference == 0 && problem_.functions[f].key < problem_.functions[g].key))
        best = i;
    }
    return best;
  }

  /// Goes on with `above` where f > g and with `below` elsewhere.
  void split(const Corners& corners, const ValueTable& values, std::uint32_t f, std::uint32_t g,
             const Contenders& above, const Contenders& below) {
    std::vector<double> d(values.corners());
    std::vector<bool> positive(values.corners());
    std::size_t positives = 0;
    for (std::size_t c = 0; c < d.size(); ++c) {
      d[c] = values(f, c) - values(g, c);
      positive[c] = d[c] > 0 || (d[c] == 0 && problem_.functions[f].key < problem_.functions[g].key);
      positives += positive[c] ? 1 : 0;
    }
    if (positives == d.size()) return divide(corners, above);
    if (positives == 0) return divide(corners, below);
    std::vector<Corners> up, down;
    cut(corners, d, positive, up, down);
    for (const Corners& piece : up) divide(piece, above);
    for (const Corners& piece : down) divide(piece, below);
  }

  const OwnershipProblem& problem_;
  Emit emit_;
};

Contenders all_contenders(const OwnershipProblem& problem) {
  Contenders contenders;
  for (const auto& candidate : problem.candidates) {
    auto& contender = contenders.list.emplace_back();
    contender.owner = candidate.owner;
    for (std::uint32_t f = 0; f < candidate.count; ++f) contender.functions.push_back(candidate.first + f);
  }
  return contenders;
}

template <class Corners, class Emit>
void divide(const OwnershipProblem& problem, const Corners& corners, Emit emit) {
  Divider<Corners, Emit>(problem, std::move(emit)).divide(corners, all_contenders(problem));
}

}  // namespace

double OwnershipProblem::value(const Candidate& candidate, const Weights& weights) const {
  double least = evaluate(functions[candidate.first].values, weights);
  for (std::uint32_t f = 1; f < candidate.count; ++f) {
    least = std::min(least, evaluate(functions[candidate.first + f].values, weights));
  }
  return least;
}

std::uint32_t OwnershipProblem::owner(const Weights& weights) const {
  const auto binding = [&](const Candidate& candidate) {
    std::uint32_t best = candidate.first;
    double least = evaluate(functions[best].values, weights);
    for (std::uint32_t f = candidate.first + 1; f < candidate.first + candidate.count; ++f) {
      const double value_f = evaluate(functions[f].values, weights);
      if (value_f < least || (value_f == least && functions[f].key > functions[best].key))
        best = f, least = value_f;
    }
    return std::pair(least, functions[best].key);
  };
  std::uint32_t owner = candidates.front().owner;
  auto [greatest, key] = binding(candidates.front());
  for (std::size_t c = 1; c < candidates.size(); ++c) {
    const auto [value_c, key_c] = binding(candidates[c]);
    if (value_c > greatest || (value_c == greatest && key_c < key)) {
      greatest = value_c, key = key_c, owner = candidates[c].owner;
    }
  }
  return owner;
}

void drop_hopeless(OwnershipProblem& problem) {
  const auto least_at = [&](const OwnershipProblem::Candidate& candidate, std::size_t corner) {
    double least = problem.functions[candidate.first].values[corner];
    for (std::uint32_t f = 1; f < candidate.count; ++f) {
      least = std::min(least, problem.functions[candidate.first + f].values[corner]);
    }
    return least;
  };
  // Each candidate is concave: nowhere below the least of its corner values, nowhere above the greatest
  // corner value of any of its functions.
  double surely = -std::numeric_limits<double>::infinity();
  for (const auto& candidate : problem.candidates) {
    surely = std::max(surely, std::min({least_at(candidate, 0), least_at(candidate, 1),
                                        least_at(candidate, 2), least_at(candidate, 3)}));
  }
  std::erase_if(problem.candidates, [&](const OwnershipProblem::Candidate& candidate) {
    double at_most = std::numeric_limits<double>::infinity();
    for (std::uint32_t f = 0; f < candidate.count; ++f) {
      const auto& values = problem.functions[candidate.first + f].values;
      at_most = std::min(at_most, *std::max_element(values.begin(), values.end()));
    }
    return at_most < surely;
  });
}

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
