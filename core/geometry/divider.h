#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "core/base/simd.h"
#include "core/geometry/ownership_problem.h"

namespace adamas::inline core {

/// The value of a linear function at a point.
inline double evaluate(const std::array<double, 4>& values, const Weights& w) {
  return values[0] * w[0] + values[1] * w[1] + values[2] * w[2] + values[3] * w[3];
}

/// Hears nothing of what a Divider drops.
struct NoDrops {
  static constexpr bool kHears = false;
};

/// Divides a convex piece of a tetrahedron by owner: cuts it where two functions are equal, until one
/// contender is left. Each cut removes a function or a contender on either side. `Piece` has corners() and
/// cut(d, positive, above, below). Memory is reused from one piece to the next.
template <class Piece>
class Divider {
 public:
  /// A candidate with those of its functions that may still be its least.
  struct Contender {
    std::uint32_t owner, candidate;
    std::uint32_t first, count;   ///< its functions among `functions`
    std::uint32_t row = 0;        ///< its row in the table of least values
    double least = 0, reach = 0;  ///< it is nowhere in the piece below the one and above the other
  };

  /// Calls emit(owner, piece, functions) for each part; the least of the functions is the owner's value
  /// there.
  template <class Emit>
  void divide(const OwnershipProblem& problem, const Piece& piece, Emit&& emit) {
    NoDrops drops;
    divide(problem, piece, emit, drops);
  }

  /// The same, and tells `drops` which candidates are clearly below, that is by more than drops.margin, in a
  /// piece: drops.add_piece(corners, heights) gets values that the owners have at least at the corners and
  /// returns a number, and drops.add_below(number, candidate, function) follows. Emit gets the
  /// place of the owner among the candidates, and in the end a list of the others that may touch the part:
  /// those of which this was said for no piece that contains it.
  template <class Emit, class Drops>
  void divide(const OwnershipProblem& problem, const Piece& piece, Emit&& emit, Drops& drops) {
    problem_ = &problem;
    State& state = at(0);
    state.contenders.clear();
    state.functions.clear();
    state.known.clear();
    state.doubtful.clear();
    std::uint32_t number = 0;
    for (const auto& candidate : problem.candidates) {
      state.add(candidate.owner, number++);
      for (std::uint32_t f = 0; f < candidate.count; ++f) state.add_function(candidate.first + f);
    }
    divide(piece, 0, emit, drops);
  }

 private:
  struct Function {
    std::uint32_t id;
    std::uint32_t row;  ///< its row in the table of values
  };
  static constexpr std::uint32_t kAll = 0xffffffffu;
  /// What becomes of a contender on one side of a cut: it is not needed there, or one of its functions is
  /// not, or that one is known to be above another function.
  struct Change {
    std::size_t contender;
    std::uint32_t function = kAll;
    std::uint32_t above = kAll;
  };
  /// The cut where f = g, and what follows where f is greater and where it is less. Without f the first thing
  /// follows in the whole piece.
  struct Cut {
    Function f, g;
    Change above, below;
  };

  /// The contenders for a piece, and the values of their functions at its corners.
  struct State {
    std::vector<Contender> contenders;
    std::vector<Function> functions;
    std::size_t corners = 0;
    std::vector<double> weights;  ///< of the corners, by vertex and corner
    /// Values by row and corner; least and greatest of each row.
    std::vector<double> values, least, greatest;
    std::vector<double> lows;  ///< the least of a contender's functions, by its row and corner
    std::vector<double> d;
    std::vector<char> positive;
    std::vector<std::size_t> often;
    /// Pairs of functions of different contenders of which the first one is known to be above in the piece.
    std::vector<std::pair<std::uint32_t, std::uint32_t>> known;
    std::vector<std::uint32_t> doubtful;  ///< dropped candidates that may touch the piece
    std::vector<double> heights;
    Piece above, below;

    void add(std::uint32_t owner, std::uint32_t candidate) {
      contenders.push_back({owner, candidate, static_cast<std::uint32_t>(functions.size()), 0});
    }
    void add_function(std::uint32_t id) {
      functions.push_back({id, 0});
      ++contenders.back().count;
    }
    [[nodiscard]] Function& function(const Contender& c, std::size_t i) { return functions[c.first + i]; }
    /// Keeps those functions of a contender for which `wanted` is true.
    template <class Wanted>
    void keep_if(Contender& c, const Wanted& wanted) {
      std::uint32_t kept = 0;
      for (std::uint32_t i = 0; i < c.count; ++i) {
        if (wanted(function(c, i))) function(c, kept++) = function(c, i);
      }
      c.count = kept;
    }
    [[nodiscard]] const double* row(const Function& f) const { return values.data() + f.row * corners; }
    [[nodiscard]] const double* row(const Contender& c) const { return lows.data() + c.row * corners; }
  };

