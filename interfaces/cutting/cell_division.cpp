#include "interfaces/cutting/cell_division.h"

#include <Eigen/Dense>
#include <algorithm>
#include <map>

#include "core/base/hash.h"
#include "core/geometry/divider.h"
#include "interfaces/network/domain_faces.h"

namespace adamas::interfaces {

namespace {

using Tetrahedron = LabelledMesh::Tetrahedron;

/// The least weight of a corner at a point where bodies meet; it keeps the point away from the border of its
/// face or cell.
constexpr double kMargin = 1e-3;

/// Returns the function of a body that is least at a point; null if the body is no candidate.
const LinearFunction* active_function(const OwnershipProblem& problem, BodyId body, const Weights& w) {
  for (const auto& candidate : problem.candidates) {
    if (candidate.owner != body.value) continue;
    const LinearFunction* best = &problem.functions[candidate.first];
    for (std::uint32_t f = 1; f < candidate.count; ++f) {
      const LinearFunction& other = problem.functions[candidate.first + f];
      if (evaluate(other.values, w) < evaluate(best->values, w)) best = &other;
    }
    return best;
  }
  return nullptr;
}

/// The tolerance for points of the mesh on a face of the box, relative to the box's diagonal.
constexpr double kOnWall = 1e-12;

/// The corners of a face or of a whole cell, and their owners.
struct Meeting {
  std::size_t count;
  std::array<std::size_t, 4> corners;  ///< corners of the cell
  std::array<BodyId, 4> owners;
};

class Division {
 public:
  explicit Division(const BisectedCells& cells) : cells_(cells), result_(cells.mesh().box) {
    for (const Vec3& p : cells.points()) result_.add_vertex(p, domain_faces_at(cells.mesh().box, p, kOnWall));
  }

  LabelledMesh finish() {
    for (std::size_t c = 0; c < cells_.cells().size(); ++c) {
      if (cells_.is_leaf(c)) divide(cells_.cells()[c]);
    }
    return std::move(result_);
  }

 private:
  BodyId owner(std::uint32_t v) const { return cells_.owners()[v]; }

  std::uint32_t cut(std::uint32_t a, std::uint32_t b) {
    const auto [entry, fresh] = cuts_.try_emplace(edge_key(a, b), 0);
    if (fresh) {
      const double t = cells_.owner_change(a, b);
      const Vec3 &from = result_.point(std::min(a, b)), &to = result_.point(std::max(a, b));
      entry->second = result_.add_vertex((1 - t) * from + t * to, result_.walls(a) & result_.walls(b));
    }
    return entry->second;
  }

  /// Returns the weight of corner j at the point where the edge from corner i changes its owner.
  double owner_change(const BisectedCells::Cell& cell, std::size_t i, std::size_t j) const {
    const double t = cells_.owner_change(cell.vertices[i], cell.vertices[j]);
    return cell.vertices[i] < cell.vertices[j] ? t : 1 - t;
  }

  /// Returns the point where the bodies that own the corners meet, as weights of the corners: the solution of
  /// the equations of their functions or, if that is not inside, the mean of the cuts.
  std::array<double, 4> meeting_point(const BisectedCells::Cell& cell, const Meeting& meeting) {
    std::array<double, 4> middle{};
    const double pairs = static_cast<double>(meeting.count * (meeting.count - 1)) / 2;
    for (std::size_t i = 0; i < meeting.count; ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        const double t = owner_change(cell, meeting.corners[i], meeting.corners[j]);
        middle[i] += (1 - t) / pairs;
        middle[j] += t / pairs;
      }
    }
    std::array<double, 4> weights = middle;
    for (int iteration = 0; iteration < 8; ++iteration) {
      if (!step_to_meeting(cell, meeting, weights)) return middle;
    }
    const double least =
        *std::min_element(weights.begin(), weights.begin() + static_cast<std::ptrdiff_t>(meeting.count));
    return least > kMargin ? weights : middle;
  }

