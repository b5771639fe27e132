#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace adamas::io {

/// Which data sets of a file of HDF5 are its mesh or grid (set_hdf5_layout()); empty names: none.
struct Hdf5Layout {
  std::string nodes;                ///< coordinates of nodes, a row of two or three each
  std::array<std::string, 3> axes;  ///< coordinates of nodes in a data set each, or axes of a grid
  std::string cells;                ///< a row of nodes for each cell
  std::int64_t base = 0;            ///< the number of the first node, 0 or 1
  std::string boxes;                ///< boxes of blocks of cells
  std::string steps;                ///< groups, one for each time
  std::string times;                ///< times, of which there are as many as other data sets have parts

  /// Whether files are read as cells of a mesh.
  [[nodiscard]] bool of_cells() const {
    return !nodes.empty() || !cells.empty() || !boxes.empty() || !steps.empty() || !times.empty();
  }
  /// Whether files are read as grids.
  [[nodiscard]] bool of_grid() const { return !of_cells() && !axes[0].empty(); }
};

/// Parses texts "KEY=DATA SET". Throws Error (kUsage), which begins with `option`, for other keys and values.
Hdf5Layout parse_hdf5_layout(const std::string& option, const std::vector<std::string>& texts);

/// What set_hdf5_layout() was given last, and the texts.
const Hdf5Layout& hdf5_layout();
const std::vector<std::string>& hdf5_layout_texts();

}  // namespace adamas::io
