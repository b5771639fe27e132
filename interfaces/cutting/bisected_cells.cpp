#include "interfaces/cutting/bisected_cells.h"

#include <algorithm>
#include <tuple>

#include "core/base/hash.h"
#include "core/geometry/convex_polyhedron.h"
#include "core/geometry/divider.h"
#include "core/geometry/tetrahedron.h"

namespace adamas::interfaces {

namespace {

/// Cells whose longest edge is shorter than this many tolerances are not bisected at given places.
constexpr double kSmallestCell = 2;
constexpr int kMostRounds = 24;
/// A part of a cell is small if its size, relative to the cell's, is less than this.
constexpr double kSmallPart = 0.8;
/// Changes of owner keep this distance from the ends of an edge, relative to its length, so that no cut has a
/// volume of zero.
constexpr double kMargin = 1e-3;

/// Sets `part` to the problem of a part of a tetrahedron, which is given by the weights of its corners.
void restrict_problem(const OwnershipProblem& whole, const std::array<Weights, 4>& corners,
                      OwnershipProblem& part) {
  part = whole;
  for (LinearFunction& f : part.functions) {
    const LinearFunction original = f;
    for (std::size_t c = 0; c < 4; ++c) f.values[c] = evaluate(original.values, corners[c]);
  }
}

}  // namespace

BisectedCells::BisectedCells(const ResampledMesh& mesh, double tolerance, Progress& progress)
    : mesh_(mesh),
      locator_(mesh),
      tolerance_(tolerance),
      points_(mesh.points),
      cells_at_(mesh.points.size()) {
  cells_.reserve(mesh.cells.size());
  for (std::uint32_t c = 0; c < mesh.cells.size(); ++c) {
    Cell cell{mesh.cells[c].vertices, c, {}};
    for (std::size_t i = 0; i < 4; ++i) {
      cell.corners[i][i] = 1;
      cells_at_[cell.vertices[i]].push_back(c);
    }
    cells_.push_back(cell);
  }
  is_bisected_.assign(cells_.size(), 0);
  find_owners();
  std::vector<std::uint32_t> wanted(cells_.size());
  for (std::uint32_t c = 0; c < wanted.size(); ++c) wanted[c] = c;
  bisect_where_needed(std::move(wanted), progress);
}

void BisectedCells::bisect_where_needed(std::vector<std::uint32_t> wanted, Progress& progress) {
  for (int round = 0; round < kMostRounds && !wanted.empty(); ++round) {
    const auto looked_at = static_cast<std::uint32_t>(cells_.size());
    for (std::size_t i = 0; i < wanted.size(); ++i) {
      const std::uint32_t c = wanted[i];
      if (i % 1024 == 0)
        progress.step("bisecting cells", static_cast<double>(i) / static_cast<double>(wanted.size()));
      if (is_bisected_[c] == 0 && needs_bisection(c)) bisect(c);
    }
    wanted.clear();
    for (std::uint32_t c = looked_at; c < cells_.size(); ++c) {
      if (is_bisected_[c] == 0) wanted.push_back(c);
    }
  }
  for (const std::uint32_t c : wanted) (void)needs_bisection(c);
}

bool BisectedCells::bisect_at(const std::vector<Vec3>& places, Progress& progress) {
  constexpr int kToHalfTheSize = 3;
  std::unordered_map<std::uint32_t, std::vector<std::uint32_t>> parts;  // by cell of the mesh
  for (std::uint32_t c = 0; c < cells_.size(); ++c) {
    if (is_bisected_[c] == 0 && problems_.contains(cells_[c].origin)) parts[cells_[c].origin].push_back(c);
  }
  const auto before = static_cast<std::uint32_t>(cells_.size());
  for (const Vec3& place : places) {
    progress.check();
    const auto origin = locator_.locate(place);
    if (!origin) continue;
    const auto found = parts.find(origin->cell);
    if (found == parts.end()) continue;
    auto& list = found->second;
    // This finds the part that holds the point. Children of parts that have been bisected meanwhile are not
    // in the list.
    std::uint32_t best = before;
    double greatest = -1e-9;
    for (const std::uint32_t c : list) {
      std::array<Vec3, 4> x;
      for (std::size_t i = 0; i < 4; ++i) x[i] = points_[cells_[c].vertices[i]];
      const Weights w = Tetrahedron(x).weights(place);
      const double least = std::min({w[0], w[1], w[2], w[3]});
      if (least > greatest) greatest = least, best = c;
    }
    if (best == before || is_bisected_[best] != 0 || !may_be_bisected(cells_[best])) continue;
    std::vector<std::uint32_t> inside{best};
    for (int step = 0; step < kToHalfTheSize; ++step) {
      const auto first = static_cast<std::uint32_t>(cells_.size());
      for (const std::uint32_t c : inside) {
        if (is_bisected_[c] == 0) bisect(c);
      }
      // Neighbours that have been bisected too are small enough already.
      inside.clear();
      for (auto c = first; c < cells_.size(); ++c) {
        if (is_bisected_[c] == 0 && cells_[c].origin == origin->cell) inside.push_back(c);
      }
    }
  }
  std::vector<std::uint32_t> added;
  for (auto c = before; c < cells_.size(); ++c) {
    if (is_bisected_[c] == 0) added.push_back(c);
  }
  const bool any = !added.empty();
  bisect_where_needed(std::move(added), progress);
  return any;
}

double BisectedCells::size(const Cell& cell) const {
  const auto [i, j] = longest_edge(cell);
  return distance(points_[cell.vertices[i]], points_[cell.vertices[j]]);
}

bool BisectedCells::may_be_bisected(const Cell& cell) const {
  return size(cell) >= kSmallestCell * tolerance_;
}

double BisectedCells::owner_change(std::uint32_t a, std::uint32_t b) const {
  const auto found = edges_.find(edge_key(a, b));
  return found == edges_.end() ? 0.5 : found->second.owner_change;
}

void BisectedCells::find_owners() {
  owners_.resize(points_.size());
  CellOwnership ownership;
  for (std::size_t c = 0; c < mesh_.cells.size(); ++c) {
    mesh_.ownership(c, ownership);
    for (std::size_t i = 0; i < 4; ++i) {
      BodyId& owner = owners_[mesh_.cells[c].vertices[i]];
      if (owner.valid()) continue;
      owner = BodyId(ownership.pure() ? ownership.problem.candidates[0].owner
                                      : ownership.problem.owner(cells_[c].corners[i]));
    }
    if (ownership.pure()) continue;
    drop_dominated(ownership.problem);
    keep_owners(ownership.problem);
    problems_.emplace(static_cast<std::uint32_t>(c), ownership.problem);
  }
}

BisectedCells::Edge BisectedCells::examine_edge(const OwnershipProblem& problem, const Cell& cell,
                                                std::size_t i, std::size_t j) const {
  if (cell.vertices[i] > cell.vertices[j]) std::swap(i, j);
  const Weights &from = cell.corners[i], &to = cell.corners[j];
  // Owners change only where two functions cross.
  std::vector<double> crossings{0, 1};
  for (std::size_t f = 0; f < problem.functions.size(); ++f) {
    const double f0 = evaluate(problem.functions[f].values, from),
                 f1 = evaluate(problem.functions[f].values, to);
    for (std::size_t g = 0; g < f; ++g) {
      const double d0 = f0 - evaluate(problem.functions[g].values, from),
                   d1 = f1 - evaluate(problem.functions[g].values, to);
      if ((d0 < 0) != (d1 < 0)) crossings.push_back(d0 / (d0 - d1));
    }
  }
  std::sort(crossings.begin(), crossings.end());
  const BodyId first = owners_[cell.vertices[i]], last = owners_[cell.vertices[j]];
  double first_ends = 0, last_begins = 1;
  std::vector<BodyId> pieces(crossings.size() - 1);
  for (std::size_t k = 0; k < pieces.size(); ++k)
    pieces[k] = BodyId(problem.owner(between(from, to, (crossings[k] + crossings[k + 1]) / 2)));
  for (std::size_t k = 0; k < pieces.size() && (pieces[k] == first || crossings[k] == crossings[k + 1]); ++k)
    first_ends = crossings[k + 1];
  for (std::size_t k = pieces.size(); k > 0 && (pieces[k - 1] == last || crossings[k - 1] == crossings[k]);
       --k)
    last_begins = crossings[k - 1];
  Edge edge;
  const double length = distance(points_[cell.vertices[i]], points_[cell.vertices[j]]);
  if (last_begins > first_ends) edge.hidden = (last_begins - first_ends) * length;
  if (first != last) edge.owner_change = std::clamp((first_ends + last_begins) / 2, kMargin, 1 - kMargin);
  return edge;
}

void BisectedCells::examine_edges(const Cell& cell) {
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = i + 1; j < 4; ++j) {
      const auto [entry, fresh] = edges_.try_emplace(edge_key(cell.vertices[i], cell.vertices[j]));
      if (fresh) entry->second = examine_edge(problem(cell), cell, i, j);
    }
  }
}