  /// Solves the equations of the functions that are least at the point; returns whether there is a solution.
  bool step_to_meeting(const BisectedCells::Cell& cell, const Meeting& meeting,
                       std::array<double, 4>& weights) const {
    const std::size_t n = meeting.count;
    Weights at{};
    for (std::size_t k = 0; k < n; ++k) {
      for (std::size_t c = 0; c < 4; ++c) at[c] += weights[k] * cell.corners[meeting.corners[k]][c];
    }
    std::array<const LinearFunction*, 4> functions{};
    for (std::size_t k = 0; k < n; ++k) {
      functions[k] = active_function(cells_.problem(cell), meeting.owners[k], at);
      if (functions[k] == nullptr) return false;
    }
    const auto size = static_cast<Eigen::Index>(n);
    Eigen::Matrix4d system = Eigen::Matrix4d::Zero();
    Eigen::Vector4d right = Eigen::Vector4d::Zero();
    for (std::size_t k = 0; k < n; ++k) {
      const Weights& corner = cell.corners[meeting.corners[k]];
      const auto column = static_cast<Eigen::Index>(k);
      system(0, column) = 1;
      for (std::size_t row = 1; row < n; ++row)
        system(static_cast<Eigen::Index>(row), column) =
            evaluate(functions[row]->values, corner) - evaluate(functions[0]->values, corner);
    }
    right(0) = 1;
    const Eigen::VectorXd solution = system.topLeftCorner(size, size).fullPivLu().solve(right.head(size));
    for (std::size_t k = 0; k < n; ++k) {
      weights[k] = solution(static_cast<Eigen::Index>(k));
      if (!std::isfinite(weights[k]) || std::abs(weights[k]) > 10) return false;
    }
    return true;
  }

  std::uint32_t add_meeting(const BisectedCells::Cell& cell, const Meeting& meeting) {
    const std::array<double, 4> weights = meeting_point(cell, meeting);
    Vec3 p;
    unsigned walls = 0x3f;
    for (std::size_t k = 0; k < meeting.count; ++k) {
      const std::uint32_t v = cell.vertices[meeting.corners[k]];
      p += weights[k] * result_.point(v);
      walls &= result_.walls(v);
    }
    return result_.add_vertex(p, static_cast<std::uint8_t>(walls));
  }

  /// Returns the point where three bodies meet on the face of three corners.
  std::uint32_t junction(const BisectedCells::Cell& cell, std::array<std::size_t, 3> corners) {
    std::sort(corners.begin(), corners.end(),
              [&](std::size_t i, std::size_t j) { return cell.vertices[i] < cell.vertices[j]; });
    std::array<std::uint32_t, 3> key{};
    Meeting meeting{3, {}, {}};
    for (std::size_t k = 0; k < 3; ++k) {
      key[k] = cell.vertices[corners[k]];
      meeting.corners[k] = corners[k];
      meeting.owners[k] = owner(key[k]);
    }
    const auto [entry, fresh] = junctions_.try_emplace(key, 0);
    if (fresh) entry->second = add_meeting(cell, meeting);
    return entry->second;
  }

  void add(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d, BodyId body) {
    Tetrahedron t{a, b, c, d};
    if (signed_volume(result_.point(a), result_.point(b), result_.point(c), result_.point(d)) < 0)
      std::swap(t[2], t[3]);
    result_.add_cell(t, body);
  }

  void divide(const BisectedCells::Cell& cell) {
    // Corners are ordered by their numbers, so that a face is divided equally from both of its sides.
    std::array<std::size_t, 4> order{0, 1, 2, 3};
    std::sort(order.begin(), order.end(),
              [&](std::size_t i, std::size_t j) { return cell.vertices[i] < cell.vertices[j]; });
    // Corners of one owner are placed side by side: those of the owner of most corners come first.
    const auto owner_at = [&](std::size_t i) { return owner(cell.vertices[i]); };
    const auto like = [&](std::size_t i) {
      return std::count_if(order.begin(), order.end(),
                           [&](std::size_t j) { return owner_at(i) == owner_at(j); });
    };
    std::array<std::size_t, 4> c = order;
    std::stable_sort(c.begin(), c.end(), [&](std::size_t i, std::size_t j) {
      return like(i) != like(j) ? like(i) > like(j) : false;
    });
    const auto v = [&](std::size_t i) { return cell.vertices[c[i]]; };
    if (like(c[0]) == 4) return result_.add_cell(cell.vertices, owner(v(0)));
    if (like(c[0]) == 3) return divide_three_and_one(v(0), v(1), v(2), v(3));
    if (like(c[0]) == 1) return divide_four(cell);
    if (like(c[2]) == 1) return divide_two_and_two_others(cell, c);
    // If two owners have two corners each, the second corner of the first owner comes next.
    if (owner_at(c[1]) != owner_at(c[0])) std::swap(c[1], owner_at(c[2]) == owner_at(c[0]) ? c[2] : c[3]);
    if (v(2) > v(3)) std::swap(c[2], c[3]);
    divide_two_and_two(v(0), v(1), v(2), v(3));
  }

