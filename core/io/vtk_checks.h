#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/io/xml_file.h"

namespace adamas::io {

// These functions check what VTK does not report about the files that it reads.

/// Walks through a legacy binary VTK file on an image or rectilinear grid and throws Error if one of its
/// arrays reaches beyond the file's end. Files of other kinds, and text files, pass.
void check_legacy_vtk(const std::filesystem::path& path);

/// Checks a .vti or .vtr: throws Error if the pieces' extents are not within the whole extent or do not cover
/// it, if the extents have more points than the file's bytes can hold values for, and if an array lies
/// outside the file.
void check_vtk_xml(const std::vector<XmlTag>& tags, const std::filesystem::path& path);

/// Checks an XML file that VTK itself is to read: throws Error if an array has more or fewer values than its
/// piece has points or cells. VTK truncates longer ones, so that values are shown at wrong places.
void check_vtk_counts(const std::vector<XmlTag>& tags, const std::filesystem::path& path);

/// Checks a picture: throws Error if its header is incomplete or of a kind that VTK misreads, and if there
/// are fewer pixels than it states and VTK does not report that. Returns a line on bytes that follow the
/// picture; usually empty.
std::string check_picture(const std::filesystem::path& path);

}  // namespace adamas::io
