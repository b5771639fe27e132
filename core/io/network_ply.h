#pragma once

#include <filesystem>
#include <string>

#include "core/data/interface_mesh.h"

namespace adamas::io {

/// Whether a .ply file is a network with materials as write_interface_mesh writes it: faces that have `front`
/// and `back`. False where there is no such file.
bool is_network_ply(const std::filesystem::path& path);

/// Reads such a network: binary, little endian, coordinates as double, triangles. Throws Error, with the
/// file's name, at anything else, at truncated files and at indices out of range.
InterfaceMesh read_network_ply(const std::filesystem::path& path);

/// Reads such a network from the bytes of a file; `name` is that of the file, for messages.
InterfaceMesh parse_network_ply(const std::string& bytes, const std::string& name);

}  // namespace adamas::io