  State& at(std::size_t depth) {
    while (states_.size() <= depth) states_.push_back(std::make_unique<State>());
    return *states_[depth];
  }
  [[nodiscard]] std::uint64_t key(const Function& f) const { return problem_->functions[f.id].key; }
  /// Whether f counts as greater than g where they are equal.
  [[nodiscard]] bool comes_first(const Function& f, const Function& g) const {
    return key(f) < key(g) || (key(f) == key(g) && f.id < g.id);
  }

  template <class Emit, class Drops>
  void divide(const Piece& piece, std::size_t depth, Emit&& emit, Drops& drops) {
    if (piece.corners().size() < 3) return;
    State& s = at(depth);
    find_values(piece, s);
    while (true) {
      const auto [x, y] = find_rivals(piece, s, drops);
      if (s.contenders.size() == 1) return finish<Drops>(piece, s, emit);
      const Cut cut = choose_cut(s, x, y);
      if (cut.f.id == kAll) {
        change(s, cut.above);
        continue;
      }
      const std::size_t positives = find_sides(piece, s, cut.f, cut.g);
      if (positives == s.corners || positives == 0) {
        change(s, positives == 0 ? cut.below : cut.above);
        continue;
      }
      piece.cut(s.d, s.positive, s.above, s.below);
      State& next = at(depth + 1);
      copy_changed(s, cut.above, next);
      divide(s.above, depth + 1, emit, drops);
      copy_changed(s, cut.below, next);
      divide(s.below, depth + 1, emit, drops);
      return;
    }
  }

  Cut choose_cut(State& s, std::size_t x, std::size_t y) const {
    const std::size_t nx = s.contenders[x].count, ny = s.contenders[y].count;
    if (nx > 1 && ny > 1) {
      // Two functions of one contender: on each side only one is needed.
      const std::size_t crowded = nx <= ny ? x : y;
      const auto [i, k] = most_often_least(s, s.contenders[crowded]);
      const Function f = s.function(s.contenders[crowded], i), g = s.function(s.contenders[crowded], k);
      return {f, g, {crowded, f.id}, {crowded, g.id}};
    }
    if (nx == 1 && ny == 1) {
      // On each side one of the two contenders is greater.
      return {s.function(s.contenders[x], 0), s.function(s.contenders[y], 0), {y}, {x}};
    }
    // One of them has a single function, g. Where a function f of the other one is less, that one is; where
    // all of its functions are greater, it is greater.
    const std::size_t single = nx == 1 ? x : y, other = nx == 1 ? y : x;
    const Function g = s.function(s.contenders[single], 0);
    const std::size_t i = lowest_open(s, s.contenders[other], g);
    if (i == s.contenders[other].count) return {{kAll, 0}, g, {single}, {single}};
    const Function f = s.function(s.contenders[other], i);
    return {f, g, {other, f.id, g.id}, {other}};
  }

  /// The function of a contender that is farthest below g at a corner, of those not known to be greater; the
  /// number of functions if all are.
  [[nodiscard]] std::size_t lowest_open(State& s, const Contender& c, const Function& g) const {
    std::size_t best = c.count;
    double lowest = std::numeric_limits<double>::infinity();
    const double* const b = s.row(g);
    for (std::uint32_t i = 0; i < c.count; ++i) {
      const Function& f = s.function(c, i);
      if (std::ranges::find(s.known, std::pair(f.id, g.id)) != s.known.end()) continue;
      double low = std::numeric_limits<double>::infinity();
      const double* const a = s.row(f);
      for (std::size_t k = 0; k < s.corners; ++k) low = std::min(low, a[k] - b[k]);
      if (best == c.count || low < lowest) best = i, lowest = low;
    }
    return best;
  }

  /// The two functions of a contender that are its least at most corners, in their order.
  [[nodiscard]] std::pair<std::size_t, std::size_t> most_often_least(State& s, const Contender& c) const {
    if (c.count == 2) return {0, 1};
    s.often.assign(c.count, 0);
    for (std::size_t corner = 0; corner < s.corners; ++corner) ++s.often[binding(s, c, corner).place];
    std::size_t first = 0;
    for (std::size_t i = 1; i < c.count; ++i) {
      if (s.often[i] > s.often[first]) first = i;
    }
    std::size_t second = first == 0 ? 1 : 0;
    for (std::size_t i = 0; i < c.count; ++i) {
      if (i != first && s.often[i] > s.often[second]) second = i;
    }
    return std::minmax(first, second);
  }