  /// Divides a cell whose corners a < b < c have one owner and d another: the prism becomes three tetrahedra,
  /// with the diagonals from the vertices of lower number.
  void divide_three_and_one(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    const std::uint32_t ad = cut(a, d), bd = cut(b, d), cd = cut(c, d);
    add(d, ad, bd, cd, owner(d));
    add(a, b, c, cd, owner(a));
    add(a, b, bd, cd, owner(a));
    add(a, ad, bd, cd, owner(a));
  }

  /// Divides a cell whose corners a < b have one owner, and c < d another.
  void divide_two_and_two(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    const std::uint32_t ac = cut(a, c), ad = cut(a, d), bc = cut(b, c), bd = cut(b, d);
    // The interface is divided along its shorter diagonal.
    const bool straight = squared_norm(result_.point(ac) - result_.point(bd)) <=
                          squared_norm(result_.point(ad) - result_.point(bc));
    const std::array<std::array<std::uint32_t, 3>, 2> faces =
        straight ? std::array<std::array<std::uint32_t, 3>, 2>{{{ac, bc, bd}, {ac, bd, ad}}}
                 : std::array<std::array<std::uint32_t, 3>, 2>{{{ac, bc, ad}, {bc, bd, ad}}};
    for (const auto& f : faces) {
      add(a, f[0], f[1], f[2], owner(a));
      add(c, f[0], f[1], f[2], owner(c));
    }
    add(a, b, bc, bd, owner(a));
    add(c, d, ad, bd, owner(c));
  }

  /// Divides a cell whose corners 0 and 1, in the order of their numbers, have one owner; the other two have
  /// one each.
  void divide_two_and_two_others(const BisectedCells::Cell& cell, const std::array<std::size_t, 4>& corners) {
    const std::uint32_t a = cell.vertices[corners[0]], b = cell.vertices[corners[1]],
                        c = cell.vertices[corners[2]], d = cell.vertices[corners[3]];
    const std::uint32_t ac = cut(a, c), ad = cut(a, d), bc = cut(b, c), bd = cut(b, d), cd = cut(c, d);
    const std::uint32_t first = junction(cell, {corners[0], corners[2], corners[3]}),
                        second = junction(cell, {corners[1], corners[2], corners[3]});
    // These are the parts at c and at d, and those between them.
    for (const auto& [tip, near, far] : {std::array{c, ac, bc}, std::array{d, ad, bd}}) {
      add(tip, near, far, second, owner(tip));
      add(tip, near, second, first, owner(tip));
      add(tip, cd, first, second, owner(tip));
      add(a, near, far, second, owner(a));
      add(a, near, second, first, owner(a));
      add(a, b, far, second, owner(a));
    }
  }

  void divide_four(const BisectedCells::Cell& cell) {
    Meeting meeting{4, {0, 1, 2, 3}, {}};
    for (std::size_t i = 0; i < 4; ++i) meeting.owners[i] = owner(cell.vertices[i]);
    const std::uint32_t middle = add_meeting(cell, meeting);
    for (std::size_t i = 0; i < 4; ++i) {
      const std::uint32_t a = cell.vertices[i];
      for (std::size_t j = 0; j < 4; ++j) {
        for (std::size_t k = 0; k < 4; ++k) {
          if (i == j || j == k || k == i) continue;
          add(a, cut(a, cell.vertices[j]), junction(cell, {i, j, k}), middle, owner(a));
        }
      }
    }
  }

  const BisectedCells& cells_;
  LabelledMesh result_;
  std::unordered_map<std::uint64_t, std::uint32_t> cuts_;
  std::map<std::array<std::uint32_t, 3>, std::uint32_t> junctions_;
};

}  // namespace

LabelledMesh divide_cells(const BisectedCells& cells) { return Division(cells).finish(); }

}  // namespace adamas::interfaces
