#pragma once

#include <string>
#include <string_view>

#include "adamas/volume.h"
#include "core/geometry/vec3.h"

namespace adamas::inline core {

/// A space as VolumeGrid names it, from its name or abbreviation in NRRD in any case ("LPS",
/// "left-posterior-superior"; time apart); empty for one that is not known.
std::string space_of_nrrd(std::string_view name);
/// The name that NRRD has for a space of VolumeGrid; empty for an empty one.
std::string nrrd_space(const std::string& space);
/// Whether VolumeGrid may have such a name: one of those that space_of_nrrd gives.
bool is_space(const std::string& space);

/// Turns the coordinates of a grid into those of another space; false, and nothing is done, where one of them
/// is not RAS, LAS or LPS.
bool to_space(const std::string& space, VolumeGrid& grid);

}  // namespace adamas::inline core
