#include "core/io/vtk_amr_reader.h"

#include <fmt/format.h>
#include <vtkDataSetAttributes.h>
#include <vtkUniformGrid.h>
#include <vtkUniformGridAMR.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/error.h"
#include "core/io/amr_cells.h"
#include "core/io/vtk_arrays.h"

namespace adamas::io {

namespace {

/// Finds what a file's blocks of cells are.
class AmrCollector {
 public:
  AmrCollector(const std::string& name, vtkUniformGridAMR& amr) : name_(name) {
    std::vector<unsigned> levels;
    for (unsigned level = 0; level < amr.GetNumberOfLevels(); ++level) {
      for (unsigned id = 0; id < amr.GetNumberOfDataSets(level); ++id) {
        vtkUniformGrid* grid = amr.GetDataSet(level, id);
        if (grid == nullptr || grid->GetNumberOfCells() == 0) continue;
        if (levels.empty() || levels.back() != level) add_level(*grid);
        levels.push_back(level);
        grids_.push_back(grid);
        level_of_grid_.push_back(blocks_.spacing.size() - 1);
      }
    }
    if (grids_.empty()) fail("{}: expected blocks of cells, found none", name);
  }

  MeshFile run() {
    blocks_.flat =
        std::ranges::all_of(grids_, [](vtkUniformGrid* grid) { return grid->GetDimensions()[2] == 1; });
    set_origin();
    for (std::size_t n = 0; n < grids_.size(); ++n) add_block(*grids_[n], level_of_grid_[n]);
    MeshFile file;
    const AmrSources sources = add_amr_cells(name_, blocks_, file);
    std::vector<MeshPiece> pieces;
    for (std::size_t n = 0; n < grids_.size(); ++n) {
      if (sources.cells[n].empty()) continue;
      pieces.push_back({grids_[n],
                        {},
                        {sources.cells[n].begin(), sources.cells[n].end()},
                        {sources.points[n].begin(), sources.points[n].end()}});
    }
    if (pieces.empty()) fail("{}: expected cells that are no copies and not hidden, found none", name_);
    if (hidden_ > 0) file.add_remark(fmt::format("{} cells that are hidden are left out", hidden_));
    add_arrays_of(name_, pieces, file);
    return file;
  }

 private:
  void add_level(vtkUniformGrid& grid) {
    const double* spacing = grid.GetSpacing();
    blocks_.spacing.push_back({spacing[0], spacing[1], spacing[2]});
  }

  /// Where a grid begins along an axis.
  static double begin_of(vtkUniformGrid& grid, int axis) {
    return grid.GetOrigin()[axis] + grid.GetExtent()[2 * axis] * grid.GetSpacing()[axis];
  }

  void set_origin() {
    for (int axis = 0; axis < 3; ++axis) {
      double least = std::numeric_limits<double>::infinity();
      for (vtkUniformGrid* grid : grids_) least = std::min(least, begin_of(*grid, axis));
      blocks_.origin[axis] = least;
    }
  }

  void add_block(vtkUniformGrid& grid, std::size_t level) {
    AmrBlock block;
    block.level = level;
    const Vec3& spacing = blocks_.spacing[level];
    for (int axis = 0; axis < 3; ++axis) {
      const auto a = static_cast<std::size_t>(axis);
      block.size[a] = std::max(grid.GetDimensions()[axis] - 1, 1);
      if (blocks_.flat && axis == 2) continue;
      if (grid.GetDimensions()[axis] < 2)
        fail("{}: expected blocks of cells with a volume, or all in the plane of x and y, found others",
             name_);
      const double cells = (begin_of(grid, axis) - blocks_.origin[axis]) / spacing[axis],
                   whole = std::round(cells);
      if (!(spacing[axis] > 0 &&
            std::abs(grid.GetSpacing()[axis] - spacing[axis]) <= kAligned * spacing[axis]))
        fail("{}: expected cells of one size on a level, found {:g} and {:g}", name_, spacing[axis],
             grid.GetSpacing()[axis]);
      if (!(std::abs(cells - whole) <= kAligned && whole < kMostCells))
        fail("{}: expected blocks that begin at cells of their level, found one {:g} cells from the first",
             name_, cells);
      block.begin[a] = static_cast<std::int64_t>(whole);
    }
    leave_out(grid, block);
    blocks_.blocks.push_back(std::move(block));
  }

  /// Leaves out copies of cells of other blocks, and hidden cells.
  void leave_out(vtkUniformGrid& grid, AmrBlock& block) {
    vtkUnsignedCharArray* ghosts = grid.GetCellGhostArray();
    const vtkIdType cells =
        ghosts != nullptr ? std::min(ghosts->GetNumberOfTuples(), grid.GetNumberOfCells()) : 0;
    for (vtkIdType c = 0; c < cells; ++c) {
      const bool copy = (ghosts->GetValue(c) & vtkDataSetAttributes::DUPLICATECELL) != 0,
                 hidden = (ghosts->GetValue(c) & vtkDataSetAttributes::HIDDENCELL) != 0;
      if (!copy && !hidden) continue;
      if (!copy) ++hidden_;
      block.left_out.resize(static_cast<std::size_t>(grid.GetNumberOfCells()));
      block.left_out[static_cast<std::size_t>(c)] = true;
    }
  }

  /// Blocks begin at cells up to this part of one.
  static constexpr double kAligned = 1e-3;
  static constexpr double kMostCells = 1 << 30;

  const std::string& name_;
  std::vector<vtkUniformGrid*> grids_;
  std::vector<std::size_t> level_of_grid_;
  std::size_t hidden_ = 0;
  AmrBlocks blocks_;
};

}  // namespace

MeshFile cells_of_amr(const std::string& name, vtkDataObject& data) {
  auto* amr = vtkUniformGridAMR::SafeDownCast(&data);
  if (amr == nullptr) fail("{}: expected AMR data, found {}", name, data.GetClassName());
  return AmrCollector(name, *amr).run();
}

}  // namespace adamas::io
