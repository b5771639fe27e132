#include <algorithm>
#include <limits>

#include "interfaces/cutting/cutting_steps.h"
#include "interfaces/cutting/local_changes.h"

namespace adamas::interfaces {

namespace {

constexpr int kMostPasses = 12;
/// Where a pass leaves more bad cells than an earlier one did, by this part of all cells, divisions make them
/// faster than they go.
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
  /// The cells below what is wanted, worst first.
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

  /// Makes the best change of the cell's edges and faces, or else moves its vertices.
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
    return moved || give_away(c) || split(v);
  }

  /// Gives the cell to another body, if that helps.
  bool give_away(std::uint32_t c) {
    if (giving_away_) return false;
    const LabelledMesh::Cell cell = mesh_.cell(c);
    giving_away_ = true;
    for (const std::uint32_t v : cell.vertices) {
      const std::uint32_t other = mesh_.neighbour(c, v);
      if (other == kNoNeighbour || mesh_.cell(other).body == cell.body) continue;
      const BodyId body = mesh_.cell(other).body;
      if (!may_change_body(mesh_, target_, c, body)) continue;
      mesh_.set_body(c, body);
      if (improve(c)) return giving_away_ = false, true;
      mesh_.set_body(c, cell.body);
    }
    return giving_away_ = false;
  }

  /// Makes the best division at an edge of the cell.
  bool split(const LabelledMesh::Tetrahedron& v) {
    if (giving_away_) return false;
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
  bool giving_away_ = false;  ///< a cell's body has been changed, to see whether that helps
};

/// Finds the vertices that share a cell with v, each once, in ascending order.
void find_vertices_round(const LabelledMesh& mesh, std::uint32_t v, std::vector<std::uint32_t>& result) {
  result.clear();
  for (const std::uint32_t c : mesh.star(v)) {
    for (const std::uint32_t w : mesh.cell(c).vertices) {
      if (w != v) result.push_back(w);
    }
  }
  std::sort(result.begin(), result.end());
  result.erase(std::unique(result.begin(), result.end()), result.end());
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