  template <class Drops, class Emit>
  void finish(const Piece& piece, State& s, Emit&& emit) {
    thread_local std::vector<std::uint32_t> functions;
    functions.clear();
    const Contender& last = s.contenders.front();
    for (std::uint32_t i = 0; i < last.count; ++i) functions.push_back(s.function(last, i).id);
    if constexpr (Drops::kHears) {
      emit(last.candidate, piece, functions, s.doubtful);
    } else {
      emit(last.owner, piece, functions);
    }
  }

  /// Makes room for so many numbers, which are then set.
  static void grow(std::vector<double>& numbers, std::size_t count) {
    if (numbers.size() < count) numbers.resize(count);
  }

  /// Finds the values of the contenders' functions at the corners, and drops functions that they show to be
  /// too high.
  void find_values(const Piece& piece, State& s) const {
    const auto& corners = piece.corners();
    s.corners = corners.size();
    grow(s.weights, 4 * s.corners);
    for (std::size_t v = 0; v < 4; ++v) {
      for (std::size_t c = 0; c < s.corners; ++c) s.weights[v * s.corners + c] = corners[c][v];
    }
    std::size_t rows = 0;
    for (const Contender& c : s.contenders) rows += c.count;
    grow(s.values, rows * s.corners);
    grow(s.least, rows);
    grow(s.greatest, rows);
    grow(s.lows, s.contenders.size() * s.corners);
    std::uint32_t row = 0, contender = 0;
    for (Contender& c : s.contenders) {
      c.row = contender++;
      c.reach = std::numeric_limits<double>::infinity();
      for (std::uint32_t i = 0; i < c.count; ++i) {
        Function& f = s.function(c, i);
        f.row = row++;
        double* const values = s.values.data() + f.row * s.corners;
        find_row(problem_->functions[f.id].values, s.weights.data(), s.corners, values);
        double least = values[0], greatest = values[0];
        for (std::size_t k = 1; k < s.corners; ++k)
          least = std::min(least, values[k]), greatest = std::max(greatest, values[k]);
        s.least[f.row] = least;
        s.greatest[f.row] = greatest;
        c.reach = std::min(c.reach, greatest);
      }
      if (c.count > 1) s.keep_if(c, [&](const Function& f) { return s.least[f.row] <= c.reach; });
      find_lows(s, c);
    }
  }

  /// Finds a contender's values from those of its functions.
  static void find_lows(State& s, Contender& c) {
    double* const lows = s.lows.data() + c.row * s.corners;
    const Function* const functions = s.functions.data() + c.first;
    std::copy_n(s.row(functions[0]), s.corners, lows);
    c.least = s.least[functions[0].row];
    c.reach = s.greatest[functions[0].row];
    for (std::uint32_t i = 1; i < c.count; ++i) {
      const double* const values = s.row(functions[i]);
      ADAMAS_INDEPENDENT
      for (std::size_t k = 0; k < s.corners; ++k) lows[k] = std::min(lows[k], values[k]);
      c.least = std::min(c.least, s.least[functions[i].row]);
      c.reach = std::min(c.reach, s.greatest[functions[i].row]);
    }
  }

  /// Finds a function's values at corners, whose weights are given by vertex and corner.
  static void find_row(const std::array<double, 4>& at_vertices, const double* weights, std::size_t corners,
                       double* values) {
    ADAMAS_INDEPENDENT
    for (std::size_t c = 0; c < corners; ++c) {
      values[c] = at_vertices[0] * weights[c] + at_vertices[1] * weights[corners + c] +
                  at_vertices[2] * weights[2 * corners + c] + at_vertices[3] * weights[3 * corners + c];
    }
  }

