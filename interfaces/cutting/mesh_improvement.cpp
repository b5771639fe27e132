#include "interfaces/cutting/mesh_improvement.h"

#include <algorithm>
#include <limits>
#include <map>

#include "core/base/disjoint_sets.h"
#include "core/base/parallel.h"
#include "core/base/sort_unique.h"
#include "interfaces/cutting/local_changes.h"

namespace adamas::interfaces {

namespace {

constexpr int kSweeps = 3;
/// Vertices do not move by less than this part of the tolerance.
constexpr double kLeastMove = 1e-3;
/// The cells round a moving vertex keep kKeptQuality of their least quality, or have kGoodQuality.
constexpr double kKeptQuality = 0.3, kGoodQuality = 0.1;

}  // namespace

void snap_vertices(LabelledMesh& mesh, const InterfaceTarget& target) {
  struct Snap {
    std::uint32_t vertex;
    LabelledMesh::Sides sides;
    Vec3 step;  ///< the way to its place, within its walls; zero if the vertex stays
  };
  std::vector<Snap> snaps;
  for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
    const auto sides = mesh.sides(v);
    if (sides.bodies() > 1) snaps.push_back({v, sides, {}});
  }
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    parallel_for(snaps.size(), 512, [&](std::size_t i) {
      Snap& snap = snaps[i];
      const Vec3& p = mesh.point(snap.vertex);
      const auto goal = target.closest(snap.sides, p, longest_edge(mesh, snap.vertex));
      snap.step = goal ? *goal - p : Vec3{};
      for (int axis = 0; axis < 3; ++axis) {
        if ((mesh.walls(snap.vertex) >> (2 * axis) & 3u) != 0) snap.step[axis] = 0;
      }
      if (norm(snap.step) < kLeastMove * target.tolerance()) snap.step = {};
    });
    std::erase_if(snaps, [](const Snap& snap) { return snap.step == Vec3{}; });
    for (const Snap& snap : snaps) {
      const std::uint32_t v = snap.vertex;
      const Vec3 p = mesh.point(v);
      const double bound = std::min(kGoodQuality, kKeptQuality * least_quality(mesh, mesh.star(v)));
      for (const double part : {1.0, 0.6, 0.3}) {
        const Vec3 q = p + part * snap.step;
        if (quality_at(mesh, v, q, bound) <= bound) continue;
        mesh.move(v, q);
        break;
      }
    }
  }
}

namespace {

struct Piece {
  BodyId body;
  std::vector<std::uint32_t> cells;
  double volume = 0;
  Box3 box;
};

std::vector<Piece> find_pieces(const LabelledMesh& mesh) {
  DisjointSets sets(mesh.cell_count());
  for (std::uint32_t c = 0; c < mesh.cell_count(); ++c) {
    if (!mesh.is_alive(c)) continue;
    for (const std::uint32_t v : mesh.cell(c).vertices) {
      const std::uint32_t other = mesh.neighbour(c, v);
      if (other != kNoNeighbour && other < c && mesh.cell(other).body == mesh.cell(c).body)
        sets.join(c, other);
    }
  }
  std::map<std::uint32_t, Piece> pieces;
  for (std::uint32_t c = 0; c < mesh.cell_count(); ++c) {
    if (!mesh.is_alive(c)) continue;
    Piece& piece = pieces[sets.find(c)];
    const auto& v = mesh.cell(c).vertices;
    piece.body = mesh.cell(c).body;
    piece.cells.push_back(c);
    piece.volume += signed_volume(mesh.point(v[0]), mesh.point(v[1]), mesh.point(v[2]), mesh.point(v[3]));
    for (const std::uint32_t w : v) piece.box.extend(mesh.point(w));
  }
  std::vector<Piece> result;
  for (auto& [root, piece] : pieces) result.push_back(std::move(piece));
  std::stable_sort(result.begin(), result.end(),
                   [](const Piece& a, const Piece& b) { return a.volume < b.volume; });
  return result;
}

/// Returns the body that has most of a piece's border; none if all of it lies on the box.
BodyId surrounding_body(const LabelledMesh& mesh, const Piece& piece) {
  std::map<BodyId, double> areas;
  for (const std::uint32_t c : piece.cells) {
    for (const std::uint32_t v : mesh.cell(c).vertices) {
      const std::uint32_t other = mesh.neighbour(c, v);
      if (other == kNoNeighbour || mesh.cell(other).body == piece.body) continue;
      std::array<Vec3, 3> face;
      std::size_t n = 0;
      for (const std::uint32_t w : mesh.cell(c).vertices) {
        if (w != v) face[n++] = mesh.point(w);
      }
      areas[mesh.cell(other).body] += norm(cross(face[1] - face[0], face[2] - face[0]));
    }
  }
  const auto greatest = std::max_element(areas.begin(), areas.end(),
                                         [](const auto& a, const auto& b) { return a.second < b.second; });
  return greatest == areas.end() ? BodyId() : greatest->first;
}

}  // namespace

