#pragma once

#include <filesystem>

#include "core/io/grid_file.h"

namespace adamas {

/// Reads .nrrd or .nhdr, of what NrrdHeader covers. (VTK's reader takes a short first axis for components,
/// and never ends on a header that does not.) Throws Error, with the file's name, at anything but a whole
/// file.
GridFile read_nrrd(const std::filesystem::path& path);

}  // namespace adamas