  /// Finds on which side of f = g each corner lies. The difference is taken at the vertices, where values
  /// that were not equal do not cancel; round-off counts as equal, so that all corners of a face in the plane
  /// lie on one side.
  std::size_t find_sides(const Piece& piece, State& s, const Function& f, const Function& g) const {
    constexpr double kRoundOff = 64 * std::numeric_limits<double>::epsilon();
    std::array<double, 4> difference;
    for (std::size_t v = 0; v < 4; ++v)
      difference[v] = problem_->functions[f.id].values[v] - problem_->functions[g.id].values[v];
    s.d.resize(s.corners);
    s.positive.resize(s.corners);
    std::size_t positives = 0;
    for (std::size_t c = 0; c < s.corners; ++c) {
      const Weights& w = piece.corners()[c];
      // Only the vertices of the face that the corner lies on count: elsewhere functions may differ by far
      // more.
      double greatest = 0;
      for (std::size_t v = 0; v < 4; ++v)
        greatest = std::max(greatest, w[v] != 0 ? std::abs(difference[v]) : 0);
      s.d[c] = evaluate(difference, w);
      if (std::abs(s.d[c]) <= kRoundOff * greatest) s.d[c] = 0;
      s.positive[c] = s.d[c] > 0 || (s.d[c] == 0 && key(f) < key(g)) ? 1 : 0;
      positives += s.positive[c] != 0 ? 1 : 0;
    }
    return positives;
  }

  static void change(State& s, const Change& change) {
    Contender& c = s.contenders[change.contender];
    if (change.function == kAll) {
      s.doubtful.push_back(c.candidate);
      s.contenders.erase(s.contenders.begin() + static_cast<std::ptrdiff_t>(change.contender));
    } else if (change.above == kAll) {
      s.keep_if(c, [&](const Function& f) { return f.id != change.function; });
      find_lows(s, c);
    } else {
      s.known.emplace_back(change.function, change.above);
    }
  }

  static void copy_changed(State& from, const Change& change, State& to) {
    const bool less = change.above == kAll;
    to.contenders.clear();
    to.functions.clear();
    to.known = from.known;
    to.doubtful = from.doubtful;
    if (!less) to.known.emplace_back(change.function, change.above);
    for (std::size_t i = 0; i < from.contenders.size(); ++i) {
      const bool changed = less && i == change.contender;
      const Contender& c = from.contenders[i];
      if (changed && change.function == kAll) {
        to.doubtful.push_back(c.candidate);
        continue;
      }
      to.add(c.owner, c.candidate);
      for (std::uint32_t k = 0; k < c.count; ++k) {
        const std::uint32_t id = from.function(c, k).id;
        if (!changed || id != change.function) to.add_function(id);
      }
    }
  }

  /// Returns two contenders that are greatest somewhere, or the one that is greatest at all corners and
  /// another that may exceed it; removes contenders and functions that are surely not needed. If one
  /// contender is left, both are that one.
  template <class Drops>
  std::pair<std::size_t, std::size_t> find_rivals(const Piece& piece, State& s, Drops& drops) const {
    drop_low(piece, s, drops);
    std::size_t x = greatest_at(s, 0), y = x;
    for (std::size_t c = 1; c < s.corners && y == x; ++c) y = greatest_at(s, c);
    drop_redundant(s, s.contenders[x]);
    if (y == x) {
      x = drop_beaten(piece, s, x, drops);
      if (s.contenders.size() == 1) return {0, 0};
      y = highest_rival(s, x);
    }
    drop_redundant(s, s.contenders[y]);
    return {x, y};
  }

  /// Drops contenders that are below what another surely reaches everywhere.
  template <class Drops>
  static void drop_low(const Piece& piece, State& s, Drops& drops) {
    if (s.contenders.size() < 3) return;
    double surely = -std::numeric_limits<double>::infinity();
    for (const Contender& c : s.contenders) surely = std::max(surely, c.least);
    std::optional<std::uint32_t> told;
    std::erase_if(s.contenders, [&](const Contender& c) {
      if (!(c.reach < surely)) return false;
      if constexpr (Drops::kHears) {
        if (!(c.reach + drops.margin < surely)) {
          s.doubtful.push_back(c.candidate);
        } else {
          const Function* low = s.functions.data() + c.first;
          while (!(s.greatest[low->row] + drops.margin < surely)) ++low;
          if (!told) {
            s.heights.assign(s.corners, surely);
            told = drops.add_piece(piece.corners(), s.heights);
          }
          drops.add_below(*told, c.candidate, low->id);
        }
      }
      return true;
    });
  }

  /// Whether g <= f all over the piece; equal functions are ordered.
  [[nodiscard]] bool at_most(const State& s, const Function& g, const Function& f) const {
    const double *a = s.row(g), *b = s.row(f);
    bool strict = false;
    for (std::size_t c = 0; c < s.corners; ++c) {
      if (a[c] > b[c]) return false;
      strict = strict || a[c] < b[c];
    }
    return strict || comes_first(f, g);
  }

