#pragma once

#include <vtkAbstractArray.h>
#include <vtkSmartPointer.h>

#include "core/data/unstructured_mesh.h"

namespace adamas {

/// A NamedArray as VTK's XML writers want it (xml_attribute), and as its readers give it; values bit for bit.
vtkSmartPointer<vtkAbstractArray> to_vtk(const NamedArray& array);
NamedArray from_vtk(vtkAbstractArray& array);

}  // namespace adamas