void drop_specks(LabelledMesh& mesh, const IdVector<BodyId, BodyTopology>& wanted, double size) {
  const std::vector<Piece> pieces = find_pieces(mesh);
  IdVector<BodyId, std::size_t> count(wanted.size(), 0);
  for (const Piece& piece : pieces) ++count[piece.body];
  for (const Piece& piece : pieces) {
    if (count[piece.body] <= std::max<std::size_t>(wanted[piece.body].pieces, 1)) continue;
    if (piece.box.diagonal() > size) continue;
    const BodyId body = surrounding_body(mesh, piece);
    if (!body.valid()) continue;
    for (const std::uint32_t c : piece.cells) mesh.set_body(c, body);
    --count[piece.body];
  }
}

namespace {

constexpr int kMostPasses = 12;
/// If a pass leaves more bad cells than an earlier one, by this part of all cells, the improvement ends, as
/// divisions make more bad cells than are mended.
constexpr double kManyMore = 0.02;

class Improvement {
 public:
  Improvement(LabelledMesh& mesh, const InterfaceTarget& target, double wanted, Progress& progress)
      : mesh_(mesh), target_(target), wanted_(wanted), progress_(progress) {}

  bool run() {
    std::size_t fewest = std::numeric_limits<std::size_t>::max();
    for (int pass = 0; pass < kMostPasses; ++pass) {
      const std::vector<std::uint32_t> bad = bad_cells();
      if (bad.empty()) return true;
      fewest = std::min(fewest, bad.size());
      if (static_cast<double>(bad.size() - fewest) > kManyMore * static_cast<double>(mesh_.alive_count()))
        return false;
      std::size_t changed = 0;
      for (std::size_t i = 0; i < bad.size(); ++i) {
        if (i % 1024 == 0)
          progress_.step("improving the cut mesh", static_cast<double>(i) / static_cast<double>(bad.size()));
        const std::uint32_t c = bad[i];
        if (mesh_.is_alive(c) && mesh_.quality(c) < wanted_ && improve(c)) ++changed;
      }
      if (changed == 0) break;
    }
    return true;
  }

 private:
  /// Returns the cells below the wanted quality, worst first.
  std::vector<std::uint32_t> bad_cells() const {
    std::vector<std::uint32_t> bad;
    for (std::uint32_t c = 0; c < mesh_.cell_count(); ++c) {
      if (mesh_.is_alive(c) && mesh_.quality(c) < wanted_) bad.push_back(c);
    }
    std::sort(bad.begin(), bad.end(), [&](std::uint32_t x, std::uint32_t y) {
      return mesh_.quality(x) != mesh_.quality(y) ? mesh_.quality(x) < mesh_.quality(y) : x < y;
    });
    return bad;
  }

  void keep_if_better() {
    if (!has_best_ || change_.quality > best_.quality) {
      std::swap(change_, best_);
      has_best_ = true;
    }
  }

