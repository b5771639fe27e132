#pragma once

#include <filesystem>

namespace adamas {

/// Throws Error where the data of a MetaImage file, beside or after its header, have not the size that the
/// header states or cannot be decompressed, neither of which VTK's reader reports. Images in several files
/// and in text pass.
void check_meta_image(const std::filesystem::path& path);

}  // namespace adamas
