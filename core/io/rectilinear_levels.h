#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/io/amr_cells.h"

namespace adamas::io {

/// A block of a mesh whose cells are boxes.
struct RectilinearBlock {
  std::array<std::vector<double>, 3> nodes;  ///< places of its nodes along each axis
  std::vector<bool> left_out;                ///< cells that are not taken, x fastest; empty: all are taken
  Box3 taken;                                ///< the box of the others
};

/// Finds the levels of blocks by the sizes of their cells. Blocks are levels where they have cells of several
/// sizes, evenly spaced and on lattices that refine each other by whole numbers, and where finer blocks
/// overlap coarser ones or, beside them, have as many cells as fill whole ones. `flat`: blocks have one node
/// along z. `stated`: the file says that its blocks are levels. Returns none where the blocks are no levels;
/// throws Error, which begins with `name`, where they should be, since the file says so or they overlap.
std::optional<AmrBlocks> find_rectilinear_levels(const std::string& name,
                                                 const std::vector<RectilinearBlock>& blocks, bool flat,
                                                 bool stated);

/// Appends the cells of blocks to an empty `file`, as add_amr_cells does: of levels where the file says so
/// and they have cells of several sizes, else of parts of one grid, which may be uneven. Throws Error, which
/// begins with `name`, where they are neither.
AmrSources add_rectilinear_cells(const std::string& name, const std::vector<RectilinearBlock>& blocks,
                                 bool flat, bool stated, MeshFile& file);

}  // namespace adamas::io
