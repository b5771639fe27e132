#pragma once

#include <string>

#include "core/data/unstructured_mesh.h"
#include "interfaces/cross_section/cross_section.h"

namespace adamas {

/// The pieces of a section as polygons with points of their own, so that values jump at interfaces: cell
/// arrays `material` and `cell`, the point array `field` unless it is empty, the field array
/// `material_names`.
UnstructuredMesh section_polygons(const CrossSection& section,
                                  const IdVector<MaterialId, std::string>& materials,
                                  const std::string& field);

}  // namespace adamas
