#pragma once

#include <vtkDataSet.h>
#include <vtkSmartPointer.h>

#include <span>
#include <string>
#include <vector>

#include "core/io/grid_file.h"
#include "core/io/mesh_file.h"

class vtkDataArray;

namespace adamas::io {

/// Converts an array of VTK's without loss.
GridArray grid_array(vtkDataArray& source, Centering centering);

/// One data set of a mesh, with what is taken of it.
struct MeshPiece {
  vtkSmartPointer<vtkDataSet> set;
  std::string block;
  std::vector<vtkIdType> cells;   ///< those that are taken, in the order in which the mesh has them
  std::vector<vtkIdType> points;  ///< those that get a number, in the order of these
};

/// Adds the arrays that all pieces have, one piece behind the other, and the names of the materials. Others
/// are named in the file's remark.
void add_arrays_of(const std::string& name, std::span<const MeshPiece> pieces, MeshFile& file);

}  // namespace adamas::io
