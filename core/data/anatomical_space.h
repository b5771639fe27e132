#pragma once

#include <string>
#include <string_view>

#include "adamas/geometry.h"
#include "adamas/volume.h"

namespace adamas::inline core {

/// The name that VolumeGrid has for a space, by its name or abbreviation in NRRD ("LPS",
/// "left-posterior-superior"), in upper or lower case and without its time axis. Empty for an unknown space.
std::string space_of_nrrd(std::string_view name);
/// The name that NRRD has for a space of VolumeGrid; empty for an empty one.
std::string nrrd_space(const std::string& space);
/// Whether a name is one that VolumeGrid may have: one that space_of_nrrd returns.
bool is_space(const std::string& space);

/// Converts the coordinates of a grid into those of another space. Returns false, and changes nothing, where
/// one of the two spaces is not RAS, LAS or LPS.
bool to_space(const std::string& space, VolumeGrid& grid);

}  // namespace adamas::inline core
