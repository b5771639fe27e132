#pragma once

#include "core/io/grid_file.h"

class vtkDataArray;

namespace adamas::io {

/// Converts an array of VTK's without loss.
GridArray grid_array(vtkDataArray& source, Centering centering);

}  // namespace adamas::io