bool BisectedCells::hides_body(const Cell& cell) const {
  if (problem(cell).candidates.size() < 3) return false;
  thread_local OwnershipProblem part;
  restrict_problem(problem(cell), cell.corners, part);
  keep_owners(part);
  const auto owns_corner = [&](std::uint32_t body) {
    return std::any_of(cell.vertices.begin(), cell.vertices.end(),
                       [&](std::uint32_t v) { return owners_[v].value == body; });
  };
  if (std::all_of(part.candidates.begin(), part.candidates.end(),
                  [&](const auto& candidate) { return owns_corner(candidate.owner); }))
    return false;
  const double smallest = std::max(tolerance_, kSmallPart * size(cell));
  std::vector<ContactPolygon> contacts;
  contact_polygons(part, contacts);
  for (const auto& candidate : part.candidates) {
    if (owns_corner(candidate.owner)) continue;
    Box3 box;
    for (const ContactPolygon& polygon : contacts) {
      if (polygon.front != candidate.owner && polygon.back != candidate.owner) continue;
      for (const auto& corner : polygon.corners) {
        Vec3 p;
        for (std::size_t i = 0; i < 4; ++i) p += corner.weights[i] * points_[cell.vertices[i]];
        box.extend(p);
      }
    }
    if (box.min.x <= box.max.x && box.diagonal() > smallest) return true;
  }
  return false;
}

