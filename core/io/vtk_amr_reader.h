#pragma once

#include <string>

#include "core/io/mesh_file.h"

class vtkDataObject;

namespace adamas::io {

/// Makes a mesh of the cells of an AMR data set that no finer ones cover. Throws Error, which begins with
/// `name`, if its levels or blocks do not fit each other.
MeshFile cells_of_amr(const std::string& name, vtkDataObject& data);

}  // namespace adamas::io
