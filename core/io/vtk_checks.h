#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/io/xml_file.h"

namespace adamas::io {

// Checks of what VTK does not report about the files that it reads.

/// Walks through a legacy binary VTK file on an image or rectilinear grid and throws Error where one of its
/// arrays reaches beyond the file's end. Files of other kinds, and text ones, pass.
void check_legacy_vtk(const std::filesystem::path& path);

/// Checks a .vti or .vtr: throws Error where the pieces' extents are not within the whole one or leave some
/// of it out, where the extents are of more points than the file's bytes can be values of, and where an array
/// lies at no place of the file.
void check_vtk_xml(const std::vector<XmlTag>& tags, const std::filesystem::path& path);

/// Checks an XML file that VTK itself is to read: throws Error where an array has more or fewer values
/// than its piece has points or cells. VTK cuts longer ones, so that values are shown at wrong places.
void check_vtk_counts(const std::vector<XmlTag>& tags, const std::filesystem::path& path);

/// Checks a picture: throws Error where its header is not whole or of a kind that VTK misreads, and where
/// there are fewer pixels than it states, if VTK does not report that. Returns a line on bytes that follow
/// the picture; mostly empty.
std::string check_picture(const std::filesystem::path& path);

}  // namespace adamas::io