bool BisectedCells::touch(std::uint32_t origin, BodyId a, BodyId b) {
  const auto [entry, fresh] = contacts_.try_emplace(origin);
  if (fresh) {
    std::vector<ContactPolygon> polygons;
    contact_polygons(problems_.at(origin), polygons);
    for (const ContactPolygon& polygon : polygons)
      entry->second.push_back({std::min(polygon.front, polygon.back), std::max(polygon.front, polygon.back)});
  }
  const std::array<std::uint32_t, 2> pair{std::min(a, b).value, std::max(a, b).value};
  return std::find(entry->second.begin(), entry->second.end(), pair) != entry->second.end();
}

bool BisectedCells::needs_bisection(std::uint32_t c) {
  const Cell cell = cells_[c];
  if (!problems_.contains(cell.origin)) return false;
  examine_edges(cell);
  for (std::size_t a = 0; a < 4; ++a) {
    for (std::size_t b = a + 1; b < 4; ++b) {
      const std::uint32_t from = cell.vertices[a], to = cell.vertices[b];
      const double hidden = edges_.at(edge_key(from, to)).hidden;
      if (hidden <= tolerance_) continue;
      // A hidden layer would be torn if edges passed through it. But if the two bodies touch nearby, it is
      // only the tip of a third body, which has vertices elsewhere.
      const bool tip = owners_[from] != owners_[to] && touch(cell.origin, owners_[from], owners_[to]);
      if (!tip || hidden > kSmallPart * distance(points_[from], points_[to])) return true;
    }
  }
  return hides_body(cell);
}

