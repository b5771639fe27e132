#include "interfaces/cutting/labelled_mesh.h"

#include <algorithm>
#include <cmath>

namespace adamas::interfaces {

namespace {
constexpr std::uint32_t kFirstWall = 0xfffffff0u;  ///< numbers of the box's faces among sides
}

double least_dihedral_sine(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Vec3 ab = b - a, ac = c - a, ad = d - a, bc = c - b, bd = d - b, cd = d - c;
  const double volume = dot(cross(ab, ac), ad);
  const double face_a = norm(cross(bc, bd)), face_b = norm(cross(ac, ad)), face_c = norm(cross(ab, ad)),
               face_d = norm(cross(ab, ac));
  // The sine at an edge is 3/2 of the volume times its length, divided by the areas of the two faces there;
  // the doubled areas and the sixfold volume make the factor 1.
  const double least =
      std::min({norm(ab) / (face_c * face_d), norm(ac) / (face_b * face_d), norm(ad) / (face_b * face_c),
                norm(bc) / (face_a * face_d), norm(bd) / (face_a * face_c), norm(cd) / (face_a * face_b)});
  const double sine = volume * least;
  return std::isfinite(sine) ? sine : 0;
}

void LabelledMesh::Sides::add(std::uint32_t value) {
  std::size_t place = 0;
  while (place < count && values[place] < value) ++place;
  if (place < count && values[place] == value) return;
  if (count == values.size()) {
    overflow = true;
    return;
  }
  for (std::size_t i = count; i > place; --i) values[i] = values[i - 1];
  values[place] = value;
  ++count;
}

void LabelledMesh::Sides::add_walls(std::uint8_t walls) {
  for (unsigned bit = 0; bit < 6; ++bit) {
    if ((walls >> bit & 1u) != 0) add(kFirstWall + bit);
  }
}

std::size_t LabelledMesh::Sides::bodies() const {
  std::size_t bodies = 0;
  while (bodies < count && values[bodies] < kFirstWall) ++bodies;
  return bodies;
}

bool LabelledMesh::Sides::operator==(const Sides& other) const {
  return count == other.count && !overflow && !other.overflow &&
         std::equal(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(count),
                    other.values.begin());
}

std::uint32_t LabelledMesh::add_vertex(const Vec3& position, std::uint8_t walls) {
  Vec3& p = points_.emplace_back(position);
  for (int axis = 0; axis < 3; ++axis) {
    const unsigned ends = walls >> (2 * axis) & 3u;
    if (ends != 0) p[axis] = ends == 1 ? box_.min[axis] : box_.max[axis];
  }
  walls_.push_back(walls);
  cells_at_.emplace_back();
  return static_cast<std::uint32_t>(points_.size() - 1);
}

void LabelledMesh::link(std::uint32_t cell) {
  for (const std::uint32_t v : cells_[cell].vertices) cells_at_[v].push_back(cell);
  quality_[cell] = quality_of(cells_[cell].vertices);
}

void LabelledMesh::add_cell(const Tetrahedron& vertices, BodyId body) {
  std::uint32_t number = 0;
  if (unused_.empty()) {
    number = static_cast<std::uint32_t>(cells_.size());
    cells_.push_back({vertices, body});
    quality_.push_back(0);
  } else {
    number = unused_.back();
    unused_.pop_back();
    cells_[number] = {vertices, body};
  }
  link(number);
}

LabelledMesh::Sides LabelledMesh::sides(std::uint32_t v) const {
  Sides result;
  for (const std::uint32_t c : cells_at_[v]) result.add(cells_[c].body.value);
  result.add_walls(walls_[v]);
  return result;
}

LabelledMesh::Sides LabelledMesh::sides(std::uint32_t a, std::uint32_t b) const {
  Sides result;
  for (const std::uint32_t c : cells_at_[a]) {
    if (has_vertex(cells_[c].vertices, b)) result.add(cells_[c].body.value);
  }
  result.add_walls(walls_[a] & walls_[b]);
  return result;
}

void LabelledMesh::cells_at_edge(std::uint32_t a, std::uint32_t b, std::vector<std::uint32_t>& result) const {
  result.clear();
  for (const std::uint32_t c : cells_at_[a]) {
    if (has_vertex(cells_[c].vertices, b)) result.push_back(c);
  }
}

std::uint32_t LabelledMesh::neighbour(std::uint32_t cell, std::uint32_t v) const {
  std::array<std::uint32_t, 3> face{};
  std::size_t n = 0;
  for (const std::uint32_t w : cells_[cell].vertices) {
    if (w != v) face[n++] = w;
  }
  for (const std::uint32_t c : cells_at_[face[0]]) {
    if (c != cell && has_vertex(cells_[c].vertices, face[1]) && has_vertex(cells_[c].vertices, face[2]))
      return c;
  }
  return kNoNeighbour;
}

void LabelledMesh::interface_faces(std::uint32_t v, std::vector<InterfaceFace>& result) const {
  result.clear();
  for (const std::uint32_t c : cells_at_[v]) {
    const Cell& cell = cells_[c];
    for (const std::uint32_t opposite : cell.vertices) {
      if (opposite == v) continue;
      const std::uint32_t other = neighbour(c, opposite);
      if (other == kNoNeighbour || other < c || cells_[other].body == cell.body) continue;
      InterfaceFace face{};
      face.bodies.add(cell.body.value);
      face.bodies.add(cells_[other].body.value);
      std::size_t n = 0;
      for (const std::uint32_t w : cell.vertices) {
        if (w != v && w != opposite) face.ends[n++] = w;
      }
      result.push_back(face);
    }
  }
}

void LabelledMesh::replace(std::span<const std::uint32_t> removed, std::span<const Cell> added) {
  for (const std::uint32_t c : removed) {
    for (const std::uint32_t v : cells_[c].vertices) {
      auto& list = cells_at_[v];
      *std::find(list.begin(), list.end(), c) = list.back();
      list.pop_back();
    }
    cells_[c].body = BodyId();
    unused_.push_back(c);
  }
  for (const Cell& cell : added) add_cell(cell.vertices, cell.body);
}

void LabelledMesh::move(std::uint32_t v, const Vec3& position) {
  points_[v] = position;
  for (const std::uint32_t c : cells_at_[v]) quality_[c] = quality_of(cells_[c].vertices);
}

ConformingMesh LabelledMesh::finish() const {
  ConformingMesh mesh;
  std::vector<std::uint32_t> number(points_.size(), 0xffffffffu);
  for (const Cell& cell : cells_) {
    if (!cell.body.valid()) continue;
    Tetrahedron t = cell.vertices;
    for (std::uint32_t& v : t) {
      if (number[v] == 0xffffffffu) {
        number[v] = static_cast<std::uint32_t>(mesh.points.size());
        mesh.points.push_back(points_[v]);
      }
      v = number[v];
    }
    mesh.tetrahedra.push_back(t);
    mesh.bodies.push_back(cell.body);
  }
  return mesh;
}

}  // namespace adamas::interfaces
