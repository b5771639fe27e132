#pragma once

#include <vtkAbstractArray.h>
#include <vtkSmartPointer.h>

#include "core/data/unstructured_mesh.h"

namespace adamas {

/// A NamedArray as VTK's and back, bit for bit.
vtkSmartPointer<vtkAbstractArray> to_vtk(const NamedArray& array);
NamedArray from_vtk(vtkAbstractArray& array);

}  // namespace adamas
