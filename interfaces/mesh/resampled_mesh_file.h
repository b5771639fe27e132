#pragma once

#include "core/data/unstructured_mesh.h"
#include "interfaces/mesh/resampled_mesh.h"

namespace adamas::interfaces {

/// Converts a mesh to the form of its file. For other programs, the file has at points `material`, `body`,
/// for each field its own value at the point, and for each field and material `FIELD in MATERIAL` with `FIELD
/// in MATERIAL validity` (1: the input's own value, 0: a ghost value or none); and at cells `material` (-1 if
/// interfaces cross it), `level`, `phase`, `interface error` and `FIELD error`. For from_unstructured_mesh(),
/// it has field arrays named `adamas ...` that restore the mesh exactly.
UnstructuredMesh to_unstructured_mesh(const ResampledMesh& mesh);

/// Returns whether the file was made by to_unstructured_mesh().
bool is_resampled_mesh(const UnstructuredMesh& mesh);

/// Returns the mesh that a file holds. Throws Error that names `source` if arrays are missing, have the wrong
/// length, or refer to elements that do not exist.
ResampledMesh from_unstructured_mesh(const UnstructuredMesh& mesh, const std::string& source);

}  // namespace adamas::interfaces
