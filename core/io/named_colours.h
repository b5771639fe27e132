#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "core/base/typed_id.h"
#include "core/data/unstructured_mesh.h"

namespace adamas::io {

/// Colours of materials by their names: red, green and blue from 0 to 1.
using NamedColours = std::map<std::string, std::array<double, 3>>;

/// Adds the colours of materials as an array `material_colors`, a row of three numbers per material, -1 where
/// it has no colour. Adds none where no material has one.
void add_colours(const IdVector<MaterialId, std::string>& materials, const NamedColours& colours,
                 std::vector<NamedArray>& arrays);

/// Finds the colours that a table of regions (none if its path is empty) and the header of a file (the same)
/// have for labels, under the names that these get; those of the table come first. A file may be .vtu or .vtp
/// too, or a saved hierarchy, with the array of add_colours(). Throws Error at a damaged table or header.
NamedColours find_named_colours(const std::filesystem::path& file, const std::filesystem::path& region_names);

}  // namespace adamas::io