std::array<std::size_t, 2> BisectedCells::longest_edge(const Cell& cell) const {
  std::array<std::size_t, 2> best{0, 1};
  std::tuple<double, std::uint64_t> greatest{-1, 0};
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = i + 1; j < 4; ++j) {
      const std::uint32_t a = std::min(cell.vertices[i], cell.vertices[j]),
                          b = std::max(cell.vertices[i], cell.vertices[j]);
      // Lengths and numbers are ordered equally in all cells round an edge.
      const std::tuple<double, std::uint64_t> length{squared_norm(points_[a] - points_[b]), edge_key(a, b)};
      if (length > greatest) greatest = length, best = {i, j};
    }
  }
  return best;
}

void BisectedCells::cells_at_edge(std::uint32_t a, std::uint32_t b,
                                  std::vector<std::uint32_t>& result) const {
  result.clear();
  std::set_intersection(cells_at_[a].begin(), cells_at_[a].end(), cells_at_[b].begin(), cells_at_[b].end(),
                        std::back_inserter(result));
}

void BisectedCells::bisect(std::uint32_t cell) {
  std::vector<std::uint32_t> round_edge;
  while (is_bisected_[cell] == 0) {
    const auto [i, j] = longest_edge(cells_[cell]);
    const std::uint32_t a = cells_[cell].vertices[i], b = cells_[cell].vertices[j];
    cells_at_edge(a, b, round_edge);
    // Cells with a longer edge are bisected first. Lengths grow from cell to cell, so the recursion ends.
    const auto longer = std::find_if(round_edge.begin(), round_edge.end(), [&](std::uint32_t other) {
      const auto [k, l] = longest_edge(cells_[other]);
      return edge_key(cells_[other].vertices[k], cells_[other].vertices[l]) != edge_key(a, b);
    });
    if (longer == round_edge.end()) {
      bisect_edge(a, b, round_edge);
    } else {
      bisect(*longer);
    }
  }
}

void BisectedCells::bisect_edge(std::uint32_t a, std::uint32_t b, const std::vector<std::uint32_t>& cells) {
  const auto middle = static_cast<std::uint32_t>(points_.size());
  points_.push_back(0.5 * (points_[a] + points_[b]));
  cells_at_.emplace_back();
  BodyId owner;
  for (const std::uint32_t c : cells) {
    const Cell parent = cells_[c];
    const auto i = static_cast<std::size_t>(std::find(parent.vertices.begin(), parent.vertices.end(), a) -
                                            parent.vertices.begin());
    const auto j = static_cast<std::size_t>(std::find(parent.vertices.begin(), parent.vertices.end(), b) -
                                            parent.vertices.begin());
    const Weights w = between(parent.corners[i], parent.corners[j], 0.5);
    // All corners of a cell of one body have its owner.
    if (!owner.valid()) {
      const auto found = problems_.find(parent.origin);
      owner = found == problems_.end() ? owners_[a] : BodyId(found->second.owner(w));
    }
    is_bisected_[c] = 1;
    for (const std::uint32_t v : parent.vertices) std::erase(cells_at_[v], c);
    for (const std::size_t replaced : {i, j}) {
      Cell child = parent;
      child.vertices[replaced] = middle;
      child.corners[replaced] = w;
      const auto number = static_cast<std::uint32_t>(cells_.size());
      for (const std::uint32_t v : child.vertices) cells_at_[v].push_back(number);
      cells_.push_back(child);
      is_bisected_.push_back(0);
    }
  }
  owners_.push_back(owner);
}

}  // namespace adamas::interfaces
