#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "core/data/interface_mesh.h"
#include "core/io/named_colours.h"

namespace adamas::io {

/// Whether a file is read as a labelled network (.arec, .txt), or as a surface without labels (.obj, .off,
/// .ply, .stl), by its extension.
bool is_network_file(const std::filesystem::path& path);
bool is_surface_file(const std::filesystem::path& path);

/// Reads a labelled network (LabelledNetwork); `region_names` is an optional file of "LABEL NAME" lines. All
/// readers here throw Error, with the file's name, at missing, corrupt or truncated files.
InterfaceMesh read_labelled_network(const std::filesystem::path& path,
                                    const std::filesystem::path& region_names = {});

/// Reads a surface without materials (.obj, .off, .ply, .stl) as the interface between two; its right-hand
/// normals point to the front. Polygons are triangulated, equal points welded, triangles with fewer than
/// three points removed.
InterfaceMesh read_surface(const std::filesystem::path& path, const std::string& front_material,
                           const std::string& back_material);

/// Reads a network that write_interface_mesh wrote as .vtp or .ply, or a labelled network.
InterfaceMesh read_interface_mesh(const std::filesystem::path& path);

/// Merges several networks: equal points become one, and so do materials of equal names.
InterfaceMesh merge(std::span<const InterfaceMesh> meshes);

/// Merges points with equal coordinates; points keep the order of their first use in `mesh.points`. Triangles
/// that lose a corner are removed.
void weld(InterfaceMesh& mesh);

/// Writes the format of the extension: .vtp (cell arrays "front" and "back", names in the field array
/// "material_names"), .ply (binary, doubles, per-face front and back), .obj (a group per interface), .off,
/// .stl (binary, floats), .arec or .txt (labelled network with the materials' indices, of which 1 becomes -1
/// where a reader could not tell the sides apart). Throws Error if the file cannot be written in full.
void write_interface_mesh(const std::filesystem::path& path, const InterfaceMesh& mesh);
/// Writes a mesh, whose arrays are freed as soon as they are converted.
/// `colours`: those of materials, which .vtp has (add_colours()).
void write_interface_mesh(const std::filesystem::path& path, InterfaceMesh&& mesh,
                          const NamedColours& colours = {});

}  // namespace adamas::io
