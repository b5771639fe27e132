#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>

#include "core/geometry/vec3.h"
#include "core/io/meta_image_fields.h"

namespace adamas {

/// Throws Error where the data of a MetaImage file, beside or after its header, have not the size that the
/// header states or cannot be decompressed, neither of which VTK's reader reports. Images in several files
/// and in text pass.
void check_meta_image(const std::filesystem::path& path);

/// The directions of the array's axes that the header states (TransformMatrix), of which VTK's reader knows
/// nothing; nothing where it states none. Throws Error where they are not four or nine numbers.
std::optional<std::array<Vec3, 3>> meta_image_directions(const std::filesystem::path& path);
std::optional<std::array<Vec3, 3>> meta_image_directions(const MetaImageFields& fields,
                                                         const std::string& name);

/// The space of a header's coordinates, as of VolumeGrid: that of ITK where the header tells how its axes lie
/// in a body (AnatomicalOrientation).
std::string meta_image_space(const std::filesystem::path& path);
std::string meta_image_space(const MetaImageFields& fields);

}  // namespace adamas
