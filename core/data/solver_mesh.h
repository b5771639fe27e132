#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "adamas/geometry.h"
#include "core/data/unstructured_mesh.h"

namespace adamas::inline core {

/// A tetrahedral mesh as solvers take it: each tetrahedron belongs to a named block, and named groups of
/// faces stand for boundaries. Neighbours share their points; where bodies are apart, only those of one body
/// do.
struct SolverMesh {
  std::vector<Vec3> points;
  std::vector<std::array<std::uint32_t, 4>> tetrahedra;  ///< positively oriented
  std::vector<std::uint32_t> block;                      ///< the block of each tetrahedron
  std::vector<std::string> blocks;                       ///< the blocks' names
  std::vector<std::int32_t> body;  ///< the body of each tetrahedron; empty where unknown
  struct Face {
    std::uint32_t tetrahedron;
    std::uint8_t opposite;  ///< the face is opposite to this corner of it
  };
  struct FaceGroup {
    std::string name;
    std::vector<Face> faces;
  };
  std::vector<FaceGroup> face_groups;
  std::vector<NamedArray> fields;        ///< doubles, one tuple per tetrahedron
  std::vector<NamedArray> point_fields;  ///< doubles, one tuple per point; none where bodies share points

  /// The corners of a face, counter-clockwise as seen from outside its tetrahedron.
  [[nodiscard]] std::array<std::uint32_t, 3> corners(const Face& face) const {
    constexpr std::array<std::array<std::size_t, 3>, 4> kFaces{{{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};
    const auto& v = tetrahedra[face.tetrahedron];
    const auto& f = kFaces[face.opposite];
    return {v[f[0]], v[f[1]], v[f[2]]};
  }
};

}  // namespace adamas::inline core
