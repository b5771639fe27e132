#include <algorithm>
#include <bit>

#include "interfaces/cutting/local_changes.h"

namespace adamas::interfaces {

namespace {

/// Sets of corners of a cell as bits: its vertices, edges and faces.
constexpr std::array<unsigned, 14> kSimplices{1, 2, 4, 8, 3, 5, 6, 9, 10, 12, 7, 11, 13, 14};
constexpr std::size_t kMostLabels = 8;

/// For each label round a cell, a body or a side of the box, the simplices of the cell that lie in another
/// cell of that label.
struct Contacts {
  std::array<std::uint32_t, kMostLabels> labels;
  std::array<std::array<bool, 16>, kMostLabels> touches{};  ///< by set of corners
  std::size_t count = 0;

  std::size_t number(std::uint32_t label) {
    for (std::size_t i = 0; i < count; ++i) {
      if (labels[i] == label) return i;
    }
    if (count == kMostLabels) return kMostLabels;
    labels[count] = label;
    return count++;
  }
  void touch(std::size_t label, unsigned corners) {
    for (const unsigned s : kSimplices) {
      if ((s & ~corners) == 0) touches[label][s] = true;
    }
  }
};

bool find_contacts(const LabelledMesh& mesh, std::uint32_t cell, Contacts& contacts) {
  const auto& v = mesh.cell(cell).vertices;
  for (std::size_t i = 0; i < 4; ++i) {
    for (const std::uint32_t c : mesh.star(v[i])) {
      if (c == cell) continue;
      unsigned corners = 0;
      for (std::size_t k = 0; k < 4; ++k) {
        if (LabelledMesh::has(mesh.cell(c).vertices, v[k])) corners |= 1u << k;
      }
      const std::size_t label = contacts.number(mesh.cell(c).body.value);
      if (label == kMostLabels) return false;
      contacts.touch(label, corners);
    }
  }
  // Beyond each side of the box there is a body of its own.
  constexpr std::uint32_t kFirstSide = 0xfffffff0u;
  for (std::uint32_t side = 0; side < 6; ++side) {
    unsigned corners = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      if ((mesh.walls(v[k]) >> side & 1u) != 0) corners |= 1u << k;
    }
    if (corners == 0) continue;
    const std::size_t label = contacts.number(kFirstSide + side);
    if (label == kMostLabels) return false;
    contacts.touch(label, corners);
  }
  return true;
}

/// Whether the simplices of a cell that touch any of the labels are one piece without a hole.
bool is_contractible(const Contacts& contacts, unsigned labels) {
  std::array<bool, 16> in{};
  for (std::size_t i = 0; i < contacts.count; ++i) {
    if ((labels >> i & 1u) == 0) continue;
    for (const unsigned s : kSimplices) in[s] = in[s] || contacts.touches[i][s];
  }
  int euler = 0;
  unsigned vertices = 0;
  for (const unsigned s : kSimplices) {
    if (!in[s]) continue;
    euler += std::popcount(s) == 2 ? -1 : 1;
    vertices |= s;
  }
  if (euler != 1) return false;
  unsigned reached = vertices & (0u - vertices);
  for (unsigned before = 0; before != reached;) {
    before = reached;
    for (const unsigned s : kSimplices) {
      if (in[s] && (s & reached) != 0) reached |= s;
    }
  }
  return reached == vertices;
}

/// Whether what would become the border of the cell's new body may be there.
bool is_near_target(const LabelledMesh& mesh, const InterfaceTarget& target, std::uint32_t cell,
                    BodyId body) {
  const auto& v = mesh.cell(cell).vertices;
  for (const std::uint32_t opposite : v) {
    const std::uint32_t other = mesh.neighbour(cell, opposite);
    if (other == kNoNeighbour || mesh.cell(other).body == body) continue;
    LabelledMesh::Sides pair;
    pair.add(body.value);
    pair.add(mesh.cell(other).body.value);
    Vec3 sum;
    for (const std::uint32_t w : v) {
      if (w == opposite) continue;
      sum += mesh.point(w);
      if (!target.allows(pair, mesh.point(w))) return false;
    }
    if (!target.allows(pair, (1.0 / 3) * sum)) return false;
  }
  return true;
}

}  // namespace

bool may_change_body(const LabelledMesh& mesh, const InterfaceTarget& target, std::uint32_t cell,
                     BodyId body) {
  Contacts contacts;
  if (!find_contacts(mesh, cell, contacts)) return false;
  const std::size_t from = contacts.number(mesh.cell(cell).body.value), to = contacts.number(body.value);
  if (from == kMostLabels || to == kMostLabels) return false;
  // Unions with the one and without the other, and what is outside of them.
  const unsigned all = (1u << contacts.count) - 1;
  for (unsigned labels = 0; labels <= all; ++labels) {
    if ((labels >> from & 1u) == (labels >> to & 1u)) continue;
    if (!is_contractible(contacts, labels)) return false;
  }
  return is_near_target(mesh, target, cell, body);
}

}  // namespace adamas::interfaces
