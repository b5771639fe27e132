#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "adamas/geometry.h"
#include "core/base/typed_id.h"
#include "interfaces/mesh/conforming_mesh.h"

namespace adamas::interfaces {

/// Returns the least sine of the angles between two faces of a tetrahedron: 0.943 for a regular one, 0 for a
/// flat one, negative for an inverted one.
double least_dihedral_sine(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

/// A conforming tetrahedral mesh of a box that can be changed locally. Each tetrahedron belongs to one body.
class LabelledMesh {
 public:
  using Tetrahedron = std::array<std::uint32_t, 4>;  ///< positively oriented
  struct Cell {
    Tetrahedron vertices;
    BodyId body;
  };

  explicit LabelledMesh(const Box3& box) : box_(box) {}

  /// Adds a vertex and returns its number. `walls`: bits of the faces of the box on which it lies: 1 and 2
  /// for least and greatest x, 4 and 8 for y, 16 and 32 for z. The vertex is moved onto them exactly.
  std::uint32_t add_vertex(const Vec3& position, std::uint8_t walls);
  void add_cell(const Tetrahedron& vertices, BodyId body);

  [[nodiscard]] const Vec3& point(std::uint32_t v) const { return points_[v]; }
  [[nodiscard]] std::uint8_t walls(std::uint32_t v) const { return walls_[v]; }
  [[nodiscard]] std::size_t vertex_count() const { return points_.size(); }
  /// Returns the count of cell numbers, including unused ones, for which is_alive() is false.
  [[nodiscard]] std::size_t cell_count() const { return cells_.size(); }
  [[nodiscard]] std::size_t alive_count() const { return cells_.size() - unused_.size(); }
  [[nodiscard]] bool is_alive(std::uint32_t cell) const { return cells_[cell].body.valid(); }
  [[nodiscard]] const Cell& cell(std::uint32_t c) const { return cells_[c]; }
  /// Returns the cells round a vertex, in an arbitrary order.
  [[nodiscard]] std::span<const std::uint32_t> star(std::uint32_t v) const { return cells_at_[v]; }
  [[nodiscard]] double quality(std::uint32_t cell) const { return quality_[cell]; }
  [[nodiscard]] double quality_of(const Tetrahedron& t) const {
    return least_dihedral_sine(points_[t[0]], points_[t[1]], points_[t[2]], points_[t[3]]);
  }
  [[nodiscard]] static bool has_vertex(const Tetrahedron& t, std::uint32_t v) {
    return t[0] == v || t[1] == v || t[2] == v || t[3] == v;
  }

  /// The bodies that meet at a point, ascending, followed by the faces of the box.
  struct Sides {
    std::array<std::uint32_t, 12> values;
    std::size_t count = 0;
    bool overflow = false;  ///< whether there are more than the array can hold
    void add(std::uint32_t value);
    void add_walls(std::uint8_t walls);
    [[nodiscard]] std::size_t bodies() const;  ///< returns the number of bodies, without faces of the box
    bool operator==(const Sides& other) const;
  };
  /// Return the sides that meet at a vertex and along an edge. With two sides, the vertex or edge lies on an
  /// interface or a face of the box, with three on a line.
  [[nodiscard]] Sides sides(std::uint32_t v) const;
  [[nodiscard]] Sides sides(std::uint32_t a, std::uint32_t b) const;
  /// Sets `result` to the cells that have both vertices.
  void cells_at_edge(std::uint32_t a, std::uint32_t b, std::vector<std::uint32_t>& result) const;
  /// Returns the cell beyond the face of a cell that is opposite to its vertex v; kNoNeighbour on the box.
  [[nodiscard]] std::uint32_t neighbour(std::uint32_t cell, std::uint32_t v) const;

  /// A face between two bodies at a vertex: the bodies, and the other two corners.
  struct InterfaceFace {
    Sides bodies;
    std::array<std::uint32_t, 2> ends;
  };
  void interface_faces(std::uint32_t v, std::vector<InterfaceFace>& result) const;

  /// Replaces the cells `removed` by the cells `added`, which fill the same region.
  void replace(std::span<const std::uint32_t> removed, std::span<const Cell> added);
  void move(std::uint32_t v, const Vec3& position);
  void set_body(std::uint32_t cell, BodyId body) { cells_[cell].body = body; }

  /// Returns the cells in use and their vertices.
  [[nodiscard]] ConformingMesh finish() const;

 private:
  void link(std::uint32_t cell);

  Box3 box_;
  std::vector<Vec3> points_;
  std::vector<std::uint8_t> walls_;
  std::vector<Cell> cells_;
  std::vector<double> quality_;
  std::vector<std::uint32_t> unused_;
  std::vector<std::vector<std::uint32_t>> cells_at_;
};

}  // namespace adamas::interfaces
