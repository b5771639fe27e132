#pragma once

#include "core/data/unstructured_mesh.h"
#include "interfaces/mesh/resampled_mesh.h"

namespace adamas::interfaces {

/// The mesh as a file holds it. For other programs: at points `material`, `body`, for each field its own
/// value at the point, and for each field and material `FIELD in MATERIAL` with `FIELD in MATERIAL validity`
/// (1: the input's own value, 0: a ghost value or none); at cells `material` (-1 where interfaces cross it),
/// `level`, `phase`, `interface error` and `FIELD error`. For ourselves: field arrays named `adamas ...` that
/// restore it exactly.
UnstructuredMesh to_unstructured_mesh(const ResampledMesh& mesh);

/// Whether the file was made by to_unstructured_mesh.
bool is_resampled_mesh(const UnstructuredMesh& mesh);

/// The mesh that a file holds. Throws Error, naming `source`, where arrays are missing, of the wrong length,
/// or point outside.
ResampledMesh from_unstructured_mesh(const UnstructuredMesh& mesh, const std::string& source);

}  // namespace adamas::interfaces