  /// Makes the best change of the cell's edges and faces; if there is none, moves its vertices.
  bool improve(std::uint32_t c) {
    const LabelledMesh::Tetrahedron v = mesh_.cell(c).vertices;
    has_best_ = false;
    for (std::size_t i = 0; i < 4; ++i) {
      const double before = least_quality(mesh_, mesh_.star(v[i]));
      for (std::size_t j = 0; j < 4; ++j) {
        if (i != j && collapse_edge(mesh_, target_, v[i], v[j], before, change_)) keep_if_better();
      }
    }
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t j = i + 1; j < 4; ++j) {
        if (remove_edge(mesh_, target_, v[i], v[j], change_)) keep_if_better();
      }
      if (remove_face(mesh_, c, v[i], change_)) keep_if_better();
    }
    if (has_best_) {
      mesh_.replace(best_.removed, best_.added);
      return true;
    }
    bool moved = false;
    for (const std::uint32_t vertex : v) {
      if (smooth_vertex(mesh_, target_, vertex)) moved = true;
    }
    return moved || give_to_neighbour(c) || split(v);
  }

  /// Gives the cell to another body if that makes a change possible.
  bool give_to_neighbour(std::uint32_t c) {
    if (is_trying_body_) return false;
    const LabelledMesh::Cell cell = mesh_.cell(c);
    is_trying_body_ = true;
    for (const std::uint32_t v : cell.vertices) {
      const std::uint32_t other = mesh_.neighbour(c, v);
      if (other == kNoNeighbour || mesh_.cell(other).body == cell.body) continue;
      const BodyId body = mesh_.cell(other).body;
      if (!may_change_body(mesh_, target_, c, body)) continue;
      mesh_.set_body(c, body);
      if (improve(c)) return is_trying_body_ = false, true;
      mesh_.set_body(c, cell.body);
    }
    return is_trying_body_ = false;
  }

  /// Divides the cells at one of the cell's edges in the best way.
  bool split(const LabelledMesh::Tetrahedron& v) {
    if (is_trying_body_) return false;
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t j = i + 1; j < 4; ++j) {
        if (split_edge(mesh_, v[i], v[j], change_)) keep_if_better();
      }
    }
    if (!has_best_) return false;
    mesh_.add_vertex(best_.point, best_.walls);
    mesh_.replace(best_.removed, best_.added);
    return true;
  }

  LabelledMesh& mesh_;
  const InterfaceTarget& target_;
  double wanted_;
  Progress& progress_;
  LocalChange change_, best_;
  bool has_best_ = false;
  bool is_trying_body_ = false;  ///< whether a cell's body has been changed tentatively
};

/// Finds the vertices that share a cell with v, each once, in ascending order.
void find_vertices_round(const LabelledMesh& mesh, std::uint32_t v, std::vector<std::uint32_t>& result) {
  result.clear();
  for (const std::uint32_t c : mesh.star(v)) {
    for (const std::uint32_t w : mesh.cell(c).vertices) {
      if (w != v) result.push_back(w);
    }
  }
  sort_unique(result);
}

}  // namespace

void coarsen_mesh(LabelledMesh& mesh, const InterfaceTarget& target, std::uint32_t first,
                  double least_quality, Progress& progress) {
  constexpr int kMostCoarsenings = 6;
  LocalChange change, best;
  std::vector<std::uint32_t> neighbours;
  for (int pass = 0; pass < kMostCoarsenings; ++pass) {
    std::size_t collapsed = 0;
    for (std::uint32_t v = first; v < mesh.vertex_count(); ++v) {
      if (v % 1024 == 0) progress.step("coarsening the cut mesh", -1);
      best.quality = least_quality;
      find_vertices_round(mesh, v, neighbours);
      bool found = false;
      for (const std::uint32_t w : neighbours) {
        if (!collapse_edge(mesh, target, v, w, best.quality, change)) continue;
        std::swap(change, best);
        found = true;
      }
      if (!found) continue;
      mesh.replace(best.removed, best.added);
      ++collapsed;
    }
    if (collapsed == 0) return;
  }
}

bool improve_mesh(LabelledMesh& mesh, const InterfaceTarget& target, double wanted, Progress& progress) {
  return Improvement(mesh, target, wanted, progress).run();
}

}  // namespace adamas::interfaces
