#pragma once

#include <filesystem>
#include <string>

#include "core/data/interface_mesh.h"

namespace adamas::io {

/// Whether a .ply file is a network with materials as write_interface_mesh writes it: its faces have `front`
/// and `back`. False if the file does not exist.
bool is_network_ply(const std::filesystem::path& path);

/// Reads such a network: binary, little endian, coordinates as double, triangles. Throws Error, with the
/// file's name, for other contents, truncated files and indices out of range.
InterfaceMesh read_network_ply(const std::filesystem::path& path);

/// Reads such a network from the bytes of a file; `name` is the file's name, for messages.
InterfaceMesh parse_network_ply(const std::string& bytes, const std::string& name);

}  // namespace adamas::io
