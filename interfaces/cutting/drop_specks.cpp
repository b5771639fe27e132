#include <algorithm>
#include <map>

#include "core/base/disjoint_sets.h"
#include "interfaces/cutting/cutting_steps.h"

namespace adamas::interfaces {

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

/// The body that has most of a piece's border; none where all of it lies on the box.
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

}  // namespace adamas::interfaces
