#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "adamas/geometry.h"
#include "core/io/mesh_file.h"

namespace adamas::io {

/// A block of cells at one level of a mesh with adaptive refinement: x runs fastest.
struct AmrBlock {
  std::size_t level = 0;
  std::array<std::int64_t, 3> begin{};  ///< the index of its first cell among the cells of its level
  std::array<std::int64_t, 3> size{};   ///< cells along each axis
  std::vector<bool> left_out;           ///< cells that are not taken, such as copies; empty: all are taken
};

/// Blocks of cells whose levels refine each other: a level has a whole number of cells along each edge of one
/// cell of the level above it. Cells that finer ones cover may be among them.
struct AmrBlocks {
  Vec3 origin;                ///< where the cells with the index 0 begin, on all levels
  std::vector<Vec3> spacing;  ///< the size of a cell per level, the coarsest first
  std::vector<AmrBlock> blocks;
  bool flat = false;  ///< whether cells are rectangles in the plane of x and y; the third index is then 0
};

/// Per block, what has become a part of a mesh.
struct AmrSources {
  std::vector<std::vector<std::int64_t>> cells;   ///< cells, by their numbers in the block
  std::vector<std::vector<std::int64_t>> points;  ///< points, by their numbers in the block
};

/// Appends the cells of blocks that no finer ones cover, and their points, to an empty `file`: in the order
/// of the blocks, and in theirs. Where finer cells touch a face or an edge, it is divided as theirs are, so
/// that faces of neighbours are the same ones. Throws Error, which begins with `name`, if levels do not
/// refine each other or finer cells cover a part of a cell only.
AmrSources add_amr_cells(const std::string& name, const AmrBlocks& blocks, MeshFile& file);

}  // namespace adamas::io