  /// Drops functions that are nowhere the least of their contender.
  void drop_redundant(State& s, Contender& c) const {
    for (std::uint32_t i = 0; i < c.count && c.count > 1;) {
      const Function f = s.function(c, i);
      bool redundant = false;
      for (std::uint32_t k = 0; k < c.count && !redundant; ++k)
        redundant = k != i && at_most(s, s.function(c, k), f);
      if (redundant) {
        s.keep_if(c, [&](const Function& other) { return other.id != f.id; });
      } else {
        ++i;
      }
    }
  }

  /// Drops contenders that are nowhere greater than x: one of their functions is at most each of x's. Returns
  /// the new place of x.
  template <class Drops>
  std::size_t drop_beaten(const Piece& piece, State& s, std::size_t x, Drops& drops) const {
    const Contender by = s.contenders[x];
    const double* const least = s.row(by);
    const auto below = [&](const Function& f) {
      const double* const values = s.row(f);
      for (std::size_t k = 0; k < s.corners; ++k) {
        if (values[k] > least[k]) return false;
      }
      const Function* const own = s.functions.data() + by.first;
      return std::all_of(own, own + by.count, [&](const Function& g) { return at_most(s, f, g); });
    };
    const auto beaten = [&](const Contender& c) {
      const Function* const functions = s.functions.data() + c.first;
      return std::any_of(functions, functions + c.count, below);
    };
    std::size_t kept = 0, place = 0;
    std::optional<std::uint32_t> told;
    for (std::size_t i = 0; i < s.contenders.size(); ++i) {
      if (i == x) {
        place = kept;
      } else if (beaten(s.contenders[i])) {
        if constexpr (Drops::kHears) tell_beaten(piece, s, by, s.contenders[i], told, drops);
        continue;
      }
      s.contenders[kept++] = s.contenders[i];
    }
    s.contenders.resize(kept);
    return place;
  }

  /// Tells `drops` that contender c is clearly below another one, if it is. `told`: the number of the piece
  /// once it has been told.
  template <class Drops>
  void tell_beaten(const Piece& piece, State& s, const Contender& by, const Contender& c,
                   std::optional<std::uint32_t>& told, Drops& drops) const {
    if (!told) s.heights.assign(s.row(by), s.row(by) + s.corners);
    for (std::uint32_t i = 0; i < c.count; ++i) {
      const Function& f = s.function(c, i);
      const double* const row = s.row(f);
      bool below = true;
      for (std::size_t k = 0; k < s.corners && below; ++k) below = row[k] + drops.margin < s.heights[k];
      if (!below) continue;
      if (!told) told = drops.add_piece(piece.corners(), s.heights);
      return drops.add_below(*told, c.candidate, f.id);
    }
    s.doubtful.push_back(c.candidate);
  }

  /// A contender's least function at a corner: its key, and its place among the contender's.
  struct Binding {
    std::uint64_t key;
    std::size_t place;
  };
  [[nodiscard]] Binding binding(const State& s, const Contender& c, std::size_t corner) const {
    Binding least{0, 0};
    double lowest = std::numeric_limits<double>::infinity();
    for (std::uint32_t i = 0; i < c.count; ++i) {
      const Function& f = s.functions[c.first + i];
      const double value = s.row(f)[corner];
      if (value < lowest || (value == lowest && key(f) > least.key)) lowest = value, least = {key(f), i};
    }
    return least;
  }

  [[nodiscard]] std::size_t greatest_at(const State& s, std::size_t corner) const {
    std::size_t best = 0;
    double greatest = s.row(s.contenders[0])[corner];
    for (std::size_t i = 1; i < s.contenders.size(); ++i) {
      const double other = s.row(s.contenders[i])[corner];
      if (other < greatest) continue;
      if (other > greatest ||
          binding(s, s.contenders[i], corner).key < binding(s, s.contenders[best], corner).key)
        best = i, greatest = other;
    }
    return best;
  }

  /// The contender, other than x, that may reach highest.
  [[nodiscard]] static std::size_t highest_rival(const State& s, std::size_t x) {
    std::size_t best = x == 0 ? 1 : 0;
    double highest = -std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < s.contenders.size(); ++i) {
      const double reach = s.contenders[i].reach;
      if (i != x && reach > highest) best = i, highest = reach;
    }
    return best;
  }

  const OwnershipProblem* problem_ = nullptr;
  std::vector<std::unique_ptr<State>> states_;
};

}  // namespace adamas::inline core
